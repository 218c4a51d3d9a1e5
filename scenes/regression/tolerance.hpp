// How far pictures and motions may be from the references.
#pragma once

#include <optional>

#include "scenes/format/keys.hpp"

namespace beamcam::scenes {

// Differences that count as "equivalent". Absent: the entry's default.
struct Tolerance {
    std::optional<int> channel;  // of a pixel's channel, 0…255; default 0 for flat views and figures, 2 for lit views
    std::optional<double> share;    // of the pixels that may differ by more, 0…1; default 0
    std::optional<double> ssim;     // least structural similarity of equivalent pictures, 0…1; default: none
    std::optional<double> motion;   // share of a channel's range, up to the reproducible horizon; default 2e-5
    std::optional<double> impacts;  // relative, of an impact's numbers; default 1e-4

    // The values of `over`; where it has none, the values of this.
    Tolerance overridden_by(const Tolerance& over) const {
        return {over.channel ? over.channel : channel, over.share ? over.share : share, over.ssim ? over.ssim : ssim,
                over.motion ? over.motion : motion, over.impacts ? over.impacts : impacts};
    }
};

void visit(SceneVisitor& v, Tolerance& tolerance);

}  // namespace beamcam::scenes
