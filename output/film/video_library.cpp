#include "output/film/video_library.hpp"

#include <utility>

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
    constexpr std::pair<const char*, const char*> kEncoders[] = {{"H.264 (libx264)", "libx264"},
                                                                 {"VP9 (libvpx)", "libvpx-vp9"},
                                                                 {"ProRes", "prores_ks"},
                                                                 {"FFV1", "ffv1"},
                                                                 {"GIF", "gif"},
                                                                 {"WebP (libwebp)", "libwebp_anim"}};
    for (const auto& [name, encoder] : kEncoders) found.encoders[name] = library.has_encoder(encoder);
    return found;
}

}  // namespace beamcam::output
