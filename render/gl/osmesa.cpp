// The lit renderer's module: OpenGL core profile on OSMesa, nothing but software, no display. See lit.hpp.
//
// Every shape is a few triangles larger than itself; the fragment shader knows the distance to the shape's edges and
// makes coverage, normal and light of it. Blending is of premultiplied colours, in drawing order: no depth buffer and
// no samples are needed for a mechanism whose parts lie behind each other.
#define GL_GLEXT_PROTOTYPES  // Debian's libOSMesa exports the modern entry points itself
#include <GL/glcorearb.h>
// glcorearb.h and gl.h cannot be had together; osmesa.h wants only gl.h's types, which are declared above.
#define __gl_h_  // NOLINT(bugprone-reserved-identifier): gl.h's own guard
#define GLAPIENTRY
#include <GL/osmesa.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <new>
#include <vector>

#include "render/base/error.hpp"
#include "render/base/modules.hpp"
#include "render/draw/tiles.hpp"
#include "render/gl/lit.hpp"

namespace beamcam::render {
namespace {

constexpr const char* kRemedy = "choose the flat view: \"view\": {\"style\": \"flat\"}";

// Pixels with y down become clip coordinates; rows run top to bottom, and colours are painted as B, G, R, so that what
// is read back is an Image.
constexpr const char* kRoundVertex = R"(#version 330 core
uniform vec2 size; uniform vec2 centre; uniform float reach;
out vec2 at;
void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
    at = corner * reach;
    vec2 p = (centre + at) / size * 2.0 - 1.0;
    gl_Position = vec4(p, 0.0, 1.0);
})";

// Shared by both lit fragment shaders. Light from the upper left, the viewer straight ahead; colours are lit linearly
// (sRGB taken as a square). Powers are squared out: on a software renderer a power costs as much as all the rest.
constexpr const char* kLight = R"(
const vec3 to_light = normalize(vec3(-0.50, 0.72, 0.85));
const vec3 half_way = normalize(to_light + vec3(0.0, 0.0, 1.0));
float power_32(float x) { x *= x; x *= x; x *= x; x *= x; return x * x; }
vec3 lit(vec3 srgb, vec3 n, vec3 grain, float grain_strength) {
    float sky = 0.5 + 0.5 * n.y, diffuse = max(dot(n, to_light), 0.0), spot = max(dot(n, half_way), 0.0);
    // Scratches along `grain` spread the highlight across them.
    float along = dot(grain, half_way), streak = power_32(1.0 - along * along) * grain_strength;
    vec3 c = srgb * srgb * (0.30 + 0.22 * sky + 0.66 * diffuse) + vec3(0.28 * power_32(spot * spot) + streak);
    return sqrt(clamp(c, 0.0, 1.0));
}
)";

// Shadows are programs of their own: this renderer runs both sides of a branch.
constexpr const char* kRoundShadow = R"(
in vec2 at; out vec4 color;
uniform float radius, hole_radius, soft, opacity; uniform vec2 hole;
void main() {
    float edge = radius - length(at), bore = hole_radius > 0.0 ? length(at - hole) - hole_radius : 1e6;
    color = vec4(0.0, 0.0, 0.0, opacity * smoothstep(-soft, soft, min(edge, bore)));
})";

constexpr const char* kStripShadow = R"(
in vec2 st; out vec4 color;
uniform float length_px, depth_px, soft, opacity;
void main() {
    float ends = min(st.x, length_px - st.x), sides = min(st.y, depth_px - st.y);
    color = vec4(0.0, 0.0, 0.0, opacity * smoothstep(-soft, soft, ends) * smoothstep(-soft, soft, sides));
})";

