// Pictures one after the other, wherever they are: a PNG file, a directory of PNG files in the order of their numbers,
// a sequence "fall-####.png", or a film.
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
    // Throws IoError: nothing there, or nothing that is a picture; MissingCodec.
    explicit PictureSource(const std::filesystem::path& path);

    // The files, when each picture is a file; empty for a film.
    const std::vector<std::filesystem::path>& files() const { return files_; }
    bool is_film() const { return film_ != nullptr; }
    bool is_sequence() const { return is_film() || is_sequence_; }

    // The next picture and what to call it: its file, or "fall.mp4#12". False after the last.
    bool next(Raster& picture, std::string& name);

  private:
    std::filesystem::path path_;
    std::vector<std::filesystem::path> files_;
    bool is_sequence_ = false;
    std::unique_ptr<VideoReader> film_;
    std::size_t next_ = 0;
};

// "frame-9" before "frame-10": runs of digits are compared as numbers.
bool natural_order(const std::string& a, const std::string& b);

}  // namespace beamcam::output
