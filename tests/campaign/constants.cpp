// Perturbs each numerical constant of sim/, up and down, and compares motions, extrema, orbits and sweeps: results must
// not depend on it beyond what the tolerance allows.
//
//   campaign_constants [--verbose] [--twice] [NAME...]      --twice: by a factor of 2 instead of 1.1
//
// It is linked with a build of sim/ whose constants at namespace scope are variables (campaign/constants.py). The
// allowed change of a result is its change in a problem whose numbers differ by kPerturbation, times kReserve. Prints
// the constants that change a result by more, with --verbose also the others. The exit code is 1 if there are any.
#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "sim/orbit/exponents.hpp"
#include "sim/orbit/periodic_orbit.hpp"
#include "sim/problem/problem.hpp"
#include "sim/run/simulate.hpp"
#include "sim/sweep/sweep_point.hpp"
#include "tests/campaign/variable.hpp"
#include "tests/sim/orbit/pressed_beam.hpp"

namespace beamcam::sim::testing {
namespace {

constexpr double kRtol = 1e-9;
constexpr double kAtol = 1e-3 * kRtol;
constexpr double kPerturbation = 10 * kRtol;
constexpr double kReserve = 30;

// Constants that define a result and not only the way to compute it, with what they define.
const std::map<std::string, const char*> kDefinitions{
    {"kShapePlaces", "how many points of a natural mode are given"},
    {"kSummedShare", "which bounces are listed"},
    {"kChatterShare", "when chatter becomes lasting contact"},
    {"kReproducible", "what is reproducible"},
    {"kComparedRate", "the instants at which motions are compared"},
    {"kBriefAgreement", "which agreements are crossings"},
    {"kSettledShare", "which motions are settled"},
    {"kStrobePhase", "at which instants the states of a sweep are compared"},
};

// ---- results ---------------------------------------------------------------------------------------

using Results = std::vector<double>;

Problem machine(ModelKind model, int modes) {
    Problem p;
    p.beam.model = model;
    p.beam.modes = modes;
    p.cam->speed = 5;
    p.initial.angle = 0.5;
    p.solver.rtol = kRtol;
    p.solver.atol = kAtol;
    return p;
}

Results of_motion(const Problem& p, double end) {
    Request request;
    request.end_time = end;
    request.apexes = true;
    for (const Channel& channel : all_channels(p))
        if (channel.kind != ChannelKind::energy_residual) request.extrema.push_back(channel);
    TableRequest table;
    for (int i = 1; i <= 20; ++i) table.times.push_back(end * i / 20);
    table.channels = {{ChannelKind::theta}, {ChannelKind::tip_deflection}};
    request.tables.push_back(table);
    const Result r = simulate(p, request);
    Results out;
    for (const std::vector<double>& column : r.tables[0].values) out.insert(out.end(), column.begin(), column.end());
    for (const Extremum& e : r.extrema) out.insert(out.end(), {e.min, e.max});
    // Only the first ones: the number of the last bounces of chatter depends on rounding.
    for (std::size_t i = 0; i < std::min<std::size_t>(6, r.impacts.size()); ++i)
        out.insert(out.end(), {r.impacts[i].t_start, r.impacts[i].impulse_n, r.impacts[i].energy_lost,
                               r.impacts[i].force_peak.value_or(0)});
    for (std::size_t i = 0; i < std::min<std::size_t>(6, r.apexes.size()); ++i)
        out.insert(out.end(), {r.apexes[i].t, r.apexes[i].theta});
    return out;
}

Results of_orbits(const Problem& p) {
    OrbitRequest request;
    request.transient = 5;
    Results out;
    for (const PeriodicOrbit& orbit : find_orbits(p, request)) {
        out.insert(out.end(), {orbit.period, orbit.initial.angle, orbit.initial.angular_velocity});
        for (const std::complex<double>& mu : orbit.multipliers) out.push_back(std::abs(mu));
        break;  // only the orbit to which the motion tends
    }
    return out;
}

Results of_sweep(const Problem& p, double turns) {
    Sampling sampling;
    sampling.transient.turns = turns;
    sampling.keep.turns = 24;
    const SweepPoint point = sweep_point(p, sampling, nullptr, {});
    Results out{static_cast<double>(point.attractor.kind), static_cast<double>(point.attractor.period)};
    for (std::size_t i = 0; i < std::min<std::size_t>(4, point.motion.samples.size()); ++i)
        out.insert(out.end(), {point.motion.samples[i][kTheta], point.motion.samples[i][kNormalBefore]});
    return out;
}

struct Case {
    const char* name;
    Problem problem;
    std::function<Results(const Problem&)> results;
};

std::vector<Case> cases() {
    std::vector<Case> all;
    const auto motion = [&](const char* name, Problem p, double end) -> Problem& {
        all.push_back({name, std::move(p), [end](const Problem& at) { return of_motion(at, end); }});
        return all.back().problem;
    };
    using enum ModelKind;
    motion("two modes", machine(first_order, 2), 0.4);
    motion("eight modes", machine(first_order, 8), 0.32);
    motion("exact", machine(exact, 2), 0.32);
    motion("second order", machine(second_order, 2), 0.32);
    motion("rigid", machine(rigid, 2), 0.6);
    motion("Runge-Kutta", machine(first_order, 2), 0.32).solver.method = Method::rk8;
    Problem& clamped = motion("clamped, damped", machine(first_order, 3), 0.32);
    clamped.beam.basis = Basis::cantilever;
    clamped.hub.inertia = 0.05;
    clamped.beam.kelvin_voigt = 1e-4;
    motion("beyond critical damping", machine(first_order, 2), 0.32).beam.damping_ratio = {1.5};
    motion("stiff damping", machine(second_order, 2), 0.3).beam.damping_ratio = {30};
    motion("friction", machine(first_order, 2), 0.32).contact.friction = CoulombFriction{0.3, 0.01};
    Problem& resting = motion("resting", machine(first_order, 3), 0.3);
    resting.initial.shape = InitialShape::resting;
    resting.cam->speed = 1;
    Problem& bounces = motion("bounces", machine(rigid, 2), 1.2);
    bounces.contact.model = ContactModel::restitution;
    bounces.contact.restitution = 0.5;
    bounces.cam->speed = 0;
    Problem& held = motion("held by restitution", machine(first_order, 8), 0.3);
    held.contact.model = ContactModel::restitution;
    held.contact.restitution = 0.3;
    held.initial.shape = InitialShape::resting;
    held.cam->speed = 1;
    motion("held, with friction", held, 0.3).contact.friction = CoulombFriction{0.3, 0.01};
    motion("bristles", machine(first_order, 4), 0.32).contact.friction = StickSlipFriction{};
    motion("Hertz", machine(exact, 2), 0.32).contact.stiffness.reset();
    motion("prescribed hub", machine(exact, 3), 0.5).hub.drive = SpinUp{6, 0.2};
    motion("prescribed hub, second order", machine(second_order, 4), 0.5).hub.drive = SpinUp{6, 0.2};
    Problem& soft_beam = motion("soft beam", machine(second_order, 4), 0.5);
    soft_beam.beam.youngs_modulus /= 100;
    soft_beam.hub.drive = SpinUp{3, 0.4};
    const Problem pressed = PressedBeam().problem(45);
    all.push_back({"orbit", pressed, of_orbits});
    all.push_back({"sweep", pressed, [](const Problem& at) { return of_sweep(at, 60); }});
    Problem soft = PressedBeam().problem(45);
    soft.contact.model = ContactModel::compliant;
    soft.solver.method = Method::automatic;
    all.push_back({"sweep, compliant", soft, [](const Problem& at) { return of_sweep(at, 20); }});
    return all;
}

Problem perturbed(Problem p) {
    p.initial.angle *= 1 + kPerturbation;
    p.beam.length *= 1 - kPerturbation;
    p.contact.stiffness = contact_stiffness(p) * (1 + kPerturbation);
    if (p.cam) p.cam->speed *= 1 + kPerturbation;
    return p;
}

// ---- comparison ------------------------------------------------------------------------------------

// The largest change of a result, in units of the allowed change.
double change(const Results& before, const Results& after, const Results& allowed) {
    if (before.size() != after.size()) return std::numeric_limits<double>::infinity();
    double most = 0;
    for (std::size_t i = 0; i < before.size(); ++i)
        if (before[i] != after[i] && !(std::isnan(before[i]) && std::isnan(after[i]))) {
            const double share = std::fabs(after[i] - before[i]) / allowed[i];
            if (!(share <= most)) most = share;
        }
    return most;
}

Results allowed(const Results& before, const Results& shifted) {
    Results out;
    for (std::size_t i = 0; i < before.size(); ++i) {
        const double moved = i < shifted.size() ? std::fabs(shifted[i] - before[i]) : 0;
        out.push_back(kReserve * (moved + kRtol * std::fabs(before[i]) + kAtol));
    }
    return out;
}

template <class T>
T moved(T value, double factor, bool up) {
    if constexpr (std::is_floating_point_v<T>) return up ? value * factor : value / factor;
    const T by = std::max<T>(1, static_cast<T>(std::abs(static_cast<double>(value)) * (1 - 1 / factor)));
    return up ? value + by : value - by;
}

}  // namespace
}  // namespace beamcam::sim::testing