constexpr const char* kRoundFragment = R"(
in vec2 at; out vec4 color;
uniform vec3 paint; uniform float radius, chamfer, hole_radius; uniform vec2 hole; uniform int finish;
void main() {
    float r = length(at), inner = length(at - hole);
    float edge = radius - r, bore = hole_radius > 0.0 ? inner - hole_radius : 1e6;
    float cover = clamp(edge + 0.5, 0.0, 1.0) * clamp(bore + 0.5, 0.0, 1.0);
    vec2 out_ward = r > 1e-3 ? at / r : vec2(0.0), n = vec2(0.0);
    vec3 grain = vec3(0.0); float strength = 0.0;
    if (finish == 2) n = 0.75 * at / radius;
    else if (finish == 3) n = -0.85 * at / radius;
    else {
        float outer_bevel = chamfer > 0.0 ? 1.0 - smoothstep(0.0, chamfer, edge) : 0.0;
        float bore_bevel = chamfer > 0.0 ? 1.0 - smoothstep(0.0, 0.7 * chamfer, bore) : 0.0;
        n = 0.80 * outer_bevel * out_ward - 0.80 * bore_bevel * (at - hole) / max(inner, 1e-3);
        if (finish == 0) {  // turned on a lathe: scratches run around
            grain = vec3(-out_ward.y, -out_ward.x, 0.0);
            strength = 0.16 * (1.0 - outer_bevel) * smoothstep(0.0, 0.35 * radius, r);
        }
    }
    vec3 normal = vec3(n.x, -n.y, sqrt(max(1.0 - dot(n, n), 0.05)));
    color = vec4(lit(paint, normalize(normal), grain, strength).bgr * cover, cover);
})";

constexpr const char* kStripVertex = R"(#version 330 core
uniform vec2 size, shift;
layout(location = 0) in vec2 where_px; layout(location = 1) in vec2 along_across;
layout(location = 2) in vec2 to_back; layout(location = 3) in vec3 tint;
out vec2 st; out vec2 across_dir; out vec3 paint;
void main() {
    st = along_across; across_dir = to_back; paint = tint;
    vec2 p = (where_px + shift) / size * 2.0 - 1.0;
    gl_Position = vec4(p, 0.0, 1.0);
})";

constexpr const char* kStripFragment = R"(
in vec2 st; in vec2 across_dir; in vec3 paint; out vec4 color;
uniform float length_px, depth_px, chamfer;
void main() {
    float ends = min(st.x, length_px - st.x), sides = min(st.y, depth_px - st.y);
    float cover = clamp(ends + 0.5, 0.0, 1.0) * clamp(sides + 0.5, 0.0, 1.0);
    float w = clamp(st.y / depth_px, 0.0, 1.0), bevel = 1.0 - smoothstep(0.0, chamfer, sides);
    float lean = 0.28 * (2.0 * w - 1.0) + 0.62 * bevel * (w < 0.5 ? -1.0 : 1.0);
    vec2 u = normalize(across_dir), n = u * lean;
    float end_bevel = 1.0 - smoothstep(0.0, chamfer, ends);
    vec2 forward = vec2(u.y, -u.x);
    n += forward * 0.5 * end_bevel * (st.x < 0.5 * length_px ? -1.0 : 1.0);
    vec3 normal = vec3(n.x, -n.y, sqrt(max(1.0 - dot(n, n), 0.05)));
    color = vec4(lit(paint, normalize(normal), vec3(forward.x, -forward.y, 0.0), 0.05).bgr * cover, cover);
})";

// ---- solid bodies --------------------------------------------------------------------------------

// Depth is linear in 1/w: nearest 0.2, farthest 3 of the eye's distance.
constexpr const char* kSolidVertex = R"(#version 330 core
layout(location = 0) in vec3 place; layout(location = 1) in vec3 towards; layout(location = 2) in vec4 tint;
uniform vec3 right, up, near; uniform vec2 size, centre; uniform float distance, zoom, reach;
uniform vec3 light_right, light_up, light_near;
out vec3 normal, lit_at, eye_dir; out vec4 paint;
void main() {
    float w = (distance - dot(near, place)) / distance;
    vec2 px = vec2(dot(right, place), dot(up, place)) * zoom;
    vec2 clip = (vec2(centre.x, size.y - centre.y) * w + px) / size * 2.0 - w;
    const float far_w = 3.0, near_w = 0.2;
    gl_Position = vec4(clip, (far_w + near_w) / (far_w - near_w) * w - 2.0 * far_w * near_w / (far_w - near_w), w);
    normal = towards; paint = tint; eye_dir = near * distance - place;
    lit_at = vec3(dot(light_right, place), dot(light_up, place), -dot(light_near, place)) / reach * 0.5 + 0.5;
})";

