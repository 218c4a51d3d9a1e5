// Interface of the module that links FFmpeg (beamcam_video.so, from output/film/ffmpeg/): encoders, and the facts that
// films state about themselves. It is loaded at its first use.
//
// All functions throw the errors of errors.hpp, CodecFailure, or std::bad_alloc.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>

#include "output/files/errors.hpp"
#include "output/film/video_format.hpp"

namespace beamcam::output {

// FFmpeg failed for a reason that beamcam does not check.
struct CodecFailure : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// How the pixels of a frame lie in its planes.
enum class PixelLayout { yuv420, yuva420, yuva444p10, bgra, indices };

// The planes of a frame that the caller fills; unused planes are null.
struct FramePlanes {
    std::uint8_t* plane[4] = {};
    std::ptrdiff_t stride[4] = {};  // [bytes]
};

class Encoder {
  public:
    virtual ~Encoder() = default;  // also without `finish`
    virtual PixelLayout layout() const = 0;
    // A new frame, which belongs to the encoder. From any thread, one at a time.
    virtual FramePlanes& make_frame() = 0;
    // Adds the frame to the film; afterwards the caller may change it again.
    virtual void encode(FramePlanes& frame) = 0;
    // Shows the last added frame for this number of frames longer.
    virtual void hold(std::int64_t frames) = 0;
    virtual void finish() = 0;
};

// The facts that a film states about itself.
struct VideoInfo {
    int width = 0, height = 0;  // [px]
    long frames = 0;            // 0: not stated
    double seconds = 0;         // 0: not stated
    std::string codec;
    std::map<std::string, std::string> metadata;
};

class VideoLibrary {
  public:
    virtual ~VideoLibrary() = default;
    // `file` exists and is overwritten; messages call it `named`, whose ending chooses the container.
    virtual std::unique_ptr<Encoder> open_encoder(const VideoOptions& options, const std::filesystem::path& file,
                                                  const std::filesystem::path& named) const = 0;
    // From the container of an MP4, MOV, Matroska or WebM file, without decoding. Throws IoError.
    virtual VideoInfo info(const std::filesystem::path& file) const = 0;
    virtual std::string versions() const = 0;                     // "libavcodec 59.37.100, …"
    virtual bool has_encoder(const std::string& name) const = 0;  // by FFmpeg's name
};

// Throws MissingCodec with every place that was searched.
const VideoLibrary& video_library();

// Versions and encoders of the FFmpeg libraries of this machine. Throws MissingCodec.
struct VideoCapabilities {
    std::string versions;                  // "libavcodec 59.37.100, …"
    std::map<std::string, bool> encoders;  // whether each encoder that beamcam uses exists
};
VideoCapabilities video_capabilities();

}  // namespace beamcam::output
