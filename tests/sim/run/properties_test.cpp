// Properties that hold for every valid problem, tested with random ones: a few dozen in the quick run, hundreds in the
// long one. A problem is drawn from a list of numbers in [0, 1); a list that fails is shrunk, number by number towards
// 0 (the simplest choice), before it is reported.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

#include "sim/dynamics/initial.hpp"
#include "sim/integrate/integrator.hpp"
#include "sim/integrate/modal_form.hpp"
#include "sim/problem/problem.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

using Draws = std::vector<double>;
constexpr std::size_t kDraws = 32;

// Reads a list of draws in order; 0 is the value of the default system, or close to it.
class Reader {
  public:
    explicit Reader(const Draws& draws) : draws_(draws) {}
    double share() { return next_ < draws_.size() ? draws_[next_++] : 0; }
    double between(double low, double high) { return low + (high - low) * share(); }
    double decades(double low, double high) { return std::pow(10, between(low, high)); }
    int below(int count) { return std::min(count - 1, static_cast<int>(share() * count)); }
    template <class T>
    T one_of(std::span<const Named<T>> all) {
        return all[static_cast<std::size_t>(below(static_cast<int>(all.size())))].value;
    }

  private:
    const Draws& draws_;
    std::size_t next_ = 0;
};

Problem drawn(const Draws& draws) {
    Reader r(draws);
    Problem p;
    p.beam.model = std::array{ModelKind::first_order, ModelKind::rigid, ModelKind::zeroth_order,
                              ModelKind::second_order}[static_cast<std::size_t>(r.below(4))];
    p.beam.modes = 1 + r.below(4);
    p.cam->speed = r.below(2) ? r.between(-10, 10) : 0;
    p.cam->eccentricity = r.between(0, 0.03);
    p.cam->phase = r.between(0, 6.28);
    p.cam->radius = r.between(0.1, 0.05);
    p.cam->centre = {r.between(0.25, 0.9), r.between(0, 0.05)};
    p.hub.radius = r.below(2) ? r.between(-0.1, 0.2) : 0;
    p.hub.inertia = r.below(2) ? r.between(0, 0.05) : 0;
    p.contact.stiffness = r.decades(8, 6);
    p.contact.exponent = r.below(2) ? r.between(1, 2) : 1.5;
    p.contact.damping = r.one_of(names(DampingLaw{}));
    p.contact.restitution = r.between(0.7, 0.2);
    if (r.below(4) == 3) {
        p.contact.model = ContactModel::restitution;
        p.contact.law = ImpactLaw::stronge;
    }
    const int friction = r.below(3);
    if (friction == 1) p.contact.friction = CoulombFriction{r.between(0.1, 0.8), 1e-2};
    if (friction == 2) p.contact.friction = StickSlipFriction{r.between(0.1, 0.8), {}, {}};
    if (r.below(2)) p.contact.offset.reset();
    if (r.below(3) == 2) p.beam.damping_ratio = {r.between(0, 0.1)};
    if (r.below(4) == 3) p.hub.drive = ConstantTorque{r.between(-1, 1)};
    const Vec2 disc = disc_centre(*p.cam, 0);
    p.initial.angle =
        std::atan2(disc.y, disc.x) + std::asin((p.cam->radius + contact_offset(p)) / norm(disc)) + r.between(0.02, 0.3);
    p.initial.angular_velocity = r.between(-0.5, 0.5);
    return p;
}

bool usable(const Problem& p) {
    const std::vector<Issue> findings = validate(p);
    return std::none_of(findings.begin(), findings.end(), [](const Issue& f) { return f.fatal; });
}

// The violation of a property by this problem, or nothing. A property may change the problem to make itself applicable.
using Verdict = std::optional<std::string>;
using Property = std::function<Verdict(Problem)>;

Verdict fault(const Property& property, const Draws& draws) {
    const Problem p = drawn(draws);
    if (!usable(p)) return std::nullopt;
    try {
        return property(p);
    } catch (const std::exception& error) {
        return std::string("it threw: ") + error.what();
    }
}

Draws shrunk(const Property& property, Draws draws, std::string& found) {
    for (double& d : draws)
        for (double simpler : {0.0, 0.5 * d}) {
            const double kept = std::exchange(d, simpler);
            if (const Verdict still = fault(property, draws)) {
                found = *still;
                break;
            }
            d = kept;
        }
    return draws;
}

Verdict differ(const std::string& what, double a, double b, double tolerance) {
    if (std::fabs(a - b) <= tolerance) return std::nullopt;
    return fmt::format("{}: {:.9g} and {:.9g}, apart by {:.3g} tolerances", what, a, b, std::fabs(a - b) / tolerance);
}

