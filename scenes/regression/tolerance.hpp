// How far pictures and motions may be from what is expected.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "scenes/format/object_reader.hpp"

namespace beamcam::scenes {

// What is still "equivalent". Absent: the entry's default.
struct Tolerance {
    std::optional<int> channel;     // of a pixel, 0…255; default 0 for flat views and figures, 2 for lit views
    std::optional<double> share;    // of the pixels that may differ by more, 0…1; default 0
    std::optional<double> ssim;     // or pictures that are at least so similar, 0…1; default: none
    std::optional<double> motion;   // of a channel's range, up to the reproducible horizon; default 2e-5
    std::optional<double> impacts;  // of an impact's quantities; its times to that share of a millisecond; default 1e-4

    // `over`, where it says something, else this.
    Tolerance overridden_by(const Tolerance& over) const;
};

// With others on some renderers, by their ids.
struct Tolerances {
    Tolerance usual;
    std::map<std::string, Tolerance> on;

    // `over` says more than this does, and what either says of a renderer more than what it says of all.
    Tolerances overridden_by(const Tolerances& over) const;
    const Tolerance& on_renderer(const std::string& renderer) const;
};

// The object `node`, which stands at `path`.
void read_tolerances(Diagnostics& diagnostics, const Node& node, const std::string& path, Tolerances& tolerances);

// `key=value` of --tolerance. Throws UsageError.
void apply_tolerance(Tolerance& tolerance, const std::string& text);

}  // namespace beamcam::scenes
