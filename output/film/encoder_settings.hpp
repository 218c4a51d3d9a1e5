// Settings of FFmpeg for each kind of film, and its encoder, opened with them.
#pragma once

#include <filesystem>
#include <memory>

#include "output/files/atomic_file.hpp"
#include "output/film/video.hpp"
#include "output/film/video_library.hpp"

namespace beamcam::output {

EncoderSettings encoder_settings(const VideoOptions& options, const AtomicFile& file);
// Throws IoError, UnsupportedOption.
std::unique_ptr<Encoder> open_encoder(const EncoderSettings& settings, const VideoOptions& options);

}  // namespace beamcam::output
