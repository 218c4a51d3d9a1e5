#include "render/plot/style.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace beamcam::render::figure {
namespace {

// Author guidelines: IEEE 3.5 and 7.16 in; Elsevier 90, 140, 190 mm; Nature 89 and 183 mm; APS 3⅜ and 7 in (86, 178
// mm).
constexpr std::array kColumns{Column{"ieee", 88.9, 8, 1.0, 0, "IEEE, one column"},
                              Column{"ieee-double", 181.9, 8, 1.0, 0, "IEEE, both columns"},
                              Column{"elsevier", 90, 8, 1.0, 0, "Elsevier, one column"},
                              Column{"elsevier-1.5", 140, 8, 1.0, 0, "Elsevier, one and a half"},
                              Column{"elsevier-double", 190, 8, 1.0, 0, "Elsevier, both columns"},
                              Column{"nature", 89, 7, 0.9, 0, "Nature, one column"},
                              Column{"nature-double", 183, 7, 0.9, 0, "Nature, both columns"},
                              Column{"aps", 86, 8, 1.0, 0, "APS, one column"},
                              Column{"aps-double", 178, 8, 1.0, 0, "APS, both columns"},
                              Column{"slide", 254, 18, 2.2, 142.875, "a 16:9 slide of 10 in"}};

// Colours of Okabe & Ito, "Color universal design" (2008), in an order in which neighbours differ in lightness too.
const std::array<LineStyle, 8> kLooks{{{rgb(0x0072B2), {}, Marker::circle},
                                       {rgb(0xD55E00), {5, 2}, Marker::square},
                                       {rgb(0x009E73), {1.2, 1.8}, Marker::triangle},
                                       {rgb(0xCC79A7), {6, 1.8, 1.2, 1.8}, Marker::diamond},
                                       {rgb(0xE69F00), {9, 2.5}, Marker::down},
                                       {rgb(0x56B4E9), {6, 1.8, 1.2, 1.8, 1.2, 1.8}, Marker::cross},
                                       {rgb(0x000000), {2.5, 1.5}, Marker::circle},
                                       {rgb(0x777777), {4, 1.5, 4, 3.5}, Marker::square}}};

// viridis from 1 down to 0, in tenths.
constexpr std::array kMap{rgb(0xfde725), rgb(0xbddf26), rgb(0x7ad151), rgb(0x44bf70), rgb(0x22a884), rgb(0x21918c),
                          rgb(0x2a788e), rgb(0x355f8d), rgb(0x414487), rgb(0x482475), rgb(0x440154)};
constexpr double kPalestShare = 0.12;  // of the map, left out

// Oklab (Ottosson 2020, "A perceptual color space for image processing"): lightness 0…1, green to red, blue to yellow.
struct Lab {
    double lightness = 0, a = 0, b = 0;
};
double encoded(double c) {
    const double part = std::clamp(c, 0.0, 1.0);
    return part <= 0.0031308 ? 12.92 * part : 1.055 * std::pow(part, 1 / 2.4) - 0.055;
}
Lab lab_of(Color c) {
    const double red = linear_light(c.r), green = linear_light(c.g), blue = linear_light(c.b);
    const double l = std::cbrt(0.4122214708 * red + 0.5363325363 * green + 0.0514459929 * blue),
                 m = std::cbrt(0.2119034982 * red + 0.6806995451 * green + 0.1073969566 * blue),
                 s = std::cbrt(0.0883024619 * red + 0.2817188376 * green + 0.6299787005 * blue);
    return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
            1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
            0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}
Color color_of(const Lab& lab, double alpha) {
    const auto cubed = [](double v) { return v * v * v; };
    const double l = cubed(lab.lightness + 0.3963377774 * lab.a + 0.2158037573 * lab.b),
                 m = cubed(lab.lightness - 0.1055613458 * lab.a - 0.0638541728 * lab.b),
                 s = cubed(lab.lightness - 0.0894841775 * lab.a - 1.2914855480 * lab.b);
    return {encoded(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
            encoded(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
            encoded(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s), alpha};
}

}  // namespace

const Column* column_named(std::string_view name) {
    const auto it = std::find_if(kColumns.begin(), kColumns.end(), [&](const Column& c) { return name == c.name; });
    return it == kColumns.end() ? nullptr : &*it;
}

std::vector<std::string> column_names() {
    std::vector<std::string> names;
    for (const Column& column : kColumns) names.emplace_back(column.name);
    return names;
}

PlotStyle style_of(const Column& column) {
    PlotStyle s;
    const double k = column.letters / 8;
    s.letters = column.letters;
    s.numbers = std::max(6.5, 0.94 * column.letters);
    s.line = column.line;
    s.frame = 0.6 * k;
    s.tick = 3 * k;
    s.minor_tick = 1.7 * k;
    s.gap = 3 * k;
    s.marker = 1.9 * k;
    return s;
}

PlotStyle scaled(PlotStyle style, double factor) {
    for (double* size : {&style.letters, &style.numbers, &style.line, &style.frame, &style.tick, &style.minor_tick,
                         &style.gap, &style.marker})
        *size *= factor;
    return style;
}

PlotStyle film_style(const Palette& palette, double unit, double letters, double numbers) {
    PlotStyle s;
    s.palette = &palette;
    s.letters = letters;
    s.numbers = numbers;
    s.line = s.unit = unit;
    s.frame = std::max(1.0, unit);
    return s;
}

// After eight colours they repeat with other dashes.
const LineStyle& look(int k) {
    static const std::vector<LineStyle> kAll = [] {
        constexpr std::size_t kStep = 3;  // has no divisor in common with eight
        std::vector<LineStyle> all;
        for (std::size_t round = 0; round < kLooks.size(); ++round)
            for (std::size_t i = 0; i < kLooks.size(); ++i) {
                const LineStyle& other = kLooks[(i + kStep * round) % kLooks.size()];
                all.push_back({kLooks[i].color, other.dash, other.marker});
            }
        return all;
    }();
    return kAll[static_cast<std::size_t>(k) % kAll.size()];
}

Color pale(Color color, double share) { return mix(color, rgb(0xFFFFFF), share); }

Color on_dark(Color color) {
    static const Lab kDarkPaper = lab_of(palette(Theme::dark).paper), kDarkInk = lab_of(palette(Theme::dark).ink);
    constexpr double kDarkestOfInk = 0.1,
                     kLeastLightness = 0.68;  // lightness; kLeastLightness: contrast 6 : 1 on the dark paper
    const Lab lab = lab_of(color);
    const bool of_line = lab.lightness > kDarkestOfInk && std::ranges::any_of(kLooks, [&](const LineStyle& each) {
                             return each.color.faded(color.a) == color;
                         });
    if (of_line) return color_of({std::max(lab.lightness, kLeastLightness), lab.a, lab.b}, color.a);
    const double paper = std::clamp(lab.lightness, 0.0, 1.0), ink = 1 - paper;
    return color_of({ink * kDarkInk.lightness + paper * kDarkPaper.lightness,
                     lab.a + ink * kDarkInk.a + paper * kDarkPaper.a, lab.b + ink * kDarkInk.b + paper * kDarkPaper.b},
                    color.a);
}

Color map_color(double share) { return along(kMap, kPalestShare + (1 - kPalestShare) * std::clamp(share, 0.0, 1.0)); }

Color signed_color(double share) {
    static constexpr std::array kSigned{rgb(0x053061), rgb(0x4393C3), rgb(0xF2F2F2), rgb(0xD6604D), rgb(0x67001F)};
    return along(kSigned, 0.5 + 0.5 * share);
}

}  // namespace beamcam::render::figure
