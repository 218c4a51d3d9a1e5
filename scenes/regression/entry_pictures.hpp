// Judges the pictures of one entry by the digests that are accepted, and where they are others by the reference
// pictures.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "output/film/picture_source.hpp"
#include "scenes/regression/entry_references.hpp"
#include "scenes/regression/result.hpp"

namespace beamcam::scenes {

// The pictures of a file that somebody accepted, taken in about the order of their numbers, from any thread.
class ExpectedPictures {
  public:
    // Throws IoError, MissingCodec.
    explicit ExpectedPictures(const std::string& file) : source_(file) {}

    std::optional<output::Raster> take(long frame);
    bool has_more();  // than were taken

  private:
    output::PictureSource source_;
    std::map<long, output::Raster> ahead_;  // read, and not taken yet
    long next_ = 0;
    std::mutex mutex_;
};

class EntryPictures {
  public:
    // `renderer`: what draws. All references must outlive this.
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
    void conclude();  // all are judged
    // Digests of the new reference pictures by file name: of all, or of those that this renderer alone has.
    std::map<std::string, std::string> new_pictures(bool all) const;

  private:
    void compare_with_expected(long frame, const output::Raster& actual, FrameResult& found);
    void compare_with_accepted(long frame, const output::Raster& actual, FrameResult& found);
    bool is_near(const PictureComparison& comparison) const;
    bool is_accepted(long frame, const std::string& digest) const;
    std::string unaccepted_reference(long frame) const;
    std::filesystem::path reference_of(long frame) const;
    void keep(long frame, const output::Raster& actual, const FrameResult& found);
    void compare_with_reference(long frame, const output::Raster& actual, FrameResult& found);
    void write_actual(long frame, const output::Raster& actual, FrameResult& found);
    void write_difference(long frame, const output::Raster& expected, const output::Raster& actual, FrameResult& found);
    std::filesystem::path put(long frame, const char* what, const output::Raster& picture);
    std::string in_words(const std::pair<const long, FrameResult>& worst) const;

    const Baseline& entry_;
    const Tolerance& tolerance_;
    const std::string& renderer_;
    const EntryReferences& references_;
    const EntryReport& report_;
    EntryResult& result_;
    std::mutex mutex_;  // of what follows, and of result_.frames
    std::unique_ptr<ExpectedPictures> expected_;
};

}  // namespace beamcam::scenes
