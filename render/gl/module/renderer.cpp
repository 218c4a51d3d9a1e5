// The common code of beamcam_osmesa.so and beamcam_egl.so. See gl/renderer.hpp.
#include "render/gl/renderer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string_view>
#include <vector>

#include "render/base/modules.hpp"
#include "render/gl/module/opengl.hpp"
#include "render/gl/module/shaders.hpp"

namespace beamcam::render {
namespace {

// Equal for all kinds of context with the same driver.
std::string driver_name() {
    const std::string_view version = reinterpret_cast<const char*>(glGetString(GL_VERSION)),
                           driver = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    const std::size_t mesa = version.find("Mesa");
    if (mesa == std::string_view::npos) return fmt::format("{} {}", driver, version);
    return fmt::format("{} 3.3 (Core Profile) {}", driver, version.substr(mesa));
}

constexpr Vec3 kLight{-0.4096, 0.5898, 0.6962};  // towards it

template <class T>
void upload(GLenum kind, GLuint buffer, const std::vector<T>& data) {
    glBindBuffer(kind, buffer);
    glBufferData(kind, static_cast<GLsizeiptr>(data.size() * sizeof(T)), data.data(), GL_STREAM_DRAW);
}

// A program with the vertices that it draws.
struct Drawing {
    GLuint program = 0, vertices = 0, buffer = 0;

    void make(std::initializer_list<const char*> vertex, std::initializer_list<const char*> fragment,
              std::initializer_list<GLint> floats) {
        program = link_program(vertex, fragment);
        glGenVertexArrays(1, &vertices);
        glGenBuffers(1, &buffer);
        glBindVertexArray(vertices);
        glBindBuffer(GL_ARRAY_BUFFER, buffer);
        describe_vertices(floats);
    }
    template <class T>
    void begin(const std::vector<T>& data, Vec2 size) const {
        glUseProgram(program);
        set(program, "size", size);
        glBindVertexArray(vertices);
        upload(GL_ARRAY_BUFFER, buffer, data);
    }
};

class Renderer final : public BodyRenderer {
  public:
    Renderer(int width, int height) : width_(width), height_(height), context_(make_context()) {
        context_->make_current();
        name_ = driver_name();
    }

    std::string name() const override { return name_; }

    void draw(const BodyScene& scene, Image& out) override {
        context_->make_current();
        if (!bodies_.program) prepare();
        glClear(GL_COLOR_BUFFER_BIT);
        draw_shadows(scene);
        draw_bodies(scene);
        out = Image(width_, height_);
        glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, out.pixels.data());
        require_no_error();
    }

  private:
    void prepare() {
        bodies_.make({kPlaced, kBodyVertex}, {kNoise, kBodyFragment}, {2, 3, 3, 4, 2});
        shadows_.make({kPlaced, kShadowVertex}, {kNoise, kShadowFragment}, {2, 4, 2});
        glGenBuffers(1, &corners_);
        make_target(width_, height_);
        glViewport(0, 0, width_, height_);
        glClearColor(0, 0, 0, 0);
        glDisable(GL_DITHER);
        glEnable(GL_BLEND);
        glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    }

    // Where shadows meet, the darker one counts.
    void draw_shadows(const BodyScene& scene) const {
        shadows_.begin(scene.shadows, size());
        set(shadows_.program, "fade", float(std::max(scene.fade, 1e-3)));
        glBlendEquation(GL_MAX);
        glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(scene.shadows.size()));
    }

    void draw_bodies(const BodyScene& scene) const {
        bodies_.begin(scene.vertices, size());
        set(bodies_.program, "eye", scene.eye);
        set(bodies_.program, "light", kLight);
        upload(GL_ELEMENT_ARRAY_BUFFER, corners_, scene.corners);
        glBlendEquation(GL_FUNC_ADD);
        glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(scene.corners.size()), GL_UNSIGNED_INT, nullptr);
    }

    Vec2 size() const { return {double(width_), double(height_)}; }

    int width_, height_;
    std::unique_ptr<GlContext> context_;
    Drawing bodies_, shadows_;
    GLuint corners_ = 0;
    std::string name_;
};

const MakeBodyRenderer kMake = [](int width, int height) -> std::unique_ptr<BodyRenderer> {
    return std::make_unique<Renderer>(width, height);
};

}  // namespace
}  // namespace beamcam::render

BEAMCAM_MODULE(beamcam::render::kMake)
