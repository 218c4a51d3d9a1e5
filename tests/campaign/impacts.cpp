// Compares random contacts impact by impact between `auto`, `rk8` and `cvode-adams`, which share only the equations.
//
//   campaign_impacts [--count N] [--seed N] [--range usual|brief] [--seconds S] [--verbose]
//
// Scene N of a range is the same on every machine. An impact is compared as long as the motion is reproducible: a run
// by rk8 of a problem whose numbers differ by kPerturbation must have the same impacts. The effect of that
// perturbation, times kReserve, is the largest allowed difference between two methods at rtol 1e-11. `--seed N --count
// 1 --verbose` prints one scene and its impacts. The exit code is 1 if methods disagree.
#include <fmt/format.h>

#include <cstdlib>
#include <cstring>
#include <ctime>
#include <map>

#include "scenes/scene/scene.hpp"
#include "sim/run/simulate.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

constexpr double kRtol = 1e-11;
constexpr double kPerturbation = 10 * kRtol;  // of every number
// Local errors of all steps add up; those of Adams's method, with its variable order, add up to more.
constexpr double kReserve = 10, kReserveOfAdams = 300;
// Smallest allowed differences: times [s]; speeds [m/s] and impulses relative to the momentum.
constexpr double kLeastTime = 1e-11, kLeastShare = 1e-9;
constexpr double kLost = 1e-5;  // [s] A motion whose impacts move by more is not judged.

// ---- scenes ----------------------------------------------------------------------------------------

Drive random_drive(Dice& dice) {
    switch (dice.one_of(6)) {
        case 0:
            return ConstantTorque{dice.about_zero(1)};
        case 1:
            return HarmonicTorque{dice.between(0, 3), dice.between(0, 8), dice.between(0, 6)};
        case 2:
            return TorqueTable{{0, 0.1, 0.15}, {dice.about_zero(2), dice.about_zero(2), 0}};
        case 3:
            return ConstantSpeed{dice.between(-2.5, -1)};
        case 4:
            return SpinUp{dice.between(-5, -1), dice.between(0.1, 0.5)};
        default:
            return AngleTable{{0, 0.2, 0.35, 0.5}, {1, dice.between(0.2, 0.6), dice.between(0.3, 0.8), 0.4}};
    }
}

struct Scene {
    Problem problem;
    double end = 0.5;
};

// All models, drives, contact laws and starts.
Scene usual(unsigned seed) {
    Dice dice(seed + 7919);
    for (unsigned tries = 0;; ++tries) {
        Problem p = random_contact(seed + 100000 * tries);
        const int model = dice.one_of(10);
        if (model == 0) p.beam.model = ModelKind::rigid;
        if (model == 1) p.beam.model = ModelKind::second_order;
        if (model == 2) p.beam.model = ModelKind::exact;
        if (model == 3) p.beam.model = ModelKind::paper;
        if (model >= 1 && model <= 2) p.beam.modes = 1 + p.beam.modes / 3;
        if (dice.one_of(3) == 0) p.hub.drive = random_drive(dice);
        if (dice.one_of(4) == 0) p.beam.basis = Basis::cantilever;
        if (dice.one_of(5) == 0) p.contact.model = ContactModel::restitution;
        p.contact.law = static_cast<ImpactLaw>(dice.one_of(3));
        if (dice.one_of(6) == 0) p.initial.shape = InitialShape::static_equilibrium;
        if (dice.one_of(12) == 0) p.initial.shape = InitialShape::resting;
        if (dice.one_of(6) == 0) p.gravity = dice.about_zero(20);
        if (is_plain(p) || p.beam.model == ModelKind::paper) {
            bool sound = true;
            for (const Issue& finding : validate(p)) sound = sound && !finding.fatal;
            if (sound) return {p, 0.5};
        }
    }
}

