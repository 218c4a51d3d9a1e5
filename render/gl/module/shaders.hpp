// The shaders of bodies and shadows. They use products instead of powers, because the renderer is software.
#pragma once

namespace beamcam::render {

// Pixels, y down, to clip coordinates. Rows run top to bottom and colours are written as B, G, R, so that the pixels
// read back form an Image.
inline constexpr const char* kPlaced = R"(#version 330 core
uniform vec2 size;
vec4 placed(vec2 pixel) { return vec4(pixel / size * 2.0 - 1.0, 0.0, 1.0); })";

// Noise of one level hides the steps between levels of soft gradients.
inline constexpr const char* kNoise = R"(#version 330 core
float noise() { return (fract(52.98 * fract(dot(gl_FragCoord.xy, vec2(0.06711, 0.00584)))) - 0.5) / 255.0; })";

inline constexpr const char* kBodyVertex = R"(
layout(location = 0) in vec2 pixel; layout(location = 1) in vec3 place; layout(location = 2) in vec3 towards;
layout(location = 3) in vec4 tint; layout(location = 4) in vec2 across_grain;
uniform vec3 eye, light;
out vec3 normal, half_way; out vec4 paint; out vec2 across;
void main() {
    gl_Position = placed(pixel);
    normal = towards; paint = tint; across = across_grain;
    half_way = normalize(light + normalize(eye - place));
})";

// The surroundings are white above and grey below, with one soft light at the upper left. Scratches spread its
// reflection across them. A front face in the plane of motion has about the brightness of its colour. Colours are
// linear (sRGB approximated by a square).
inline constexpr const char* kBodyFragment = R"(
in vec3 normal, half_way; in vec4 paint; in vec2 across; out vec4 color;
uniform vec3 light;
float power_24(float x) { x *= x * x; x *= x; x *= x; return x * x; }
void main() {
    vec3 n = normalize(normal);
    float facing = max(dot(n, light), 0.0), diffuse = 0.36 + 0.14 * n.y + 0.92 * facing;
    float grain = dot(across, across), along = dot(vec2(-across.y, across.x), half_way.xy);
    float mirrored = grain > 0.0 ? 1.0 - along * along / grain : max(dot(n, half_way), 0.0);
    vec3 c = paint.rgb * paint.rgb * diffuse + vec3(0.10 * power_24(mirrored) * facing);
    color = vec4(clamp(sqrt(max(c, 0.0)).bgr + noise(), 0.0, 1.0), 1.0) * paint.a;
})";

// A shadow is the share of the light that a strip, or a disc, covers. Where shadows meet, the darker one counts.
inline constexpr const char* kShadowVertex = R"(
layout(location = 0) in vec2 pixel; layout(location = 1) in vec4 inside; layout(location = 2) in vec2 tone;
out vec4 within; out vec2 shade;
void main() { gl_Position = placed(pixel); within = inside; shade = tone; })";
inline constexpr const char* kShadowFragment = R"(
in vec4 within; in vec2 shade; out vec4 color;
uniform vec2 size; uniform float fade;
void main() {
    vec4 covered = smoothstep(-1.0, 1.0, within);
    vec2 rim = smoothstep(0.0, fade, min(gl_FragCoord.xy, size - gl_FragCoord.xy));
    float alpha = shade.x * max(covered.x + covered.y - 1.0, 0.0) * max(covered.z + covered.w - 1.0, 0.0) * rim.x * rim.y;
    alpha = max(alpha + noise(), 0.0);
    color = vec4(vec3(shade.y * alpha), alpha);
})";

}  // namespace beamcam::render
