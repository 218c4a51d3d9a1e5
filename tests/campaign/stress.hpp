// Extreme problems: single hard cases and random mixtures of all keys. Each must finish or be rejected with a clear
// message.
//
// A case fails unless: only exceptions of simulate.hpp occur, all recorded numbers are finite, the energy balance
// closes or is reported as open, no energy is gained on a cam at rest, and a failed run has partial results.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "sim/observe/channels.hpp"
#include "sim/problem/problem.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::sim::stress {

using std::numbers::pi;

inline constexpr double kUsualEnd = 0.06;       // [s] of a usual case: fall, strike, bounce
inline constexpr double kFirstBending = 816.9;  // [rad/s] of the free default beam

// The angle of a straight beam that touches the cam.
inline double touching_angle(const Problem& p) {
    const Vec2 disc = disc_centre(*p.cam, 0);
    return std::atan2(disc.y, disc.x) + std::asin(std::min(1.0, (p.cam->radius + contact_offset(p)) / norm(disc)));
}
inline void approach(Problem& p, double lead = 0.03, double speed = -2) {
    p.initial.angle = touching_angle(p) + lead;
    p.initial.angular_velocity = speed;
}
// The default system, with the beam 0.03 rad above the cam and approaching it.
inline Problem base() {
    Problem p;
    approach(p);
    return p;
}

struct StressCase {
    std::string title;
    Problem problem;
    double end = kUsualEnd;  // [s]
};

// The budget of steps of a case. The cost of a step differs a thousandfold between models.
inline int budget(const Problem& p) {
    const double n = p.beam.modes;
    switch (p.beam.model) {
        case ModelKind::rigid:
            return 100000;
        case ModelKind::zeroth_order:
        case ModelKind::first_order:
        case ModelKind::paper:
            return static_cast<int>(std::max(8000.0, 50000 / (1 + n * n / 50)));
        case ModelKind::second_order:
        case ModelKind::exact:
            return static_cast<int>(std::max(2000.0, 30000 / (1 + n * n / 4)));
    }
    return 0;
}

// ---- single hard cases -------------------------------------------------------------------------------

inline void long_runs(std::vector<StressCase>& out, bool full) {
    {
        Problem p;  // the default scene for ten minutes
        p.beam.model = ModelKind::rigid;
        p.contact.restitution = 1;
        out.push_back({"ten minutes, elastic", p, full ? 600.0 : 60.0});
        p.beam.model = ModelKind::first_order;
        p.contact.restitution = 0.7;
        out.push_back({"ten minutes", p, full ? 600.0 : 10.0});
    }
    {
        Problem p;  // ten thousand impacts and more
        p.beam.model = ModelKind::rigid;
        p.contact.restitution = 1;
        p.contact.damping = DampingLaw::none;
        p.cam->speed = 0;
        p.initial.angle = touching_angle(p) + 0.005;
        out.push_back({"10⁴ elastic impacts", p, full ? 1000.0 : 20.0});
        p.contact.model = ContactModel::restitution;
        out.push_back({"10⁴ impulses", p, full ? 1000.0 : 20.0});
        p.contact.restitution = 0.999;
        out.push_back({"chatter of many impulses", p, full ? 300.0 : 20.0});
    }
    {
        Problem p;  // 10⁵ periods of the first bending mode, undamped, in free flight
        p.cam.reset();
        p.gravity = 0;
        p.initial.angular_velocity = 1;
        p.hub.drive = TorqueTable{{0, 0.005, 0.01, 0.011}, {0, 5, 0, 0}};
        out.push_back({"10⁵ periods of free vibration", p, full ? 1e5 * 2 * pi / kFirstBending : 10});
    }
}

inline void chatter_and_resonance(std::vector<StressCase>& out) {
    for (const ImpactLaw law : {ImpactLaw::newton, ImpactLaw::poisson, ImpactLaw::stronge}) {
        Problem p = base();
        p.contact.model = ContactModel::restitution;
        p.contact.law = law;
        p.contact.restitution = 0.5;
        p.beam.modes = 6;
        p.cam->speed = 3;
        out.push_back({fmt::format("chatter to rest, {}", name(law)), p, 2});
    }
    {
        Problem p = base();
        p.cam->speed = kFirstBending;
        p.cam->eccentricity = 1e-3;
        approach(p);
        out.push_back({"cam at the bending frequency", p, 0.3});
        p.hub.drive = HarmonicTorque{2, kFirstBending / (2 * pi), 0};
        p.cam.reset();
        out.push_back({"torque at the bending frequency", p, 2});
    }
}