struct Trial {
    unsigned seed;
    int count;
};

class PropertyOfProblems : public ::testing::TestWithParam<Trial> {
  protected:
    // `share`: fraction of the trial's problems, for properties that are expensive to check.
    void hold_for_all(const Property& property, double share = 1) {
        Dice dice(GetParam().seed);
        const int count = static_cast<int>(share * GetParam().count);
        int tried = 0;
        for (int repeat = 0; repeat < count; ++repeat) {
            Draws draws(kDraws);
            for (double& d : draws) d = dice.between(0, 0.999999);
            tried += usable(drawn(draws));
            const Verdict found = fault(property, draws);
            if (!found) continue;
            std::string told = *found, list;
            for (double d : shrunk(property, draws, told)) list += fmt::format("{:g} ", d);
            FAIL() << *found << "\nproblem " << repeat << "; shrunk: " << told << "\ndraws " << list;
        }
        EXPECT_GT(tried, count / 2);
    }
};

constexpr double kEnd = 0.12;  // [s]: a few impacts, before sensitivity has made 1e-8 into 1e-5
// Difference of θ [rad] after kEnd between two computations of one motion: rtol = 1e-8, amplified by impacts.
constexpr double kSameResult = 2e-6;

double theta_at(const Problem& p, double t) { return series(p, "theta", {t})[0]; }

// Two computations may differ in an impact at grazing, and in a start close to the cam.
bool grazing(const Result& r) {
    return std::any_of(r.impacts.begin(), r.impacts.end(), [](const Impact& i) { return i.v_n_before > -0.02; });
}

TEST_P(PropertyOfProblems, TheLedgerClosesOrSaysSo) {
    hold_for_all([](const Problem& p) -> Verdict {
        const Result r = run(p, kEnd);
        const bool told = std::any_of(r.warnings.begin(), r.warnings.end(),
                                      [](const auto& w) { return w.find("energy balance") != std::string::npos; });
        if (!told && r.energy_residual_max > 10 * p.solver.rtol * r.energy_scale) return "open and not told";
        // Reported or not, it is small.
        return differ("ledger", r.energy_residual_max / r.energy_scale, 0, 1e-5);
    });
}

TEST_P(PropertyOfProblems, EnergyNeverRisesOnACamAtRest) {
    hold_for_all([](Problem p) -> Verdict {
        p.cam->speed = 0;
        p.hub.drive = FreeDrive{};
        Request request;
        std::vector<double> times;
        for (int k = 0; k <= 60; ++k) times.push_back(kEnd * k / 60);
        request.tables.push_back({times,
                                  {channel("energy_kinetic"), channel("energy_potential"), channel("energy_elastic"),
                                   channel("energy_contact")}});
        const Result r = simulate(p, request);
        double lowest = INFINITY;
        for (std::size_t k = 0; k < times.size(); ++k) {
            double total = 0;
            for (const auto& column : r.tables[0].values) total += column[k];
            // The residual is that of the ends of steps; inside them the dense output is a little less accurate.
            if (total > lowest + 2 * r.energy_residual_max + p.solver.rtol * r.energy_scale)
                return fmt::format("it rose by {:.3g} J of {:.3g} J (ledger {:.3g} J) before {:g} s", total - lowest,
                                   r.energy_scale, r.energy_residual_max, times[k]);
            lowest = std::min(lowest, total);
        }
        return std::nullopt;
    });
}

TEST_P(PropertyOfProblems, EnergyIsConstantInFlightWithoutDamping) {
    hold_for_all([](Problem p) -> Verdict {
        p.cam.reset();
        p.hub.drive = FreeDrive{};
        p.beam.damping_ratio.clear();
        std::vector<double> times;
        for (int k = 0; k <= 20; ++k) times.push_back(kEnd * k / 20);
        Request request;
        request.tables.push_back(
            {times, {channel("energy_kinetic"), channel("energy_potential"), channel("energy_elastic")}});
        const Result r = simulate(p, request);
        const auto& values = r.tables[0].values;
        const auto total = [&](std::size_t k) { return values[0][k] + values[1][k] + values[2][k]; };
        for (std::size_t k = 1; k < times.size(); ++k)
            if (auto wrong = differ("energy", total(k), total(0), 10 * p.solver.rtol * r.energy_scale)) return wrong;
        return std::nullopt;
    });
}

TEST_P(PropertyOfProblems, ACentredSmoothCamTurnsWithoutEffect) {
    hold_for_all(
        [](Problem p) -> Verdict {
            p.cam->eccentricity = 0;
            p.contact.friction = NoFriction{};
            p.cam->speed = 0;
            if (!usable(p)) return std::nullopt;
            const double still = theta_at(p, kEnd);
            p.cam->speed = 7;
            return differ("theta", theta_at(p, kEnd), still, 1e-8);
        },
        0.5);
}

