// What the scene format and the command line name but this version cannot do yet.
//
// The only place that knows: everything else asks here, so that nothing is ignored silently and a
// feature becomes available by removing its line.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace beamcam::scenes {

// `what` is a key or value, `where` the key that would hold it: ("outputs.type", "figure"),
// ("outputs", "speed"), ("command", "modes"). Gives the refusal in words, or nothing when no such
// thing is planned.
std::optional<std::string> not_available(std::string_view where, std::string_view what);

std::vector<std::string> planned_commands();

}  // namespace beamcam::scenes
