// Formats of films: the codecs of each kind of file, their settings and limits.
//
//   .mp4   h264              talks, the web; no transparency, even sides
//   .webm  vp9               the web; also with transparency; even sides
//   .mov   prores, h264      editing; prores (4444) keeps full colour and transparency
//   .mkv   ffv1, h264, vp9   ffv1: every bit of every pixel, for archives
//   .gif   gif               256 colours, at most 50 frames a second
//   .webp  webp              animated, with transparency; small
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace beamcam::output {

enum class Codec { h264, vp9, prores, ffv1, gif, webp };
const char* name(Codec codec);          // "h264"
const char* title(Codec codec);         // "H.264"
const char* encoder_name(Codec codec);  // FFmpeg's: "libx264"

// The default codec of files with this ending (with its dot); nothing: no film has this ending.
std::optional<Codec> default_codec(std::string_view ending);
bool goes_into(Codec codec, std::string_view ending);

inline constexpr double kSlowestRate = 0.1, kFastestRate = 1000;  // [Hz]; players fail long before

// Frames per second as a fraction: 29.97 means 30000/1001.
struct FrameRate {
    int numerator = 60, denominator = 1;  // both > 0, in lowest terms
    double value() const { return static_cast<double>(numerator) / denominator; }
    bool operator==(const FrameRate&) const = default;
};
// The broadcast rates n·1000/1001 for their usual decimals, otherwise the nearest fraction with a denominator up to
// 1000.
FrameRate frame_rate(double fps);  // 0.1…1000

// How the pictures of a film are encoded.
struct Encoding {
    Codec codec = Codec::h264;
    std::optional<int> crf;           // 0 (large, nearly perfect) … the codec's worst; absent: its usual one
    std::string preset = "veryfast";  // x264's
    // Variable frame rate: a repeated picture is encoded once and shown longer, for up to 5 s; then, and at the end of
    // the film, it is encoded again.
    bool variable_rate = false;
};

// The settings of a film.
struct VideoOptions : Encoding {
    int width = 1920, height = 1080;  // [px], 16…16384; even where the codec needs it
    FrameRate fps;
    std::map<std::string, std::string> metadata;
    bool transparent = false;            // with the alpha of the pictures
    std::vector<std::uint32_t> palette;  // of a GIF: 1 to 256 colours from PaletteMaker, 0xffRRGGBB
};

struct QualityScale {
    int usual, worst;  // crf: 0 is best
};
std::optional<QualityScale> quality_scale(Codec codec);  // absent: the codec has no crf

// Why such a film is not possible although its size and rate are within the limits of all films, with a remedy; empty:
// it is possible. `ending` with the dot.
std::string format_problem(std::string_view ending, Codec codec, bool transparent);
std::string quality_problem(Codec codec, std::optional<int> crf);
std::string size_problem(Codec codec, int width, int height);
std::string rate_problem(Codec codec, double fps);

}  // namespace beamcam::output