// Shadows are the mean of 5 × 5 comparisons, each of them filtered. Light from the sky above, from the floor below and
// from the wall behind stands for what bounces around the room.
constexpr const char* kSolidFragment = R"(#version 330 core
in vec3 normal, lit_at, eye_dir; in vec4 paint; out vec4 color;
uniform sampler2DShadow depths; uniform vec3 light_near; uniform float opacity, texel; uniform vec2 size;
void main() {
    vec3 n = normalize(normal), eye = normalize(eye_dir);
    if (dot(n, eye) < 0.0) n = -n;
    float facing = dot(n, light_near), bias = 0.0012 + 0.003 * (1.0 - clamp(facing, 0.0, 1.0));
    float seen = 0.0;
    for (int y = -2; y <= 2; ++y)
        for (int x = -2; x <= 2; ++x)
            seen += texture(depths, vec3(lit_at.xy + vec2(x, y) * texel, lit_at.z - bias));
    seen /= 25.0;
    if (paint.a == 0.0) {  // fading out before the panel ends
        vec2 rim = smoothstep(0.0, 60.0, min(gl_FragCoord.xy, size - gl_FragCoord.xy));
        color = vec4(0.0, 0.0, 0.0, 0.62 * opacity * (1.0 - seen) * rim.x * rim.y);
        return;
    }
    float diffuse = max(facing, 0.0) * seen, sky = 0.5 + 0.5 * n.y, front = max(n.z, 0.0);
    float spot = pow(max(dot(n, normalize(light_near + eye)), 0.0), 48.0) * seen;
    vec3 c = paint.rgb * paint.rgb * (0.20 + 0.22 * sky + 0.16 * front + 0.72 * diffuse) + vec3(0.16 * spot);
    color = vec4(sqrt(clamp(c, 0.0, 1.0)), 1.0);
})";

constexpr const char* kDepthVertex = R"(#version 330 core
layout(location = 0) in vec3 place;
uniform vec3 light_right, light_up, light_near; uniform float reach;
void main() {
    gl_Position = vec4(dot(light_right, place) / reach, dot(light_up, place) / reach, -dot(light_near, place) / reach, 1.0);
})";
constexpr const char* kDepthFragment = "#version 330 core\nvoid main() {}";
constexpr int kShadowSize = 2048;

GLuint compile(GLenum kind, const std::vector<const char*>& parts) {
    const GLuint shader = glCreateShader(kind);
    glShaderSource(shader, static_cast<GLsizei>(parts.size()), parts.data(), nullptr);
    glCompileShader(shader);
    GLint good = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (!good) {
        std::array<char, 2048> log{};
        glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
        throw GlError(fmt::format("the OpenGL driver refused a shader ({}); {}", log.data(), kRemedy));
    }
    return shader;
}

GLuint link(const char* vertex, const std::vector<const char*>& fragment) {
    const GLuint program = glCreateProgram(), v = compile(GL_VERTEX_SHADER, {vertex}),
                 f = compile(GL_FRAGMENT_SHADER, fragment);
    glAttachShader(program, v);
    glAttachShader(program, f);
    glLinkProgram(program);
    glDeleteShader(v);
    glDeleteShader(f);
    GLint good = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &good);
    if (!good) throw GlError(fmt::format("the OpenGL driver could not link a program; {}", kRemedy));
    return program;
}

GLuint link(const char* vertex, const char* functions, const char* fragment) {
    return link(vertex, {"#version 330 core\n", functions, fragment});
}

struct Vertex {
    float x, y, along, across, bx, by, r, g, b;
};

// The strip widened by `margin` on all sides, as a triangle strip of (face, back) pairs.
struct StripMesh {
    std::vector<Vertex> vertices;
    float length = 0, depth = 0;
};
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
    add(0, direction(0, 1) * -margin, -margin);
    for (std::size_t i = 0; i < n; ++i) {
        if (i > 0) along += norm(middle(i) - middle(i - 1));
        add(i, {}, along);
    }
    add(n - 1, direction(n - 2, n - 1) * margin, along + margin);
    mesh.length = static_cast<float>(along);
    return mesh;
}

class OsmesaRenderer final : public LitRenderer {
  public:
    OsmesaRenderer(int width, int height) : width_(width), height_(height) {
        const int attributes[] = {OSMESA_FORMAT,
                                  OSMESA_BGRA,
                                  OSMESA_DEPTH_BITS,
                                  0,
                                  OSMESA_STENCIL_BITS,
                                  0,
                                  OSMESA_PROFILE,
                                  OSMESA_CORE_PROFILE,
                                  OSMESA_CONTEXT_MAJOR_VERSION,
                                  3,
                                  OSMESA_CONTEXT_MINOR_VERSION,
                                  3,
                                  0};
        context_ = OSMesaCreateContextAttribs(attributes, nullptr);
        if (!context_)
            throw GlError(fmt::format(
                "OSMesa offers no OpenGL 3.3 context; install the Debian package libosmesa6, or {}", kRemedy));
        try {
            use(unused_);
            make_objects();
        } catch (...) {
            OSMesaDestroyContext(context_);
            throw;
        }
    }
    ~OsmesaRenderer() override { OSMesaDestroyContext(context_); }
    OsmesaRenderer(const OsmesaRenderer&) = delete;
    OsmesaRenderer& operator=(const OsmesaRenderer&) = delete;

