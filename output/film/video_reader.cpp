#include "output/film/video_reader.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace beamcam::output {

VideoReader::VideoReader(const std::filesystem::path& file)
    : file_(file), decoder_(video_library().open_decoder(file)) {
    const VideoInfo& found = info();
    if (found.width <= kLargestSide && found.height <= kLargestSide) return;
    throw IoError("cannot read " + file.string() + ": " + std::to_string(found.width) + "x" +
                  std::to_string(found.height) + " pixels are more than the " + std::to_string(kLargestSide) + "x" +
                  std::to_string(kLargestSide) + " that beamcam handles");
}

bool VideoReader::next(Raster& picture) {
    picture.resize(info().width, info().height);
    return decode(picture.rgba.data());
}

bool VideoReader::skip() { return decode(nullptr); }

bool VideoReader::decode(std::uint8_t* rgba) {
    if (decoder_->next(rgba)) {
        ++read_;
        return true;
    }
    if (read_ == 0 || read_ < info().frames)
        throw IoError("cannot read " + file_.string() + ": the film ends after " + std::to_string(read_) + " of its " +
                      std::to_string(info().frames) + " frames; make or copy it again");
    return false;
}

VideoCapabilities video_capabilities() {
    const VideoLibrary& library = video_library();
    VideoCapabilities found{library.versions(), {}};
    const std::pair<const char*, std::vector<const char*>> encoders[] = {
        {"H.264 (libx264)", {"libx264"}},
        {"HEVC (libx265)", {"libx265"}},
        {"VP9 (libvpx)", {"libvpx-vp9"}},
        {"AV1 (libsvtav1, libaom)", {"libsvtav1", "libaom-av1"}},
        {"ProRes", {"prores_ks"}},
        {"FFV1", {"ffv1"}},
        {"GIF", {"gif"}},
        {"APNG", {"apng"}}};
    for (const auto& [name, any] : encoders)
        found.encoders[name] =
            std::ranges::any_of(any, [&](const char* encoder) { return library.has_encoder(encoder); });
    return found;
}

}  // namespace beamcam::output
