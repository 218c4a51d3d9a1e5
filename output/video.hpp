// A film: H.264 in MP4, 4:2:0, tagged BT.709, index first. Pictures are converted where `write` is called and
// encoded in a thread of the writer's own, so that encoding overlaps drawing; the order is kept.
//
// The same pictures and options give the same bytes on every machine with the same x264.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "output/errors.hpp"
#include "render/image.hpp"

namespace beamcam::output {

// Frames per second as films state it: 29.97 means 30000/1001.
struct FrameRate {
    int rate = 60, base = 1;  // rate / base
    double value() const { return double(rate) / base; }
    double time_of(long frame) const { return double(frame) * base / rate; }  // [s]
    bool operator==(const FrameRate&) const = default;
};
// The broadcast rates n·1000/1001 for what their usual two to four decimals say, otherwise the nearest fraction with
// base up to 1000. Throws UnsupportedOption outside 0.1…1000.
FrameRate frame_rate(double fps);

struct VideoOptions {
    int width = 1920, height = 1080;  // [px], even, 16…16384
    double fps = 60;                  // [1/s]
    std::string codec = "h264";       // the only one so far
    int crf = 18;                     // 0 (large, nearly perfect) … 51
    std::string preset = "veryfast";  // x264's, ultrafast … placebo
    int threads = 4;  // 1…4 of the encoder. Beyond 4 its bits depend on the number, and the default is
                      // the same on every machine for that reason.
    std::map<std::string, std::string> metadata;
};
// Everything about these options that a film cannot do, in words with the alternative.
std::vector<std::string> problems(const VideoOptions& options);

// What a film has cost so far, for progress lines and -v.
struct VideoStatistics {
    long frames = 0;             // encoded
    double convert_seconds = 0;  // picture to film colours, in the thread that calls `write`
    double encode_seconds = 0;   // inside the encoder, in the writer's thread
    double wait_seconds = 0;     // `write` waiting for the encoder
};

class VideoWriter {
  public:
    // Throws UnsupportedOption, MissingCodec, IoError.
    VideoWriter(const std::filesystem::path& file, const VideoOptions& options);
    // Without `finish` the film is dropped and nothing is left of it.
    ~VideoWriter();
    VideoWriter(const VideoWriter&) = delete;
    VideoWriter& operator=(const VideoWriter&) = delete;

    // The next picture; waits when the encoder is a few pictures behind. Transparent pixels show over black.
    void write(const render::Image& image);
    // The picture before, once more, without converting it again. Not the first.
    void repeat();
    // Encodes what is left and puts the film in its place.
    void finish();

    VideoStatistics statistics() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace beamcam::output
