// Colours as drawn (sRGB, 0…1, not premultiplied), and the palette of each theme.
//
// Meanings are fixed throughout: blue is the beam and motion, vermilion is contact force and nothing else, grey is
// reference; bending moments are blue to crimson. These pairs are distinguishable with every common colour deficiency.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace beamcam::render {

struct Color {
    double r = 0, g = 0, b = 0, a = 1;
    constexpr Color faded(double alpha) const { return {r, g, b, a * alpha}; }
    constexpr bool operator==(const Color&) const = default;
};
constexpr Color rgb(std::uint32_t hex) {
    return {((hex >> 16) & 255) / 255.0, ((hex >> 8) & 255) / 255.0, (hex & 255) / 255.0, 1};
}
std::string hex(Color color);  // "#0072b2"
constexpr Color mix(Color a, Color b, double share_of_b) {
    const double s = share_of_b, k = 1 - s;
    return {a.r * k + b.r * s, a.g * k + b.g * s, a.b * k + b.b * s, a.a * k + b.a * s};
}

// Between equally spaced colours, share 0…1, clamped.
template <std::size_t N>
Color along(const std::array<Color, N>& stops, double share) {
    const double at = std::clamp(share, 0.0, 1.0) * (N - 1);
    const auto i = std::min(static_cast<std::size_t>(at), N - 2);
    return mix(stops[i], stops[i + 1], at - static_cast<double>(i));
}
double linear_light(double channel);  // of an encoded channel of sRGB

// Shares of red, green and blue in the luminance: ITU-R BT.709.
inline constexpr double kLumaRed = 0.2126, kLumaGreen = 0.7152, kLumaBlue = 0.0722;

enum class Theme { light, dark, print };

struct Palette {
    Color paper, ink, muted, faint, grid;
    Color motion, motion_faint;    // beam and curves; their future part
    Color contact, contact_faint;  // forces
    Color steel, steel_edge, pin;  // disc, outline, hub
    std::array<Color, 5> moment;   // −1, −½, 0, ½, 1 of the scale
    std::array<Color, 3> force;    // 0, ½, 1 of the scale
    bool transparent = false;      // no paper: pale colours have alpha instead

    // A colour diluted to this share on the paper.
    Color tint(Color c, double share) const { return transparent ? c.faded(share) : mix(paper, c, share); }
    // Colour of the halo that makes texts readable on any background; null: there is paper.
    std::optional<Color> halo_of_all() const { return transparent ? std::optional(paper.faded(0.9)) : std::nullopt; }
    // The palette of a film without paper: pale colours get alpha, so that they look the same over this paper and right
    // over other backgrounds.
    Palette without_paper() const;
};
const Palette& palette(Theme theme);

// The palette on paper of another colour: pale colours are diluted on it, and text stays readable.
Palette on_paper(Palette palette, Color paper);

// Colours of several curves or motions; the first is `motion`, none is `contact`.
Color series_color(const Palette& palette, std::size_t index);
double contrast(const Color& a, const Color& b);  // 1…21, WCAG 2.1
// The colour for text: unchanged if its contrast with the paper is at least `least` (WCAG 2.1: 3 for large text, 4.5
// for small text), otherwise mixed with as much ink as necessary.
Color readable(const Palette& palette, Color color, double least = 3);
Color moment_color(const Palette& palette, double share);  // −1…1; beyond: the end colour
Color force_color(const Palette& palette, double share);   // 0…1

}  // namespace beamcam::render