    std::string name() const override { return name_; }

    void draw(const LitScene& scene, Image& out) override {
        out = Image(width_, height_);
        draw(scene, {{0, 0, width_, height_}}, out);
    }

    void redraw(const LitScene& scene, const Tiles& where, Image& out) override { draw(scene, bands(where), out); }

    void draw(const SolidScene& scene, Image& out) override {
        if (out.width != width_ || out.height != height_) out = Image(width_, height_);
        use(out);
        if (solid_ == 0) make_solid_objects();
        glBindVertexArray(solid_vertices_);
        glBindBuffer(GL_ARRAY_BUFFER, solid_buffer_);
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(scene.triangles.size() * sizeof(SolidVertex)),
                     scene.triangles.data(), GL_STREAM_DRAW);
        const auto count = static_cast<GLsizei>(scene.triangles.size());
        glEnable(GL_DEPTH_TEST);
        glDisable(GL_BLEND);
        // What the light sees. The wall, the first two triangles, casts no shadow.
        glBindFramebuffer(GL_FRAMEBUFFER, shadow_target_);
        glViewport(0, 0, kShadowSize, kShadowSize);
        glClear(GL_DEPTH_BUFFER_BIT);
        glUseProgram(depth_);
        set_light(depth_, scene.reach);
        glDrawArrays(GL_TRIANGLES, 6, count - 6);
        // What the eye sees.
        glBindFramebuffer(GL_FRAMEBUFFER, solid_target_);
        glViewport(0, 0, width_, height_);
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        glUseProgram(solid_);
        set_light(solid_, scene.reach);
        set_view(scene.view);
        set(solid_, "opacity", float(scene.shadow));
        set(solid_, "texel", 1.6F / kShadowSize);
        glDepthMask(GL_FALSE);
        glDrawArrays(GL_TRIANGLES, 0, 6);
        glDepthMask(GL_TRUE);
        glDrawArrays(GL_TRIANGLES, 6, count - 6);
        glDisable(GL_DEPTH_TEST);
        glEnable(GL_BLEND);
        glBindFramebuffer(GL_READ_FRAMEBUFFER, solid_target_);
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
        glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        glFinish();
        require_no_error();
    }

  private:
    struct Band {
        int left, top, right, bottom;  // [px]
    };
    // A few rows of tiles each, as wide as they need: reading one back costs as much as some ten thousand pixels.
    static std::vector<Band> bands(const Tiles& tiles) {
        constexpr int kRows = 4 * Tiles::kHeight;
        std::vector<Band> out;
        tiles.for_each_run([&](int left, int top, int right, int bottom) {
            if (out.empty() || out.back().top / kRows != top / kRows) out.push_back({left, top, right, bottom});
            Band& b = out.back();
            b = {std::min(b.left, left), b.top, std::max(b.right, right), bottom};
        });
        return out;
    }

    void draw(const LitScene& scene, const std::vector<Band>& where, Image& out) {
        use(unused_);
        if (lit_target_ == 0) make_lit_target();
        glBindFramebuffer(GL_FRAMEBUFFER, lit_target_);
        glViewport(0, 0, width_, height_);
        glEnable(GL_SCISSOR_TEST);
        for (const Band& b : where) {
            glScissor(b.left, b.top, b.right - b.left, b.bottom - b.top);
            glClear(GL_COLOR_BUFFER_BIT);
        }
        glDisable(GL_SCISSOR_TEST);
        // Shadows fall on the wall behind everything, to the lower right.
        const Vec2 fall{7 * scene.unit, 11 * scene.unit};
        const float soft = static_cast<float>(11 * scene.unit), opacity = static_cast<float>(scene.shadow);
        for (const LitRound& r : scene.behind)
            if (r.shadow) draw_round(r, fall, soft, opacity);
        draw_strip(scene.strip, fall, soft, opacity);
        for (const LitRound& r : scene.behind) draw_round(r, {}, 0, 1);
        draw_strip(scene.strip, {}, 0, 1);
        const Vec2 near = fall * 0.35;
        for (const LitRound& r : scene.front) {
            if (r.shadow) draw_round(r, near, 0.5F * soft, opacity);
            draw_round(r, {}, 0, 1);
        }
        glFinish();
        const auto drawn = std::chrono::steady_clock::now();
        glPixelStorei(GL_PACK_ROW_LENGTH, width_);
        for (const Band& b : where)
            glReadPixels(b.left, b.top, b.right - b.left, b.bottom - b.top, GL_RGBA, GL_UNSIGNED_BYTE,
                         out.pixels.data() + std::ptrdiff_t(b.top) * width_ + b.left);
        read_back += std::chrono::duration<double>(std::chrono::steady_clock::now() - drawn).count();
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        require_no_error();
    }

    void make_lit_target() {
        GLuint buffer = 0;
        glGenRenderbuffers(1, &buffer);
        glGenFramebuffers(1, &lit_target_);
        glBindFramebuffer(GL_FRAMEBUFFER, lit_target_);
        glBindRenderbuffer(GL_RENDERBUFFER, buffer);
        glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width_, height_);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffer);
        require_target();
    }

    static void set(GLuint program, const char* what, Vec3 a) {
        glUniform3f(glGetUniformLocation(program, what), float(a.x), float(a.y), float(a.z));
    }

    // From the upper left and the front, as in the lit view.
    static void set_light(GLuint program, double reach) {
        set(program, "light_near", Vec3{-0.4096, 0.5898, 0.6962});
        set(program, "light_right", Vec3{0.8619, 0, 0.5071});
        set(program, "light_up", Vec3{0.2991, 0.8076, -0.5084});
        set(program, "reach", float(reach));
    }

    void set_view(const Perspective& view) {
        set(solid_, "right", view.axes[0]);
        set(solid_, "up", view.axes[1]);
        set(solid_, "near", view.axes[2]);
        set(solid_, "size", Vec2{double(width_), double(height_)});
        set(solid_, "centre", view.centre);
        set(solid_, "distance", float(view.distance));
        set(solid_, "zoom", float(view.zoom));
    }

    void make_solid_objects() {
        solid_ = link(kSolidVertex, {kSolidFragment});
        depth_ = link(kDepthVertex, {kDepthFragment});
        glGenVertexArrays(1, &solid_vertices_);
        glGenBuffers(1, &solid_buffer_);
        glBindVertexArray(solid_vertices_);
        glBindBuffer(GL_ARRAY_BUFFER, solid_buffer_);
        const GLint counts[] = {3, 3, 4};
        std::size_t offset = 0;
        for (GLuint i = 0; i < 3; ++i) {
            glEnableVertexAttribArray(i);
            glVertexAttribPointer(
                i, counts[i], GL_FLOAT, GL_FALSE, sizeof(SolidVertex),
                reinterpret_cast<const void*>(offset));  // NOLINT(performance-no-int-to-ptr): as OpenGL has it
            offset += sizeof(float) * static_cast<std::size_t>(counts[i]);
        }
        GLuint buffers[2] = {0, 0};
        glGenRenderbuffers(2, buffers);
        glGenFramebuffers(1, &solid_target_);
        glBindFramebuffer(GL_FRAMEBUFFER, solid_target_);
        glBindRenderbuffer(GL_RENDERBUFFER, buffers[0]);
        glRenderbufferStorageMultisample(GL_RENDERBUFFER, 4, GL_RGBA8, width_, height_);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffers[0]);
        glBindRenderbuffer(GL_RENDERBUFFER, buffers[1]);
        glRenderbufferStorageMultisample(GL_RENDERBUFFER, 4, GL_DEPTH_COMPONENT24, width_, height_);
        glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, buffers[1]);
        require_target();
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
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
    }
    static void require_no_error() {
        const GLenum error = glGetError();
        if (error == GL_OUT_OF_MEMORY) throw std::bad_alloc();
        if (error != GL_NO_ERROR)
            throw GlError(fmt::format("OpenGL reported error 0x{:x} while drawing; {}", error, kRemedy));
    }
    static void require_target() {
        require_no_error();  // a buffer for which there was no memory
        if (const GLenum state = glCheckFramebufferStatus(GL_FRAMEBUFFER); state != GL_FRAMEBUFFER_COMPLETE)
            throw GlError(fmt::format("OpenGL cannot draw into its own memory here (0x{:x}); {}", state, kRemedy));
    }

    // Binds the context to this thread and lets it draw into the picture itself.
    void use(Image& target) {
        if (!OSMesaMakeCurrent(context_, target.pixels.data(), GL_UNSIGNED_BYTE, target.width, target.height))
            throw GlError(fmt::format("OSMesa cannot draw a picture of {}×{} pixels; choose a smaller size, or {}",
                                      width_, height_, kRemedy));
        OSMesaPixelStore(OSMESA_Y_UP, 0);
        glViewport(0, 0, width_, height_);
    }

    void make_objects() {
        name_ = fmt::format("{} {}", reinterpret_cast<const char*>(glGetString(GL_RENDERER)),
                            reinterpret_cast<const char*>(glGetString(GL_VERSION)));
        round_ = link(kRoundVertex, kLight, kRoundFragment);
        round_shadow_ = link(kRoundVertex, "", kRoundShadow);
        strip_ = link(kStripVertex, kLight, kStripFragment);
        strip_shadow_ = link(kStripVertex, "", kStripShadow);
        glGenVertexArrays(1, &no_vertices_);
        glGenVertexArrays(1, &strip_vertices_);
        glGenBuffers(1, &buffer_);
        glBindVertexArray(strip_vertices_);
        glBindBuffer(GL_ARRAY_BUFFER, buffer_);
        const GLint counts[] = {2, 2, 2, 3};
        std::size_t offset = 0;
        for (GLuint i = 0; i < 4; ++i) {
            glEnableVertexAttribArray(i);
            glVertexAttribPointer(
                i, counts[i], GL_FLOAT, GL_FALSE, sizeof(Vertex),
                reinterpret_cast<const void*>(offset));  // NOLINT(performance-no-int-to-ptr): as OpenGL has it
            offset += sizeof(float) * static_cast<std::size_t>(counts[i]);
        }
        glEnable(GL_BLEND);
        glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
        glDisable(GL_DITHER);
        glClearColor(0, 0, 0, 0);
    }

    static void set(GLuint program, const char* what, float a) { glUniform1f(glGetUniformLocation(program, what), a); }
    static void set(GLuint program, const char* what, Vec2 a) {
        glUniform2f(glGetUniformLocation(program, what), float(a.x), float(a.y));
    }

    void draw_round(const LitRound& r, Vec2 shift, float soft, float opacity) {
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
        glUniform1i(glGetUniformLocation(program, "finish"), finish_code(r.finish));
        glUniform3f(glGetUniformLocation(program, "paint"), float(r.color.r), float(r.color.g), float(r.color.b));
        glBindVertexArray(no_vertices_);
        glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    }

    static int finish_code(Finish finish) {
        switch (finish) {
            case Finish::turned:
                return 0;
            case Finish::plain:
                return 1;
            case Finish::dome:
                return 2;
            case Finish::dimple:
                return 3;
        }
        return 1;
    }

    void draw_strip(const LitStrip& strip, Vec2 shift, float soft, float opacity) {
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
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.vertices.size() * sizeof(Vertex)),
                     mesh.vertices.data(), GL_STREAM_DRAW);
        glDrawArrays(GL_TRIANGLE_STRIP, 0, static_cast<GLsizei>(mesh.vertices.size()));
    }

    int width_, height_;
    Image unused_{1, 1};  // what OSMesa wants to draw into while we draw into our own memory
    GLuint lit_target_ = 0;
    OSMesaContext context_ = nullptr;
    std::string name_;
    GLuint round_ = 0, round_shadow_ = 0, strip_ = 0, strip_shadow_ = 0, no_vertices_ = 0, strip_vertices_ = 0,
           buffer_ = 0;
    GLuint solid_ = 0, depth_ = 0, solid_vertices_ = 0, solid_buffer_ = 0, solid_target_ = 0, shadow_target_ = 0;
};

class OsmesaLibrary : public LitLibrary {
  public:
    OsmesaLibrary() = default;
    std::unique_ptr<LitRenderer> make_renderer(int width, int height) const override {
        return std::make_unique<OsmesaRenderer>(width, height);
    }
};
const OsmesaLibrary kLibrary;

}  // namespace
}  // namespace beamcam::render

BEAMCAM_MODULE(static_cast<const beamcam::render::LitLibrary&>(beamcam::render::kLibrary))
