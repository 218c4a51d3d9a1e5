// A film whose pictures are written one by one from one thread.
#pragma once

#include "output/film/video.hpp"

namespace beamcam::output {

class Film : public VideoWriter {
  public:
    Film(const FileTarget& file, const VideoOptions& options)
        : VideoWriter(file, options), all_(options.width, options.height) {
        all_.add_all();
    }
    void write(const render::Image& image) {
        input_.convert(image, all_);
        input_.send();
    }

  private:
    VideoInput input_{*this};
    render::DirtyTiles all_;
};

}  // namespace beamcam::output
