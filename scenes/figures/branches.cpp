#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "render/base/error.hpp"
#include "scenes/figures/axis_labels.hpp"
#include "scenes/figures/caption.hpp"
#include "scenes/figures/command_figures.hpp"
#include "sim/problem/number_keys.hpp"

namespace beamcam::scenes {
namespace {

using render::figure::Figure, render::figure::Panel, render::figure::Series;

constexpr std::uint32_t kSweptColor = 0x333333;
constexpr double kUnstable = 0.6;  // of the width of stable branches
constexpr double kGapInCurve = std::numeric_limits<double>::quiet_NaN();
constexpr double kTiny = std::numeric_limits<double>::min();

// Approach speeds of one impact of the orbit along a branch, a value for each point; NaN where it does not occur.
using FollowedImpact = std::vector<double>;

// Impacts are numbered from the section. Where it moves, the number of the old impact that has become the first one:
// with it the impacts move least in cam angle and speed.
std::size_t first_impact(const sim::PeriodicOrbit& before, const sim::PeriodicOrbit& here) {
    if (before.section == here.section) return 0;
    const std::vector<sim::OrbitImpact>&a = before.impacts, &b = here.impacts;
    const std::size_t count = std::max(a.size(), b.size());
    const auto moves_by = [&](std::size_t first) {
        double sum = 0;
        for (std::size_t k = 0; k < b.size(); ++k) {
            const std::size_t from = (k + first) % count;
            if (from >= a.size()) continue;
            const double turned = std::remainder(b[k].cam_angle - a[from].cam_angle, 2 * std::numbers::pi);
            const double faster =
                (b[k].approach - a[from].approach) / std::max({b[k].approach, a[from].approach, kTiny});
            sum += turned * turned + faster * faster;
        }
        return sum;
    };
    std::size_t least = 0;
    for (std::size_t first = 1; first < count; ++first)
        if (moves_by(first) < moves_by(least)) least = first;
    return least;
}

std::vector<FollowedImpact> followed_impacts(const sim::Branch& branch) {
    std::vector<FollowedImpact> out;
    std::vector<std::size_t> before, here;  // which of them each impact of an orbit is
    for (std::size_t i = 0; i < branch.points.size(); ++i) {
        const sim::PeriodicOrbit& orbit = branch.points[i].orbit;
        const std::size_t first = i > 0 ? first_impact(branch.points[i - 1].orbit, orbit) : 0;
        here.clear();
        for (std::size_t k = 0; k < orbit.impacts.size(); ++k) {
            const std::size_t from = (k + first) % std::max(before.size(), orbit.impacts.size());
            here.push_back(from < before.size() ? before[from] : out.size());
            if (here.back() == out.size()) out.emplace_back(branch.points.size(), kGapInCurve);
            out[here.back()][i] = orbit.impacts[k].approach;
        }
        before.swap(here);
    }
    return out;
}

// The impacts of the stable or of the unstable orbits of a branch, one after the other; pieces meet at the change.
void add_impacts(const sim::Branch& branch, const std::vector<FollowedImpact>& impacts, bool stable, double factor,
                 Series& series) {
    const auto is_kind = [&](std::size_t i) { return branch.points[i].orbit.stable() == stable; };
    for (const FollowedImpact& approach : impacts)
        for (std::size_t i = 0; i < approach.size(); ++i) {
            const bool shown = std::isfinite(approach[i]) && (is_kind(i) || (i > 0 && is_kind(i - 1)));
            if (shown) series.add(factor * branch.points[i].parameter, approach[i]);
            const bool ends = !shown || !is_kind(i) || i + 1 == approach.size();
            if (ends && !series.x.empty() && std::isfinite(series.x.back())) series.add(kGapInCurve, kGapInCurve);
        }
}

// The letters of each change at its mark, and its name in the caption.
struct ChangeName {
    const char *letters, *name;
};
constexpr ChangeName kChanges[] = {{"SN", "saddle-node (fold)"},
                                   {"PD", "period doubling"},
                                   {"NS", "Neimark–Sacker"},
                                   {"BP", "branching"},
                                   {"G", "grazing"},
                                   {"C", "corner"},
                                   {"R", "release"}};

// The names of the changes that have marks.
std::string legend_of_marks(const Panel& panel) {
    std::string out;
    for (const ChangeName& change : kChanges)
        if (std::ranges::count(panel.marks, change.letters, &render::figure::Mark::label))
            out += fmt::format("; {}: {}", change.letters, change.name);
    return out;
}

// A change has a mark at its fastest impact, unless one of the same kind is closer than this share of the range, as
// along a cascade of period doublings.
constexpr double kRoomOfMark = 0.06;

void add_special(const output::BranchTable& table, double factor, double range, Panel& panel) {
    std::map<sim::OrbitChange, double> marked;
    for (const sim::Branch& branch : table.branches)
        for (const sim::SpecialPoint& point : branch.special) {
            const double x = factor * point.at.parameter;
            const auto last = marked.find(point.change);
            if (last != marked.end() && std::abs(x - last->second) < kRoomOfMark * range) continue;
            marked[point.change] = x;
            double fastest = 0;  // of a beam that never leaves the cam
            for (const sim::OrbitImpact& impact : point.at.orbit.impacts) fastest = std::max(fastest, impact.approach);
            panel.marks.push_back({.x = x,
                                   .y = fastest,
                                   .label = kChanges[static_cast<std::size_t>(point.change)].letters,
                                   .look = static_cast<int>(point.change),
                                   .hollow = true});
        }
}

// Stable and unstable pieces of all branches.
struct BranchCurves {
    Series stable, unstable;
};
BranchCurves curves_of(const output::BranchTable& table, double factor, Lang lang) {
    BranchCurves out{{.label = phrase(lang, "stable"), .solid = true},
                     {.label = phrase(lang, "unstable"), .look = 1, .weight = kUnstable}};
    for (const sim::Branch& branch : table.branches) {
        const std::vector<FollowedImpact> impacts = followed_impacts(branch);
        add_impacts(branch, impacts, true, factor, out.stable);
        add_impacts(branch, impacts, false, factor, out.unstable);
    }
    return out;
}

// At the ends of the ranges of the branches.
std::vector<sim::Problem> problems_along(const output::BranchTable& table, const sim::Problem& problem) {
    std::vector<sim::Problem> out;
    for (const sim::Branch& branch : table.branches) {
        if (branch.points.empty()) continue;
        const auto [low, high] = std::ranges::minmax_element(branch.points, {}, &sim::BranchPoint::parameter);
        for (const double value : {low->parameter, high->parameter})
            set_number(out.emplace_back(problem), table.key, value);
    }
    return out;
}

}  // namespace

Figure branches_figure(const output::BranchTable& table, const SweptImpacts& swept, const Scene& scene, Lang lang) {
    const auto key = sim::number_key(scene.problem, table.key);
    const Measure shown = measure_in(scene.units, key ? sim::si_unit(key->dimension) : "");
    BranchCurves curves = curves_of(table, shown.factor, lang);
    Panel panel{.x = {.label = axis_label(symbol_of(table.key), shown.unit),
                      .from = shown.factor * table.from,
                      .to = shown.factor * table.to,
                      .tight = true},
                .y = {.label = axis_label(phrase(lang, "approach speed"), "m/s")},
                .name = "branches"};
    const bool with_sweep = !swept.parameter.empty();
    if (with_sweep) panel.clouds.push_back({phrase(lang, "sweep"), {}, swept.approach, render::rgb(kSweptColor)});
    for (const double parameter : swept.parameter) panel.clouds[0].x.push_back(shown.factor * parameter);
    add_special(table, shown.factor, shown.factor * (table.to - table.from), panel);
    for (Series* series : {&curves.unstable, &curves.stable})  // the stable ones on top
        if (!series->x.empty()) panel.series.push_back(std::move(*series));
    if (panel.series.empty())
        throw render::PictureError("branches: no orbit with impacts was followed, so there is nothing to draw");
    Figure figure{.name = "branches",
                  .title = fmt::format("Approach speeds of periodic orbits over {}{}{}", key_text(table.key),
                                       legend_of_marks(panel), with_sweep ? "; dots: impacts of a sweep" : ""),
                  .panels = {std::move(panel)}};
    add_caption(figure, problems_along(table, scene.problem), scene.units);
    figure.accuracy = "Newton's method on the section map at relative tolerance 10^{−12}.";
    return figure;
}

}  // namespace beamcam::scenes
