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

// The size of the picture's part from its first pixel to the last tile.
struct Extent {
    int width = 0, height = 0;
};
Extent extent_of(const DirtyTiles& tiles) {
    Extent out;
    tiles.for_each_run([&](int, int, int right, int bottom) {
        out = {std::max(out.width, right), std::max(out.height, bottom)};
    });
    return out;
}

}  // namespace

SolidPainter::SolidPainter(int width, int height) : width_(width), height_(height) {
    constexpr const char* kVersion = "#version 330 core\n";
    bodies_ = link_program({kSolidVertex}, {kVersion, kSoftShadow, kSolidFragment});
    wall_ = link_program({kSolidVertex}, {kVersion, kSoftShadow, kWallFragment});
    depths_ = link_program({kDepthVertex}, {kDepthFragment});
    mean_ = link_program({kTileVertex}, {kMeanFragment});
    glGenVertexArrays(1, &vertices_);
    glGenBuffers(1, &buffer_);
    glGenBuffers(1, &corners_);
    glBindVertexArray(vertices_);
    glBindBuffer(GL_ARRAY_BUFFER, buffer_);
    describe_vertices({3, 3, 4});
    glGenVertexArrays(1, &tiles_);
    glGenBuffers(1, &tile_buffer_);
    glBindVertexArray(tiles_);
    glBindBuffer(GL_ARRAY_BUFFER, tile_buffer_);
    describe_vertices({2});
    glGenTextures(1, &samples_);
    glGenRenderbuffers(1, &sample_depths_);
    glGenFramebuffers(1, &target_);
    picture_ = make_target(width_, height_);
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

// Makes the buffers of samples at least this large. They grow in steps, because bodies move.
void SolidPainter::fit_samples(int width, int height) {
    if (width <= samples_width_ && height <= samples_height_) return;
    constexpr int kStep = 128;
    const auto grown = [](int now, int needed, int most) {
        return std::max(now, std::min((needed + kStep - 1) / kStep * kStep, most));
    };
    samples_width_ = grown(samples_width_, width, width_), samples_height_ = grown(samples_height_, height, height_);
    glBindFramebuffer(GL_FRAMEBUFFER, target_);
    glBindTexture(GL_TEXTURE_2D_MULTISAMPLE, samples_);
    glTexImage2DMultisample(GL_TEXTURE_2D_MULTISAMPLE, 4, GL_RGBA8, samples_width_, samples_height_, GL_TRUE);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D_MULTISAMPLE, samples_, 0);
    glBindRenderbuffer(GL_RENDERBUFFER, sample_depths_);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, 4, GL_DEPTH_COMPONENT24, samples_width_, samples_height_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, sample_depths_);
    require_target();
}

void SolidPainter::draw(const SolidScene& scene, Image& out) {
    const Extent extent = extent_of(scene.bodies);
    fit_samples(extent.width, extent.height);
    glBindVertexArray(vertices_);
    upload(GL_ARRAY_BUFFER, buffer_, scene.mesh.vertices);
    upload(GL_ELEMENT_ARRAY_BUFFER, corners_, scene.mesh.corners);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    draw_depths(scene);
    draw_wall(scene);
    if (extent.width > 0) draw_bodies(scene);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glEnable(GL_BLEND);
    if (extent.width > 0) blend_bodies(scene.bodies);
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

void SolidPainter::draw_wall(const SolidScene& scene) {
    glBindFramebuffer(GL_FRAMEBUFFER, picture_);
    glViewport(0, 0, width_, height_);
    glClear(GL_COLOR_BUFFER_BIT);
    use_program(wall_, scene);
    set(wall_, "opacity", float(scene.shadow));
    set(wall_, "fade", float(std::max(scene.fade, 1e-3)));
    glFrontFace(GL_CW);  // the picture's rows run from top to bottom
    draw_triangles(0, scene.wall);
}

void SolidPainter::draw_bodies(const SolidScene& scene) {
    glBindFramebuffer(GL_FRAMEBUFFER, target_);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    use_program(bodies_, scene);
    draw_triangles(scene.wall, scene.mesh.corners.size());
}

void SolidPainter::blend_bodies(const DirtyTiles& where) {
    std::vector<float> corners;  // of two triangles for each run
    where.for_each_run([&](float left, float top, float right, float bottom) {
        corners.insert(corners.end(), {left, top, right, top, left, bottom, left, bottom, right, top, right, bottom});
    });
    glBindFramebuffer(GL_FRAMEBUFFER, picture_);
    glBindVertexArray(tiles_);
    upload(GL_ARRAY_BUFFER, tile_buffer_, corners);
    glUseProgram(mean_);
    set(mean_, "size", Vec2{double(width_), double(height_)});
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(corners.size() / 2));
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

void SolidPainter::read(const DirtyTiles& seen, Image& out) const {
    std::ranges::fill(out.pixels, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, picture_);
    glPixelStorei(GL_PACK_ROW_LENGTH, width_);
    for (const Band& b : bands(seen))
        glReadPixels(b.left, b.top, b.right - b.left, b.bottom - b.top, GL_RGBA, GL_UNSIGNED_BYTE,
                     out.pixels.data() + std::ptrdiff_t(b.top) * width_ + b.left);
}

}  // namespace beamcam::render
