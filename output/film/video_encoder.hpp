// The encoder of a film, opened where there are memory and threads for it.
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

// Throws IoError, UnsupportedOption, std::bad_alloc.
OpenedEncoder open_encoder(const VideoOptions& options, const AtomicFile& file);

IoError no_encoder_thread(const std::filesystem::path& film);

}  // namespace beamcam::output
