// Interface of the module that links FFmpeg (beamcam_video.so, from output/film/ffmpeg/): encoders, decoders, and
// joining of films packet by packet. It is loaded at its first use.
//
// All functions throw the errors of errors.hpp, CodecFailure, or std::bad_alloc.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "output/files/errors.hpp"
#include "output/film/video_format.hpp"

namespace beamcam::output {

// FFmpeg failed for a reason that beamcam does not check.
struct CodecFailure : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// Segments that cannot be joined: not films, different codecs, sizes, rates, settings or scenes, or a wrong order.
struct Mismatch : IoError {
    using IoError::IoError;
};

using OptionList = std::vector<std::pair<std::string, std::string>>;

struct Chapter {
    double from = 0, to = 0;  // of the film [s]
    std::string title;
};

// Of a film, and of its encoder.
struct FilmSettings {
    int width = 1920, height = 1080;  // [px], 16…16384; even where the codec needs it
    FrameRate fps;
    std::map<std::string, std::string> metadata;
    std::vector<Chapter> chapters;          // in increasing order; containers without chapters ignore them
    std::vector<Chapter> subtitles;         // in increasing order, apart; in .mp4, .mov, .mkv and .webm
    std::string subtitle_language = "eng";  // ISO 639-2
};

struct EncoderSettings : FilmSettings {
    std::filesystem::path file;                             // exists; it is overwritten
    std::filesystem::path named;                            // its name in messages
    std::string container;                                  // FFmpeg's name of the muxer
    std::vector<std::string> encoders;                      // FFmpeg's names; the first that exists is used
    std::string pixel_format;                               // FFmpeg's name
    OptionList encoder_options;                             // keys "x:name" are for encoder x alone
    OptionList container_options;                           //
    std::string missing;                                    // message if none of these encoders exists
    std::optional<std::array<std::uint32_t, 256>> palette;  // 0xAARRGGBB, for "pal8"
};

// The planes of a frame that the caller fills; unused planes are null.
struct FramePlanes {
    std::uint8_t* plane[4] = {};
    std::ptrdiff_t stride[4] = {};  // [bytes]
};

class Encoder {
  public:
    virtual ~Encoder() = default;  // also without `finish`
    // A new frame, which belongs to the encoder. From any thread, one at a time.
    virtual FramePlanes& make_frame() = 0;
    // Adds the frame to the film; afterwards the caller may change it again.
    virtual void encode(FramePlanes& frame) = 0;
    // Shows the last added frame for this number of frames longer.
    virtual void hold(std::int64_t frames) = 0;
    virtual void finish() = 0;
};

struct VideoInfo {
    int width = 0, height = 0;  // [px]
    long frames = 0;            // as stated in the file; 0: not stated
    double seconds = 0;         // as stated in the file; 0: not stated
    std::string codec, container;
    std::map<std::string, std::string> metadata;

    bool is_still() const { return container.ends_with("_pipe") && container != "webp_pipe"; }
};

class Decoder {
  public:
    virtual ~Decoder() = default;
    virtual const VideoInfo& info() const = 0;
    // The next picture as 4·width·height bytes R, G, B, A; null: it is decoded only. False after the last.
    virtual bool next(std::uint8_t* rgba) = 0;
};

class VideoLibrary {
  public:
    virtual ~VideoLibrary() = default;
    virtual std::unique_ptr<Encoder> open_encoder(const EncoderSettings& settings) const = 0;
    virtual std::unique_ptr<Decoder> open_decoder(const std::filesystem::path& file) const = 0;
    // Joins films without encoding them again. `file` exists and is overwritten; its name in messages is `named`.
    // Returns the number of frames.
    virtual std::int64_t concatenate(const std::vector<std::filesystem::path>& segments,
                                     const std::filesystem::path& file, const std::filesystem::path& named,
                                     const std::string& container) const = 0;
    virtual std::string versions() const = 0;                     // "libavcodec 59.37.100, …"
    virtual bool has_encoder(const std::string& name) const = 0;  // by FFmpeg's name
};

// Throws MissingCodec with every place that was searched.
const VideoLibrary& video_library();

}  // namespace beamcam::output
