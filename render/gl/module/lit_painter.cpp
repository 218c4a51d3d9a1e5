#include "render/gl/module/lit_painter.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "render/gl/module/shaders.hpp"
#include "sim/base/clock.hpp"

namespace beamcam::render {
namespace {

struct Vertex {
    float x, y, along, across, bx, by, r, g, b;
};

// The strip widened by `margin` on all sides, as a triangle strip of (face, back) pairs.
struct StripMesh {
    std::vector<Vertex> vertices;
    float length = 0, depth = 0;
};
// A closed strip has no ends, and no edge at its back: the shader takes it for half of one of twice the depth.
StripMesh closed_mesh(const LitStrip& strip, double margin) {
    constexpr float kFarFromEnds = 1e6F;  // [px]
    StripMesh mesh;
    for (std::size_t k = 0; k <= strip.face.size(); ++k) {
        const std::size_t i = k % strip.face.size();
        const Vec2 across = strip.back[i] - strip.face[i];
        const double depth = norm(across);
        const Vec2 u = across * (1 / depth), edge = strip.face[i] - u * margin;
        const Color& c = strip.colors[i];
        const auto vertex = [&](Vec2 p, double t) {
            mesh.vertices.push_back({float(p.x), float(p.y), kFarFromEnds, float(t), float(u.x), float(u.y), float(c.r),
                                     float(c.g), float(c.b)});
        };
        vertex(edge, -margin);
        vertex(strip.back[i], depth);
        mesh.depth = std::max(mesh.depth, static_cast<float>(2 * depth));
    }
    mesh.length = 2 * kFarFromEnds;
    return mesh;
}
StripMesh strip_mesh(const LitStrip& strip, double margin) {
    StripMesh mesh;
    const std::size_t n = strip.face.size();
    double along = 0;
    mesh.depth = static_cast<float>(norm(strip.back[0] - strip.face[0]));
    const auto middle = [&](std::size_t i) { return (strip.face[i] + strip.back[i]) * 0.5; };
    const auto add = [&](std::size_t i, Vec2 shift, double s) {
        const Vec2 across = strip.back[i] - strip.face[i];
        const Vec2 u = across * (1 / norm(across));
        const Color& c = strip.colors[i];
        const auto vertex = [&](Vec2 p, double t) {
            mesh.vertices.push_back({float(p.x), float(p.y), float(s), float(t), float(u.x), float(u.y), float(c.r),
                                     float(c.g), float(c.b)});
        };
        vertex(strip.face[i] - u * margin + shift, -margin);
        vertex(strip.back[i] + u * margin + shift, mesh.depth + margin);
    };
    const auto direction = [&](std::size_t a, std::size_t b) {
        const Vec2 d = middle(b) - middle(a);
        return d * (1 / norm(d));
    };
    if (strip.closed) return closed_mesh(strip, margin);
    add(0, direction(0, 1) * -margin, -margin);
    for (std::size_t i = 0; i < n; ++i) {
        if (i > 0) along += norm(middle(i) - middle(i - 1));
        add(i, {}, along);
    }
    add(n - 1, direction(n - 2, n - 1) * margin, along + margin);
    mesh.length = static_cast<float>(along);
    return mesh;
}

}  // namespace

LitPainter::LitPainter(int width, int height) : width_(width), height_(height) {
    constexpr const char* kVersion = "#version 330 core\n";
    round_ = link_program({kRoundVertex}, {kVersion, kLight, kRoundFragment});
    round_shadow_ = link_program({kRoundVertex}, {kVersion, kRoundShadow});
    strip_ = link_program({kStripVertex}, {kVersion, kLight, kStripFragment});
    strip_shadow_ = link_program({kStripVertex}, {kVersion, kStripShadow});
    glGenVertexArrays(1, &no_vertices_);
    glGenVertexArrays(1, &strip_vertices_);
    glGenBuffers(1, &buffer_);
    glBindVertexArray(strip_vertices_);
    glBindBuffer(GL_ARRAY_BUFFER, buffer_);
    describe_vertices({2, 2, 2, 3});
    target_ = make_target(width, height);
}

double LitPainter::draw(const LitScene& scene, const DirtyTiles* where, Image& out) {
    const std::vector<Band> changed = where ? bands(*where) : std::vector<Band>{{0, 0, width_, height_}};
    glBindFramebuffer(GL_FRAMEBUFFER, target_);
    glViewport(0, 0, width_, height_);
    glEnable(GL_SCISSOR_TEST);
    for (const Band& b : changed) {
        glScissor(b.left, b.top, b.right - b.left, b.bottom - b.top);
        glClear(GL_COLOR_BUFFER_BIT);
    }
    glDisable(GL_SCISSOR_TEST);
    draw_shapes(scene);
    glFinish();
    const auto drawn = Clock::now();
    glPixelStorei(GL_PACK_ROW_LENGTH, width_);
    for (const Band& b : changed)
        glReadPixels(b.left, b.top, b.right - b.left, b.bottom - b.top, GL_RGBA, GL_UNSIGNED_BYTE,
                     out.pixels.data() + std::ptrdiff_t(b.top) * width_ + b.left);
    require_no_error();
    return seconds_since(drawn);
}

void LitPainter::draw_shapes(const LitScene& scene) {
    // Shadows fall to the lower right, on the wall behind everything.
    const Vec2 fall{7 * scene.unit, 11 * scene.unit};
    const float soft = static_cast<float>(11 * scene.unit), opacity = static_cast<float>(scene.shadow);
    if (scene.cam) draw_strip(*scene.cam, fall, soft, opacity);
    for (const LitRound& r : scene.behind)
        if (r.shadow) draw_round(r, fall, soft, opacity);
    draw_strip(scene.strip, fall, soft, opacity);
    if (scene.cam) draw_strip(*scene.cam, {}, 0, 1);
    for (const LitRound& r : scene.behind) draw_round(r, {}, 0, 1);
    draw_strip(scene.strip, {}, 0, 1);
    const Vec2 near = fall * 0.35;
    for (const LitRound& r : scene.front) {
        if (r.shadow) draw_round(r, near, 0.5F * soft, opacity);
        draw_round(r, {}, 0, 1);
    }
}

void LitPainter::draw_round(const LitRound& r, Vec2 shift, float soft, float opacity) {
    const GLuint program = soft > 0 ? round_shadow_ : round_;
    glUseProgram(program);
    set(program, "size", Vec2{double(width_), double(height_)});
    set(program, "centre", r.centre + shift);
    set(program, "reach", float(r.radius + 1.5 + soft));
    set(program, "radius", float(r.radius));
    set(program, "chamfer", float(r.chamfer));
    set(program, "hole", r.hole - r.centre);
    set(program, "hole_radius", float(r.hole_radius));
    set(program, "soft", soft);
    set(program, "opacity", opacity);
    glUniform1i(glGetUniformLocation(program, "finish"), static_cast<int>(r.finish));
    glUniform3f(glGetUniformLocation(program, "paint"), float(r.color.r), float(r.color.g), float(r.color.b));
    glBindVertexArray(no_vertices_);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

void LitPainter::draw_strip(const LitStrip& strip, Vec2 shift, float soft, float opacity) {
    if (strip.face.size() < 2) return;
    const StripMesh mesh = strip_mesh(strip, 1.5 + soft);
    const GLuint program = soft > 0 ? strip_shadow_ : strip_;
    glUseProgram(program);
    set(program, "size", Vec2{double(width_), double(height_)});
    set(program, "shift", shift);
    set(program, "length_px", mesh.length);
    set(program, "depth_px", mesh.depth);
    set(program, "chamfer", float(strip.chamfer));
    set(program, "soft", soft);
    set(program, "opacity", opacity);
    glBindVertexArray(strip_vertices_);
    glBindBuffer(GL_ARRAY_BUFFER, buffer_);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.vertices.size() * sizeof(Vertex)), mesh.vertices.data(),
                 GL_STREAM_DRAW);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, static_cast<GLsizei>(mesh.vertices.size()));
}

}  // namespace beamcam::render
