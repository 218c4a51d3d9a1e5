#include "sim/run/horizon.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "sim/dynamics/system.hpp"
#include "sim/integrate/integrator.hpp"

namespace beamcam::sim {
namespace {

constexpr double kComparedRate = 1000;       // [Hz] sampling rate of the comparison
constexpr double kBriefAgreement = 0.1;      // [s] a shorter agreement of two motions is a crossing
constexpr double kTightestRtol = 1e-13;      // below it rounding errors dominate
constexpr double kMaxComparedSteps = 500e3;  // of an explicit method: some seconds
constexpr double kExplicitRadians = 2;       // of the fastest vibration in one step of such a method

Problem at_tolerance(const Problem& problem) {
    Problem out = problem;
    out.solver.rtol = std::max(kTightestRtol, kTighterTolerance * problem.solver.rtol);
    out.solver.atol = kTighterTolerance * problem.solver.atol;
    return out;
}

Method other_method(Method method) { return method == Method::rk8 ? Method::cvode_adams : Method::rk8; }

// The fastest rate that an explicit method must resolve, of vibration or of its decay [1/s].
double fastest_rate(const System& system) {
    return system.highest_frequency() * std::max(1.0, 2 * system.damping_ratio());
}

// True if the angles of row i agree.
bool agree(const Problem& problem, const Result& plain, const Result& other, std::size_t i) {
    const double scale = compared_angle(problem).scale;
    const double a = scale * plain.tables[0].values[0][i], b = scale * other.tables[0].values[0][i];
    return std::fabs(a - b) <= kReproducible * std::max(1.0, std::fabs(b));
}

std::string sentence(const Result& result) {
    const auto until = [](const Interval& lost) {
        return lost.to ? fmt::format("from {:.4g} s to {:.4g} s", lost.from, *lost.to)
                       : fmt::format("from {:.4g} s on", lost.from);
    };
    if (result.not_reproducible.empty())
        return fmt::format("reproducible to {:g} rad throughout, compared with {}", kReproducible,
                           result.compared_with);
    std::vector<std::string> lost;
    for (const Interval& interval : result.not_reproducible) lost.push_back(until(interval));
    const std::string again =
        result.reproducible_again_from ? fmt::format(", again from {:.4g} s on", *result.reproducible_again_from) : "";
    return fmt::format("reproducible to {:g} rad until {:.4g} s, not {}{}, compared with {}", kReproducible,
                       *result.reproducible_until, fmt::join(lost, ", nor "), again, result.compared_with);
}

}  // namespace

Request horizon_request(const Problem& problem, double end) {
    TableRequest table;
    table.channels = {compared_angle(problem).channel};
    const auto rows = static_cast<long>(std::floor(end * kComparedRate));
    for (long k = 0; k <= rows; ++k) table.times.push_back(static_cast<double>(k) / kComparedRate);
    table.times.push_back(end);
    Request request;
    request.tables.push_back(std::move(table));
    request.impact_peaks = false;
    return request;
}

Comparison comparison(const Problem& problem, double end) {
    System system(problem);
    Comparison out{at_tolerance(problem), false};
    if (fastest_rate(system) * end > kExplicitRadians * kMaxComparedSteps) return tighter_comparison(problem);
    out.problem.solver.method = other_method(used_method(problem.solver.method, system));
    out.problem.solver.max_steps = std::min(problem.solver.max_steps, static_cast<int>(4 * kMaxComparedSteps));
    return out;
}

Comparison tighter_comparison(const Problem& problem) { return {at_tolerance(problem), true}; }

void report_reproducibility(const Problem& problem, const Request& angle, const Result& plain, const Result& other,
                            const Comparison& compared, Result& result) {
    const std::vector<double>& times = angle.tables[0].times;
    const double end = result.end_time;
    result.not_reproducible.clear();
    result.reproducible_again_from.reset();
    double agreed = 0;  // last instant of agreement
    bool lost = false;
    double back = 0;  // first instant of renewed agreement
    for (std::size_t i = 0; i < times.size() && times[i] <= end; ++i) {
        const double t = times[i];
        if (!agree(problem, plain, other, i)) {
            const bool crossing = !lost && !result.not_reproducible.empty() &&
                                  agreed - *result.not_reproducible.back().to < kBriefAgreement;
            if (crossing)
                result.not_reproducible.back().to.reset();
            else if (!lost)
                result.not_reproducible.push_back({agreed, std::nullopt});
            lost = true;
            continue;
        }
        if (lost) {
            back = t;
            result.not_reproducible.back().to = back;
        }
        lost = false;
        agreed = t;
    }
    if (!result.not_reproducible.empty() && !lost) {
        if (agreed - back < kBriefAgreement)
            result.not_reproducible.back().to.reset();
        else
            result.reproducible_again_from = back;
    }
    result.reproducible_until = result.not_reproducible.empty() ? end : result.not_reproducible.front().from;
    const Solver& solver = compared.problem.solver;
    result.compared_with = fmt::format("{} at rtol {:g}{}", name(solver.method), solver.rtol,
                                       compared.same_method ? " (the same method: others take too many steps)" : "");
    result.reproducibility = sentence(result);
}

}  // namespace beamcam::sim
