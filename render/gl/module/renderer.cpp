// The common code of beamcam_osmesa.so and beamcam_egl.so: lit and solid views. See lit.hpp.
#include <fmt/format.h>

#include <memory>
#include <string_view>

#include "render/base/modules.hpp"
#include "render/draw/dirty_tiles.hpp"
#include "render/gl/lit.hpp"
#include "render/gl/module/lit_painter.hpp"
#include "render/gl/module/opengl.hpp"
#include "render/gl/module/solid_painter.hpp"

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

class Renderer final : public LitRenderer {
  public:
    Renderer(int width, int height) : width_(width), height_(height), context_(make_context()) {
        context_->make_current();
        glEnable(GL_BLEND);
        glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
        glDisable(GL_DITHER);
        glClearColor(0, 0, 0, 0);
        name_ = driver_name();
    }

    std::string name() const override { return name_; }

    void draw(const LitScene& scene, const DirtyTiles* where, Image& out) override {
        if (!where) out = Image(width_, height_);
        context_->make_current();
        if (!lit_) lit_ = std::make_unique<LitPainter>(width_, height_);
        read_back += lit_->draw(scene, where, out);
    }

    void draw(const SolidScene& scene, Image& out) override {
        if (out.width != width_ || out.height != height_) out = Image(width_, height_);
        context_->make_current();
        if (!solid_) solid_ = std::make_unique<SolidPainter>(width_, height_);
        solid_->draw(scene, out);
    }

  private:
    int width_, height_;
    std::unique_ptr<GlContext> context_;
    std::unique_ptr<LitPainter> lit_;
    std::unique_ptr<SolidPainter> solid_;
    std::string name_;
};

class Library final : public LitLibrary {
  public:
    Library() = default;
    std::unique_ptr<LitRenderer> make_renderer(int width, int height) const override {
        return std::make_unique<Renderer>(width, height);
    }
};
const Library kLibrary;

}  // namespace
}  // namespace beamcam::render

BEAMCAM_MODULE(static_cast<const beamcam::render::LitLibrary&>(beamcam::render::kLibrary))
