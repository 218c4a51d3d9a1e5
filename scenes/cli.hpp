// The command line: arguments in, exit code out.
#pragma once

namespace beamcam::scenes {

// What scripts rely on.
enum ExitCode {
    kDone = 0,
    kBug = 1,
    kUsage = 2,
    kBadScene = 3,
    kSolverFailed = 4,
    kMissingPart = 5,  // renderer, codec or font
    kInputOutput = 6,
    kDiffers = 7,
    kInterrupted = 130
};

// Never throws: every failure becomes a message on standard error and its code.
int command_line(int argc, const char* const* argv);

}  // namespace beamcam::scenes
