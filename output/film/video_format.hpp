// Formats of films: the codecs of each kind of file, and their limits.
//
//   .mp4   h264, av1, hevc  talks, the web; no transparency but hevc's, even sides
//   .webm  vp9, av1         the web; vp9 also with transparency; even sides
//   .mov   prores, h264, hevc   editing; prores (4444) keeps full colour and transparency; hevc for Apple's players,
//                               transparent where libx265 was built with alpha
//   .mkv   ffv1, h264, vp9, av1   ffv1: every bit of every pixel, for archives
//   .gif   gif              256 colours, at most 50 frames a second
//   .apng  apng             every pixel, with transparency; large
//   .webp  webp             animated, with transparency; small
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace beamcam::output {

enum class Codec { h264, hevc, vp9, av1, prores, ffv1, gif, apng, webp };
const char* name(Codec codec);   // "h264"
const char* title(Codec codec);  // "H.264"
std::optional<Codec> codec_named(std::string_view name);

// The default codec of files with this ending (with its dot); nothing: no film has this ending.
std::optional<Codec> default_codec(std::string_view ending);
bool goes_into(Codec codec, std::string_view ending);

struct QualityScale {
    int usual, worst;  // crf: 0 is best
};
std::optional<QualityScale> quality_scale(Codec codec);  // absent: the codec has no crf

// Why such a film is not possible, with a remedy; empty: it is possible. `ending` with the dot.
std::string format_problem(std::string_view ending, Codec codec, bool transparent);
std::string size_problem(Codec codec, int width, int height);
std::string rate_problem(Codec codec, double fps);

}  // namespace beamcam::output
