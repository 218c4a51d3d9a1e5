#include "render/gl/module/solid_painter.hpp"

#include <algorithm>
#include <cstddef>

#include "render/gl/module/shaders.hpp"

namespace beamcam::render {
namespace {

constexpr int kShadowSize = 1536;

void set_light(GLuint program, double reach) {
    set(program, "light_near", kLightNear);
    set(program, "light_right", kLightRight);
    set(program, "light_up", kLightUp);
    set(program, "reach", float(reach));
}

// Of the buffer's vertices, those from `first` until before `end`.
void draw_triangles(std::size_t first, std::size_t end) {
    glDrawArrays(GL_TRIANGLES, static_cast<GLint>(first), static_cast<GLsizei>(end - first));
}

}  // namespace

SolidPainter::SolidPainter(int width, int height) : width_(width), height_(height) {
    bodies_ = link_program({kSolidVertex}, {kSolidFragment});
    depths_ = link_program({kDepthVertex}, {kDepthFragment});
    glGenVertexArrays(1, &vertices_);
    glGenBuffers(1, &buffer_);
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
    glBindBuffer(GL_ARRAY_BUFFER, buffer_);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(scene.triangles.size() * sizeof(SolidVertex)),
                 scene.triangles.data(), GL_STREAM_DRAW);
    glEnable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    draw_depths(scene);
    draw_bodies(scene);
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_BLEND);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target_);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_);
    glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, resolved_);
    glPixelStorei(GL_PACK_ROW_LENGTH, width_);
    glReadPixels(0, 0, width_, height_, GL_BGRA, GL_UNSIGNED_BYTE, out.pixels.data());
    require_no_error();
    // OpenGL's first row is the lowest.
    const auto row = [&](int y) { return out.pixels.begin() + std::ptrdiff_t(y) * width_; };
    for (int y = 0; y < height_ / 2; ++y) std::swap_ranges(row(y), row(y + 1), row(height_ - 1 - y));
}

// What the light sees. The wall casts no shadow.
void SolidPainter::draw_depths(const SolidScene& scene) {
    glBindFramebuffer(GL_FRAMEBUFFER, shadow_target_);
    glViewport(0, 0, kShadowSize, kShadowSize);
    glClear(GL_DEPTH_BUFFER_BIT);
    glUseProgram(depths_);
    set_light(depths_, scene.reach);
    draw_triangles(scene.wall, scene.triangles.size());
}

// What the eye sees.
void SolidPainter::draw_bodies(const SolidScene& scene) {
    glBindFramebuffer(GL_FRAMEBUFFER, target_);
    glViewport(0, 0, width_, height_);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glUseProgram(bodies_);
    set_light(bodies_, scene.reach);
    set_view(scene.view);
    set(bodies_, "opacity", float(scene.shadow));
    set(bodies_, "apart", 2.0F / kShadowSize);
    draw_triangles(scene.wall, scene.triangles.size());
    draw_triangles(0, scene.wall);  // behind them: where they hide it, it costs nothing
}

void SolidPainter::set_view(const Perspective& view) {
    set(bodies_, "right", view.axes[0]);
    set(bodies_, "up", view.axes[1]);
    set(bodies_, "near", view.axes[2]);
    set(bodies_, "size", Vec2{double(width_), double(height_)});
    set(bodies_, "centre", view.centre);
    set(bodies_, "distance", float(view.distance));
    set(bodies_, "zoom", float(view.zoom));
}

}  // namespace beamcam::render
