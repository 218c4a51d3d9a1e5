// Exit codes, and the errors that end the program before any work.
#pragma once

#include <stdexcept>

namespace beamcam::scenes {

// Part of the contract with scripts.
enum ExitCode {
    kDone = 0,
    kBug = 1,
    kUsage = 2,
    kBadScene = 3,
    kSolverFailed = 4,
    kMissingPart = 5,
    kInputOutput = 6,
    kDiffers = 7,
    kInterrupted = 130,
    kReaderEnded = 141  // output::print_data
};
// Their meanings in the help text.
struct ExitMeaning {
    ExitCode code;
    const char* meaning;
};
inline constexpr ExitMeaning kExitCodes[] = {
    {kDone, "done"},
    {kBug, "bug"},
    {kUsage, "usage"},
    {kBadScene, "scene"},
    {kSolverFailed, "solver"},
    {kMissingPart, "missing renderer, codec, font or library"},
    {kInputOutput, "input/output"},
    {kDiffers, "differs"},
    {kInterrupted, "interrupted"},
    {kReaderEnded, "the reader of standard output has ended"},
};

// Exit code 2.
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};
// Exit code 3. The text contains one or more complete messages.
struct SceneError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

}  // namespace beamcam::scenes
