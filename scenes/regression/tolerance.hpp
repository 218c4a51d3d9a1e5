// How far pictures and motions may be from the accepted ones.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenes/format/keys.hpp"

namespace beamcam::scenes {

// Differences that count as "equivalent". Absent: the entry's default.
struct Tolerance {
    std::optional<int> channel;  // of a pixel's channel, 0…255; default 0 for flat views and figures, 2 for lit views
    std::optional<double> share;    // of the pixels that may differ by more, 0…1; default 0
    std::optional<double> ssim;     // least structural similarity of equivalent pictures, 0…1; default: none
    std::optional<double> motion;   // share of a channel's range, up to the reproducible horizon; default 2e-5
    std::optional<double> impacts;  // share of an impact's quantities; of a millisecond for its times; default 1e-4

    // The values of `over`; where it has none, the values of this.
    Tolerance overridden_by(const Tolerance& over) const;
};

struct Tolerances {
    Tolerance common;
    std::map<std::string, Tolerance> by_renderer;  // by the ids of renderers

    // `over` takes precedence over this, and in each a renderer's tolerance over the common one.
    Tolerances overridden_by(const Tolerances& over) const;
    const Tolerance& of(const std::string& renderer) const;
};

void visit(SceneVisitor& v, Tolerance& tolerance);  // of pictures
void visit(SceneVisitor& v, Tolerances& tolerances);

// The tolerance that `key=value` texts of --tolerance give. Throws UsageError.
Tolerance tolerance_argument(const std::vector<std::string>& texts);

}  // namespace beamcam::scenes
