// Settings of FFmpeg for each kind of film: container, encoder, pixel format and options.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "output/film/pixel_layout.hpp"
#include "output/film/video.hpp"
#include "output/film/video_library.hpp"

namespace beamcam::output {

struct EncoderRecipe {
    const char* container;
    std::vector<std::string> encoders;
    const char* pixel_format;
    PixelLayout layout;
    OptionList encoder_options, container_options;
    std::string missing;  // message if FFmpeg has none of the encoders
};

// `ending`: of the file, ".mp4".
const char* container_of(std::string_view ending);
EncoderRecipe encoder_recipe(const VideoOptions& options, const std::string& ending);

}  // namespace beamcam::output
