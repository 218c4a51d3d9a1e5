#include "render/plot/panel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "render/plot/cloud.hpp"

namespace beamcam::render::figure {
namespace {

constexpr double kCellSide = 1.5;             // of the grid of what is covered: resolves letters [pt]
constexpr double kBeyondPlot = 1e5;           // cost of a box that leaves the plot
constexpr std::size_t kMostDirectLabels = 4;  // more labels are easier to distinguish in a box

}  // namespace

PanelDrawing::PanelDrawing(const Panel& panel, const PrintStyle& style, PageCanvas& sheet, double width, double height,
                           bool lowest, const std::string& what)
    : panel_(panel),
      style_(style),
      sheet_(sheet),
      what_(what),
      axes_(panel, style, sheet, lowest, what),
      legend_(panel, style, sheet) {
    axes_.fit(width, height);
}

Margins PanelDrawing::margins() const {
    Margins m = axes_.margins();
    m.top += legend_.height_above();
    return m;
}

// ---- placement -------------------------------------------------------------------------------

bool PanelDrawing::place(const Box& plot) {
    plot_ = plot;
    axes_.place(plot);
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
    taken_.emplace(plot_, kCellSide);
    for (const Series& s : panel_.series) {
        const DrawnCurve& curve = curves_.emplace_back(s, axes_, sheet_.grain());
        if (s.line) taken_->cover(curve.points(), s.faded ? 0.7 : 1);
        if (s.every_point)
            for (const Vec2 p : curve.points()) taken_->cover(Box{p.x, p.y, 0, 0}.inset(-style_.marker));
    }
    data_ = taken_;
    for (const Cells& cells : panel_.cells) cover_cells(cells, axes_, *taken_);
    for (const Cloud& cloud : panel_.clouds) cover_cloud(cloud, axes_, *taken_);
    for (const Band& b : panel_.bands)
        for (const auto* edge : {&b.low, &b.high}) {
            std::vector<Vec2> points;
            for (std::size_t i = 0; i < std::min(b.x.size(), edge->size()); ++i)
                points.push_back(at(b.x[i], (*edge)[i]));
            taken_->cover(points, 0.5);
        }
    for (const Rule& r : panel_.rules) {
        taken_->cover(ends(r), 0.4);
    }
}

std::array<Vec2, 2> PanelDrawing::ends(const Rule& r) const {
    if (r.vertical) return {Vec2{axes_.along_x(r.at), plot_.y}, {axes_.along_x(r.at), plot_.bottom()}};
    return {Vec2{plot_.x, axes_.along_y(r.at)}, {plot_.right(), axes_.along_y(r.at)}};
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

// Tries places around the mark, near ones first.
PanelDrawing::Writing PanelDrawing::best_at_mark(const Mark& m) {
    const Vec2 p = at(m.x, m.y, m.right);
    TextStyle l = style_.tick_numbers();
    l.color = look(m.look).color;
    const Box size = sheet_.measure(m.label, l);
    Writing best;
    double least = 10 * kBeyondPlot;
    for (const double far : {1.0, 2.0, 3.5, 5.5, 8.0})
        for (int k = 0; k < 16; ++k) {
            const double turn = (k + 0.5) * std::numbers::pi / 8;
            const double reach = style_.marker + far * 1.2 * style_.gap;
            const Vec2 middle{p.x + std::cos(turn) * (reach + size.w / 2), p.y - std::sin(turn) * (reach + size.h / 2)};
            const Box box{middle.x - size.w / 2, middle.y - size.h / 2, size.w, size.h};
            const Box air = box.inset(-0.8);
            const Vec2 end{std::clamp(p.x, air.x, air.right()), std::clamp(p.y, air.y, air.bottom())};
            double cost = 10 * taken_->cost(box.inset(-2.2)) + 2 * far - 0.5 * std::cos(turn);
            if (cost >= least) continue;
            // A leader should cross no curves.
            for (int s = 6; far > 2 && s < 20; ++s) {
                const Vec2 on = p + (end - p) * (s / 20.0);
                cost += std::min(1.0, taken_->cost(Box{on.x, on.y, 0, 0}.inset(-0.4)));
            }
            if (cost >= least) continue;
            least = cost;
            best = {{box.x, box.y - size.y}, m.label, l, {}};
            if (far > 2) best.leader = {p, end};
        }
    return best;
}

void PanelDrawing::place_marks() {
    for (const Mark& m : panel_.marks) {
        const Vec2 p = at(m.x, m.y, m.right);
        taken_->cover(Box{p.x, p.y, 0, 0}.inset(-style_.marker));
    }
    for (const Mark& m : panel_.marks) {
        if (m.label.empty()) continue;
        const Box size = sheet_.measure(m.label, style_.tick_numbers());
        Writing best = best_at_mark(m);
        if (best.markup.empty()) continue;  // a plot too small for it
        taken_->cover(Box{best.at.x, best.at.y + size.y, size.w, size.h});
        if (best.leader) taken_->cover(std::vector<Vec2>{best.leader->first, best.leader->second}, 4);
        writings_.push_back(std::move(best));
    }
}

// Places the labels of rules where they cover least; the right end wins ties.
void PanelDrawing::place_rules() {
    TextStyle l = style_.tick_numbers();
    l.color = kMuted;
    for (const Rule& r : panel_.rules) {
        const double along = r.vertical ? axes_.along_x(r.at) : axes_.along_y(r.at);
        if (r.label.empty() || !inside(plot_, r.vertical ? Vec2{along, plot_.y} : Vec2{plot_.x, along}, 1e-6)) continue;
        const Box size = sheet_.measure(r.label, l);
        const double room = (r.vertical ? plot_.h - size.h : plot_.w - size.w) - 2 * style_.gap;
        Box best;
        double least = std::numeric_limits<double>::infinity();
        for (int k = 0; k <= 20; ++k)
            for (const double side : {-1.0, 1.0}) {  // above or left of the rule, below or right of it
                const double from = style_.gap + room * (1 - k / 20.0), off = 0.7 * style_.gap;
                const double beside = side < 0 ? along - off - (r.vertical ? size.w : size.h) : along + off;
                const Box box = r.vertical ? Box{beside, plot_.y + room + 2 * style_.gap - from, size.w, size.h}
                                           : Box{plot_.x + from, beside, size.w, size.h};
                const double cost = 10 * taken_->cost(box.inset(-1)) + 0.1 * k + 0.05 * side;
                if (cost < least) least = cost, best = box;
            }
        taken_->cover(best);
        writings_.push_back({{best.x, best.y - size.y}, r.label, l, {}});
    }
}

bool PanelDrawing::place_labels() {
    if (legend_.entries() == 0 || panel_.legend == Legend::none) return true;
    if (legend_.is_above()) {
        const bool settled = legend_.place_above(plot_.w);
        legend_.stand_at({plot_.x, plot_.y - margins().top + axes_.titles_height()});
        return settled;
    }
    if (panel_.legend == Legend::direct && legend_.entries() <= kMostDirectLabels && panel_.bands.empty() &&
        place_direct())
        return true;
    return legend_.place_inside(*taken_);
}

// How much nearer another curve is than the label's own, which would mislead.
double PanelDrawing::crowding(const Box& box, const DrawnCurve& own) const {
    const auto distance = [&](const DrawnCurve& c) {
        double least = 1e9;
        for (const Vec2 p : c.points()) {
            const double dx = std::max({box.x - p.x, p.x - box.right(), 0.0});
            const double dy = std::max({box.y - p.y, p.y - box.bottom(), 0.0});
            least = std::min(least, std::hypot(dx, dy));
        }
        return least;
    };
    const double mine = distance(own);
    double worst = 0;
    for (const DrawnCurve& c : curves_)
        if (&c.series() != &own.series()) worst = std::max(worst, mine + 1.5 * style_.gap - distance(c));
    return worst;
}

double PanelDrawing::best_direct(const DrawnCurve& curve, Writing& out) {
    TextStyle l = style_.words();
    l.color = color_of(curve.series());
    const Box size = sheet_.measure(curve.series().label, l);
    double least = std::numeric_limits<double>::infinity();
    const std::size_t stride = std::max<std::size_t>(1, curve.points().size() / 60);
    for (std::size_t i = 0; i < curve.points().size(); i += stride) {
        const Vec2 p = curve.points()[i];
        if (!inside(plot_, p)) continue;
        for (const double up : {1.0, -1.0, 0.0})
            for (const double side : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
                if (up == 0 && std::abs(side) < 1) continue;
                const Vec2 middle{p.x + side * (size.w / 2 + style_.gap), p.y - up * (size.h / 2 + 1.0 * style_.gap)};
                const Box box{middle.x - size.w / 2, middle.y - size.h / 2, size.w, size.h};
                const double cover = taken_->cost(box.inset(-1));
                if (cover >= kBeyondPlot) continue;
                const double cost = 10 * cover + 3 * std::max(0.0, crowding(box, curve)) +
                                    0.02 * (plot_.right() - middle.x) + std::abs(side);
                if (cost >= least) continue;
                least = cost;
                out = {{box.x, box.y - size.y}, curve.series().label, l, {}};
            }
    }
    return least;
}

bool PanelDrawing::place_direct() {
    const OccupancyGrid before = *taken_;
    const std::size_t written = writings_.size();
    for (const DrawnCurve& curve : curves_) {
        if (curve.series().label.empty()) continue;
        Writing label;
        if (best_direct(curve, label) > 10 * kFewCells + 12) {
            taken_ = before;
            writings_.resize(written);
            return false;
        }
        const Box size = sheet_.measure(label.markup, label.lettering);
        taken_->cover(Box{label.at.x, label.at.y + size.y, size.w, size.h});
        writings_.push_back(std::move(label));
    }
    return true;
}

// ---- drawing -----------------------------------------------------------------------------------------

void PanelDrawing::draw() {
    sheet_.clip(plot_, [&] { draw_backgrounds(); });
    std::deque<PanelDrawing> insets = draw_inset_backgrounds();
    sheet_.clip(plot_, [&] {
        for (const Cloud& cloud : panel_.clouds) draw_cloud(cloud, axes_, sheet_);
        for (const DrawnCurve& curve : curves_) curve.draw(style_, sheet_);
    });
    axes_.draw_frame();
    for (const DrawnCurve& curve : curves_) curve.draw_markers(plot_, style_, sheet_);
    for (const Mark& m : panel_.marks) {
        const Vec2 p = at(m.x, m.y, m.right);
        if (!inside(plot_, p, 1)) continue;
        draw_marker(sheet_, style_, look(m.look).marker, p, 1.1 * style_.marker, look(m.look).color, m.hollow);
    }
    for (PanelDrawing& inset : insets) inset.draw();
    for (const Writing& w : writings_) {
        if (w.leader) {
            sheet_.line(w.leader->first, w.leader->second, {kMuted, 0.6 * style_.frame, {}, Cap::butt});
        }
        sheet_.text(w.at, w.markup, w.lettering);
    }
    legend_.draw();
    axes_.draw_titles(plot_.y - margins().top + style_.letters, legend_.is_above());
    axes_.draw_color_bar();
}

void PanelDrawing::draw_backgrounds() {
    for (const Cells& cells : panel_.cells) draw_cells(cells, axes_, sheet_);
    for (const Span& s : panel_.spans) {
        const double a = at(s.from, 0).x, b = at(s.to, 0).x;
        // At least a visible width.
        const double width = std::max(std::abs(b - a), 0.4);
        sheet_.rectangle({std::min(a, b), plot_.y, width, plot_.h});
        sheet_.fill(s.color);
    }
    for (const Band& b : panel_.bands) {
        std::vector<Vec2> edge;
        const std::size_t count = std::min({b.x.size(), b.low.size(), b.high.size()});
        for (std::size_t i = 0; i < count; ++i) edge.push_back(at(b.x[i], b.high[i]));
        for (std::size_t i = count; i-- > 0;) edge.push_back(at(b.x[i], b.low[i]));
        std::erase_if(edge, [](Vec2 p) { return !std::isfinite(p.x + p.y); });
        sheet_.polyline(edge);
        sheet_.close();
        sheet_.fill(pale(look(b.look).color, 0.72));
    }
    for (const Rule& r : panel_.rules)
        sheet_.line(ends(r)[0], ends(r)[1],
                    {rgb(0x888888), 0.75 * style_.frame, {3.3 * style_.frame, 3.3 * style_.frame}, Cap::butt});
}

}  // namespace beamcam::render::figure
