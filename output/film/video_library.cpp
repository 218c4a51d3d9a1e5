#include "output/film/video_library.hpp"

#include "render/base/modules.hpp"

namespace beamcam::output {

const VideoLibrary& video_library() {
    try {
        static const auto* const library = static_cast<const VideoLibrary*>(render::load_module("beamcam_video.so"));
        return *library;
    } catch (const render::ModuleError& error) {
        throw MissingCodec(std::string("films need FFmpeg's libraries (Debian: libavcodec59 or newer): ") +
                           error.what());
    }
}

VideoCapabilities video_capabilities() {
    const VideoLibrary& library = video_library();
    VideoCapabilities found{library.versions(), {}};
    for (const Codec codec : {Codec::h264, Codec::vp9, Codec::prores, Codec::ffv1, Codec::gif, Codec::webp})
        found.encoders[title(codec)] = library.has_encoder(encoder_name(codec));
    return found;
}

}  // namespace beamcam::output
