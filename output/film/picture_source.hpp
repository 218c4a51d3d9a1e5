// A series of pictures: a PNG file, a directory of PNG files in the order of their numbers, a sequence "fall-####.png",
// or a film.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "output/film/video_reader.hpp"
#include "output/image/raster.hpp"

namespace beamcam::output {

class PictureSource {
  public:
    // Throws IoError if there are no pictures, MissingCodec.
    explicit PictureSource(const std::filesystem::path& path);

    // The files of the pictures; empty for a film.
    const std::vector<std::filesystem::path>& files() const { return files_; }
    bool is_film() const { return film_ != nullptr; }

    // The next picture and its name: its file, or "fall.mp4#12". False after the last.
    bool next(Raster& picture, std::string& name);
    // Passes over it, in a fraction of the time. False after the last.
    bool skip();

  private:
    std::filesystem::path path_;
    std::vector<std::filesystem::path> files_;
    std::unique_ptr<VideoReader> film_;
    std::size_t next_ = 0;
};

}  // namespace beamcam::output
