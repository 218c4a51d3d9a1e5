// Decodes films by FFmpeg's libraries: MP4, WebM, GIF, APNG and others. The colours are those of
//     ffmpeg -i FILM -sws_flags bicubic+accurate_rnd+full_chroma_int+bitexact -pix_fmt rgba -f framehash -hash sha256 -
// so that FFmpeg can verify a digest. A damaged or truncated film is an error, not a shorter film.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "output/film/video_library.hpp"
#include "output/image/raster.hpp"

namespace beamcam::output {

class VideoReader {
  public:
    // Throws IoError, MissingCodec.
    explicit VideoReader(const std::filesystem::path& file);

    const VideoInfo& info() const { return decoder_->info(); }
    bool next(Raster& picture);  // false after the last; throws IoError
    bool skip();                 // the same without converting the picture

  private:
    bool decode(std::uint8_t* rgba);

    std::filesystem::path file_;
    std::unique_ptr<Decoder> decoder_;
    long read_ = 0;
};

// Versions and encoders of the FFmpeg libraries of this machine. Throws MissingCodec.
struct VideoCapabilities {
    std::string versions;                  // "libavcodec 59.37.100, …"
    std::map<std::string, bool> encoders;  // whether each encoder that beamcam uses exists
};
VideoCapabilities video_capabilities();

}  // namespace beamcam::output
