// Judges the pictures of one entry: by the accepted digests, and pictures with other digests by comparison with the
// reference pictures.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "scenes/regression/entry_files.hpp"

namespace beamcam::scenes {

class ExpectedPictures;

class EntryPictures {
  public:
    explicit EntryPictures(const EntryContext& test);
    ~EntryPictures();

    // From any thread.
    void judge(long frame, const render::Image& image);
    void judge(long frame, const output::Raster& picture);
    void conclude();  // after all are judged

  private:
    void compare_with_expected(long frame, const output::Raster& actual, FrameResult& result);
    void compare_with_accepted(long frame, const output::Raster& actual, FrameResult& result);
    bool is_within_tolerance(const PictureComparison& comparison) const;
    bool is_accepted(long frame, const std::string& digest) const;
    std::string unaccepted_reference(long frame) const;
    std::filesystem::path reference_of(long frame) const;
    void compare_with_reference(long frame, const output::Raster& actual, FrameResult& result);
    void write_actual(long frame, const output::Raster& actual, FrameResult& result);
    void report_difference(long frame, const output::Raster& expected, const output::Raster& actual,
                           FrameResult& result);
    std::filesystem::path write(long frame, const char* kind, const output::Raster& picture);
    std::string message(const ChangedFrames& changed) const;

    const EntryContext& test_;
    std::mutex mutex_;  // guards what follows and the frames of the result
    std::unique_ptr<ExpectedPictures> expected_;
};

}  // namespace beamcam::scenes
