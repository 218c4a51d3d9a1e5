#include "render/film/force_curve.hpp"

#include <algorithm>
#include <cmath>

namespace beamcam::render {
namespace {

struct Row {
    double t, force;
};

// In the order of time; those with no force are left out.
std::vector<Row> sampled_rows(const Motion& motion) {
    std::vector<Row> rows;
    for (const sim::Table* table : {&motion.chart, &motion.trace}) {
        const auto *t = column(*table, {sim::ChannelKind::t, 0}),
                   *force = column(*table, {sim::ChannelKind::contact_force, 0});
        if (!t || !force) continue;
        for (std::size_t i = 0; i < table->rows(); ++i)
            if (!std::isnan((*force)[i])) rows.push_back({(*t)[i], (*force)[i]});
    }
    std::ranges::stable_sort(rows, {}, &Row::t);
    const auto simultaneous = [](const Row& a, const Row& b) { return a.t == b.t; };
    rows.erase(std::unique(rows.begin(), rows.end(), simultaneous), rows.end());
    return rows;
}

// Instant of the maximum between rows: the vertex of the parabola through the highest row and its neighbours.
double instant_of_peak(const Row& before, const Row& highest, const Row& after) {
    const double left = highest.t - before.t, right = after.t - highest.t;
    const double rise = (highest.force - before.force) / left,
                 fall = (after.force - highest.force) / right;  // rise >= 0 >= fall
    const double lean = rise - fall > 0 ? (rise * right + fall * left) / (rise - fall) : 0;
    const double least = 0.01 * std::min(left, right);
    double shift = 0.5 * lean;
    if (std::abs(shift) < least) shift = lean < 0 ? -least : least;  // not at the row, which keeps its value
    return highest.t + std::clamp(shift, -0.9 * left, 0.9 * right);
}

// Adds what the rows do not show of an impact that ends at `end`.
void add_peak(const std::vector<Row>& rows, const sim::Impact& impact, double end, std::vector<Row>& peaks) {
    const double force = *impact.force_peak;
    const auto first = std::ranges::lower_bound(rows, impact.t_start, {}, &Row::t),
               last = std::ranges::upper_bound(first, rows.end(), end, {}, &Row::t),
               highest = std::ranges::max_element(first, last, {}, &Row::force);
    if (highest == last || !(highest->force > 0))
        peaks.insert(peaks.end(), {{impact.t_start, 0}, {(impact.t_start + end) / 2, force}, {end, 0}});
    else if (force > highest->force && highest != rows.begin() && highest + 1 != rows.end())
        peaks.push_back({instant_of_peak(*(highest - 1), *highest, *(highest + 1)), force});
}

}  // namespace

figure::Series force_curve(const Motion& motion, Range span) {
    std::vector<Row> rows = sampled_rows(motion), peaks;
    for (const sim::Impact& impact : motion.impacts)
        if (impact.force_peak && impact.t_end && !rows.empty() && *impact.t_end <= rows.back().t)
            add_peak(rows, impact, *impact.t_end, peaks);
    rows.insert(rows.end(), peaks.begin(), peaks.end());
    std::ranges::stable_sort(rows, {}, &Row::t);
    figure::Series curve;
    for (const Row& row : rows)
        if (row.t >= span.low && row.t <= span.high) curve.add(row.t, row.force);
    return curve;
}

Peaks::Peaks(const FilmContext& context, Range span) {
    for (int m = 0; m < context.members(); ++m) forces_.push_back(force_curve(context.motion(m), span));
}

Vec2 Peaks::of(int member, Range part) const {
    const figure::Series& force = forces_[static_cast<std::size_t>(member)];
    Vec2 peak{kNan, kNan};
    const auto from = std::ranges::lower_bound(force.x, part.low) - force.x.begin(),
               to = std::ranges::upper_bound(force.x, part.high) - force.x.begin();
    for (auto i = static_cast<std::size_t>(from); i < static_cast<std::size_t>(to); ++i)
        if (force.y[i] > 0 && !(force.y[i] <= peak.y)) peak = {force.x[i], force.y[i]};
    return peak;
}

}  // namespace beamcam::render
