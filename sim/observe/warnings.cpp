#include "sim/observe/warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/base/counted.hpp"
#include "sim/base/numerics.hpp"
#include "sim/contact/chatter.hpp"
#include "sim/problem/assumptions.hpp"

namespace beamcam::sim {
namespace {

constexpr double kMissedPeak = 0.95;       // of the largest force: rows that reach less miss it
constexpr double kBalanceTolerances = 10;  // times rtol: the accuracy of `auto`; a larger error is a warning
constexpr double kReportedGap = 1e-10;     // of the length, left at an event: 1000 times rounding

void warn_of_chatter(const Problem& problem, const RunStatistics& statistics, std::vector<std::string>& out) {
    if (statistics.chatters == 0) return;
    const double speed = kSummedShare * problem.contact.approach_floor.value;
    out.push_back(
        fmt::format("chatter ended {} in sustained contact; bounces below {:g} m/s (contact.approach_floor.value "
                    "times {:g}) are summed up at its end instead of listed",
                    counted(statistics.chatters, "time"), speed, kSummedShare));
}

void warn_of_balance(const Problem& problem, const Result& result, std::vector<std::string>& out) {
    const double limit = kBalanceTolerances * problem.solver.rtol * result.energy_scale;
    if (problem.beam.model == ModelKind::paper || !(result.energy_residual_max > limit)) return;
    out.push_back(
        fmt::format("the energy balance closes only to {:.2g} J of {:.3g} J, more than 10 times rtol = {:g}: "
                    "tighten solver.rtol{}",
                    result.energy_residual_max, result.energy_scale, problem.solver.rtol,
                    problem.solver.method == Method::automatic ? "" : ", or use \"method\": \"auto\""));
}

// Upper bound of the slope from the bending energy, for any shape: ∫v″² ≥ (slope at the tip)²/L [rad].
double slope_bound(const Problem& problem, double largest_elastic) {
    const Beam& beam = problem.beam;
    return std::sqrt(2 * largest_elastic * beam.length / beam.bending_stiffness());
}

void warn_of_slopes(const Problem& problem, double largest_elastic, std::vector<std::string>& out) {
    const double slope = slope_bound(problem, largest_elastic);
    if (bends_beyond(problem, largest_elastic))
        out.push_back(
            fmt::format("the beam bends through angles up to about {:.2g} rad; {} holds for small ones: use "
                        "\"model\": \"exact\"",
                        slope, name(problem.beam.model)));
}

// Newton's law creates energy where friction turns the slip around during an impact (Kane & Levinson 1985).
void warn_of_gains(const Problem& problem, const Result& result, std::vector<std::string>& out) {
    if (problem.contact.model != ContactModel::restitution ||
        std::holds_alternative<NoFriction>(problem.contact.friction))
        return;
    double gained = 0;
    long count = 0;
    for (const Impact& impact : result.impacts)
        if (impact.v_n_before < 0 && impact.energy_lost < -kLongRounding * result.energy_scale)
            ++count, gained -= impact.energy_lost;
    if (count > 0)
        out.push_back(fmt::format(
            "the impact law {} with friction created {:.2g} J in {} of {} impacts; the law \"stronge\" never "
            "creates any",
            name(problem.contact.law), gained, count, result.impacts.size()));
}

void warn_of_floor(const Problem& problem, const Result& result, const RunStatistics& statistics,
                   std::vector<std::string>& out) {
    if (statistics.floored > 0)
        out.push_back(
            fmt::format("{} of {} touches began slower than contact.approach_floor.value = {} m/s; their "
                        "dissipation uses that floor",
                        statistics.floored, result.impacts.size(), problem.contact.approach_floor.value));
}

struct MissedPeaks {
    long between = 0;               // impacts without a row
    long all = 0;                   // impacts with a force, within the table's time
    double in_rows = 0, truth = 0;  // largest force [N]
};

MissedPeaks missed_peaks(const std::vector<double>& times, const std::vector<double>* force, const Result& result) {
    MissedPeaks out;
    for (const Impact& impact : result.impacts) {
        if (!impact.force_peak || !(impact.t_start >= times.front() && impact.t_start < times.back())) continue;
        const auto row = std::ranges::lower_bound(times, impact.t_start);
        ++out.all;
        if (impact.t_end && (row == times.end() || *row > *impact.t_end)) ++out.between;
        out.truth = std::max(out.truth, *impact.force_peak);
    }
    for (std::size_t row = 0; force && row < force->size(); ++row)
        if ((*force)[row] > out.in_rows) out.in_rows = (*force)[row];
    return out;
}

// Departures from the request, and events that could not be resolved.
void warn_of_fallbacks(const Problem& problem, const RunStatistics& statistics, std::vector<std::string>& out) {
    const Fallbacks& f = statistics.fallbacks;
    if (f.left_behind > 0)
        out.push_back(
            "no motion was found in which the resting beam follows the turning cam: it starts from the equilibrium "
            "without inertia and may leave the cam");
    if (f.unstable > 0)
        out.push_back(
            "the static equilibrium at the start is unstable, since the beam buckles under its weight: the smallest "
            "disturbance makes it fall");
    if (f.friction_changes > 0)
        out.push_back(
            fmt::format("in {} the friction alternated between stick and slip at one instant and kept its state: "
                        "tighten solver.rtol",
                        counted(f.friction_changes, "step")));
    if (f.strikes > 0)
        out.push_back(
            fmt::format("{} taken as plastic: the rebound is smaller than the error of a step; tighten "
                        "solver.rtol",
                        counted(f.strikes, "strike")));
    if (f.coarse > 0)
        out.push_back(fmt::format(
            "in {} the beam vibrates faster than the search for touches resolves: a touch may be missed; use "
            "fewer modes or tighten solver.rtol",
            counted(f.coarse, "step")));
    if (f.gap > kReportedGap * problem.beam.length)
        out.push_back(fmt::format(
            "a gap of {:.2g} m remained at a touch or release and was set to zero: tighten solver.rtol", f.gap));
}

}  // namespace

bool bends_beyond(const Problem& problem, double largest_elastic) {
    const ModelKind model = problem.beam.model;
    return model != ModelKind::exact && model != ModelKind::rigid &&
           slope_bound(problem, largest_elastic) > kSmallSlope;
}

std::vector<std::string> warnings(const Problem& problem, const Result& result, const RunStatistics& statistics,
                                  double largest_elastic) {
    std::vector<std::string> out;
    warn_of_chatter(problem, statistics, out);
    warn_of_gains(problem, result, out);
    warn_of_balance(problem, result, out);
    warn_of_slopes(problem, largest_elastic, out);
    warn_of_floor(problem, result, statistics, out);
    warn_of_fallbacks(problem, statistics, out);
    return out;
}

void warn_of_missed_peaks(const Request& request, Result& result) {
    for (std::size_t i = 0; i < request.tables.size(); ++i) {
        const TableRequest& table = request.tables[i];
        const auto column = [&](ChannelKind kind) { return std::ranges::find(table.channels, kind, &Channel::kind); };
        const auto force = column(ChannelKind::contact_force);
        const bool of_contact = force != table.channels.end() ||
                                column(ChannelKind::friction_force) != table.channels.end() ||
                                column(ChannelKind::energy_contact) != table.channels.end();
        if (!table.rate || !of_contact || result.tables[i].rows() == 0) continue;
        const auto index = static_cast<std::size_t>(force - table.channels.begin());
        const std::vector<double>* forces = force == table.channels.end() ? nullptr : &result.tables[i].values[index];
        const MissedPeaks missed = missed_peaks(table.times, forces, result);
        const bool low = forces && missed.in_rows < kMissedPeak * missed.truth;
        if (missed.between == 0 && !low) continue;
        std::string text = fmt::format("in a table with rows every {:g} s", 1 / *table.rate);
        if (missed.between > 0)
            text += fmt::format(" {} of {} fall between the rows{}", missed.between, counted(missed.all, "impact"),
                                forces ? "," : "");
        if (forces)
            text +=
                fmt::format(" the largest contact_force is {:.3g} N, {:.3g} N in truth", missed.in_rows, missed.truth);
        result.warnings.push_back(text + ": use \"rate\": \"adaptive\"");
    }
}

}  // namespace beamcam::sim