TEST_P(PropertyOfProblems, FrictionCannotMoveARigidRodThroughItsHinge) {
    hold_for_all(
        [](Problem p) -> Verdict {
            p.beam.model = ModelKind::rigid;
            p.hub.radius = 0;
            p.contact.offset = 0;
            p.contact.friction = NoFriction{};
            if (!usable(p)) return std::nullopt;
            const Result smooth = run(p, kEnd);
            for (const Impact& i : smooth.impacts)
                if (i.x > 0.999 * p.beam.length) return std::nullopt;  // at the tip t is not radial
            const double without = theta_at(p, kEnd);
            p.contact.friction = CoulombFriction{0.5, 1e-3};
            return differ("theta", theta_at(p, kEnd), without, kSameResult);
        },
        0.5);
}

TEST_P(PropertyOfProblems, ARigidRodNeverRisesAboveItsLastPeakOnACamAtRest) {
    hold_for_all([](Problem p) -> Verdict {
        p.beam.model = ModelKind::rigid;
        p.cam->speed = 0;
        p.hub.drive = FreeDrive{};
        p.initial.angular_velocity = 0;
        if (!usable(p)) return std::nullopt;
        Request request;
        std::vector<double> times;
        for (int k = 0; k <= 5000; ++k) times.push_back(2e-4 * k);
        request.tables.push_back({times, {channel("theta"), channel("contact_force")}});
        const Table table = simulate(p, request).tables[0];
        const std::vector<double>&theta = table.values[0], &force = table.values[1];
        double peak = INFINITY;
        for (std::size_t k = 1; k + 1 < times.size(); ++k) {
            // In flight: pressed on the cam the beam stores energy.
            if (force[k - 1] != 0 || force[k] != 0 || force[k + 1] != 0) continue;
            if (theta[k] < theta[k - 1] || theta[k] < theta[k + 1]) continue;
            // The largest possible excess between the samples, from the pendulum's acceleration.
            if (theta[k] > peak + 1e-6) return fmt::format("a peak of {:.9g} rad after one of {:.9g}", theta[k], peak);
            peak = theta[k];
        }
        return std::nullopt;
    });
}

TEST_P(PropertyOfProblems, AStiffBeamFallsLikeARigidOne) {
    hold_for_all(
        [](Problem p) -> Verdict {
            p.cam.reset();
            // Its steps would resolve the vibration of the stiff one.
            if (p.beam.model == ModelKind::second_order) p.beam.model = ModelKind::first_order;
            const double soft = theta_at(p, kEnd);
            p.beam.youngs_modulus *= 1e4;
            const double stiff = theta_at(p, kEnd);
            p.beam.model = ModelKind::rigid;
            const double rigid = theta_at(p, kEnd);
            // The deflection goes with 1/EI; the hub turns against the chord by as much.
            return differ("theta", stiff, rigid, 1e-3 * std::fabs(soft - rigid) + 1e-7);
        },
        0.5);
}

TEST_P(PropertyOfProblems, TheMirroredProblemHasTheMirroredMotion) {
    // In the vertical through the hub: θ → π − θ, x → −x, ψ → π − ψ, ω → −ω, τ → −τ. The face keeps to the cam.
    hold_for_all(
        [](const Problem& p) -> Verdict {
            Problem m = p;
            m.initial.angle = std::numbers::pi - p.initial.angle;
            m.initial.angular_velocity = -p.initial.angular_velocity;
            m.cam->centre.x = -p.cam->centre.x;
            m.cam->phase = std::numbers::pi - p.cam->phase;
            m.cam->speed = -p.cam->speed;
            if (const auto* torque = std::get_if<ConstantTorque>(&p.hub.drive))
                m.hub.drive = ConstantTorque{-torque->value};
            const Result there = run(p, kEnd);
            if (grazing(there)) return std::nullopt;
            if (auto wrong = differ("theta", theta_at(m, kEnd), std::numbers::pi - theta_at(p, kEnd), kSameResult))
                return wrong;
            return differ("impacts", static_cast<double>(run(m, kEnd).impacts.size()),
                          static_cast<double>(there.impacts.size()), 0);
        },
        0.5);
}

