#include "render/film/picture_frame.hpp"

#include <algorithm>
#include <cmath>

namespace beamcam::render {
namespace {

constexpr double kSmallestUnit = 0.5;  // gaps do not become smaller in smaller pictures [px]
constexpr double kTightWords = 17;     // letters for which the margins of plots are stated below [design px]

Letters letters_of(double design_pixel) {
    const double words = std::max(kReadable, 24 * design_pixel);
    return {34 / 16.0 * words, 20 / 16.0 * words, words};
}

constexpr double kCaptionBand = 48;  // height [design px]

}  // namespace

bool is_wide(int width, int height) { return width >= 1.4 * height; }

Box whole(const Box& b) {
    const double x = std::round(b.x), y = std::round(b.y);
    return {x, y, std::max(1.0, std::round(b.right()) - x), std::max(1.0, std::round(b.bottom()) - y)};
}

Box plot_area(const Box& box, double u, double words) {
    const double more = words - kTightWords * u, left = 70 * u + 2.4 * more, below = 44 * u + more;
    return whole({box.x + left, box.y + 46 * u, box.w - left - 8 * u, box.h - 46 * u - below});
}

PictureFrame picture_frame(int width, int height, const Shown& shown) {
    PictureFrame f;
    Layout& out = f.out;
    const bool wide = is_wide(width, height);
    const double design_pixel = wide ? std::min(width / 1920.0, height / 1080.0) : std::min(width, height) / 1080.0;
    out.letters = letters_of(shown.size * design_pixel);
    out.unit = shown.size * std::max(kSmallestUnit, (wide ? 1 : 1080 / 1240.0) * design_pixel);
    const double u = out.unit, w = width, h = height;
    const double margin = f.margin = std::min(64 * u, 0.04 * std::min(w, h) + 12 * u);
    f.top = margin * 0.8, f.bottom = h - margin * 0.7, f.right = w - margin;

    const bool has_title = shown.title && w >= 320 * u && h >= 300 * u,
               has_parameters = shown.parameters && w >= 560 * u && h >= 480 * u;
    const bool has_clock = (shown.clock || shown.legend) && w >= 230 * u && h >= 190 * u;
    const bool is_large = w >= (wide ? 1200 : 860) * u && h >= 640 * u, has_scales = shown.legend && is_large;
    const double scales = std::max(560 * u, 30 * out.letters.words);  // width of two
    if (has_title) {
        out.title = Box{margin, f.top, w - 2 * margin, 64 * u};
        f.top += 64 * u;
    }
    if (has_parameters) {
        out.parameters = Box{margin, f.top, w - 2 * margin, 40 * u};
        f.top += 40 * u;
    }
    if (shown.warning && is_large) {
        out.warning = Box{margin, f.bottom - 26 * u, w - 2 * margin, 26 * u};
        f.bottom -= 40 * u;
    }
    const bool apart = has_scales && !wide;  // beside the clock there is not enough space
    if (apart) {
        out.scales = Box{w - margin - scales, f.bottom - 56 * u, scales, 56 * u};
        f.bottom -= 64 * u;
    }
    if (has_clock) {
        out.clock = Box{margin, f.bottom - 56 * u, w - 2 * margin, 56 * u};
        f.bottom -= 56 * u;
    }
    if (has_scales && !apart) {
        out.scales = Box{w - margin - scales, out.clock->y, scales, 56 * u};
        out.clock->w = out.scales->x - 30 * u - out.clock->x;
    }
    if (has_title || has_parameters) f.top += 0.8 * out.letters.words;
    if (has_clock) f.bottom -= 1.3 * out.letters.words;
    if (shown.captions && w >= 230 * u && h >= 190 * u) {
        out.captions = Box{margin, f.bottom - kCaptionBand * u, w - 2 * margin, kCaptionBand * u};
        f.bottom -= (kCaptionBand + 10) * u;
    }
    return f;
}

}  // namespace beamcam::render
