#include "scenes/commands/orbit_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenes/figures/axis_labels.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {
namespace {

std::string orbit_text(const sim::PeriodicOrbit& orbit) {
    return fmt::format("period {} of the cam, {:.12g} s, {}: {}, largest multiplier {:.9g}{}\n",
                       counted(orbit.turns, "turn"), orbit.period, counted(orbit.impacts.size(), "impact"),
                       orbit.stable() ? "stable" : "unstable", orbit.largest_multiplier(),
                       orbit.chatters()          ? ", rests on the cam for a part of the period"
                       : orbit.always_touching() ? ", always touching"
                       : orbit.impacts.empty()   ? ", never touching the cam"
                                                 : "");
}

// Along a branch that rests on the cam the number of impacts varies: they die out before it.
std::string impacts_text(const std::vector<sim::BranchPoint>& points) {
    std::size_t least = points.front().orbit.impacts.size(), most = least;
    for (const sim::BranchPoint& point : points) {
        least = std::min(least, point.orbit.impacts.size());
        most = std::max(most, point.orbit.impacts.size());
    }
    return least == most ? counted(most, "impact") : fmt::format("{} to {}", least, counted(most, "impact"));
}

// Significant digits of the parameter, up to the first that is uncertain.
int known_digits(const sim::SpecialPoint& point) {
    constexpr double kMost = 13;
    const double digits =
        std::floor(std::log10(std::abs(point.at.parameter))) - std::floor(std::log10(point.uncertainty)) + 1;
    return static_cast<int>(std::isnan(digits) ? kMost : std::clamp(digits, 1.0, kMost));
}

std::string suffix_of(const Measure& shown) {
    if (shown.unit == "1") return "";
    return (shown.unit == "°" ? "" : " ") + shown.unit;
}

std::string branches_text(const output::BranchTable& table, const render::Units& units) {
    const Measure shown = measure_in(units, table.unit);
    const std::string unit = suffix_of(shown);
    std::string text;
    for (const sim::Branch& branch : table.branches) {
        const auto [low, high] =
            std::minmax_element(branch.points.begin(), branch.points.end(),
                                [](const auto& a, const auto& b) { return a.parameter < b.parameter; });
        text += fmt::format("branch of {}, {}: {}, {} from {:.9g} to {:.9g}{}\n",
                            counted(branch.points.front().orbit.turns, "turn"), impacts_text(branch.points),
                            counted(branch.points.size(), "point"), table.key, shown.factor * low->parameter,
                            shown.factor * high->parameter, unit);
        for (const sim::SpecialPoint& point : branch.special)
            text += fmt::format("  {:16} {} = {:.{}g} ± {:.0e}{}\n", name(point.change), table.key,
                                shown.factor * point.at.parameter, known_digits(point),
                                shown.factor * point.uncertainty, unit);
        for (const std::string& end : {branch.first_end, branch.last_end})
            if (!end.empty()) text += fmt::format("  ends: {}\n", end);
    }
    return text;
}

}  // namespace

std::string value_text(const output::BranchTable& table, double value, const render::Units& units) {
    const Measure shown = measure_in(units, table.unit);
    return fmt::format("{:.10g}{}", shown.factor * value, suffix_of(shown));
}

std::string to_text(const output::BranchTable& table, const render::Units& units) {
    std::string text;
    for (const sim::PeriodicOrbit& orbit : table.orbits) text += orbit_text(orbit);
    return text + branches_text(table, units);
}

std::string nothing_found(const sim::OrbitRequest& request) {
    const std::string periods =
        request.turns > 1
            ? fmt::format("a shortest period of {} turns (one of fewer turns that repeats is not counted)",
                          request.turns)
            : fmt::format("a period of {}{}", request.turns == 0 ? "up to " : "",
                          counted(request.turns == 0 ? request.most_turns : 1, "turn"));
    return fmt::format(
        "no periodic orbit was found with {}{}: neither near the motion after a transient of {:.6g} s, nor near throws "
        "of the beam off the cam that last {}; try another initial state, --turns, --impacts or --transient",
        periods, request.impacts ? " and " + counted(*request.impacts, "impact") : "", request.transient,
        counted(std::max(1, request.turns), "turn"));
}

}  // namespace beamcam::scenes
