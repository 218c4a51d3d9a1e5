// Work that a foreign library may crash in, done in a child process.
#pragma once

#include <functional>
#include <string>

namespace beamcam::scenes {

// What `work` returns. Throws std::runtime_error with what it threw, or with the signal that ended it. Only while the
// process has one thread.
std::string in_child(const std::function<std::string()>& work);

}  // namespace beamcam::scenes
