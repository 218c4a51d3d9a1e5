// Settings of FFmpeg for each kind of film: container, encoder, pixel format and options.
#pragma once

#include <string>
#include <string_view>

#include "output/film/pixel_layout.hpp"
#include "output/film/video.hpp"
#include "output/film/video_library.hpp"

namespace beamcam::output {

// The recipe has neither the names of the file nor the palette.
struct EncoderRecipe : EncoderSettings {
    PixelLayout layout = PixelLayout::yuv420;
};

// `ending`: of the file, ".mp4".
const char* container_of(std::string_view ending);
EncoderRecipe encoder_recipe(const VideoOptions& options, const std::string& ending);

}  // namespace beamcam::output
