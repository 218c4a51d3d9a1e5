#include "scenes/figures/findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "render/draw/markup.hpp"
#include "scenes/figures/figure_types.hpp"
#include "sim/beam/modes.hpp"
#include "sim/studies/paper.hpp"

namespace beamcam::scenes {
namespace {

using sim::Printing;

constexpr double kRepeated = 4;      // [s] of repeated impacts, as in the figures
constexpr double kSettled = 12;      // [s]: the transient is over at each of the three speeds
constexpr double kFirst = 0.3;       // [s]: the first collision on a cam at rest is over
constexpr double kTolerated = 1e-6;  // [rad]: θ is reproducible to this
constexpr double kTighter = 100;     // tolerance of the run that decides on that

sim::Problem falling(double length) {
    sim::Problem p;
    p.cam.reset();
    p.beam.length = length;
    p.beam.basis = sim::Basis::cantilever;
    p.solver.rtol = 1e-11;
    p.solver.atol = 1e-14;
    return p;
}

// Without markup: "−5.48×10⁻⁸".
std::string plain(double value, int digits) { return render::to_plain(number(value, digits)); }

double zero(const sim::Result& r) { return r.theta_zero.empty() ? std::nan("") : r.theta_zero.front().t; }

// Highest θ of the rebounds of the first seconds, in order.
std::vector<double> heights_of_rebounds(const sim::Result& r) {
    std::vector<double> heights;
    for (const sim::Apex& apex : sim::rebounds(r))
        if (apex.t < kRepeated) heights.push_back(apex.theta);
    return heights;
}

int higher_than_before(const std::vector<double>& heights) {
    int count = 0;
    for (std::size_t i = 1; i < heights.size(); ++i) count += heights[i] > heights[i - 1];
    return count;
}

// Eq. (5) with the rod tangent to the centred disc, the support at the paper's x₁ = l₁ = √(D² − R²).
struct SupportedBeam {
    sim::Problem p;
    double angle = std::asin(p.cam->radius / norm(p.cam->centre));
    double support = sim::tangent_distance(*p.cam, 0, Printing::printed);
    sim::StaticDeflection at(double x, Printing printing, bool overhang) const {
        return sim::supported_beam(p, angle, support, x, printing, overhang);
    }
    double jump(Printing printing) const {
        return std::abs(at(support, printing, true).slope - at(support, printing, false).slope);
    }
    double tip(Printing printing) const { return at(p.beam.length * std::cos(angle), printing, true).v; }
};

// First flapwise frequency of the beam turning at Ω = 4, both in √(EI/(ρAL⁴)).
double flapwise_frequency() {
    sim::Problem p;
    p.beam.basis = sim::Basis::cantilever;
    p.beam.modes = 12;
    p.beam.model = sim::ModelKind::first_order;
    const double unit = std::sqrt(p.beam.bending_stiffness() / p.beam.line_density()), turning = 4;
    const double omega = sim::natural_modes(p, turning * unit).front().omega / unit;
    return std::sqrt(omega * omega + turning * turning);
}

// Samples in contact that a channel calls separated, of all of them.
struct Verdicts {
    int touching = 0, printed_wrong = 0, corrected_wrong = 0;
};
Verdicts verdicts(const sim::Table& t) {
    Verdicts out;
    const auto &force = column(t, ChannelKind::contact_force), &corrected = column(t, ChannelKind::separation),
               &printed = column(t, ChannelKind::separation_paper);
    for (std::size_t i = 0; i < force.size(); ++i) {
        if (!(force[i] > 0)) continue;
        ++out.touching;
        out.printed_wrong += printed[i] < 0;
        out.corrected_wrong += corrected[i] < 0;
    }
    return out;
}

// The interval in which two runs of one motion differ by more than the tolerated angle, and the largest difference.
struct Transient {
    double from = 0, to = 0, largest = 0;
};
Transient transient(const sim::Table& a, const sim::Table& b) {
    const auto &t = column(a, ChannelKind::t), &x = column(a, ChannelKind::theta), &y = column(b, ChannelKind::theta);
    Transient out;
    for (std::size_t i = 0; i < t.size(); ++i)
        if (const double difference = std::abs(x[i] - y[i]); difference > kTolerated)
            out = {out.largest == 0 ? t[i] : out.from, t[i], std::max(out.largest, difference)};
    return out;
}

// The studies of the findings.
struct FindingStudies {
    std::size_t flexible, printed, long_beam, long_printed, first, rest, table;
    std::array<std::array<std::size_t, 2>, 3> repeated{}, angles{};  // at the scene's tolerance, and a tighter one
};

sim::Problem with_cam_speed(double speed) {
    sim::Problem p;
    p.cam->speed = speed;
    return p;
}

FindingStudies ask_for_findings(Studies& studies) {
    studies.name_figure("findings");
    FindingStudies all{};
    const auto falls = [&](double length, double end, sim::ModelKind model) {
        sim::Problem p = falling(length);
        p.beam.model = model;
        const std::size_t study = studies.of(p, end);
        studies.apexes(study), studies.zero_crossings(study);
        return study;
    };
    const sim::ModelKind usual = sim::Problem{}.beam.model;
    all.flexible = falls(1, 0.4, usual), all.printed = falls(1, 0.4, sim::ModelKind::paper);
    all.long_beam = falls(8, 1.2, usual), all.long_printed = falls(8, 1.2, sim::ModelKind::paper);
    sim::Problem resting = with_cam_speed(0);
    all.first = studies.of(resting, kFirst);
    resting.initial.shape = sim::InitialShape::resting;
    all.rest = studies.of(resting, kFirst);
    all.table = studies.table(all.rest, {0, kFirst, 3001},
                              {ChannelKind::contact_force, ChannelKind::separation, ChannelKind::separation_paper});
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t tight = 0; tight < 2; ++tight) {
            sim::Problem p = with_cam_speed(kPaperSpeeds[k]);
            if (tight) p.solver.rtol /= kTighter, p.solver.atol /= kTighter;
            const std::size_t study = all.repeated[k][tight] = studies.of(p, kSettled);
            all.angles[k][tight] = studies.table(study, {0, kSettled, 12001}, {ChannelKind::t, ChannelKind::theta});
            if (!tight) studies.apexes(study), studies.zero_crossings(study);
        }
    return all;
}

Finding on_fall_times(const sim::Result& flex) {
    return {"Fig. 2: the flexible beam falls in 0.37 s, the rigid rod in 0.262 s",
            "Both take 0.37 s; 0.262 s is 1/√2 of it: a factor 2 between torque and inertia",
            fmt::format("flexible {:.9f} s, rigid {:.15f} s, with the factor 2 {:.12f} s", zero(flex),
                        sim::rod_fall_time(1, 9.81, M_PI / 4, 1), sim::rod_fall_time(1, 9.81, M_PI / 4, 2)),
            "`Published.NumbersAreReproducedEveryOne`, `Paper.AFactorTwoGivesThePapersTime`"};
}

Finding on_overhanging_span() {
    const SupportedBeam held;
    return {"Eq. (5), overhanging span",
            "C₂ lacks + q l₁³/(24 cos θ), D₂ lacks − q l₁⁴/(24 cos θ): the slope jumps at the support. Both are "
            "small; "
            "nearly all of the difference is that along the rod the deflection is 1/cos² θ larger",
            fmt::format("l₁ = {:.3f} m: slope jumps by {} as printed, by {} with the terms; deflection of the tip: "
                        "printed {} mm, with the terms {} mm ({} %), along the rod {} mm",
                        held.support, plain(held.jump(Printing::printed), 4), plain(held.jump(Printing::completed), 1),
                        plain(held.tip(Printing::printed) * 1e3, 4), plain(held.tip(Printing::completed) * 1e3, 4),
                        plain(100 * (held.tip(Printing::completed) / held.tip(Printing::printed) - 1), 1),
                        plain(held.tip(Printing::corrected) * 1e3, 4)),
            "`Paper.DeflectionAsPrintedJumpsInSlopeAndTheCorrectedOneDoesNot`, "
            "`Paper.MissingTermsOfTheDeflectionAreSmall`"};
}

Finding on_signs_of_gravity() {
    return {"Eq. (4): the signs of gravity", "They contradict the potential (2): as printed, the rod would rise",
            fmt::format("θ̈(0) = {} rad/s² (true), +{} rad/s² (as printed)", plain(-1.5 * 9.81 * std::cos(M_PI / 4), 6),
                        plain(1.5 * 9.81 * std::cos(M_PI / 4), 6)),
            "`Published.NumbersAreReproducedEveryOne`"};
}

Finding on_stiffening(const sim::Result& paper, const sim::Result& flex) {
    return {"Eq. (4): l = L cos θ in the stiffening term", "Energy is not conserved",
            fmt::format("largest change of energy in the free fall, of its scale: printed {}, consistent {}",
                        plain(paper.energy_residual_max / paper.energy_scale, 3),
                        plain(flex.energy_residual_max / flex.energy_scale, 1)),
            "`Energy.IsNotConstantInThePapersEquation`"};
}

Finding on_foreshortening(const sim::Result& paper, const sim::Result& flex, const sim::Result& long_paper,
                          const sim::Result& long_flex) {
    return {"Eq. (4): u_f kept in T, dropped from gravity", "Small for L = 1 m, milliseconds for L = 8 m",
            fmt::format("fall time, printed − consistent: {} s (L = 1 m), {} s (L = 8 m)",
                        plain(zero(paper) - zero(flex), 3), plain(zero(long_paper) - zero(long_flex), 3)),
            "`Findings.ForeshorteningInGravityMatters`"};
}

Finding on_separation(const Verdicts& v) {
    return {"Eq. (6): Δ ≥ 0 means not separated",
            "The sign of its gravity term is reversed for a rod above the cam; true is N ≥ 0",
            fmt::format("a beam that rests on the cam, {} samples: Δ calls it separated in {}, with the sign "
                        "corrected in {}",
                        v.touching, v.printed_wrong, v.corrected_wrong),
            "`Findings.SeparationAsPrintedIsWrongForARestingBeam`, "
            "`Findings.SeparationAsPrintedHasTheWrongSign`"};
}

Finding on_first_touch(const sim::Result& touch) {
    const sim::Cam cam = *with_cam_speed(0).cam;
    sim::Cam centred = cam;
    centred.eccentricity = 0;
    return {"§3.4: x₁ = √(D² − R²) = 0.229 m", "Right only for e = 0; √(D² + e² + 2De cos ψ − R²) with eccentricity",
            fmt::format("e = 0: {:.6f} m; e = 0.02 m, ψ = 0: {:.6f} m, the located first touch: {:.6f} m",
                        sim::tangent_distance(centred, 0, Printing::printed),
                        sim::tangent_distance(cam, 0, Printing::corrected),
                        touch.impacts.empty() ? std::nan("") : touch.impacts.front().x),
            "`Figures.TrialMethodMeetsTheLocatedTouch`"};
}

Finding on_gravity() {
    return {"The system moves in the horizontal plane", "Gravity is in its potential (2); without it nothing falls",
            "g is not printed; 9.81 m/s² reproduces 0.37 s", "`Published.NumbersAreReproducedEveryOne`"};
}

std::string numbers_of_repeated_impacts(const FindingStudies& all, const Results& results) {
    std::string numbers;
    const double rtol = sim::Problem{}.solver.rtol;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto run = [&](std::size_t tight) -> const sim::Result& { return *results[all.repeated[k][tight]]; };
        const Transient apart = transient(run(0).tables[all.angles[k][0]], run(1).tables[all.angles[k][1]]);
        const std::vector<double> heights = heights_of_rebounds(run(0));
        numbers += fmt::format(
            "{}ω = {}: θ by `auto` at the relative tolerances {} and {} differs by more than {} rad from {:.1f} s to "
            "{:.1f} s "
            "(by up to {:.2f} rad); {} of {} rebounds in {} s exceed the one before",
            k ? "; " : "", kPaperSpeeds[k], plain(rtol, 1), plain(rtol / kTighter, 1), plain(kTolerated, 1), apart.from,
            apart.to, apart.largest, higher_than_before(heights), heights.empty() ? 0 : heights.size() - 1, kRepeated);
    }
    return numbers;
}

