#include "render/gl/module/solid_painter.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/gl/module/shaders.hpp"

namespace beamcam::render {
namespace {

constexpr int kShadowSize = 1024;

void set_light(GLuint program, double reach) {
    set(program, "light_near", kLightNear);
    set(program, "light_right", kLightRight);
    set(program, "light_up", kLightUp);
    set(program, "reach", float(reach));
}

// Draws the triangles of the corners from `first` to before `end`.
void draw_triangles(std::size_t first, std::size_t end) {
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(end - first), GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(  // NOLINT(performance-no-int-to-ptr): required by OpenGL
                       first * sizeof(std::uint32_t)));
}

template <class T>
void upload(GLenum kind, GLuint buffer, const std::vector<T>& data) {
    glBindBuffer(kind, buffer);
    glBufferData(kind, static_cast<GLsizeiptr>(data.size() * sizeof(T)), data.data(), GL_STREAM_DRAW);
}

}  // namespace

SolidPainter::SolidPainter(int width, int height) : width_(width), height_(height) {
    constexpr const char* kVersion = "#version 330 core\n";
    bodies_ = link_program({kSolidVertex}, {kVersion, kSoftShadow, kSolidFragment});
    wall_ = link_program({kSolidVertex}, {kVersion, kSoftShadow, kWallFragment});
    depths_ = link_program({kDepthVertex}, {kDepthFragment});
    glGenVertexArrays(1, &vertices_);
    glGenBuffers(1, &buffer_);
    glGenBuffers(1, &corners_);
    glBindVertexArray(vertices_);
    glBindBuffer(GL_ARRAY_BUFFER, buffer_);
    describe_vertices({3, 3, 4});
    GLuint buffers[2] = {0, 0};
    glGenRenderbuffers(2, buffers);
    glGenFramebuffers(1, &target_);
    glBindFramebuffer(GL_FRAMEBUFFER, target_);
    glBindRenderbuffer(GL_RENDERBUFFER, buffers[0]);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, 4, GL_RGBA8, width_, height_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffers[0]);
    glBindRenderbuffer(GL_RENDERBUFFER, buffers[1]);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, 4, GL_DEPTH_COMPONENT24, width_, height_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, buffers[1]);
    require_target();
    resolved_ = make_target(width_, height_);
    make_shadow_target();
}

void SolidPainter::make_shadow_target() {
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT24, kShadowSize, kShadowSize, 0, GL_DEPTH_COMPONENT, GL_FLOAT,
                 nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    glGenFramebuffers(1, &shadow_target_);
    glBindFramebuffer(GL_FRAMEBUFFER, shadow_target_);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, texture, 0);
    glDrawBuffer(GL_NONE);
    glReadBuffer(GL_NONE);
    require_target();
}

void SolidPainter::draw(const SolidScene& scene, Image& out) {
    glBindVertexArray(vertices_);
    upload(GL_ARRAY_BUFFER, buffer_, scene.mesh.vertices);
    upload(GL_ELEMENT_ARRAY_BUFFER, corners_, scene.mesh.corners);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    draw_depths(scene);
    draw_scene(scene);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glEnable(GL_BLEND);
    read(scene.seen, out);
    require_no_error();
}

// The shadow map. The wall casts no shadow.
void SolidPainter::draw_depths(const SolidScene& scene) {
    glBindFramebuffer(GL_FRAMEBUFFER, shadow_target_);
    glViewport(0, 0, kShadowSize, kShadowSize);
    glClear(GL_DEPTH_BUFFER_BIT);
    glUseProgram(depths_);
    set_light(depths_, scene.reach);
    glFrontFace(GL_CCW);
    draw_triangles(scene.wall, scene.mesh.corners.size());
}

// The picture.
void SolidPainter::draw_scene(const SolidScene& scene) {
    glBindFramebuffer(GL_FRAMEBUFFER, target_);
    glViewport(0, 0, width_, height_);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    use_program(bodies_, scene);
    glFrontFace(GL_CW);  // the picture's rows run from top to bottom
    draw_triangles(scene.wall, scene.mesh.corners.size());
    use_program(wall_, scene);
    set(wall_, "opacity", float(scene.shadow));
    set(wall_, "fade", float(std::max(scene.fade, 1e-3)));
    draw_triangles(0, scene.wall);  // after the bodies, so that hidden pixels are not shaded
}

void SolidPainter::use_program(GLuint program, const SolidScene& scene) {
    const Perspective& view = scene.view;
    glUseProgram(program);
    set_light(program, scene.reach);
    set(program, "right", view.axes[0]);
    set(program, "up", view.axes[1]);
    set(program, "near", view.axes[2]);
    set(program, "size", Vec2{double(width_), double(height_)});
    set(program, "centre", view.centre);
    set(program, "distance", float(view.distance));
    set(program, "zoom", float(view.zoom));
    set(program, "texel", 1.0F / kShadowSize);
    glUniform1i(glGetUniformLocation(program, "more_taps"), 5);
}

// Resolves the samples and reads the pixels.
void SolidPainter::read(const DirtyTiles& seen, Image& out) const {
    std::ranges::fill(out.pixels, 0);
    const std::vector<Band> parts = bands(seen);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target_);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_);
    for (const Band& b : parts)
        glBlitFramebuffer(b.left, b.top, b.right, b.bottom, b.left, b.top, b.right, b.bottom, GL_COLOR_BUFFER_BIT,
                          GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, resolved_);
    glPixelStorei(GL_PACK_ROW_LENGTH, width_);
    for (const Band& b : parts)
        glReadPixels(b.left, b.top, b.right - b.left, b.bottom - b.top, GL_RGBA, GL_UNSIGNED_BYTE,
                     out.pixels.data() + std::ptrdiff_t(b.top) * width_ + b.left);
}

}  // namespace beamcam::render
