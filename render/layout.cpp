#include "render/layout.hpp"

#include <cmath>

namespace beamcam::render {
namespace {

constexpr double kSmallest = 0.5;  // 16 design pixels of text are 8 px: the least that reads

Box whole(const Box& b) {
    const double x = std::round(b.x), y = std::round(b.y);
    return {x, y, std::max(1.0, std::round(b.right()) - x), std::max(1.0, std::round(b.bottom()) - y)};
}

ChartSlot chart_slot(ChartKind kind, const Box& box, double u) {
    return {kind, box, whole({box.x + 70 * u, box.y + 46 * u, box.w - 78 * u, box.h - 46 * u - 44 * u})};
}

// Stacks the charts into `area`, as many as keep a readable height.
void stack(Layout& out, const std::vector<ChartKind>& kinds, const Box& area) {
    const double u = out.unit, gap = 14 * u;
    const auto room = static_cast<std::size_t>(std::max(0.0, (area.h + gap) / (215 * u + gap)));
    const std::size_t n = std::min(kinds.size(), room);
    for (std::size_t i = 0; i < n; ++i) {
        const double h = std::min(440 * u, (area.h - gap * static_cast<double>(n - 1)) / static_cast<double>(n));
        out.charts.push_back(chart_slot(kinds[i], {area.x, area.y + (h + gap) * static_cast<double>(i), area.w, h}, u));
    }
}

// Side by side, as many as keep a readable width.
void spread(Layout& out, const std::vector<ChartKind>& kinds, const Box& area) {
    const double u = out.unit, gap = 30 * u;
    const auto room = static_cast<std::size_t>(std::max(0.0, (area.w + gap) / (400 * u + gap)));
    const std::size_t n = std::min(kinds.size(), room);
    for (std::size_t i = 0; i < n; ++i) {
        const double w = (area.w - gap * static_cast<double>(n - 1)) / static_cast<double>(n);
        out.charts.push_back(chart_slot(kinds[i], {area.x + (w + gap) * static_cast<double>(i), area.y, w, area.h}, u));
    }
}

}  // namespace

Layout layout(int width, int height, const std::vector<ChartKind>& charts) {
    Layout out;
    const bool wide = width >= 1.4 * height;
    out.unit = std::max(kSmallest, wide ? std::min(width / 1920.0, height / 1080.0) : std::min(width, height) / 1240.0);
    const double u = out.unit, w = width, h = height;
    const double margin = std::min(64 * u, 0.04 * std::min(w, h) + 12 * u);
    double top = margin * 0.8, bottom = h - margin * 0.7, right = w - margin;

    const bool has_title = w >= 320 * u && h >= 300 * u, has_parameters = w >= 560 * u && h >= 480 * u;
    const bool has_clock = w >= 230 * u && h >= 190 * u, has_scales = w >= 1150 * u && h >= 600 * u;
    if (has_title) {
        out.title = Box{margin, top, w - 2 * margin, 54 * u};
        top += 54 * u;
    }
    if (has_parameters) {
        out.parameters = Box{margin, top, w - 2 * margin, 36 * u};
        top += 36 * u;
    }
    if (has_scales) {
        out.note = Box{margin, bottom - 26 * u, w - 2 * margin, 26 * u};
        bottom -= 34 * u;
    }
    if (has_clock) {
        out.clock = Box{margin, bottom - 56 * u, w - 2 * margin, 56 * u};
        bottom -= 56 * u;
    }
    if (has_scales) {
        out.scales = Box{w - margin - 600 * u, out.clock->y, 600 * u, 56 * u};
        out.clock->w = out.scales->x - 30 * u - out.clock->x;
    }
    if (has_title) top += 10 * u;
    if (has_clock) bottom -= 10 * u;

    if (wide && w >= 1150 * u && h >= 480 * u) {
        const double column = 540 * u, first = margin * 0.8;
        stack(out, charts, {right - column, first, column, bottom - first - 6 * u});
        if (!out.charts.empty()) {
            right -= column + 40 * u;
            if (out.title) out.title->w = right - out.title->x;
            if (out.parameters) out.parameters->w = right - out.parameters->x;
        }
    } else if (!wide && w >= 420 * u && bottom - top >= 620 * u) {
        const double share = std::min(0.62 * (bottom - top), 3 * 330 * u);
        if (h > 1.35 * w) {
            const Box area{margin, bottom - share, right - margin, share};
            stack(out, charts, area);
            if (!out.charts.empty()) bottom -= share - (area.bottom() - out.charts.back().box.bottom()) + 20 * u;
            const double spare = area.bottom() - (out.charts.empty() ? area.bottom() : out.charts.back().box.bottom());
            for (ChartSlot& slot : out.charts) {
                slot.box.y += spare, slot.plot.y = std::round(slot.plot.y + spare);
            }
        } else {
            spread(out, charts, {margin, bottom - 300 * u, right - margin, 300 * u});
            if (!out.charts.empty()) bottom -= 320 * u;
        }
    }
    out.mechanism = whole({margin, top, right - margin, bottom - top});
    if (out.mechanism.w < 8 || out.mechanism.h < 8) out.mechanism = {0, 0, w, h};
    return out;
}

}  // namespace beamcam::render
