// Films as pixels, decoded by FFmpeg's libraries: MP4, WebM, GIF, APNG and whatever else they know.
//
// The colours are those of
//     ffmpeg -i FILM -sws_flags bicubic+accurate_rnd+full_chroma_int+bitexact -pix_fmt rgba -f framehash -hash sha256 -
// so that anyone can check a digest. A film that is damaged or ends early is an error, not a shorter film.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "output/errors.hpp"
#include "output/raster.hpp"

namespace beamcam::output {

struct VideoFacts {
    int width = 0, height = 0;  // [px]
    long frames = 0;            // as the file says; 0: it does not
    double seconds = 0;         // as the file says; 0: it does not
    std::string codec, container;
    std::map<std::string, std::string> metadata;

    bool is_still() const { return container.ends_with("_pipe") && container != "webp_pipe"; }
};

class VideoReader {
  public:
    // Throws IoError, MissingCodec.
    explicit VideoReader(const std::filesystem::path& file);
    ~VideoReader();
    VideoReader(const VideoReader&) = delete;
    VideoReader& operator=(const VideoReader&) = delete;

    const VideoFacts& facts() const;
    bool next(Raster& picture);  // false after the last; throws IoError

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

// What the FFmpeg libraries of this machine can do. Throws MissingCodec.
struct VideoAbilities {
    std::string versions;                  // "libavcodec 59.37.100, …"
    std::map<std::string, bool> encoders;  // of those that beamcam's outputs use
};
VideoAbilities video_abilities();

}  // namespace beamcam::output