Finding on_repeated_impacts(const std::string& numbers) {
    return {"Fig. 6: θ(t) through repeated impacts",
            "Cannot be reproduced number by number: half of its parameters are not printed, and the motion "
            "is a sensitive transient. What holds: θ fluctuates, peaks decline in trend, without regularity",
            numbers,
            "`Findings.ReboundsDeclineInTrendWithoutRegularity`, "
            "`LongFindings.TheTransientIsSensitiveAndThenReproducibleAgain`"};
}

Finding on_variation_of_t() {
    return {"Variation of T: the last term 2ρAθ̇²(a + x + u_f)δu_f",
            "The factor 2 is wrong: (1) gives 1, and (4) is right again",
            fmt::format("with the factor 1, a beam turning at Ω = 4 has the flapwise frequency {:.4f} (both "
                        "in √(EI/(ρAL⁴))); published: 5.5850",
                        flapwise_frequency()),
            "`Modes.StiffeningOfTheTurningBeamHasTheFactorOne`"};
}

}  // namespace

std::function<std::vector<Finding>(const Results&)> prepare_findings(Studies& studies) {
    return [all = ask_for_findings(studies)](const Results& of) {
        const sim::Result &flex = *of[all.flexible], &paper = *of[all.printed];
        return std::vector<Finding>{on_fall_times(flex),
                                    on_overhanging_span(),
                                    on_signs_of_gravity(),
                                    on_stiffening(paper, flex),
                                    on_foreshortening(paper, flex, *of[all.long_printed], *of[all.long_beam]),
                                    on_separation(verdicts(of[all.rest]->tables[all.table])),
                                    on_first_touch(*of[all.first]),
                                    on_gravity(),
                                    on_repeated_impacts(numbers_of_repeated_impacts(all, of)),
                                    on_variation_of_t()};
    };
}

std::string findings_markdown(const std::vector<Finding>& findings) {
    std::string text =
        "# Findings on the paper\n\nYang, Feng, Chen and Wu, *Acta Physica Sinica* 65, 240502 (2016), doi "
        "10.7498/aps.65.240502. Numbers are computed by this run; the last column names the test of each finding.\n\n"
        "| | printed | true | numbers | test |\n|---|---|---|---|---|\n";
    int row = 0;
    for (const Finding& f : findings)
        text += fmt::format("| {} | {} | {} | {} | {} |\n", ++row, f.paper, f.truth, f.numbers, f.test);
    return text;
}

}  // namespace beamcam::scenes
