#include "scenes/figures/findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "render/figure/text.hpp"
#include "scenes/figures/recipes.hpp"
#include "sim/paper.hpp"

namespace beamcam::scenes {
namespace {

using sim::ChannelKind;
using sim::Printing;

constexpr double kRepeated = 4;  // [s] of repeated impacts, as in the figures
constexpr double kFirst = 0.3;   // [s]: the first collision on a cam at rest is over

sim::Problem falling(double length) {
    sim::Problem p;
    p.cam.reset();
    p.beam.length = length;
    p.beam.basis = sim::Basis::cantilever;
    p.solver.rtol = 1e-11;
    p.solver.atol = 1e-14;
    return p;
}

sim::Problem with_model(sim::Problem p, sim::ModelKind model) {
    p.beam.model = model;
    return p;
}

// Without markup: "−5.48×10⁻⁸".
std::string plain(double value, int digits) { return render::figure::to_plain(number(value, digits)); }

double zero(const sim::Result& r) { return r.theta_zero.empty() ? std::nan("") : r.theta_zero.front().t; }

// Highest θ between collisions, in order.
std::vector<double> rebounds(const sim::Result& r) {
    std::vector<double> heights;
    for (std::size_t i = 0; i < r.collisions.size(); ++i) {
        const double from = r.collisions[i].t_end.value_or(r.end_time);
        const double to = i + 1 < r.collisions.size() ? r.collisions[i + 1].t_start : r.end_time;
        double highest = -1e300;
        for (const sim::Apex& apex : r.apexes)
            if (apex.t > from && apex.t < to) highest = std::max(highest, apex.theta);
        if (highest > -1e300) heights.push_back(highest);
    }
    return heights;
}

int higher_than_before(const std::vector<double>& heights) {
    int count = 0;
    for (std::size_t i = 1; i < heights.size(); ++i) count += heights[i] > heights[i - 1];
    return count;
}

// Largest |jump of the slope| at the support, printed and corrected.
double slope_jump(Printing printing) {
    const sim::Problem p;
    const double angle = std::asin(p.cam->radius / norm(p.cam->centre)), support = 0.25 * std::cos(angle);
    return std::abs(sim::supported_beam(p, angle, support, support, printing, true).slope -
                    sim::supported_beam(p, angle, support, support, printing, false).slope);
}

}  // namespace

std::function<std::vector<Finding>(const Results&)> prepare_findings(Studies& studies) {
    const char* who = "findings";
    const std::size_t flexible = studies.of(falling(1), 0.4, who);
    const std::size_t printed = studies.of(with_model(falling(1), sim::ModelKind::paper), 0.4, who);
    const std::size_t long_beam = studies.of(falling(8), 1.2, who);
    const std::size_t long_printed = studies.of(with_model(falling(8), sim::ModelKind::paper), 1.2, who);
    sim::Problem still;
    still.cam->speed = 0;
    const std::size_t first = studies.of(still, kFirst, who);
    // The printed condition is the rigid rod's.
    const std::size_t rod = studies.of(with_model(still, sim::ModelKind::rigid), kFirst, who);
    const std::size_t table = studies.table(
        rod, {0, kFirst, 40001}, {ChannelKind::contact_force, ChannelKind::separation, ChannelKind::separation_paper});
    std::array<std::size_t, 3> repeated{};
    for (std::size_t k = 0; k < 3; ++k) {
        sim::Problem p;
        p.cam->speed = std::array{0.0, 1.0, 5.0}[k];
        repeated[k] = studies.of(p, kRepeated, who);
        studies.horizon(repeated[k]);
    }
    for (const std::size_t study : {flexible, printed, long_beam, long_printed, repeated[0], repeated[1], repeated[2]})
        studies.turning_points(study);
    return [=](const Results& results) {
        std::vector<Finding> out;
        const sim::Result& flex = *results[flexible];
        out.push_back(
            {"Fig. 2: the flexible beam falls in 0.37 s, the rigid rod in 0.262 s",
             "Both take 0.37 s; 0.262 s is the rigid rod with its gravity torque doubled",
             fmt::format("flexible {:.9f} s, rigid {:.15f} s, torque doubled {:.12f} s", zero(flex),
                         sim::rod_fall_time(1, 9.81, M_PI / 4, 1), sim::rod_fall_time(1, 9.81, M_PI / 4, 2)),
             "`Published.RigidRodFall`, `Published.FlexibleFall`, `Paper.DoubledTorqueAloneGivesThePapersTime`"});
        out.push_back(
            {"Eq. (5), overhanging span",
             "C₂ lacks + q l₁³/(24 cos θ), D₂ lacks − q l₁⁴/(24 cos θ): the slope jumps at the support; along the "
             "rod the deflection is 1/cos² θ larger",
             fmt::format("jump of the slope at l₁ = L cos θ/4: printed {}, corrected {}",
                         plain(slope_jump(Printing::printed), 4), plain(slope_jump(Printing::corrected), 1)),
             "`Paper.DeflectionAsPrintedJumpsInSlopeAndTheCorrectedOneDoesNot`"});
        out.push_back(
            {"Eq. (4): the signs of gravity", "They contradict the potential (2): as printed, the rod would rise",
             fmt::format("θ̈(0) = {} rad/s² (true), +{} rad/s² (as printed)", plain(-1.5 * 9.81 * std::cos(M_PI / 4), 6),
                         plain(1.5 * 9.81 * std::cos(M_PI / 4), 6)),
             "`FallingRod.ReachesTheHorizontalWhenItShould`"});
        const sim::Result& paper = *results[printed];
        out.push_back({"Eq. (4): l = L cos θ in the stiffening term", "Energy is not conserved",
                       fmt::format("largest change of energy in the free fall, of its scale: printed {}, consistent {}",
                                   plain(paper.energy_residual_max / paper.energy_scale, 3),
                                   plain(flex.energy_residual_max / flex.energy_scale, 1)),
                       "`Energy.IsNotConstantInThePapersEquation`"});
        out.push_back({"Eq. (4): u_f kept in T, dropped from gravity", "Small for L = 1 m, milliseconds for L = 8 m",
                       fmt::format("fall time, printed − consistent: {} s (L = 1 m), {} s (L = 8 m)",
                                   plain(zero(paper) - zero(flex), 3),
                                   plain(zero(*results[long_printed]) - zero(*results[long_beam]), 3)),
                       "`Findings.ForeshorteningInGravityMatters`"});
        const sim::Table& t = results[rod]->tables[table];
        int touching = 0, right = 0, wrong = 0;
        const auto &force = column(t, ChannelKind::contact_force), &true_sign = column(t, ChannelKind::separation),
                   &paper_sign = column(t, ChannelKind::separation_paper);
        for (std::size_t i = 0; i < force.size(); ++i) {
            if (!(force[i] > 0)) continue;
            ++touching;
            right += true_sign[i] >= 0;
            wrong += paper_sign[i] < 0;
        }
        out.push_back(
            {"Eq. (6): Δ ≥ 0 means not separated",
             "The sign of its gravity term is reversed for a rod above the cam; true is N ≥ 0",
             fmt::format("rigid rod, {} samples in contact in the first collision: Δ calls {} separated, N {}",
                         touching, wrong, touching - right),
             "`Findings.SeparationAsPrintedHasTheWrongSign`"});
        const sim::Result& touch = *results[first];
        const sim::Cam cam = *still.cam;
        sim::Cam centred = cam;
        centred.eccentricity = 0;
        out.push_back({"§3.4: x₁ = √(D² − R²) = 0.229 m",
                       "Right only for e = 0; √(D² + e² + 2De cos ψ − R²) with eccentricity",
                       fmt::format("e = 0: {:.6f} m; e = 0.02 m, ψ = 0: {:.6f} m, the located first touch: {:.6f} m",
                                   sim::tangent_distance(centred, 0, Printing::printed),
                                   sim::tangent_distance(cam, 0, Printing::corrected),
                                   touch.impacts.empty() ? std::nan("") : touch.impacts.front().x),
                       "`Paper.TrialMethodFindsTheLocatedTouch`"});
        out.push_back({"The system moves in the horizontal plane",
                       "Gravity is in its potential (2); without it nothing falls",
                       "g is not printed; 9.81 m/s² reproduces 0.37 s", "`Published.RigidRodFall`"});
        std::string numbers;
        for (std::size_t k = 0; k < 3; ++k) {
            const sim::Result& r = *results[repeated[k]];
            const std::vector<double> heights = rebounds(r);
            numbers += fmt::format(
                "{}ω = {}: reproducible to 10⁻⁶ rad until {:.2f} s, {} of {} rebounds exceed the one before",
                k ? "; " : "", std::array{0, 1, 5}[k], r.reproducible_until.value_or(kRepeated),
                higher_than_before(heights), heights.empty() ? 0 : heights.size() - 1);
        }
        out.push_back(
            {"Fig. 6: θ(t) through repeated impacts",
             "Cannot be reproduced number by number: half of its parameters are not printed, and it is chaotic. "
             "What holds: peaks decline in trend, without regularity",
             numbers, "`Findings.ReboundsDeclineInTrendWithoutRegularity`"});
        return out;
    };
}

std::string findings_markdown(const std::vector<Finding>& findings) {
    std::string text =
        "# Findings on the paper\n\nYang, Feng, Chen and Wu, *Acta Physica Sinica* 65, 240502 (2016), doi "
        "10.7498/aps.65.240502. Numbers are computed by this run; the last column names the test that keeps each.\n\n"
        "| | printed | true | numbers | test |\n|---|---|---|---|---|\n";
    int row = 0;
    for (const Finding& f : findings)
        text += fmt::format("| {} | {} | {} | {} | {} |\n", ++row, f.paper, f.truth, f.numbers, f.test);
    return text;
}

}  // namespace beamcam::scenes
