// A sweep as a scene says it: which keys take which values, what is kept of each motion, where each motion starts.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/sweep/sampling.hpp"

namespace beamcam::scenes {

// A key and its values: a range, a list, or a column of a table. In the key's SI unit.
struct SweptKey {
    std::string key;
    std::optional<double> from, to;  // both ends are values
    std::optional<int> count;
    bool logarithmic = false;
    std::vector<double> values;
    std::string file, column;
    bool operator==(const SweptKey&) const = default;
};

// A key that takes a random number between two.
struct RandomKey {
    std::string key;
    double from = 0, to = 0;
    bool operator==(const RandomKey&) const = default;
};

enum class SeedKind {
    same,        // each motion starts as the scene says
    carry_up,    // from where that of the value before ended, in the order of the values
    carry_down,  // in the opposite order
    random
};

struct SweepSeeds {
    std::vector<SeedKind> kinds{SeedKind::same};  // one motion each; of `random` so many as `random` says
    int random = 0;
    std::vector<RandomKey> keys;  // none: initial.angle and initial.angular_velocity, see FORMAT.md
    bool operator==(const SweepSeeds&) const = default;
};

struct Sweep {
    std::vector<SweptKey> over;  // one or two
    sim::Sampling sampling;
    SweepSeeds seeds;
    bool operator==(const Sweep&) const = default;
};

// The motions at one value of the keys, in the order of their points.
std::vector<SeedKind> starts_of(const SweepSeeds& seeds);
// Puts the values of the tables that the sweep names in place of them: what is made depends on these. Throws SceneError
// where there is no such column, UnreadableFile, IoError.
void write_out_tables(Sweep& sweep);
std::string text_of_sample(const sim::Sampling& sampling);  // as the key "sample" is written

}  // namespace beamcam::scenes