int main(int argc, char** argv) {
    using namespace beamcam::sim::testing;
    bool verbose = false;
    double factor = 1.1;  // of a constant; a whole number changes by one at least
    std::vector<std::string> names;
    for (int i = 1; i < argc; ++i)
        if (std::strcmp(argv[i], "--verbose") == 0)
            verbose = true;
        else if (std::strcmp(argv[i], "--twice") == 0)
            factor = 2;
        else
            names.emplace_back(argv[i]);
    const std::vector<Case> all = cases();
    std::vector<Results> before, limits;
    for (const Case& c : all) {
        before.push_back(c.results(c.problem));
        limits.push_back(allowed(before.back(), c.results(perturbed(c.problem))));
        if (verbose) fmt::print("{}: {} results\n", c.name, before.back().size());
    }
    int depends = 0, idle = 0, count = 0;
    for (const beamcam::sim::Constant& constant : beamcam::sim::all_constants()) {
        if (kDefinitions.contains(constant.name)) continue;
        if (!names.empty() && std::find(names.begin(), names.end(), constant.name) == names.end()) continue;
        ++count;
        double most = 0;
        const char* where = "";
        for (const bool up : {true, false}) {
            std::visit(
                [&](auto* value) {
                    const auto kept = *value;
                    *value = moved(kept, factor, up);
                    for (std::size_t i = 0; i < all.size(); ++i) {
                        double changed = std::numeric_limits<double>::infinity();
                        try {
                            changed = change(before[i], all[i].results(all[i].problem), limits[i]);
                        } catch (const std::exception& failure) {
                            fmt::print("{} {}: {}\n", constant.name, all[i].name, failure.what());
                        }
                        if (!(changed <= most)) most = changed, where = all[i].name;
                    }
                    *value = kept;
                },
                constant.value);
        }
        if (most == 0) ++idle;
        if (most > 1) ++depends;
        if (most > 1 || verbose)
            fmt::print("{:<32} {:<24} {:8.2g} {} {}\n", constant.file, constant.name, most, where,
                       most > 1 ? "DEPENDS" : "");
    }
    fmt::print("{} constants perturbed by {:g}: results depend on {}, none of the cases feels {}\n", count, factor,
               depends, idle);
    return depends > 0 ? 1 : 0;
}
