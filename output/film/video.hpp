// Writes films in the formats of video_format.hpp; the ending of the file chooses the container. Films in Y'CbCr are
// tagged BT.709; an MP4 begins with its index. The threads that draw pictures convert them, only where they changed; a
// separate thread encodes them in order. The memory does not grow with the length of the film, except for animated
// WebP.
//
// Equal pictures and options give equal bytes on every machine with the same encoder.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "output/files/errors.hpp"
#include "output/files/target.hpp"
#include "output/film/video_format.hpp"
#include "output/film/video_library.hpp"
#include "render/draw/dirty_tiles.hpp"
#include "render/draw/image.hpp"

namespace beamcam::output {

// The work for a film so far, for progress lines and -v.
struct VideoStatistics {
    long frames = 0;             // encoded
    long held = 0;               // not encoded: the previous frame is shown longer
    double convert_seconds = 0;  // colour conversion, summed over the drawing threads
    double encode_seconds = 0;   // encoding, in the writer's thread
};

class VideoWriter {
  public:
    // The options have none of the problems of video_format.hpp. Throws UnsupportedOption, MissingCodec, IoError.
    VideoWriter(const FileTarget& file, const VideoOptions& options);
    // Removes the film unless `finish` was called.
    ~VideoWriter();
    VideoWriter(const VideoWriter&) = delete;
    VideoWriter& operator=(const VideoWriter&) = delete;

    // Shows the last picture once more without converting it again; with a variable rate, also without encoding it.
    void repeat();
    // Encodes the waiting pictures and completes the file.
    void finish();

    VideoStatistics statistics() const;

  private:
    friend class VideoInput;
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

// The input of one of several drawing threads: the threads convert pictures in parallel and send them in the order of
// the film.
class VideoInput {
  public:
    explicit VideoInput(VideoWriter& film);  // the film must outlive it
    // Waits while all frames of this input are in use. `changed`: tiles that may differ from the last picture that this
    // input converted. Transparent pixels show over black unless the film is transparent.
    void convert(const render::Image& image, const render::DirtyTiles& changed);
    // Adds the converted picture to the film.
    void send();

  private:
    struct Slot;
    friend struct VideoWriter::Impl;
    VideoWriter::Impl& film_;
    std::vector<Slot*> slots_;  // the film's
    Slot* filled_ = nullptr;
};

}  // namespace beamcam::output
