// Labels of a panel at its marks, rules and curves, where they cover least.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "render/plot/panel.hpp"

namespace beamcam::render::figure {
namespace {

constexpr double kBeyondPlot = 1e5;           // cost of a box that leaves the plot
constexpr std::size_t kMostDirectLabels = 4;  // more labels are easier to distinguish in a box

}  // namespace

// Tries places around the mark, near ones first.
PanelDrawing::Writing PanelDrawing::best_at_mark(const Mark& m) {
    const Vec2 p = plot_.at(m.x, m.y, m.right);
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
        const Vec2 p = plot_.at(m.x, m.y, m.right);
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

// Places the labels of rules where they cover least, rather not across another rule; the right end wins ties.
void PanelDrawing::place_rules() {
    const Box& plot = plot_.box();
    TextStyle l = style_.tick_numbers();
    l.color = kMuted;
    const auto along_of = [&](const Rule& r) { return r.vertical ? plot_.along_x(r.at) : plot_.along_y(r.at); };
    for (const Rule& r : panel_.rules) {
        const double along = along_of(r);
        const auto crosses = [&](const Box& box, const Rule& other) {
            const double at = along_of(other), low = r.vertical ? box.x : box.y;
            return other.vertical == r.vertical && at > low && at < low + (r.vertical ? box.w : box.h);
        };
        if (r.label.empty() || !inside(plot, r.vertical ? Vec2{along, plot.y} : Vec2{plot.x, along}, 1e-6)) continue;
        const Box size = sheet_.measure(r.label, l);
        const double room = (r.vertical ? plot.h - size.h : plot.w - size.w) - 2 * style_.gap;
        Box best;
        double least = std::numeric_limits<double>::infinity();
        for (int k = 0; k <= 20; ++k)
            for (const double side : {-1.0, 1.0}) {  // above or left of the rule, below or right of it
                const double from = style_.gap + room * (1 - k / 20.0), off = 0.7 * style_.gap;
                const double beside = side < 0 ? along - off - (r.vertical ? size.w : size.h) : along + off;
                const Box box = r.vertical ? Box{beside, plot.y + room + 2 * style_.gap - from, size.w, size.h}
                                           : Box{plot.x + from, beside, size.w, size.h};
                const auto crossed =
                    std::ranges::count_if(panel_.rules, [&](auto& each) { return crosses(box, each); });
                const double cost =
                    10 * taken_->cost(box.inset(-1)) + 3 * static_cast<double>(crossed) + 0.1 * k + 0.05 * side;
                if (cost < least) least = cost, best = box;
            }
        taken_->cover(best);
        Writing& label = writings_.emplace_back(Writing{{best.x, best.y - size.y}, r.label, l, {}});
        if (std::ranges::any_of(panel_.rules, [&](auto& each) { return crosses(best, each); }))
            label.ground = best.inset(-0.5);
    }
}

bool PanelDrawing::place_labels() {
    if (legend_.entries() == 0 || panel_.legend == Legend::none) return true;
    if (legend_.is_above()) {
        const bool settled = legend_.place_above(plot_.box().w);
        legend_.stand_at({plot_.box().x, plot_.box().y - margins().top + names_.titles_height()});
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
    const Box within = plot_.box().inset(style_.tick + 1);  // between the ticks of the frame
    double least = std::numeric_limits<double>::infinity();
    const std::size_t stride = std::max<std::size_t>(1, curve.points().size() / 60);
    for (std::size_t i = 0; i < curve.points().size(); i += stride) {
        const Vec2 p = curve.points()[i];
        if (!inside(plot_.box(), p)) continue;
        for (const double up : {1.0, -1.0, 0.0})
            for (const double side : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
                if (up == 0 && std::abs(side) < 1) continue;
                const Vec2 middle{p.x + side * (size.w / 2 + style_.gap), p.y - up * (size.h / 2 + 1.0 * style_.gap)};
                const Box box{middle.x - size.w / 2, middle.y - size.h / 2, size.w, size.h};
                if (!within.contains(box)) continue;
                const double cover = taken_->cost(box.inset(-1));
                const double cost = 10 * cover + 3 * std::max(0.0, crowding(box, curve)) +
                                    0.02 * (plot_.box().right() - middle.x) + std::abs(side);
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

}  // namespace beamcam::render::figure
