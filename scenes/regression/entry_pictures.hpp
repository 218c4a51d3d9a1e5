// Judges the pictures of one entry by the digests that are accepted, and where they are others by the reference
// pictures.
#pragma once

#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "output/data/manifest.hpp"
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

    void judge(long frame, const render::Image& image);         // from any thread
    void conclude();                                            // all are judged
    output::Target report_file(const std::string& name) const;  // in the folder of the entry; there must be a report

  private:
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
    std::mutex mutex_;  // of result_.frames
};

}  // namespace beamcam::scenes
