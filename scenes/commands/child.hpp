// Runs work in a child process, because a library may crash in it.
#pragma once

#include <functional>
#include <string>

namespace beamcam::scenes {

// Returns the result of `work`. Throws std::runtime_error with the message of its exception, or with the signal that
// ended it. Only while the process has one thread.
std::string in_child(const std::function<std::string()>& work);

}  // namespace beamcam::scenes
