// Judges the pictures of one entry by the digests that are accepted, and where they are others by the reference
// pictures.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "output/data/manifest.hpp"
#include "output/film/picture_source.hpp"
#include "scenes/regression/references.hpp"
#include "scenes/regression/regression.hpp"

namespace beamcam::scenes {

// Of a report, below its folder; `what`: "actual", "expected", "difference".
std::filesystem::path report_picture(const std::string& entry, long frame, const char* what);
std::string picture_name(long frame);  // "0012.png"

// The folder of an entry's references, and where new ones go.
class EntryReferences {
  public:
    // Throws IoError for a damaged marker.
    explicit EntryReferences(const std::filesystem::path& where)
        : folder(where), marked_(marked_files(where).value_or(ReferenceFiles{})) {}

    const ReferenceFile* marked(const std::string& name) const {
        const auto file = marked_.find(name);
        return file == marked_.end() ? nullptr : &file->second;
    }
    bool is_as_marked(const std::string& name) const;
    // Reads what may be damaged; then an update replaces it.
    void read(const std::function<void()>& work) const {
        try {
            work();
        } catch (const output::IoError&) {
            if (!fresh) throw;
        }
    }

    const std::filesystem::path folder;
    std::optional<std::filesystem::path> fresh;  // of an update

  private:
    const ReferenceFiles marked_;
};

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
    // `report`: folder for actual and difference pictures. All must outlive this.
    EntryPictures(const Baseline& entry, const Tolerance& tolerance, const EntryReferences& references,
                  const std::optional<std::filesystem::path>& report, output::Manifest& report_files,
                  EntryResult& result)
        : entry_(entry),
          tolerance_(tolerance),
          references_(references),
          report_(report),
          report_files_(report_files),
          result_(result) {}

    // From any thread.
    void judge(long frame, const render::Image& image);
    void judge(long frame, const output::Raster& picture);
    void conclude();                                            // all are judged
    output::Target report_file(const std::string& name) const;  // in the folder of the entry; there must be a report

  private:
    void compare_with_expected(long frame, const output::Raster& actual, FrameResult& found);
    void compare_with_accepted(long frame, const output::Raster& actual, FrameResult& found);
    bool is_near(const PictureComparison& comparison) const;
    bool is_accepted(long frame, const std::string& digest) const;
    bool is_reference_accepted(long frame) const;
    void compare_with_reference(long frame, const output::Raster& actual, FrameResult& found);
    void write_actual(long frame, const output::Raster& actual, FrameResult& found);
    void write_difference(long frame, const output::Raster& expected, const output::Raster& actual, FrameResult& found);
    std::filesystem::path put(long frame, const char* what, const output::Raster& picture);
    std::string in_words(const std::pair<const long, FrameResult>& worst) const;

    const Baseline& entry_;
    const Tolerance& tolerance_;
    const EntryReferences& references_;
    const std::optional<std::filesystem::path>& report_;
    output::Manifest& report_files_;
    EntryResult& result_;
    std::mutex mutex_;  // of what follows, and of result_.frames
    std::unique_ptr<ExpectedPictures> expected_;
};

}  // namespace beamcam::scenes
