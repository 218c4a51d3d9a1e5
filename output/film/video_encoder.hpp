// The encoder of a film, opened with the options of the film.
#pragma once

#include <filesystem>
#include <memory>

#include "output/files/atomic_file.hpp"
#include "output/film/pixel_layout.hpp"
#include "output/film/video.hpp"
#include "output/film/video_library.hpp"

namespace beamcam::output {

struct OpenedEncoder {
    std::unique_ptr<Encoder> encoder;
    PixelLayout layout;  // of its frames
};

// Throws IoError, UnsupportedOption.
OpenedEncoder open_encoder(const VideoOptions& options, const AtomicFile& file);

}  // namespace beamcam::output
