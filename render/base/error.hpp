// Errors of drawing, grouped by what the user can do about them. Messages name the remedy.
#pragma once

#include <stdexcept>

namespace beamcam::render {

// A renderer, codec, font or library is missing on this machine (exit code 5).
struct MissingPart : std::runtime_error {
    using std::runtime_error::runtime_error;
};
struct FontError : MissingPart {
    using MissingPart::MissingPart;
};
struct GlError : MissingPart {
    using MissingPart::MissingPart;
};

// The requested picture is impossible, for example of an invalid size or without frames (exit code 3).
struct PictureError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

}  // namespace beamcam::render
