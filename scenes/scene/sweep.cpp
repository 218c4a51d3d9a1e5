#include "scenes/scene/sweep.hpp"

namespace beamcam::scenes {

constexpr double kRandomAngle = 0.3, kRandomRate = 1;  // [rad], [rad/s]

std::vector<RandomKey> random_keys(const Sweep& sweep, const sim::Problem& problem) {
    if (!sweep.seeds.keys.empty()) return sweep.seeds.keys;
    const double angle = problem.initial.angle;
    return {{"initial.angle", angle, angle + kRandomAngle}, {"initial.angular_velocity", -kRandomRate, kRandomRate}};
}

std::vector<SeedKind> starts_of(const SweepSeeds& seeds) {
    std::vector<SeedKind> all;
    for (const SeedKind kind : seeds.kinds)
        all.insert(all.end(), kind == SeedKind::random ? static_cast<std::size_t>(seeds.random) : 1, kind);
    return all;
}

}  // namespace beamcam::scenes
