#include "render/gl/module/solid_painter.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

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

// Draws the vertices from `first` to before `end`.
void draw_triangles(std::size_t first, std::size_t end) {
    glDrawArrays(GL_TRIANGLES, static_cast<GLint>(first), static_cast<GLsizei>(end - first));
}

}  // namespace

SolidPainter::SolidPainter(int width, int height) : width_(width), height_(height) {
    constexpr const char* kVersion = "#version 330 core\n";
    bodies_ = link_program({kSolidVertex}, {kVersion, kSoftShadow, kSolidFragment});
    wall_ = link_program({kSolidVertex}, {kVersion, kSoftShadow, kWallFragment});
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
    const Part part = part_of(scene);
    glEnable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    draw_depths(scene);
    draw_scene(scene);
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_BLEND);
    read(part, out);
    require_no_error();
}

SolidPainter::Part SolidPainter::part_of(const SolidScene& scene) const {
    const auto whole = [](double at, int most) { return static_cast<int>(std::clamp<double>(at, 0, most)); };
    return {whole(std::floor(scene.seen.x), width_), whole(std::floor(scene.seen.y), height_),
            whole(std::ceil(scene.seen.right()), width_), whole(std::ceil(scene.seen.bottom()), height_)};
}

// The shadow map. The wall casts no shadow.
void SolidPainter::draw_depths(const SolidScene& scene) {
    glBindFramebuffer(GL_FRAMEBUFFER, shadow_target_);
    glViewport(0, 0, kShadowSize, kShadowSize);
    glClear(GL_DEPTH_BUFFER_BIT);
    glUseProgram(depths_);
    set_light(depths_, scene.reach);
    draw_triangles(scene.wall, scene.triangles.size());
}

// The picture.
void SolidPainter::draw_scene(const SolidScene& scene) {
    glBindFramebuffer(GL_FRAMEBUFFER, target_);
    glViewport(0, 0, width_, height_);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    use_program(bodies_, scene);
    draw_triangles(scene.wall, scene.front);
    use_program(wall_, scene);
    set(wall_, "opacity", float(scene.shadow));
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
void SolidPainter::read(const Part& part, Image& out) const {
    std::ranges::fill(out.pixels, 0);
    if (part.left >= part.right || part.top >= part.bottom) return;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target_);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_);
    glBlitFramebuffer(part.left, part.top, part.right, part.bottom, part.left, part.top, part.right, part.bottom,
                      GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, resolved_);
    glPixelStorei(GL_PACK_ROW_LENGTH, width_);
    glReadPixels(part.left, part.top, part.right - part.left, part.bottom - part.top, GL_RGBA, GL_UNSIGNED_BYTE,
                 out.pixels.data() + std::ptrdiff_t(part.top) * width_ + part.left);
}

}  // namespace beamcam::render
