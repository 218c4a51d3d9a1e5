// Settings of FFmpeg for each kind of film: container, encoder, pixel format and options.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "output/film/pixel_layout.hpp"
#include "output/film/video.hpp"
#include "output/film/video_library.hpp"

namespace beamcam::output {

// Without the names of the file and without the palette.
struct EncoderRecipe : EncoderSettings {
    PixelLayout layout = PixelLayout::yuv420;
};

// An encoder of the FFmpeg on this machine.
struct AvailableEncoder {
    std::string name;
    std::vector<std::string> pixel_formats;  // empty: unknown
};
// The first of the names that is available and takes these pixels: builds of libx265 differ in alpha. Null: none.
inline const AvailableEncoder* chosen_encoder(const std::vector<std::string>& names, const std::string& pixel_format,
                                              const std::vector<AvailableEncoder>& available) {
    for (const std::string& name : names)
        for (const AvailableEncoder& each : available)
            if (each.name == name &&
                (each.pixel_formats.empty() || std::ranges::count(each.pixel_formats, pixel_format)))
                return &each;
    return nullptr;
}

// `ending`: of the file, ".mp4".
const char* container_of(std::string_view ending);
EncoderRecipe encoder_recipe(const VideoOptions& options, const std::string& ending);

}  // namespace beamcam::output