// Events shorter than any step: contacts that barely close or open, forces that are clamped for a short time, many
// modes, long contacts, hubs that press the beam on the cam.
Scene brief(unsigned seed) {
    Dice dice(seed + 104729);
    for (unsigned tries = 0;; ++tries) {
        Problem p = random_contact(seed + 50000 + 100000 * tries);
        switch (dice.one_of(6)) {
            case 0:  // separations within a contact: a soft beam, many modes
                p.beam.modes = 4 + dice.one_of(8);
                p.beam.youngs_modulus = std::pow(10, dice.between(9.5, 10.3));
                p.contact.exponent = dice.one_of(2) ? 1 : 1.5;
                break;
            case 1:  // the law would pull: strong dissipation in a soft contact
                p.contact.stiffness = std::pow(10, dice.between(3.5, 6));
                p.contact.restitution = dice.between(0.05, 0.3);
                p.contact.damping = dice.one_of(names(DampingLaw{}).subspan(1));  // not `none`
                break;
            case 2:  // grazing touches: a slow cam swings up to a light beam
                p.gravity = dice.between(0, 1);
                p.cam->eccentricity = dice.between(0.01, 0.04);
                p.cam->speed = dice.about_zero(40);
                break;
            case 3:  // pressed on by the hub: long contacts
                p.hub.drive = ConstantTorque{-dice.between(1, 15)};
                p.contact.stiffness = std::pow(10, dice.between(3, 6));
                break;
            case 4:  // a hub-driven rod
                p.beam.model = dice.one_of(2) ? ModelKind::rigid : ModelKind::zeroth_order;
                p.beam.modes = 1;
                p.hub.inertia = std::pow(10, dice.between(-2, 1));
                p.hub.drive = HarmonicTorque{dice.between(0.5, 20), dice.between(1, 20), dice.between(0, 6)};
                p.gravity = dice.about_zero(10);
                break;
            default:  // a resting start
                p.initial.shape = InitialShape::resting;
                p.contact.stiffness = std::pow(10, dice.between(3.5, 8));
                p.cam->speed = dice.about_zero(30);
                break;
        }
        if (p.initial.shape != InitialShape::resting) p.initial.angular_velocity = dice.between(-4, -1.5);
        if (is_plain(p)) return {p, 0.45};
    }
}

// The problem with slightly different numbers.
Problem perturbed(Problem p) {
    const double s = kPerturbation;
    p.initial.angle += s;
    p.initial.angular_velocity += s;
    p.gravity *= 1 + s;
    p.cam->centre.y += s * p.beam.length;
    p.cam->phase -= s;
    p.cam->speed *= 1 + s;
    if (p.contact.stiffness) *p.contact.stiffness *= 1 + s;
    p.contact.restitution *= 1 - s;
    return p;
}

// ---- runs ------------------------------------------------------------------------------------------

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Motion {
    std::vector<Impact> impacts;
    std::string stopped;  // why it did not reach the end
    double seconds = 0;
};

