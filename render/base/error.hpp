// What can go wrong with pictures, by what the user can do about it. Messages name the remedy.
#pragma once

#include <stdexcept>
#include <string>

namespace beamcam::render {

// A part that this machine lacks: a renderer, a codec or a font (exit code 5).
struct MissingPart : std::runtime_error {
    using std::runtime_error::runtime_error;
};
struct FontError : MissingPart {
    using MissingPart::MissingPart;
};
struct GlError : MissingPart {
    using MissingPart::MissingPart;
};

// A picture that cannot be drawn as asked: no frames, an impossible size (exit code 3).
struct PictureError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// A library needs threads that cannot start (exit code 6).
struct ThreadError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

}  // namespace beamcam::render
