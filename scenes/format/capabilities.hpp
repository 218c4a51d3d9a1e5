// Words that people try and that this version does not have, with what to write instead.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace beamcam::scenes {

// A sentence for the user; nothing when nobody is expected to try `what`. `where`: the path of the key whose value it
// is, as "outputs.type".
std::optional<std::string> not_available(std::string_view where, std::string_view what);

}  // namespace beamcam::scenes