inline void slender_beams_and_needles(std::vector<StressCase>& out) {
    {
        Problem p = base();  // a hair that curls
        p.beam.second_moment = 1e-13;
        p.beam.area = 1e-6;
        p.beam.model = ModelKind::exact;
        p.beam.modes = 8;
        out.push_back({"hair over the cam", p, 0.3});
        p.hub.drive = ConstantSpeed{-6};
        out.push_back({"hair pulled over the cam", p, 0.3});
    }
    {
        Problem p = base();  // a very small cam
        p.cam->radius = 1e-6;
        p.cam->eccentricity = 0;
        p.cam->speed = 0;
        approach(p);
        out.push_back({"needle of a micrometre", p});
        p.contact.stiffness = 1e12;
        out.push_back({"hard needle of a micrometre", p});
        p.gravity = 0;
        p.initial.angular_velocity = -1e-9;
        p.initial.angle = touching_angle(p) + 1e-9;
        out.push_back({"touch at a nanometre a second", p, 3});
    }
}

inline void loads_and_models(std::vector<StressCase>& out) {
    {
        Problem p = base();
        p.beam.damping_ratio = {50};
        out.push_back({"overdamped fifty times", p});
        p.beam.damping_ratio.clear();
        p.beam.kelvin_voigt = 1;
        out.push_back({"Kelvin–Voigt of a second", p});
        p.beam.kelvin_voigt.reset();
        p.gravity = 1e6;
        out.push_back({"gravity 1e6 m/s²", p, 0.01});
        p.gravity = -9.81;
        out.push_back({"gravity upwards", p});
        p.gravity = 0;
        p.initial.angular_velocity = 0;
        out.push_back({"nothing moves", p});
    }
    for (const auto& model : names(ModelKind{})) {
        Problem p = base();
        p.beam.model = model.value;
        out.push_back({fmt::format("one second, {}", model.name), p, model.value == ModelKind::exact ? 0.2 : 1});
        p.beam.youngs_modulus = 1e8;
        out.push_back({fmt::format("soft beam, {}", model.name), p, 0.2});
    }
}

// `full`: for minutes of motion, otherwise for seconds.
inline std::vector<StressCase> single_cases(bool full) {
    std::vector<StressCase> all;
    long_runs(all, full);
    chatter_and_resonance(all);
    slender_beams_and_needles(all);
    loads_and_models(all);
    return all;
}

// ---- random mixtures -----------------------------------------------------------------------------------

class Dice {
  public:
    explicit Dice(unsigned seed) : engine_(seed) {}
    double share() { return static_cast<double>(engine_()) / 4294967296.0; }
    double between(double low, double high) { return low + (high - low) * share(); }
    double decades(double low, double high) { return std::pow(10, between(low, high)); }
    int below(int count) { return static_cast<int>(share() * count); }
    bool one_in(int n) { return below(n) == 0; }
    template <class Enum>
    Enum one_of(std::span<const Named<Enum>> all) {
        return all[static_cast<std::size_t>(below(static_cast<int>(all.size())))].value;
    }

  private:
    std::mt19937 engine_;
};

