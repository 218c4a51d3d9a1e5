#include "render/plot/legend.hpp"

#include <algorithm>

#include "render/plot/drawn_curve.hpp"

namespace beamcam::render::figure {
namespace {
// In sizes of letters: the height of a row, and the space between entries.
constexpr double kRow = 1.35, kBetween = 0.75;

// The labels of the lines that look like `first`, which share an entry; empty if an earlier line has it.
std::string shared_label(const std::vector<Series>& all, const Series& first) {
    std::string label;
    for (const Series& s : all) {
        const bool alike =
            &s == &first || (s.line && first.line && s.look == first.look && color_of(s) == color_of(first));
        if (!alike || s.label.empty()) continue;
        if (label.empty() && &s != &first) return {};
        label += (label.empty() ? "" : ", ") + s.label;
    }
    return label;
}
}  // namespace

LegendAbove::LegendAbove(const Panel& panel, const PlotStyle& style, PageCanvas& sheet, bool shown)
    : style_(style), sheet_(sheet) {
    const auto add = [&](const std::string& label, const Series* series, Color color, bool dots) {
        if (label.empty()) return;
        const double width = kSampleLength * style.letters + style.gap + sheet.measure(label, style.words()).w;
        entries_.push_back({label, series, color, dots, width, {}});
        widest_ = std::max(widest_, width);
    };
    if (!shown) return;
    for (const Series& s : panel.series)
        if (!s.label.empty()) add(shared_label(panel.series, s), &s, {}, false);
    for (const Band& b : panel.bands) add(b.label, nullptr, pale(look(b.look).color, 0.72), false);
    for (const Cloud& c : panel.clouds) add(c.label, nullptr, c.color, true);
    for (const Swatch& w : panel.swatches) add(w.label, nullptr, w.color, false);
}

void LegendAbove::fit(double width) {
    Vec2 next;
    for (Entry& entry : entries_) {
        if (next.x > 0 && next.x + entry.width > width) next = {0, next.y + kRow * style_.letters};
        entry.at = next;
        next.x += entry.width + kBetween * style_.letters;
    }
}

double LegendAbove::height() const {
    return entries_.empty() ? 0 : entries_.back().at.y + kRow * style_.letters + style_.gap;
}

double LegendAbove::baseline() const { return 0.5 * (kRow * style_.letters + sheet_.cap_height(style_.letters)); }

void LegendAbove::draw_sample(const Entry& entry, Vec2 left, double width) const {
    if (entry.series) {
        figure::draw_sample(sheet_, style_, *entry.series, left, left + Vec2{width, 0});
    } else if (entry.dots) {
        for (const double share : {0.2, 0.5, 0.8}) {
            sheet_.circle(left + Vec2{share * width, 0}, 0.5 * style_.marker);
            sheet_.fill(entry.color);
        }
    } else {
        sheet_.rectangle({left.x, left.y - 0.3 * style_.letters, width, 0.6 * style_.letters});
        sheet_.fill(entry.color);
    }
}

void LegendAbove::draw(Vec2 top_left) const {
    const double sample = kSampleLength * style_.letters;
    TextStyle l = style_.words();
    l.valign = VAlign::middle;
    for (const Entry& entry : entries_) {
        const Vec2 at = top_left + entry.at + Vec2{0, 0.5 * kRow * style_.letters};
        draw_sample(entry, at, sample);
        sheet_.text(at + Vec2{sample + style_.gap, 0}, entry.label, l);
    }
}

}  // namespace beamcam::render::figure
