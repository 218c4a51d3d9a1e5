#include "render/plot/legend.hpp"

#include <algorithm>
#include <utility>

namespace beamcam::render::figure {
namespace {
constexpr double kSampleLength = 2.6, kRow = 1.35;  // length of a line, height of an entry, in letters
}  // namespace

LegendBox::LegendBox(const Panel& panel, const PlotStyle& style, PageCanvas& sheet)
    : panel_(panel), style_(style), sheet_(sheet) {
    const auto add = [&](const std::string& label, const Series* series, Color color, bool dots) {
        if (!label.empty()) entries_.push_back({label, series, color, dots});
    };
    for (const Series& s : panel.series) add(s.label, &s, {}, false);
    for (const Band& b : panel.bands) add(b.label, nullptr, pale(look(b.look).color, 0.72), false);
    for (const Cloud& c : panel.clouds) add(c.label, nullptr, c.color, true);
    for (const Swatch& w : panel.swatches) add(w.label, nullptr, w.color, false);
}

Box LegendBox::size(double width) {
    const double apart = 2 * style_.gap, row = kRow * style_.letters;
    const auto count = static_cast<int>(entries_.size());
    std::vector<double> widths;
    for (const Entry& entry : entries_)
        widths.push_back(kSampleLength * style_.letters + style_.gap + sheet_.measure(entry.label, style_.words()).w);
    entry_ = std::ranges::max(widths);
    // Inside the plot one column; above it as many columns as the width holds.
    const int columns = above_ ? std::clamp(static_cast<int>((width + apart) / (entry_ + apart)), 1, count) : 1;
    places_.clear();
    for (int k = 0; k < count; ++k) {
        const int line = k / columns;
        places_.push_back({k % columns * (entry_ + apart), row * line});
    }
    const Box box{0, 0, columns * (entry_ + apart) - apart, places_.back().y + row};
    if (!above_) return box;
    // Without columns, if that saves a line.
    std::vector<Vec2> packed;
    Vec2 next;
    for (const double wide : widths) {
        if (next.x > 0 && next.x + wide > width) next = {0, next.y + row};
        packed.push_back(next);
        next.x += wide + apart;
    }
    if (packed.back().y >= places_.back().y) return box;
    places_ = std::move(packed);
    return {0, 0, width, places_.back().y + row};
}

bool LegendBox::place_inside(OccupancyGrid& taken) {
    const Box& plot = taken.area();
    const Box box = size(plot.w);
    const Place place = best_place(taken, box.w, box.h, 1.6 * style_.gap);
    if (panel_.legend != Legend::above && place.cost <= kFewCells && box.w < plot.w && box.h < plot.h) {
        box_ = place.box;
        taken.cover(place.box);
        return true;
    }
    above_ = true;
    height_ = size(plot.w).h;
    return false;
}

bool LegendBox::place_above(double width) {
    box_ = size(width);
    return box_->h <= std::exchange(height_, box_->h) + 0.01;
}

void LegendBox::draw_sample(const Entry& entry, Vec2 left, double width) const {
    if (entry.series) {
        const Series& s = *entry.series;
        const Pen pen = curve_pen(s, style_);
        if (s.line && s.value.empty()) sheet_.line(left, left + Vec2{width, 0}, pen);
        if (s.every_point)
            draw_marker(sheet_, style_, look(s.look).marker, left + Vec2{width / 2, 0}, style_.marker, pen.color,
                        s.look % 2 == 1);
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

void LegendBox::draw() const {
    if (!box_) return;
    const double row = kRow * style_.letters, sample = kSampleLength * style_.letters;
    TextStyle l = style_.words();
    l.valign = VAlign::middle;
    for (std::size_t k = 0; k < entries_.size(); ++k) {
        const Vec2 at = Vec2{box_->x, box_->y + 0.5 * row} + places_[k];
        draw_sample(entries_[k], at, sample);
        sheet_.text(at + Vec2{sample + style_.gap, 0}, entries_[k].label, l);
    }
}

}  // namespace beamcam::render::figure