TEST_P(PropertyOfProblems, ScaledLengthMassAndTimeScaleTheMotion) {
    hold_for_all(
        [](const Problem& p) -> Verdict {
            const double l = 4, m = 8, t = 2, force = m * l / (t * t), speed = l / t;
            // The bristle's default stiffness is that of 1 m/s, which is no similarity.
            if (std::holds_alternative<StickSlipFriction>(p.contact.friction)) return std::nullopt;
            Problem s = p;
            s.beam.length *= l;
            s.beam.depth = l * beam_depth(p.beam);
            s.beam.area *= l * l;
            s.beam.second_moment *= std::pow(l, 4);
            s.beam.density *= m / (l * l * l);
            s.beam.youngs_modulus *= force / (l * l);
            s.hub.radius *= l;
            s.hub.inertia *= m * l * l;
            s.cam->centre = l * p.cam->centre;
            s.cam->radius *= l;
            s.cam->eccentricity *= l;
            s.cam->speed /= t;
            s.contact.stiffness = *p.contact.stiffness * force / std::pow(l, contact_exponent(p));
            s.contact.approach_floor.value *= speed;
            *s.contact.collision_gap *= t;
            if (const auto* coulomb = std::get_if<CoulombFriction>(&p.contact.friction))
                s.contact.friction = CoulombFriction{coulomb->coefficient, coulomb->slip_speed * speed};
            if (const auto* torque = std::get_if<ConstantTorque>(&p.hub.drive))
                s.hub.drive = ConstantTorque{torque->value * force * l};
            s.gravity *= l / (t * t);
            s.initial.angular_velocity /= t;
            if (grazing(run(p, kEnd))) return std::nullopt;
            return differ("theta", theta_at(s, t * kEnd), theta_at(p, kEnd), kSameResult);
        },
        0.5);
}

TEST_P(PropertyOfProblems, ARigidRodStartedAgainInFlightGoesOnTheSame) {
    hold_for_all(
        [](Problem p) -> Verdict {
            p.beam.model = ModelKind::rigid;
            if (!usable(p)) return std::nullopt;
            const double middle = 0.4 * kEnd;
            const Result first = run(p, kEnd);
            if (grazing(first)) return std::nullopt;
            for (const Impact& i : first.impacts)
                if (i.t_start <= middle && i.t_end.value_or(kEnd) >= middle) return std::nullopt;  // touching then
            Problem later = p;
            later.initial.angle = theta_at(p, middle);
            later.initial.angular_velocity = series(p, "theta_dot", {middle})[0];
            later.cam->phase = p.cam->phase - p.cam->speed * middle;
            // A new start drops the approach speed of the collision's first touch.
            if (p.contact.approach_floor.policy == ApproachFloorPolicy::first_touch) later.contact.approach_floor = {};
            return differ("theta", theta_at(later, kEnd - middle), theta_at(p, kEnd), kSameResult);
        },
        0.5);
}

// Every method and model, started again from its own dense output in the middle of a step.
TEST_P(PropertyOfProblems, AFlexibleFlightStartedAgainInsideAStepGoesOnTheSame) {
    hold_for_all([](Problem p) -> Verdict {
        p.cam.reset();
        p.initial.angular_velocity -= 1;
        System system(p);
        const InitialState start = initial_state(system);
        const auto go = [&](Integrator& integrator, double t, std::vector<double> y, double end) {
            integrator.start(t, y.data());
            const Segment* segment = &integrator.step();
            while (segment->t1 < end) segment = &integrator.step();
            segment->value(end, y.data());
            return y;
        };
        const auto make = [&] {
            return ModalForm::exists(system) ? make_exponential(system, p.solver.rtol / 3, p.solver.atol / 3)
                                             : make_rk8(system, p.solver.rtol / 3, p.solver.atol / 3);
        };
        const std::vector<double> whole = go(*make(), 0, start.y, kEnd);
        const std::vector<double> half = go(*make(), 0, start.y, 0.37 * kEnd);
        const std::vector<double> rest = go(*make(), 0.37 * kEnd, half, kEnd);
        for (int i = 0; i < system.ledger_at; ++i) {
            const auto k = static_cast<std::size_t>(i);
            if (auto wrong = differ("component " + std::to_string(i), rest[k], whole[k],
                                    100 * (p.solver.rtol * std::max(1.0, std::fabs(whole[k])) + p.solver.atol)))
                return wrong;
        }
        return std::nullopt;
    });
}

std::string name_of(const ::testing::TestParamInfo<Trial>& trial) { return std::to_string(trial.param.count); }
#ifdef __SANITIZE_ADDRESS__
constexpr int kSome = 10;  // a sanitizer makes minutes of seconds
#else
constexpr int kSome = 40;
#endif
INSTANTIATE_TEST_SUITE_P(Some, PropertyOfProblems, ::testing::Values(Trial{101, kSome}), name_of);
INSTANTIATE_TEST_SUITE_P(LongMany, PropertyOfProblems, ::testing::Values(Trial{202, 600}), name_of);

}  // namespace
}  // namespace beamcam::sim::testing