Motion solve(Problem p, double end, Method method, double patience, double rtol = kRtol) {
    p.solver = {method, rtol, 1e-3 * rtol, 2'000'000'000};
    Motion motion;
    const double start = cpu_seconds();
    Request request;
    request.end_time = end;
    try {
        motion.impacts = simulate(p, request, [&](double) { return cpu_seconds() - start < patience; }).impacts;
    } catch (const Interrupted&) {
        motion.stopped = fmt::format("{} takes more than {:g} s", name(method), patience);
    } catch (const SolverError& error) {
        motion.stopped = fmt::format("{}: {}", name(method), error.what());
        if (!error.partials.empty()) motion.impacts = error.partials.front().impacts;
    }
    motion.seconds = cpu_seconds() - start;
    // A threshold of their duration decides which of the slowest bounces are listed and which are summed up.
    std::erase_if(motion.impacts, [&](const Impact& i) {
        return i.v_n_before < 0 && i.v_n_before > -0.1 * p.contact.approach_floor.value &&
               p.contact.model == ContactModel::restitution;
    });
    return motion;
}

// ---- comparison ------------------------------------------------------------------------------------

// The differences of one impact between two runs.
struct Difference {
    double time = 0, speed = 0, impulse = 0;
    void widen(const Difference& d) {
        time = std::max(time, d.time);
        speed = std::max(speed, d.speed);
        impulse = std::max(impulse, d.impulse);
    }
};
Difference between(const Impact& a, const Impact& b) {
    Difference d{std::fabs(a.t_start - b.t_start), std::fabs(a.v_n_before - b.v_n_before), 0};
    if (!a.t_end || !b.t_end) return d;
    d.time = std::max(d.time, std::fabs(*a.t_end - *b.t_end));
    d.speed = std::max(d.speed, std::fabs(*a.v_n_after - *b.v_n_after));
    d.impulse = std::fabs(a.impulse_n - b.impulse_n);
    return d;
}

// The allowed differences at each impact, as long as the motion is reproducible.
struct Judged {
    std::vector<Difference> growth;
    bool to_the_end = false;
    std::string lost;  // why not
};
Judged judged(const Motion& plain, const Motion& other) {
    Judged out;
    const std::size_t both = std::min(plain.impacts.size(), other.impacts.size());
    Difference all;
    for (std::size_t i = 0; i < both; ++i) {
        const Impact &a = plain.impacts[i], &b = other.impacts[i];
        const Difference d = between(a, b);
        if (!(d.time * kReserve < kLost) || a.t_end.has_value() != b.t_end.has_value()) {
            out.lost = "not reproducible";
            return out;
        }
        all.widen(d);
        out.growth.push_back(all);
    }
    out.to_the_end = plain.stopped.empty() && other.stopped.empty() && plain.impacts.size() == other.impacts.size();
    if (!plain.stopped.empty())
        out.lost = plain.stopped;
    else if (!out.to_the_end)
        out.lost = other.stopped.empty() ? "not reproducible" : other.stopped;
    return out;
}

// The disagreement of two methods; empty if there is none.
std::string disagreement(const Problem& p, const Judged& limits, const Motion& a, const Motion& b, double reserve) {
    const double momentum = p.beam.line_density() * p.beam.length;
    for (std::size_t i = 0; i < limits.growth.size(); ++i) {
        const Difference& g = limits.growth[i];
        if (i >= a.impacts.size()) return fmt::format("impact {} is missing", i + 1);
        const Impact& reference = b.impacts[i];
        const Difference d = between(a.impacts[i], reference);
        const double speed = 1 + std::fabs(reference.v_n_before);
        if (a.impacts[i].t_end.has_value() != reference.t_end.has_value())
            return fmt::format("impact {} ends in one run only", i + 1);
        const double share = kLeastShare * speed * reserve / kReserve, time = kLeastTime * reserve / kReserve;
        const auto tell = [&](const char* what, double by, double limit) {
            return fmt::format("impact {}: {} by {:.1e}, limit {:.1e}", i + 1, what, by, limit);
        };
        if (d.time > time + reserve * g.time) return tell("time", d.time, time + reserve * g.time);
        if (d.speed > share + reserve * g.speed) return tell("speed", d.speed, share + reserve * g.speed);
        if (d.impulse > share * momentum + reserve * g.impulse)
            return tell("impulse", d.impulse, share * momentum + reserve * g.impulse);
    }
    if (limits.to_the_end && a.impacts.size() != b.impacts.size() && a.stopped.empty())
        return fmt::format("{} impacts instead of {}", a.impacts.size(), b.impacts.size());
    return {};
}

struct Options {
    unsigned count = 300, seed = 1;
    std::string range = "usual";
    double seconds = 10;
    bool verbose = false;
};

void print_impacts(const char* title, const Motion& motion) {
    fmt::print("  {} ({} impacts, {:.2f} s) {}\n", title, motion.impacts.size(), motion.seconds, motion.stopped);
    for (const Impact& i : motion.impacts)
        fmt::print("    {:.13f} {:.13f}  v {:+.11e} {:+.11e}  J {:.11e}\n", i.t_start, i.t_end.value_or(0),
                   i.v_n_before, i.v_n_after.value_or(0), i.impulse_n);
}

struct Total {
    long scenes = 0, impacts = 0, agreed = 0, late = 0, disagreed = 0;
    std::map<std::string, long> not_judged;
};

void compare(const Options& options, unsigned seed, Total& total) {
    const auto [problem, end] = options.range == "brief" ? brief(seed) : usual(seed);
    const auto run = [&](Method method) { return solve(problem, end, method, options.seconds); };
    const Motion fast = run(Method::automatic), rk8 = run(Method::rk8);
    const Motion other = solve(perturbed(problem), end, Method::rk8, options.seconds);
    const Motion adams = run(Method::cvode_adams);
    const Judged limits = judged(rk8, other);
    if (options.verbose) {
        scenes::Scene scene;
        scene.problem = problem;
        scene.end_time = end;
        fmt::print("{}\n", scenes::to_json(scene));
        print_impacts("auto", fast);
        print_impacts("rk8", rk8);
        print_impacts("rk8, perturbed", other);
        print_impacts("cvode-adams", adams);
    }
    ++total.scenes;
    total.impacts += static_cast<long>(limits.growth.size());
    if (!limits.lost.empty()) ++total.not_judged[limits.lost];
    const Beam& beam = problem.beam;
    const std::string place =
        fmt::format("{} {} {} {}", seed, name(beam.model), name(problem.contact.model), beam.modes);
    const std::string command = fmt::format("--range {} --seed {} --count 1 --verbose", options.range, seed);
    bool agreed = true, late = false;
    const auto judge = [&](Method method, const Motion& motion, double reserve) {
        if (!motion.stopped.empty() && limits.to_the_end) ++total.not_judged[motion.stopped];
        const auto compared = [&](const Motion& with, const Motion& reference) {
            Judged part = limits;
            if (!with.stopped.empty()) part.growth.resize(std::min(part.growth.size(), with.impacts.size()));
            return disagreement(problem, part, with, reference, reserve);
        };
        const std::string found = compared(motion, rk8);
        if (found.empty()) return;
        const auto tighter = [&](Method by) { return solve(problem, end, by, 10 * options.seconds, 0.1 * kRtol); };
        const std::string still = compared(tighter(method), tighter(Method::rk8));
        (still.empty() ? late : agreed) = still.empty();
        fmt::print("{}: {} differs from rk8: {}; at rtol {:g}: {}   [{}]\n", place, name(method), found, 0.1 * kRtol,
                   still.empty() ? "agrees" : still, command);
    };
    judge(Method::automatic, fast, kReserve);
    judge(Method::cvode_adams, adams, kReserveOfAdams);
    ++(!agreed ? total.disagreed : late ? total.late : total.agreed);
    std::fflush(stdout);
}

int campaign(int count, char** words) {
    Options options;
    for (int i = 1; i < count; ++i) {
        const std::string word = words[i];
        if (word == "--verbose") {
            options.verbose = true;
            continue;
        }
        if (i + 1 == count) return 2;
        const char* value = words[++i];
        if (word == "--count")
            options.count = static_cast<unsigned>(std::atoi(value));
        else if (word == "--seed")
            options.seed = static_cast<unsigned>(std::atoi(value));
        else if (word == "--range")
            options.range = value;
        else if (word == "--seconds")
            options.seconds = std::atof(value);
        else
            return 2;
    }
    Total total;
    for (unsigned seed = options.seed; seed < options.seed + options.count; ++seed) compare(options, seed, total);
    fmt::print(
        "\nrange {}, seeds {} to {}\n{:6} scenes\n{:6} impacts judged\n{:6} scenes agreed\n{:6} agreed at a tenth of "
        "the tolerance only\n{:6} disagreed\n",
        options.range, options.seed, options.seed + options.count - 1, total.scenes, total.impacts, total.agreed,
        total.late, total.disagreed);
    for (const auto& [why, times] : total.not_judged) fmt::print("{:6} not judged to the end: {}\n", times, why);
    return total.disagreed > 0;
}

}  // namespace
}  // namespace beamcam::sim::testing

int main(int count, char** words) {
    try {
        return beamcam::sim::testing::campaign(count, words);
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 2;
    }
}
