// The shaders of lit and solid views. They use products instead of powers, and separate programs instead of branches,
// because a software renderer executes both sides of a branch.
#pragma once

namespace beamcam::render {

// Converts pixels with y down to clip coordinates. Rows run top to bottom and colours are written as B, G, R, so that
// the pixels read back form an Image.
inline constexpr const char* kRoundVertex = R"(#version 330 core
uniform vec2 size; uniform vec2 centre; uniform float reach;
out vec2 at;
void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
    at = corner * reach;
    vec2 p = (centre + at) / size * 2.0 - 1.0;
    gl_Position = vec4(p, 0.0, 1.0);
})";

// Shared by both lit fragment shaders. The light is at the upper left, the viewer in front; lighting is computed with
// linear colours (sRGB approximated by a square).
inline constexpr const char* kLight = R"(
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

inline constexpr const char* kRoundShadow = R"(
in vec2 at; out vec4 color;
uniform float radius, hole_radius, soft, opacity; uniform vec2 hole;
void main() {
    float edge = radius - length(at), bore = hole_radius > 0.0 ? length(at - hole) - hole_radius : 1e6;
    color = vec4(0.0, 0.0, 0.0, opacity * smoothstep(-soft, soft, min(edge, bore)));
})";

inline constexpr const char* kStripShadow = R"(
in vec2 st; out vec4 color;
uniform float length_px, depth_px, soft, opacity;
void main() {
    float ends = min(st.x, length_px - st.x), sides = min(st.y, depth_px - st.y);
    color = vec4(0.0, 0.0, 0.0, opacity * smoothstep(-soft, soft, ends) * smoothstep(-soft, soft, sides));
})";

inline constexpr const char* kRoundFragment = R"(
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

inline constexpr const char* kStripVertex = R"(#version 330 core
uniform vec2 size, shift;
layout(location = 0) in vec2 where_px; layout(location = 1) in vec2 along_across;
layout(location = 2) in vec2 to_back; layout(location = 3) in vec3 tint;
out vec2 st; out vec2 across_dir; out vec3 paint;
void main() {
    st = along_across; across_dir = to_back; paint = tint;
    vec2 p = (where_px + shift) / size * 2.0 - 1.0;
    gl_Position = vec4(p, 0.0, 1.0);
})";

inline constexpr const char* kStripFragment = R"(
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

// Depth is linear in 1/w; near plane at 0.2, far plane at 3 times the camera's distance.
inline constexpr const char* kSolidVertex = R"(#version 330 core
layout(location = 0) in vec3 place; layout(location = 1) in vec3 towards; layout(location = 2) in vec4 tint;
uniform vec3 right, up, near; uniform vec2 size, centre; uniform float distance, zoom, reach;
uniform vec3 light_right, light_up, light_near;
out vec3 normal, lit_at, eye_dir; out vec4 paint;
void main() {
    float w = (distance - dot(near, place)) / distance;
    vec2 px = vec2(dot(right, place), dot(up, place)) * zoom;
    vec2 clip = (vec2(centre.x, size.y - centre.y) * w + px) / size * 2.0 - w;
    const float far_w = 3.0, near_w = 0.2;
    gl_Position = vec4(clip.x, -clip.y, (far_w + near_w) / (far_w - near_w) * w - 2.0 * far_w * near_w / (far_w - near_w), w);
    normal = towards; paint = tint; eye_dir = near * distance - place;
    lit_at = vec3(dot(light_right, place), dot(light_up, place), -dot(light_near, place)) / reach * 0.5 + 0.5;
})";

// Shared by the wall and the bodies. A shadow is the mean of four comparisons at the corners of a square and of up to
// five `more` between them, each filtered over 2 × 2 texels. Comparisons dominate the cost of a pixel: bodies have
// four; the wall, where long edges make steps of the map visible, has nine, but only where the four differ. The number
// of `more` is a uniform, because this renderer skips iterations of loops but executes both sides of a branch.
inline constexpr const char* kSoftShadow = R"(
in vec3 normal, lit_at, eye_dir; in vec4 paint; out vec4 color;
uniform sampler2DShadow depths; uniform vec3 light_near; uniform float texel; uniform int more_taps;
float tap(vec2 at, float depth) { return texture(depths, vec3(lit_at.xy + at * texel, depth)); }
float light_that_arrives(float facing, float far, int more) {
    float depth = lit_at.z - 0.0018 - 0.0045 * (1.0 - clamp(facing, 0.0, 1.0)), taps = 4.0;
    float seen = tap(vec2(-far, -far), depth) + tap(vec2(far, -far), depth) + tap(vec2(-far, far), depth) +
                 tap(vec2(far, far), depth);
    int rest = seen == 0.0 || seen == 4.0 ? 0 : more;
    for (int i = 0; i < rest; ++i) {
        float side = far * (2.0 * float(i & 1) - 1.0);
        seen += tap(i < 2 ? vec2(side, 0.0) : i < 4 ? vec2(0.0, side) : vec2(0.0), depth);
        taps += 1.0;
    }
    return seen / taps;
}
)";

// Interpolated normals may point slightly away from the camera at silhouettes; only clearly reversed ones are flipped.
// Light from above, below and behind approximates indirect light.
inline constexpr const char* kSolidFragment = R"(
float power_48(float x) { x *= x; x *= x; x *= x; x *= x; return x * x * x; }
void main() {
    vec3 n = normalize(normal), eye = normalize(eye_dir);
    if (dot(n, eye) < -0.2) n = -n;
    float facing = dot(n, light_near), seen = light_that_arrives(facing, 1.0, 0);
    float diffuse = max(facing, 0.0) * seen, sky = 0.5 + 0.5 * n.y, front = max(n.z, 0.0);
    float spot = power_48(max(dot(n, normalize(light_near + eye)), 0.0)) * seen;
    vec3 c = paint.rgb * paint.rgb * (0.20 + 0.22 * sky + 0.16 * front + 0.72 * diffuse) + vec3(0.16 * spot);
    color = vec4(sqrt(clamp(c, 0.0, 1.0)).bgr, 1.0);
})";

// The wall, whose normal is z, shows only shadows.
inline constexpr const char* kWallFragment = R"(
uniform float opacity, fade; uniform vec2 size;
void main() {
    float seen = light_that_arrives(light_near.z, 2.0, more_taps);
    vec2 rim = smoothstep(0.0, fade, min(gl_FragCoord.xy, size - gl_FragCoord.xy));
    color = vec4(0.0, 0.0, 0.0, 0.62 * opacity * (1.0 - seen) * rim.x * rim.y);
})";

// Draws parts of the picture [px]: the means of the samples of the bodies.
inline constexpr const char* kTileVertex = R"(#version 330 core
layout(location = 0) in vec2 corner; uniform vec2 size;
void main() { gl_Position = vec4(corner / size * 2.0 - 1.0, 0.0, 1.0); })";
inline constexpr const char* kMeanFragment = R"(#version 330 core
uniform sampler2DMS samples; out vec4 color;
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    color = 0.25 * (texelFetch(samples, at, 0) + texelFetch(samples, at, 1) + texelFetch(samples, at, 2) +
                    texelFetch(samples, at, 3));
})";

inline constexpr const char* kDepthVertex = R"(#version 330 core
layout(location = 0) in vec3 place;
uniform vec3 light_right, light_up, light_near; uniform float reach;
void main() {
    gl_Position = vec4(dot(light_right, place) / reach, dot(light_up, place) / reach, -dot(light_near, place) / reach, 1.0);
})";
inline constexpr const char* kDepthFragment = "#version 330 core\nvoid main() {}";

}  // namespace beamcam::render
