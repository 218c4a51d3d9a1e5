// Errors of files. Each message names the file and the remedy; the command line maps each type to its exit code.
#pragma once

#include <filesystem>
#include <stdexcept>

namespace beamcam::output {

// A file could not be read or written: full disk, missing directory, no permission.   Exit code 6.
struct IoError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// An existing file would be replaced that beamcam did not make, or that was changed afterwards.   Exit code 6.
struct WouldOverwrite : IoError {
    using IoError::IoError;
};

// The video module or an encoder is not installed.   Exit code 5.
struct MissingCodec : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// The scene requires something that a writer cannot do, such as a film of odd size.   Exit code 3.
struct UnsupportedOption : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// "cannot write out/fall.mp4: No space left on device; free some space or …" from an errno value.
IoError write_error(const std::filesystem::path& file, int error_number);
// "cannot read film.mp4: No such file or directory; correct its name, or …".
IoError read_error(const std::filesystem::path& file, int error_number);
// The error of the standard library, with its path and cause.
IoError io_error(const std::filesystem::filesystem_error& error);

}  // namespace beamcam::output
