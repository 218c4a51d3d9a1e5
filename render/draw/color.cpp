#include "render/draw/color.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace beamcam::render {
namespace {

const Palette kLight{.paper = rgb(0xFCFCFA),
                     .ink = rgb(0x1B1F27),
                     .muted = rgb(0x666C78),
                     .faint = rgb(0xB9BEC7),
                     .grid = rgb(0xE3E5E8),
                     .motion = rgb(0x0072B2),
                     .motion_faint = rgb(0xC3D9E8),
                     .contact = rgb(0xD55E00),
                     .contact_faint = rgb(0xF3D9C7),
                     .steel = rgb(0xC3C9D3),
                     .steel_edge = rgb(0x2A2F39),
                     .pin = rgb(0x4A505C),
                     .moment = {rgb(0x005C99), rgb(0x5AA0CF), rgb(0xD3DAE3), rgb(0xE095A8), rgb(0xAE1243)},
                     .force = {rgb(0xF6C9A4), rgb(0xE3721C), rgb(0x9C2F00)}};

const Palette kDark{.paper = rgb(0x14171D),
                    .ink = rgb(0xF1F3F6),
                    .muted = rgb(0xA0A7B4),
                    .faint = rgb(0x565D6A),
                    .grid = rgb(0x2B303A),
                    .motion = rgb(0x56B4E9),
                    .motion_faint = rgb(0x2A4458),
                    .contact = rgb(0xFF8A3D),
                    .contact_faint = rgb(0x53341F),
                    .steel = rgb(0x8D95A3),
                    .steel_edge = rgb(0xD9DEE6),
                    .pin = rgb(0xC3C9D3),
                    .moment = {rgb(0x2E9BE0), rgb(0x7DB7DC), rgb(0xC4CBD6), rgb(0xEE9DB0), rgb(0xF0476F)},
                    .force = {rgb(0xFFD9B8), rgb(0xFF9A4A), rgb(0xFF5A00)}};

const Palette kPrint{.paper = rgb(0xFFFFFF),
                     .ink = rgb(0x000000),
                     .muted = rgb(0x4A4A4A),
                     .faint = rgb(0xA8A8A8),
                     .grid = rgb(0xDDDDDD),
                     .motion = rgb(0x0072B2),
                     .motion_faint = rgb(0xBFD8E8),
                     .contact = rgb(0xD55E00),
                     .contact_faint = rgb(0xF5DCCB),
                     .steel = rgb(0xD9D9D9),
                     .steel_edge = rgb(0x000000),
                     .pin = rgb(0x333333),
                     .moment = {rgb(0x005C99), rgb(0x5AA0CF), rgb(0xE4E4E4), rgb(0xE095A8), rgb(0xAE1243)},
                     .force = {rgb(0xF6C9A4), rgb(0xE3721C), rgb(0x9C2F00)}};

// Distance from one colour to another, for shares of a mixture of both.
double distance(const Color& a, const Color& b) {
    return std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b);
}
// The share of `whole` in a colour that is `whole` diluted on the paper.
double share_of(const Palette& p, const Color& pale, const Color& whole) {
    const double all = distance(whole, p.paper);
    return all > 0 ? std::min(1.0, distance(pale, p.paper) / all) : 1;
}

// Relative luminance and contrast of sRGB colours (WCAG 2.1).
double luminance(const Color& c) {
    return kLumaRed * linear_light(c.r) + kLumaGreen * linear_light(c.g) + kLumaBlue * linear_light(c.b);
}

}  // namespace

double linear_light(double channel) {
    return channel <= 0.04045 ? channel / 12.92 : std::pow((channel + 0.055) / 1.055, 2.4);
}

std::string hex(Color color) {
    const auto level = [](double share) { return static_cast<int>(std::lround(255 * share)); };
    return fmt::format("#{:02x}{:02x}{:02x}", level(color.r), level(color.g), level(color.b));
}

const Palette& palette(Theme theme) { return theme == Theme::light ? kLight : theme == Theme::dark ? kDark : kPrint; }

Palette on_paper(Palette p, Color paper) {
    constexpr double kSmallText = 4.5;  // smallest contrast
    const Palette old = p;
    p.paper = paper;
    const bool dark = contrast(paper, rgb(0)) < contrast(paper, rgb(0xFFFFFF));
    if (contrast(p.ink, paper) < kSmallText) p.ink = palette(dark ? Theme::dark : Theme::light).ink;
    if (contrast(p.ink, paper) < kSmallText) p.ink = rgb(dark ? 0xFFFFFF : 0);
    p.muted = readable(p, mix(paper, p.ink, share_of(old, old.muted, old.ink)), kSmallText);
    p.faint = mix(paper, p.ink, share_of(old, old.faint, old.ink));
    p.grid = mix(paper, p.ink, share_of(old, old.grid, old.ink));
    p.motion_faint = mix(paper, p.motion, share_of(old, old.motion_faint, old.motion));
    p.contact_faint = mix(paper, p.contact, share_of(old, old.contact_faint, old.contact));
    return p;
}

double contrast(const Color& a, const Color& b) {
    const double x = luminance(a), y = luminance(b);
    return (std::max(x, y) + 0.05) / (std::min(x, y) + 0.05);
}

Color readable(const Palette& palette, Color color, double least) {
    constexpr int kSteps = 20;
    for (int k = 0; k < kSteps; ++k)
        if (const Color mixed = mix(color, palette.ink, double(k) / kSteps); contrast(mixed, palette.paper) >= least)
            return mixed;
    return palette.ink;
}

Color series_color(const Palette& p, std::size_t i) {
    // Okabe and Ito's palette without vermilion, which means contact, and the colours farthest from all of these under
    // every common colour deficiency; eight in all with the palette's own.
    static constexpr std::array kOnLight{rgb(0x009E73), rgb(0xCC79A7), rgb(0xE69F00), rgb(0x882255),
                                         rgb(0x332288), rgb(0x56B4E9), rgb(0x603018)};
    static constexpr std::array kOnDark{rgb(0x009E73), rgb(0xCC79A7), rgb(0xE69F00), rgb(0x7B6BB5),
                                        rgb(0xF0F0D8), rgb(0xD81848), rgb(0xA800F0)};
    const auto& others = p.paper.g < 0.5 ? kOnDark : kOnLight;
    return i == 0 ? p.motion : others[(i - 1) % others.size()];
}

Color moment_color(const Palette& p, double share) { return along(p.moment, 0.5 + 0.5 * share); }
Color force_color(const Palette& p, double share) { return along(p.force, share); }

Palette Palette::without_paper() const {
    Palette out = *this;
    out.transparent = true;
    const auto ink_of = [&](Color& pale, const Color& of) {
        if (distance(of, paper) > 0) pale = of.faded(share_of(*this, pale, of));
    };
    ink_of(out.faint, ink);
    ink_of(out.grid, ink);
    ink_of(out.motion_faint, motion);
    ink_of(out.contact_faint, contact);
    out.muted = ink;  // small letters are thinner than their outlines
    return out;
}

}  // namespace beamcam::render
