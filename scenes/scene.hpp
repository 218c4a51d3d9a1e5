// What a scene says, resolved: every default filled in, every unit turned into SI.
//
// Plain values; nothing here reads, checks or runs. The format is described, key by key, in
// beamcam-scene.schema.json; `reader.hpp` makes a Scene from a file.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "render/film.hpp"
#include "sim/channels.hpp"
#include "sim/problem.hpp"

namespace beamcam::scenes {

// Frames a second as a fraction, so that 30000/1001 stays exact.
struct FrameRate {
    int numerator = 60, denominator = 1;  // both > 0, in lowest terms

    double value() const { return static_cast<double>(numerator) / denominator; }
    bool operator==(const FrameRate&) const = default;
};

struct Size {
    int width = 1920, height = 1080;  // [px]
    bool operator==(const Size&) const = default;
};

// How x264 is asked to encode.
struct Encoding {
    int crf = 18;                     // 0 (lossless) … 51
    std::string preset = "veryfast";  // of x264
};

// Pictures of the instants k / fps with from <= k/fps < to, by rounded frame numbers.
struct FrameSpan {
    FrameRate fps;
    double from = 0;           // [s], >= 0
    std::optional<double> to;  // [s], > from; absent: the end of the scene
};

struct VideoOutput {
    std::string file;  // relative to the output directory, as in every output
    Size size;
    render::View view;
    FrameSpan span;
    Encoding encoding;
};
struct FramesOutput {
    std::string file;  // with one run of '#', replaced by the frame number
    Size size;
    render::View view;
    FrameSpan span;
};
struct StillOutput {
    std::string file;
    Size size;
    render::View view;
    double at = 0;  // [s], >= 0
};
struct TrajectoryOutput {
    std::string file;                    // .csv or .npz
    std::vector<sim::Channel> channels;  // in this order; the time comes first in any case
    double rate = 1000;                  // [Hz], rows k/rate and the end; unless there are times
    std::vector<double> times;           // [s], rows in this order
};
struct ImpactsOutput {
    std::string file;  // .json or .csv
};
struct SummaryOutput {
    std::string file;  // .json
    bool horizon = false;
};
using Output = std::variant<VideoOutput, FramesOutput, StillOutput, TrajectoryOutput, ImpactsOutput, SummaryOutput>;

const std::string& file_of(const Output& output);
const char* type_name(const Output& output);  // "video", "frames", …

struct Scene {
    std::string name = "scene";  // the file's name without its ending
    std::string title;
    sim::Problem problem;
    double end_time = 1.5;  // [s], > 0
    std::vector<Output> outputs;
};

// The film that a scene without outputs yields.
VideoOutput default_film(const Scene& scene);

// The scene as JSON text in the scene format, every default written out: it reads back to the same
// scene, and goes into the metadata of what was made from it. Without `outputs`: physics only.
std::string to_json(const Scene& scene);

}  // namespace beamcam::scenes
