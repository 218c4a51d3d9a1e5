#include "sim/studies/peak_budget.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "sim/base/clock.hpp"
#include "sim/base/counted.hpp"
#include "sim/beam/model.hpp"
#include "sim/run/horizon.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::sim {
namespace {

constexpr double kUnsettled = 0.1;     // of the peak: a change with half or twice the shapes that is worth a warning
constexpr double kStiffnesses = 2;     // by which the stiffness is changed: that of a contact is not known better
constexpr double kRestitutions = 0.1;  // by which the restitution is changed

struct Variant {
    std::string change;
    Problem problem;
    int modes = 0;
};

Variant with_modes(Problem problem, int modes) {
    set_shapes(problem, problem.beam.model, problem.beam.basis, modes);
    return {counted(modes, "mode"), std::move(problem), modes};
}

std::vector<Variant> variants_of(const Problem& problem) {
    std::vector<Variant> all;
    const int modes = problem.beam.modes;
    if (problem.beam.model != ModelKind::rigid) {
        if (modes > 1) all.push_back(with_modes(problem, (modes + 1) / 2));
        if (modes < kMaxModes) all.push_back(with_modes(problem, std::min(2 * modes, kMaxModes)));
        for (const ModelKind model : {ModelKind::first_order, ModelKind::exact}) {
            if (model == problem.beam.model) continue;
            Variant& variant = all.emplace_back(Variant{fmt::format("model {}", name(model)), problem});
            set_shapes(variant.problem, model, problem.beam.basis, modes);
        }
    }
    all.push_back({fmt::format("tolerance / {:g}", 1 / kTighterTolerance), tighter_comparison(problem).problem});
    if (!problem.cam) return all;
    if (problem.contact.model == ContactModel::compliant)
        for (const double factor : {1 / kStiffnesses, kStiffnesses}) {
            Variant& variant = all.emplace_back(Variant{fmt::format("stiffness × {:g}", factor), problem});
            variant.problem.contact.stiffness_factor = factor;
        }
    const double c = problem.contact.restitution, other = c > 0.5 ? c - kRestitutions : c + kRestitutions;
    Variant& variant = all.emplace_back(Variant{fmt::format("restitution {:g}", other), problem});
    variant.problem.contact.restitution = other;
    return all;
}

// The value of largest magnitude, and its instant; nothing after `longest` seconds.
std::optional<Vec2> peak_of(const Problem& problem, Channel channel, double end_time, double longest,
                            const std::function<bool()>& goes_on) {
    Request request;
    request.end_time = end_time;
    request.extrema = {channel};
    const auto start = Clock::now();
    bool stopped = false;
    try {
        const Result result = simulate(problem, request, [&](double) {
            stopped = !goes_on();
            return !stopped && seconds_since(start) <= longest;
        });
        const Extremum& e = result.extrema.front();
        return std::fabs(e.min) > std::fabs(e.max) ? Vec2{e.t_min, e.min} : Vec2{e.t_max, e.max};
    } catch (const Interrupted&) {
        if (stopped) throw;
        return std::nullopt;
    }
}

void measure(PeakRow& row, const Variant& variant, const PeakBudget& budget, double longest,
             const std::function<bool()>& goes_on) {
    try {
        if (const auto found = peak_of(variant.problem, budget.channel, budget.end_time, longest, goes_on))
            row.peak = found->y, row.t = found->x;
        else
            row.note = fmt::format("left out: longer than {:g} s", longest);
    } catch (const SolverError& failure) {
        row.note = fmt::format("failed: {}", failure.what());
    } catch (const std::invalid_argument& rejected) {
        row.note = fmt::format("rejected: {}", rejected.what());
    }
}

// A comparison with more shapes, where it could be afforded, replaces that with half of them.
std::string advice(const PeakBudget& budget, int modes) {
    const bool has_more =
        std::ranges::any_of(budget.rows, [&](const PeakRow& row) { return row.peak && row.modes > modes; });
    const PeakRow* most = nullptr;
    for (const PeakRow& row : budget.rows) {
        if (!row.peak || (has_more && row.modes > 0 && row.modes < modes)) continue;
        const auto change = [&](const PeakRow& of) { return std::fabs(relative_change(budget, of)); };
        if (row.modes > 0 && change(row) > kUnsettled)
            return fmt::format("the largest {} changes by {:.0f} % with {}: it {}", name(budget.channel),
                               100 * change(row), row.change,
                               modes < kMaxModes
                                   ? "has not converged; use more modes, or a softer contact"
                                   : fmt::format("does not converge with {} modes, the most there are; use a softer "
                                                 "contact, or assess a stress",
                                                 kMaxModes));
        if (!most || change(row) > change(*most)) most = &row;
    }
    if (!most) return "no other run was possible";
    return fmt::format("the largest {} changes by {:.2g} % at most, with {}", name(budget.channel),
                       100 * std::fabs(relative_change(budget, *most)), most->change);
}

}  // namespace

double relative_change(const PeakBudget& budget, const PeakRow& row) {
    return row.peak && budget.peak != 0 ? (*row.peak - budget.peak) / std::fabs(budget.peak) : kNan;
}

PeakBudget peak_budget(const Problem& problem, Channel channel, double end_time, double longest,
                       const std::function<bool(double share)>& progress) {
    PeakBudget out;
    out.channel = channel;
    out.end_time = end_time;
    const std::vector<Variant> variants = variants_of(problem);
    double done = 0;
    const auto goes_on = [&] { return !progress || progress(done / static_cast<double>(1 + variants.size())); };
    const auto own = peak_of(problem, channel, end_time, std::numeric_limits<double>::infinity(), goes_on);
    if (!own || !std::isfinite(own->y)) throw std::invalid_argument(name(channel) + " has no values in this scene");
    out.t = own->x;
    out.peak = own->y;
    for (const Variant& variant : variants) {
        ++done;
        PeakRow& row = out.rows.emplace_back();
        row.change = variant.change;
        row.modes = variant.modes;
        measure(row, variant, out, longest, goes_on);
    }
    out.recommendation = advice(out, problem.beam.modes);
    return out;
}

}  // namespace beamcam::sim
