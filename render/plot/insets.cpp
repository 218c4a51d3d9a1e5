// Insets of a panel: their places, and the lines to the part that they enlarge.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "render/plot/panel.hpp"

namespace beamcam::render::figure {
namespace {

constexpr double kTouchedByAnInset = 8;  // cells of data that the empty edge of an inset may touch

// Whether the segment a–b enters the box.
bool enters(const Box& box, Vec2 a, Vec2 b) {
    const Box inner = box.inset(0.5);
    for (int k = 0; k <= 200; ++k)
        if (inside(inner, a + (b - a) * (k / 200.0))) return true;
    return false;
}

// Lines between two corners of the inset's plot and those of the enlarged part, through neither box.
std::vector<std::pair<Vec2, Vec2>> connectors(const Box& from, const Box& plot) {
    const auto corners = [](const Box& c) {
        return std::array<Vec2, 4>{Vec2{c.x, c.y}, {c.right(), c.y}, {c.right(), c.bottom()}, {c.x, c.bottom()}};
    };
    const auto c0 = corners(from), c1 = corners(plot);
    std::vector<std::pair<Vec2, Vec2>> lines;
    for (std::size_t k = 0; k < 4; ++k)
        if (!enters(from, c0[k], c1[k]) && !enters(plot, c0[k], c1[k])) lines.emplace_back(c0[k], c1[k]);
    if (lines.size() < 2) return lines;
    // The outermost two, seen along the way from one box to the other.
    const Vec2 way = plot.centre() - from.centre(), across{-way.y, way.x};
    const auto [least, most] = std::minmax_element(lines.begin(), lines.end(), [&](const auto& a, const auto& b) {
        return dot(a.second, across) < dot(b.second, across);
    });
    return {*least, *most};
}

}  // namespace

// The frame of the enlarged part, never smaller than 4 pt.
Box PanelDrawing::shown_enlarged(const Inset::Source& source) const {
    const Vec2 a = plot_.at(source.x_from, source.y_from), b = plot_.at(source.x_to, source.y_to);
    const Box box{std::min(a.x, b.x), std::min(a.y, b.y), std::abs(b.x - a.x), std::abs(b.y - a.y)};
    return box.inset(-std::max({0.0, 4 - box.w, 4 - box.h}) / 2);
}

double PanelDrawing::place_insets() {
    double cost = 0;
    for (const Inset& inset : panel_.insets) {
        if (inset.source) taken_->cover(shown_enlarged(*inset.source));
        // Smaller, or omitted, rather than over data.
        std::optional<PlacedInset> placed;
        for (const double share : {1.0, 0.9, 0.8, 0.7}) {
            // With its numbers and labels.
            const double w = share * inset.width * plot_.box().w, h = share * inset.height * plot_.box().h;
            const Margins m =
                PanelDrawing(inset.panel.front(), style_, sheet_, w, h, true, what_ + ", inset").margins();
            const Place place = best_place(*taken_, w + m.left + m.right, h + m.top + m.bottom, 2 * style_.gap);
            if (data_->cost(place.box) > kTouchedByAnInset) continue;
            placed = {place.box, w, h};
            cost += place.cost;
            taken_->cover(place.box);
            if (!inset.source) break;
            for (const auto& [from, to] : connectors(shown_enlarged(*inset.source), without(place.box, m)))
                taken_->cover(std::vector<Vec2>{from, to});
            break;
        }
        insets_.push_back(placed);
    }
    return cost;
}

// Below the curves, which may reach into the empty edge of an inset.
std::deque<PanelDrawing> PanelDrawing::draw_inset_backgrounds() const {
    std::deque<PanelDrawing> out;
    for (std::size_t i = 0; i < panel_.insets.size(); ++i) {
        if (!insets_[i]) continue;
        const auto& [outer, width, height] = *insets_[i];
        PanelDrawing& inner =
            out.emplace_back(panel_.insets[i].panel.front(), style_, sheet_, width, height, true, what_ + ", inset");
        if (!inner.place(without(outer, inner.margins()))) inner.place(without(outer, inner.margins()));
        const Box& plot = inner.plot_.box();
        sheet_.rectangle(outer);
        sheet_.fill(kWhite);
        if (const auto& source = panel_.insets[i].source) {
            const Box from = shown_enlarged(*source);
            const Pen thin{kMuted, 0.75 * style_.frame, {}, Cap::butt};
            sheet_.rectangle(from);
            sheet_.stroke(thin);
            for (const auto& [start, end] : connectors(from, plot)) sheet_.line(start, end, thin);
        }
        // Its numbers and labels, left and below, interrupt the connectors.
        for (const Box& beside : {Box{outer.x, outer.y, plot.x - outer.x, outer.h},
                                  Box{outer.x, plot.bottom(), outer.w, outer.bottom() - plot.bottom()}}) {
            sheet_.rectangle(beside);
            sheet_.fill(kWhite);
        }
    }
    return out;
}

}  // namespace beamcam::render::figure
