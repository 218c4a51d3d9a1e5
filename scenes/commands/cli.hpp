// The command line: arguments in, exit code out.
#pragma once

namespace beamcam::scenes {

// Never throws: every failure becomes a message on standard error and its code.
int command_line(int argc, const char* const* argv);

}  // namespace beamcam::scenes
