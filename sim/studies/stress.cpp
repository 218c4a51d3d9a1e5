#include "sim/studies/stress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "sim/observe/channels.hpp"
#include "sim/run/simulate.hpp"
#include "sim/studies/constants.hpp"

namespace beamcam::sim {
namespace {

bool passive(const Problem& p) {
    return std::holds_alternative<FreeDrive>(p.hub.drive) && (!p.cam || p.cam->speed == 0) &&
           p.beam.model != ModelKind::paper;
}

// CPU time of this thread, which does not depend on the load of the machine.
double processor_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// The first error in the recorded results; empty if there is none.
std::string first_error(const StressCase& one, const Result& r, const Request& request) {
    const Table& table = r.tables[0];
    const std::vector<double>& times = request.tables[0].times;
    // Elastic energy of slopes of the size of the absolute tolerance, for a beam that is straight and at rest.
    const Beam& beam = one.problem.beam;
    const double unseen = beam.bending_stiffness() / beam.length * std::pow(one.problem.solver.atol, 2);
    double start = 0;
    for (std::size_t row = 0; row < times.size(); ++row) {
        if (times[row] > r.end_time) break;
        double energy = 0;
        for (std::size_t c = 0; c < table.channels.size(); ++c) {
            const ChannelKind kind = table.channels[c].kind;
            const double value = table.values[c][row];
            if (!std::isfinite(value))
                return fmt::format("{} is {} at {:g} s", name(table.channels[c]), value, times[row]);
            if (kind == ChannelKind::energy_kinetic || kind == ChannelKind::energy_potential ||
                kind == ChannelKind::energy_elastic || kind == ChannelKind::energy_contact)
                energy += value;
        }
        if (row == 0) start = energy;
        const double slack = 2 * r.energy_residual_max + 1e-9 * r.energy_scale + unseen;
        if (passive(one.problem) && energy > start + slack)
            return fmt::format("{:.3g} J of {:.3g} J were gained on a cam at rest", energy - start, r.energy_scale);
    }
    for (const Impact& i : r.impacts)
        if (!std::isfinite(i.v_n_before) || !std::isfinite(i.impulse_n) || !std::isfinite(i.energy_lost))
            return fmt::format("an impact at {:g} s is not finite", i.t_start);
    return {};
}

void record(const StressCase& one, const Result& r, const Request& request, StressResult& out) {
    out.reached = r.end_time;
    out.steps = r.counters.steps + r.counters.rejected;
    out.impacts = r.impacts.size();
    out.steps_per_second = r.end_time > 0 ? static_cast<double>(out.steps) / r.end_time : 0;
    out.message = first_error(one, r, request);
}

}  // namespace

StressResult run_case(const StressCase& one) {
    StressResult out;
    out.closure = std::numeric_limits<double>::quiet_NaN();
    Request request;
    request.end_time = one.end;
    TableRequest table;
    table.channels = all_channels(one.problem);
    for (int k = 0; k < kChannelSamples; ++k) table.times.push_back(one.end * k / (kChannelSamples - 1));
    if (!one.problem.cam) std::erase_if(table.channels, [](const Channel& c) { return traits(c.kind).needs_cam; });
    request.tables.push_back(table);
    request.extrema = {{ChannelKind::theta, 0}, {ChannelKind::tip_deflection, 0}};
    const Progress watch = [start = processor_seconds()](double) { return processor_seconds() - start < kCaseLimit; };
    try {
        for (const Issue& issue : validate(one.problem))
            if (issue.fatal) {
                out.outcome = issue.message.empty() ? Outcome::failed : Outcome::refused;
                out.message = issue.path + ": " + issue.message;
                return out;
            }
        const Result r = simulate(one.problem, request, watch);
        record(one, r, request, out);
        if (!out.message.empty()) return out;
        const double unit = one.problem.solver.rtol * r.energy_scale;
        out.closure = unit > 0 ? r.energy_residual_max / unit : 0;
        const bool reported = std::ranges::any_of(
            r.warnings, [](const std::string& w) { return w.find("energy ledger") != std::string::npos; });
        out.outcome = reported || one.problem.beam.model == ModelKind::paper ? Outcome::open : Outcome::closed;
        if (!r.warnings.empty()) out.message = r.warnings.front();
    } catch (const SolverError& error) {
        if (!error.partials.empty()) record(one, error.partials.at(0), request, out);
        if (!out.message.empty()) return out;
        out.message = error.what();
        const double reached = error.partials.empty() ? 0 : error.partials.at(0).end_time;
        out.outcome = reached == error.last_time ? Outcome::stopped : Outcome::failed;
    } catch (const Interrupted&) {
        out.message = fmt::format("still running after {:g} s", kCaseLimit);
    } catch (const std::exception& error) {
        out.message = fmt::format("an exception other than a solver failure: {}", error.what());
    }
    return out;
}

}  // namespace beamcam::sim
