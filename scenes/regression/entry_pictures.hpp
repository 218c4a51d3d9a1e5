// Judges the pictures of one entry: by the accepted digests, and pictures with other digests by comparison with the
// reference pictures.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "output/film/picture_source.hpp"
#include "scenes/regression/entry_files.hpp"
#include "scenes/regression/result.hpp"

namespace beamcam::scenes {

// The pictures of a file of expected pictures, taken approximately in the order of their numbers, from any thread.
class ExpectedPictures {
  public:
    // Throws IoError, MissingCodec.
    explicit ExpectedPictures(const std::string& file) : source_(file) {}

    std::optional<output::Raster> take(long frame);
    bool has_more();  // whether some were not taken

  private:
    output::PictureSource source_;
    std::map<long, output::Raster> ahead_;  // read but not taken yet
    long next_ = 0;
    std::mutex mutex_;
};

class EntryPictures {
  public:
    // `renderer`: id of the renderer that draws. All references must outlive this.
    EntryPictures(const Baseline& entry, const Tolerance& tolerance, const std::string& renderer,
                  const EntryReferences& references, const EntryReport& report, EntryResult& result)
        : entry_(entry),
          tolerance_(tolerance),
          renderer_(renderer),
          references_(references),
          report_(report),
          result_(result) {}

    // From any thread.
    void judge(long frame, const render::Image& image);
    void judge(long frame, const output::Raster& picture);
    void conclude();  // after all are judged
    // Digests of the new reference pictures by file name: of all pictures, or of those of this renderer alone.
    std::map<std::string, std::string> new_pictures(bool all) const;

  private:
    void compare_with_expected(long frame, const output::Raster& actual, FrameResult& result);
    void compare_with_accepted(long frame, const output::Raster& actual, FrameResult& result);
    bool is_within_tolerance(const PictureComparison& comparison) const;
    bool is_accepted(long frame, const std::string& digest) const;
    std::string unaccepted_reference(long frame) const;
    std::filesystem::path reference_of(long frame) const;
    void write_reference(long frame, const output::Raster& actual, const FrameResult& result);
    void compare_with_reference(long frame, const output::Raster& actual, FrameResult& result);
    void report_actual(long frame, const output::Raster& actual, FrameResult& result);
    void report_difference(long frame, const output::Raster& expected, const output::Raster& actual,
                           FrameResult& result);
    std::filesystem::path report(long frame, const char* kind, const output::Raster& picture);
    std::string message(const std::pair<const long, FrameResult>& worst) const;

    const Baseline& entry_;
    const Tolerance& tolerance_;
    const std::string& renderer_;
    const EntryReferences& references_;
    const EntryReport& report_;
    EntryResult& result_;
    std::mutex mutex_;  // guards what follows and result_.frames
    std::unique_ptr<ExpectedPictures> expected_;
};

}  // namespace beamcam::scenes
