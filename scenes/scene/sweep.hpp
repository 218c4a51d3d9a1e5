// A sweep: the keys and their values, the samples of each motion, and the start of each motion.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/base/named.hpp"
#include "sim/sweep/sampling.hpp"

namespace beamcam::scenes {

// A key and its values in SI units: a range or a list.
struct SweptKey {
    std::string key;
    std::optional<double> from, to;  // both ends are values
    std::optional<int> count;
    bool logarithmic = false;
    std::vector<double> values;
    bool operator==(const SweptKey&) const = default;
};

// A key with a random value between two bounds.
struct RandomKey {
    std::string key;
    double from = 0, to = 0;
    bool operator==(const RandomKey&) const = default;
};

enum class SeedKind {
    same,        // the initial state of the scene
    carry_up,    // the end of the motion at the previous value, in increasing order
    carry_down,  // the same in decreasing order
    random
};
constexpr sim::Named<SeedKind> kSeedKinds[] = {{SeedKind::same, "same"},
                                               {SeedKind::carry_up, "carry-up"},
                                               {SeedKind::carry_down, "carry-down"},
                                               {SeedKind::random, "random"}};
inline std::span<const sim::Named<SeedKind>> names(SeedKind) { return kSeedKinds; }
using sim::name;

struct SweepSeeds {
    std::vector<SeedKind> kinds{SeedKind::same};  // one motion each; `random` motions for SeedKind::random
    int random = 0;
    std::vector<RandomKey> keys;  // empty: those of `random_keys`
    bool operator==(const SweepSeeds&) const = default;
};

struct Sweep {
    std::vector<SweptKey> over;  // one or two
    sim::Sampling sampling;
    SweepSeeds seeds;
    bool operator==(const Sweep&) const = default;
};

// The keys that random starts vary: by default initial.angle and initial.angular_velocity, as FORMAT.md says.
std::vector<RandomKey> random_keys(const Sweep& sweep, const sim::Problem& problem);
// The starts at one value of the keys, in the order of their points.
std::vector<SeedKind> starts_of(const SweepSeeds& seeds);

}  // namespace beamcam::scenes
