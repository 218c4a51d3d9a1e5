#include "render/plot/legend.hpp"

#include <algorithm>
#include <utility>

namespace beamcam::render::figure {
namespace {
constexpr double kSampleLength = 2.6;  // length of a line in a legend, in letters
}  // namespace

int LegendBox::entries() const {
    const auto labelled = [](const auto& each) { return !each.label.empty(); };
    return static_cast<int>(std::ranges::count_if(panel_.series, labelled) +
                            std::ranges::count_if(panel_.bands, labelled) +
                            std::ranges::count_if(panel_.clouds, labelled) + std::ssize(panel_.swatches));
}

Box LegendBox::size(double width) {
    const double row = 1.35 * style_.letters, sample = kSampleLength * style_.letters;
    double widest = 0;
    int rows = 0;
    const auto add = [&](const std::string& label) {
        if (label.empty()) return;
        ++rows;
        widest = std::max(widest, sheet_.measure(label, style_.words()).w);
    };
    for (const Series& s : panel_.series) add(s.label);
    for (const Band& b : panel_.bands) add(b.label);
    for (const Cloud& c : panel_.clouds) add(c.label);
    for (const Swatch& w : panel_.swatches) add(w.label);
    // Inside the plot one column; above it as many columns as the width holds.
    entry_ = sample + style_.gap + widest;
    const double apart = 2 * style_.gap;
    columns_ = above_ ? std::clamp(static_cast<int>((width + apart) / (entry_ + apart)), 1, rows) : 1;
    const int lines = (rows + columns_ - 1) / columns_;
    return {0, 0, columns_ * (entry_ + apart) - apart, lines * row};
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

void LegendBox::draw_sample(const Series& s, Vec2 left, double width) const {
    const Pen pen = curve_pen(s, style_);
    if (s.line && s.value.empty()) {
        sheet_.line(left, left + Vec2{width, 0}, pen);
    }
    if (s.every_point)
        draw_marker(sheet_, style_, look(s.look).marker, left + Vec2{width / 2, 0}, style_.marker, pen.color,
                    s.look % 2 == 1);
}

void LegendBox::draw() const {
    if (!box_) return;
    const double row = 1.35 * style_.letters, sample = kSampleLength * style_.letters;
    TextStyle l = style_.words();
    l.valign = VAlign::middle;
    int k = 0;
    const auto next = [&] {
        const int column = k % columns_, line = k / columns_;
        const Vec2 at{box_->x + column * (entry_ + 2 * style_.gap), box_->y + (line + 0.5) * row};
        ++k;
        return at;
    };
    for (const Series& s : panel_.series) {
        if (s.label.empty()) continue;
        const Vec2 p = next();
        draw_sample(s, p, sample);
        sheet_.text(p + Vec2{sample + style_.gap, 0}, s.label, l);
    }
    const auto block = [&](const std::string& label, Color color) {
        if (label.empty()) return;
        const Vec2 p = next();
        sheet_.rectangle({p.x, p.y - 0.3 * style_.letters, sample, 0.6 * style_.letters});
        sheet_.fill(color);
        sheet_.text(p + Vec2{sample + style_.gap, 0}, label, l);
    };
    for (const Band& b : panel_.bands) block(b.label, pale(look(b.look).color, 0.72));
    for (const Cloud& c : panel_.clouds) {
        if (c.label.empty()) continue;
        const Vec2 p = next();
        for (const double share : {0.2, 0.5, 0.8}) {
            sheet_.circle(p + Vec2{share * sample, 0}, 0.5 * style_.marker);
            sheet_.fill(c.color);
        }
        sheet_.text(p + Vec2{sample + style_.gap, 0}, c.label, l);
    }
    for (const Swatch& w : panel_.swatches) block(w.label, w.color);
}

}  // namespace beamcam::render::figure
