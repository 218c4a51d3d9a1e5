#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "render/base/error.hpp"
#include "scenes/figures/axis_labels.hpp"
#include "scenes/figures/caption.hpp"
#include "scenes/figures/command_figures.hpp"
#include "sim/problem/number_keys.hpp"

namespace beamcam::scenes {
namespace {

using render::figure::Figure, render::figure::Panel, render::figure::Series;

constexpr std::uint32_t kSweptColor = 0x9A9A9A;  // beneath the branches
constexpr double kGapInCurve = std::numeric_limits<double>::quiet_NaN();

// The impacts of the stable or of the unstable orbits of a branch, one after the other; pieces meet at the change.
void add_impacts(const sim::Branch& branch, bool stable, double factor, Series& series) {
    std::size_t impacts = 0;  // their number changes along the branch before a rest on the cam
    for (const sim::BranchPoint& point : branch.points) impacts = std::max(impacts, point.orbit.impacts.size());
    for (std::size_t k = 0; k < impacts; ++k)
        for (std::size_t i = 0; i < branch.points.size(); ++i) {
            const sim::BranchPoint& point = branch.points[i];
            const bool before = i > 0 && branch.points[i - 1].orbit.stable() == stable;
            const bool here = point.orbit.stable() == stable;
            if (!here && !before) continue;
            const bool there = k < point.orbit.impacts.size();
            series.add(there ? factor * point.parameter : kGapInCurve,
                       there ? point.orbit.impacts[k].approach : kGapInCurve);
            if (!here || i + 1 == branch.points.size()) series.add(kGapInCurve, kGapInCurve);
        }
}

const char* letters(sim::OrbitChange change) {
    static constexpr const char* kLetters[] = {"SN", "PD", "NS", "BP", "G", "C", "R"};
    return kLetters[static_cast<std::size_t>(change)];
}

// Labels nearer to the last one of the same change than this share of the range are omitted, as along a cascade of
// period doublings.
constexpr double kLabelRoom = 0.06;

std::string add_special(const output::BranchTable& table, double factor, double range, Panel& panel) {
    std::string text;
    std::map<sim::OrbitChange, double> labelled;
    for (const sim::Branch& branch : table.branches)
        for (const sim::SpecialPoint& point : branch.special) {
            const double x = factor * point.at.parameter;
            const auto last = labelled.find(point.change);
            const bool room = last == labelled.end() || !(std::abs(x - last->second) < kLabelRoom * range);
            if (room && !point.at.orbit.impacts.empty()) labelled[point.change] = x;
            for (std::size_t k = 0; k < point.at.orbit.impacts.size(); ++k)
                panel.marks.push_back({.x = x,
                                       .y = point.at.orbit.impacts[k].approach,
                                       .label = room && k == 0 ? letters(point.change) : "",
                                       .look = static_cast<int>(point.change),
                                       .hollow = true});
            text += fmt::format("{}{} {}", text.empty() ? "" : "; ", letters(point.change), number(x, 11));
        }
    return text;
}

// Stable and unstable pieces of all branches.
struct BranchCurves {
    Series stable, unstable;
};
BranchCurves curves_of(const output::BranchTable& table, double factor, Lang lang) {
    BranchCurves out{{.label = phrase(lang, "stable", "稳定"), .solid = true},
                     {.label = phrase(lang, "unstable", "不稳定"), .look = 1}};
    for (const sim::Branch& branch : table.branches) {
        add_impacts(branch, true, factor, out.stable);
        add_impacts(branch, false, factor, out.unstable);
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

std::string branches_caption(const output::BranchTable& table, const std::string& special, bool with_sweep,
                             const Scene& scene, Lang lang) {
    return phrase(lang,
                  "Approach speeds of the impacts of periodic orbits over {}: stable orbits solid, unstable ones "
                  "dashed; SN fold, PD period doubling, NS Neimark–Sacker, BP branching, G grazing, C corner (the "
                  "contact passes the tip), R release. {}{}{}",
                  "周期轨道各次碰撞的接近速度随 {} 的变化：实线稳定，虚线不稳定；SN 鞍结，PD 倍周期，NS "
                  "Neimark–Sacker，BP 分支点，G 擦边，C 拐点（接触越过自由端），R 脱离。{}{}{}",
                  symbol_of(table.key), special.empty() ? "" : phrase(lang, "{}. ", "{}。", special),
                  !with_sweep ? "" : phrase(lang, "Dots: impacts of a sweep. ", "点：扫描所得碰撞。"),
                  facts(subject_of(scene, lang), {.others = problems_along(table, scene.problem)}));
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
                .y = {.label = axis_label(kApproachSpeed.in(lang), "m/s")},
                .legend = render::figure::Legend::box,
                .name = "branches"};
    const bool with_sweep = !swept.parameter.empty();
    if (with_sweep)
        panel.clouds.push_back({phrase(lang, "sweep", "扫描"), {}, swept.approach, render::rgb(kSweptColor)});
    for (const double parameter : swept.parameter) panel.clouds[0].x.push_back(shown.factor * parameter);
    const std::string special = add_special(table, shown.factor, shown.factor * (table.to - table.from), panel);
    for (Series* series : {&curves.stable, &curves.unstable})
        if (!series->x.empty()) panel.series.push_back(std::move(*series));
    if (panel.series.empty())
        throw render::PictureError("branches: no orbit with impacts was followed, so there is nothing to draw");
    return {.name = "branches",
            .title = phrase(lang, "Branches of periodic orbits", "周期轨道分支"),
            .panels = {std::move(panel)},
            .caption = branches_caption(table, special, with_sweep, scene, lang),
            .accuracy = phrase(lang, "Newton's method on the section map at relative tolerance 10^{−12}.",
                               "截面映射上的 Newton 法，相对容差 10^{−12}。")};
}

}  // namespace beamcam::scenes
