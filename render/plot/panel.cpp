#include "render/plot/panel.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/plot/cloud.hpp"

namespace beamcam::render::figure {
namespace {

constexpr double kCellSide = 1.5;  // of the grid of what is covered: resolves letters [pt]

}  // namespace

PanelDrawing::PanelDrawing(const Panel& panel, const PlotStyle& style, PageCanvas& sheet, double width, double height,
                           bool lowest, const std::string& what)
    : panel_(panel),
      style_(style),
      sheet_(sheet),
      what_(what),
      plot_(panel, style, what, lowest),
      names_(panel, style, sheet, lowest),
      legend_(panel, style, sheet) {
    fit(width, height);
}

void PanelDrawing::fit(double width, double height) {
    plot_.fit(sheet_, width, height);
    names_.fit(plot_, width, height);
}

Margins PanelDrawing::margins() const {
    Margins m = names_.margins();
    m.top += legend_.height_above();
    return m;
}

// ---- placement -------------------------------------------------------------------------------

bool PanelDrawing::place(const Box& box) {
    plot_.place(sheet_, box);
    names_.fit(plot_, box.w, box.h);
    writings_.clear();
    insets_.clear();
    make_curves();
    // Legend and insets compete for the free corners: the order that covers less is taken. Labels at marks and curves
    // avoid both.
    const bool boxed = panel_.legend == Legend::box;
    if (boxed && !panel_.insets.empty() && !legend_.is_above()) {
        const std::optional<OccupancyGrid> before = taken_;
        const double legend_first = place_boxes(true);
        taken_ = before;
        const double insets_first = place_boxes(false);
        taken_ = before;
        legend_.try_inside_again();
        place_boxes(legend_first <= insets_first);
    } else {
        place_boxes(true);
    }
    place_marks();
    place_rules();
    return boxed ? settled_ : place_labels();
}

void PanelDrawing::make_curves() {
    curves_.clear();
    taken_.emplace(plot_.box(), kCellSide);
    for (const Series& s : panel_.series) {
        const DrawnCurve& curve = curves_.emplace_back(s, plot_, sheet_.grain());
        if (s.line) taken_->cover(curve.points(), s.faded ? 0.7 : 1);
        if (s.every_point)
            for (const Vec2 p : curve.points()) taken_->cover(Box{p.x, p.y, 0, 0}.inset(-style_.marker));
    }
    data_ = taken_;
    for (const Cells& cells : panel_.cells) cover_cells(cells, plot_, *taken_);
    for (const Cloud& cloud : panel_.clouds) cover_cloud(cloud, plot_, *taken_);
    for (const Band& b : panel_.bands)
        for (const auto* edge : {&b.low, &b.high}) taken_->cover(plot_.points(b.x, *edge), 0.5);
    for (const Rule& r : panel_.rules) taken_->cover(ends(r), 0.4);
}

std::array<Vec2, 2> PanelDrawing::ends(const Rule& r) const {
    if (r.vertical) return {Vec2{plot_.along_x(r.at), plot_.box().y}, {plot_.along_x(r.at), plot_.box().bottom()}};
    return {Vec2{plot_.box().x, plot_.along_y(r.at)}, {plot_.box().right(), plot_.along_y(r.at)}};
}

// The cost of placing boxes in this order; a legend without room is expensive.
double PanelDrawing::place_boxes(bool legend_first) {
    constexpr double kNoRoom = 25;  // cells: rather above the plot than over this much of a curve
    legend_.forget();
    insets_.clear();
    settled_ = true;
    double cost = 0;
    const auto legend = [&] {
        if (panel_.legend != Legend::box) return;
        settled_ = place_labels();
        if (!settled_) cost += kNoRoom;
    };
    if (legend_first) legend();
    cost += place_insets();
    if (!legend_first) legend();
    return cost;
}

// ---- drawing -----------------------------------------------------------------------------------------

void PanelDrawing::draw() {
    sheet_.clip(plot_.box(), [&] { draw_backgrounds(); });
    std::deque<PanelDrawing> insets = draw_inset_backgrounds();
    const bool any_line = std::ranges::any_of(panel_.series, &Series::line);
    const auto draw_markers = [&](bool beneath) {  // of points without a line, such as data, beneath the lines
        for (const DrawnCurve& curve : curves_)
            if (beneath == (any_line && !curve.series().line)) curve.draw_markers(plot_.box(), style_, sheet_);
    };
    draw_markers(true);
    sheet_.clip(plot_.box(), [&] {
        for (const DrawnCurve& curve : curves_) curve.draw(style_, sheet_);
        for (const Cloud& cloud : panel_.clouds) draw_cloud(cloud, plot_, sheet_);  // dots are smaller than lines
    });
    plot_.draw_x_axis(sheet_);
    plot_.draw_y_axis(sheet_);
    plot_.draw_frame(sheet_);
    plot_.draw_dots_and_events(sheet_);
    draw_markers(false);
    for (const Mark& m : panel_.marks) {
        const Vec2 p = plot_.at(m.x, m.y, m.right);
        if (!inside(plot_.box(), p, 1)) continue;
        draw_marker(sheet_, style_, look(m.look).marker, p, 1.1 * style_.marker, look(m.look).color, m.hollow);
    }
    for (PanelDrawing& inset : insets) inset.draw();
    for (const Writing& w : writings_) {
        if (w.leader) {
            sheet_.line(w.leader->first, w.leader->second, {kMuted, 0.6 * style_.frame, {}, Cap::butt});
        }
        if (w.ground) sheet_.rectangle(*w.ground), sheet_.fill(kWhite);
        sheet_.text(w.at, w.markup, w.lettering);
    }
    legend_.draw();
    names_.draw(plot_, plot_.box().y - margins().top + style_.letters, legend_.is_above());
}

void PanelDrawing::draw_backgrounds() {
    for (const Cells& cells : panel_.cells) draw_cells(cells, plot_, sheet_);
    for (const Span& s : panel_.spans) {
        const double a = plot_.at(s.from, 0).x, b = plot_.at(s.to, 0).x;
        // At least a visible width.
        const double width = std::max(std::abs(b - a), 0.4);
        sheet_.rectangle({std::min(a, b), plot_.box().y, width, plot_.box().h});
        sheet_.fill(s.color);
    }
    plot_.draw_bands(sheet_);
    for (const Rule& r : panel_.rules)
        sheet_.line(ends(r)[0], ends(r)[1],
                    {rgb(0x888888), 0.75 * style_.frame, {3.3 * style_.frame, 3.3 * style_.frame}, Cap::butt});
}

}  // namespace beamcam::render::figure