inline Problem mixture_of(Dice& dice) {
    Problem p;
    p.beam.model = dice.one_of(names(ModelKind{}));
    const bool costly = p.beam.model == ModelKind::exact || p.beam.model == ModelKind::second_order;
    p.beam.modes = 1 + dice.below(costly ? 8 : dice.one_in(4) ? 40 : 10);
    p.beam.basis = dice.one_of(names(Basis{}));
    p.beam.youngs_modulus = dice.decades(8, 12);
    if (dice.one_in(3)) p.beam.damping_ratio = {dice.decades(-4, 1)};
    p.hub.radius = dice.one_in(2) ? 0 : dice.between(-0.2, 0.5);
    p.hub.inertia = dice.one_in(2) ? 0 : dice.decades(-9, 6);
    p.cam->radius = dice.decades(-4, -0.8);
    p.cam->eccentricity = dice.one_in(4) ? 0 : p.cam->radius * dice.share();
    const double nearest = p.cam->radius + p.cam->eccentricity;
    p.cam->centre = {dice.between(nearest, std::max(1.1 * nearest, 1 + p.hub.radius + nearest)),
                     dice.between(-0.1, 0.1)};
    p.cam->phase = dice.between(-pi, pi);
    p.cam->speed = dice.one_in(3) ? 0 : (dice.one_in(2) ? 1 : -1) * dice.decades(-2, 3);
    p.contact.model = dice.one_in(3) ? ContactModel::restitution : ContactModel::compliant;
    p.contact.law = dice.one_of(names(ImpactLaw{}));
    p.contact.stiffness = dice.decades(4, 12);
    p.contact.exponent = dice.between(1, 2);
    p.contact.damping = dice.one_of(names(DampingLaw{}));
    p.contact.restitution = dice.share();
    if (dice.one_in(3)) p.contact.friction = CoulombFriction{dice.between(0, 5), dice.decades(-6, 0)};
    if (dice.one_in(3)) p.contact.friction = StickSlipFriction{dice.between(0, 2), {}, dice.decades(2, 9)};
    if (dice.one_in(3)) p.contact.offset = dice.decades(-4, -1.3);
    p.gravity = dice.one_in(5) ? 0 : dice.decades(-1, 2);
    p.solver.rtol = dice.decades(-12, -2);
    p.solver.atol = 1e-3 * p.solver.rtol;
    approach(p, dice.decades(-9, -1), -dice.decades(-3, 1));
    if (dice.one_in(8)) p.initial.shape = InitialShape::resting;
    if (dice.one_in(8)) p.hub.drive = ConstantTorque{dice.between(-10, 10)};
    if (dice.one_in(8)) p.hub.drive = ConstantSpeed{dice.between(-10, 10)};
    return p;
}

inline StressCase mixture(unsigned seed) {
    Dice dice(seed);
    StressCase one{fmt::format("mixture {}", seed), mixture_of(dice)};
    one.problem.solver.max_steps = budget(one.problem);
    return one;
}

// ---- running a case ------------------------------------------------------------------------------------

inline constexpr double kCaseLimit = 120;  // [s] of CPU time: a case that takes longer hangs
inline constexpr int kChannelSamples = 7;  // instants at which all channels are checked

enum class Outcome {
    closed,   // finished; the energy balance closes within ten times rtol of the energy scale
    open,     // finished, and reported that the energy balance does not close so well
    refused,  // rejected by `validate`
    stopped,  // SolverError with last good time, cause and remedy
    failed    // anything else
};

struct StressResult {
    Outcome outcome = Outcome::failed;
    std::string message;  // the first warning, validation error or failure
    double closure = 0;   // largest residual of the energy balance over rtol × energy scale; NaN if not finished
    double steps_per_second = 0;  // steps per simulated second
};

inline bool passive(const Problem& p) {
    return std::holds_alternative<FreeDrive>(p.hub.drive) && (!p.cam || p.cam->speed == 0) &&
           p.beam.model != ModelKind::paper;
}

// CPU time of this thread, which does not depend on the load of the machine.
inline double processor_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// The first error in the recorded results; empty if there is none.
inline std::string first_error(const StressCase& one, const Result& r, const Request& request) {
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

inline void record(const StressCase& one, const Result& r, const Request& request, StressResult& out) {
    const auto steps = static_cast<double>(r.counters.steps + r.counters.rejected);
    out.steps_per_second = r.end_time > 0 ? steps / r.end_time : 0;
    out.message = first_error(one, r, request);
}

// Runs one case without exceptions.
inline StressResult run_case(const StressCase& one) {
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
            r.warnings, [](const std::string& w) { return w.find("energy balance") != std::string::npos; });
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

}  // namespace beamcam::sim::stress
