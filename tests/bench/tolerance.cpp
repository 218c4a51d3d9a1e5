// Compares errors with the requested tolerance. Random scenes (modes, cam speed and phase, law and friction of contact,
// stiffness, damping) at random tolerances by `auto`, each against the Runge–Kutta method at 1e-12. Prints, for the
// fall up to the first impact and for the first second with its impacts, how many times rtol the largest error was, as
// quantiles: of the hub's angle, and of the state, which is the worst of hub angle and rate, tip deflection and its
// rate. Each error is in units of the largest value in that time (of the angle, 1 rad at least). Scenes whose impacts
// differ in number are named.
//
//   bench_tolerance [--scenes 300] [--seed 1] [--csv FILE]
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <vector>

#include "sim/problem/keys.hpp"
#include "sim/run/simulate.hpp"

using namespace beamcam;

namespace {

sim::Problem scene(std::mt19937_64& dice) {
    const auto between = [&](double low, double high) {
        return low + (high - low) * std::generate_canonical<double, 53>(dice);
    };
    const auto laws = names(sim::DampingLaw{});
    sim::Problem p;
    p.beam.modes = static_cast<int>(between(1, 9));
    if (between(0, 1) < 0.3) p.beam.damping_ratio = {between(0, 0.05)};
    p.cam->speed = between(-8, 8);
    p.cam->phase = between(-3, 3);
    p.contact.stiffness = std::pow(10, between(7, 9));
    p.contact.damping = laws[static_cast<std::size_t>(between(0, static_cast<double>(laws.size())))].value;
    p.contact.restitution = between(0.3, 0.95);
    if (between(0, 1) < 0.3) p.contact.friction = sim::CoulombFriction{between(0.05, 0.5), 1e-2};
    p.solver.rtol = std::pow(10, between(-9, -4));
    p.solver.atol = 1e-3 * p.solver.rtol;
    return p;
}

// Largest difference of each channel at the times before `end`, over the channel's largest value.
std::vector<double> errors(const sim::Table& found, const sim::Table& exact, const std::vector<double>& times,
                           double end) {
    std::vector<double> worst;
    for (std::size_t c = 0; c < exact.values.size(); ++c) {
        double error = 0, size = exact.channels[c].kind == sim::ChannelKind::theta ? 1 : 0;
        for (std::size_t k = 0; k < times.size() && times[k] < end; ++k) {
            error = std::max(error, std::fabs(found.values[c][k] - exact.values[c][k]));
            size = std::max(size, std::fabs(exact.values[c][k]));
        }
        worst.push_back(size > 0 ? error / size : 0);
    }
    return worst;
}

void print(const char* what, std::vector<double> ratios) {
    std::sort(ratios.begin(), ratios.end());
    const auto at = [&](double share) {
        return ratios[static_cast<std::size_t>(share * static_cast<double>(ratios.size() - 1))];
    };
    const auto inside = std::count_if(ratios.begin(), ratios.end(), [](double r) { return r >= 0.01 && r <= 10; });
    const auto below = std::count_if(ratios.begin(), ratios.end(), [](double r) { return r < 0.01; });
    fmt::print(
        "{:28} error/rtol: least {:.1e}, 10 % {:.1e}, median {:.1e}, 90 % {:.1e}, largest {:.1e}; {} of {} within "
        "0.01…10, {} below\n",
        what, at(0), at(0.1), at(0.5), at(0.9), at(1), inside, ratios.size(), below);
}

}  // namespace

int main(int argc, char** argv) {
    int scenes = 300;
    std::uint64_t seed = 1;
    std::FILE* csv = nullptr;
    for (int i = 1; i + 1 < argc; i += 2) {
        if (!std::strcmp(argv[i], "--scenes")) scenes = std::atoi(argv[i + 1]);
        if (!std::strcmp(argv[i], "--seed")) seed = std::strtoull(argv[i + 1], nullptr, 10);
        if (!std::strcmp(argv[i], "--csv")) csv = std::fopen(argv[i + 1], "w");
    }
    if (csv)
        fmt::print(
            csv,
            "scene,modes,speed,rtol,impacts,reference_impacts,fall_angle,fall_state,second_angle,second_state,steps\n");
    sim::Request request;
    std::vector<double> times;
    for (int k = 1; k <= 500; ++k) times.push_back(2e-3 * k);
    request.tables.push_back({times,
                              {{sim::ChannelKind::theta, 0},
                               {sim::ChannelKind::theta_dot, 0},
                               {sim::ChannelKind::tip_deflection, 0},
                               {sim::ChannelKind::tip_rate, 0}}});
    std::vector<double> angle_falls, falls, angles, states;
    int others = 0;
    for (int s = 0; s < scenes; ++s) {
        std::mt19937_64 dice(seed * 100003 + static_cast<std::uint64_t>(s));
        sim::Problem p = scene(dice);
        const sim::Result found = sim::simulate(p, request);
        const double rtol = p.solver.rtol;
        p.solver.method = sim::Method::rk8;
        p.solver.rtol = 1e-12;
        p.solver.atol = 1e-15;
        const sim::Result exact = sim::simulate(p, request);
        const double first = exact.impacts.empty() ? 1e9 : exact.impacts.front().t_start;
        const std::vector<double> fall = errors(found.tables[0], exact.tables[0], times, first),
                                  second = errors(found.tables[0], exact.tables[0], times, 1e9);
        angle_falls.push_back(fall[0] / rtol);
        falls.push_back(*std::max_element(fall.begin(), fall.end()) / rtol);
        const bool same = found.impacts.size() == exact.impacts.size();
        const double worst = *std::max_element(second.begin(), second.end()) / rtol;
        if (!same) {
            ++others;
            fmt::print("scene {}: {} impacts, {} at 1e-12 (rtol {:.1e}, {} modes, {:.3g} rad/s)\n", s,
                       found.impacts.size(), exact.impacts.size(), rtol, p.beam.modes, p.cam->speed);
        } else {
            angles.push_back(second[0] / rtol);
            states.push_back(worst);
        }
        if (csv)
            fmt::print(csv, "{},{},{:.6g},{:.3e},{},{},{:.3e},{:.3e},{:.3e},{:.3e},{}\n", s, p.beam.modes, p.cam->speed,
                       rtol, found.impacts.size(), exact.impacts.size(), angle_falls.back(), falls.back(),
                       second[0] / rtol, worst, found.counters.steps);
    }
    print("falling, angle", angle_falls);
    print("falling, state", falls);
    print("the first second, angle", angles);
    print("the first second, state", states);
    fmt::print("{} of {} with another number of impacts\n", others, scenes);
    if (csv) std::fclose(csv);
}
