// A film in any of video_format.hpp's kinds; the file's ending names the container. Films of Y'CbCr are tagged BT.709,
// and MP4 has its index first. Pictures are converted in the threads that draw them, only where they changed, and
// encoded in a thread of the writer's own, so that encoding overlaps drawing; the order is kept, and memory does not
// grow with the length of the film (an animated WebP alone is held, compressed, until it is finished).
//
// The same pictures and options give the same bytes on every machine with the same encoder.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "output/files/errors.hpp"
#include "output/files/target.hpp"
#include "output/film/video_format.hpp"
#include "output/film/video_library.hpp"
#include "render/draw/dirty_tiles.hpp"
#include "render/draw/image.hpp"

namespace beamcam::output {

// Encoders tell errors alone on stderr from now on, unless the environment says otherwise. Before any thread starts.
void silence_encoder_logs();

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
    int width = 1920, height = 1080;  // [px], 16…16384; even where the codec needs it
    double fps = 60;                  // [1/s]
    Codec codec = Codec::h264;
    bool transparent = false;            // the pictures' alpha is kept
    std::optional<int> crf;              // 0 (large, nearly perfect) … the codec's worst; absent: its usual one
    std::string preset = "veryfast";     // x264's, ultrafast … placebo
    std::vector<std::uint32_t> palette;  // of a GIF: 1 to 256 colours, as PaletteMaker finds them
    int threads = 4;  // 1…4 of the encoder. Beyond 4 its bits depend on the number, and the default is
                      // the same on every machine for that reason.
    // Variable frame rate: a picture that is repeated is coded once and shown longer, for up to 5 s; then, and at the
    // film's end, it is coded again.
    bool variable_rate = false;
    std::map<std::string, std::string> metadata;
    std::vector<Chapter> chapters;  // increasing; containers without chapters leave them out
};
// Everything about these options that a film cannot do, in words with the alternative. `ending` with the dot.
std::vector<std::string> problems(const VideoOptions& options, std::string_view ending = ".mp4");

// What a film has cost so far, for progress lines and -v.
struct VideoStatistics {
    long frames = 0;             // encoded
    long held = 0;               // shown by the one before, which lasts longer
    double convert_seconds = 0;  // picture to film colours, summed over the threads that draw
    double encode_seconds = 0;   // inside the encoder, in the writer's thread
    double wait_seconds = 0;     // for the encoder, summed over the threads that draw
    double idle_seconds = 0;     // of the writer's thread, for want of pictures
};

class VideoWriter {
  public:
    // Throws UnsupportedOption, MissingCodec, IoError.
    VideoWriter(const Target& file, const VideoOptions& options);
    // Without `finish` the film is dropped and nothing is left of it.
    ~VideoWriter();
    VideoWriter(const VideoWriter&) = delete;
    VideoWriter& operator=(const VideoWriter&) = delete;

    // The next picture; waits when the encoder is a few pictures behind. Transparent pixels show over black
    // unless the film is transparent itself.
    void write(const render::Image& image);
    // The picture before, once more, without drawing or converting it again; with a variable rate without encoding it
    // either. Not the first.
    void repeat();
    // Encodes what is left and puts the film in its place.
    void finish();

    VideoStatistics statistics() const;

  private:
    friend class VideoInput;
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

// The way into a film for one thread of several: each converts its own pictures at the same time as the others, then
// sends them in the film's order.
class VideoInput {
  public:
    explicit VideoInput(VideoWriter& film);  // before the film is finished, which outlives it
    // Waits while the encoder has to do with this thread's pictures before. `changed`: where the picture may differ
    // from the last one that this input converted.
    void convert(const render::Image& image, const render::DirtyTiles& changed);
    // What was converted becomes the film's next picture.
    void send();

  private:
    struct Slot;
    friend struct VideoWriter::Impl;
    VideoWriter::Impl& film_;
    std::vector<Slot*> slots_;  // the film's
    Slot* filled_ = nullptr;
};

// One film out of segments, in their order, packets as they are: every picture decodes to what it was. Metadata is the
// first one's. Returns how many pictures there are. Throws Mismatch (video_library.hpp), MissingCodec, IoError.
long concatenate(const std::vector<std::filesystem::path>& segments, const Target& file);

}  // namespace beamcam::output
