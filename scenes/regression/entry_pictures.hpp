// Judges the pictures of one entry by comparison with the reference pictures.
#pragma once

#include <filesystem>
#include <mutex>
#include <optional>
#include <string>

#include "output/data/file_list.hpp"
#include "scenes/regression/references.hpp"
#include "scenes/regression/result.hpp"

namespace beamcam::scenes {

// The path of a picture in the folder of a report. `kind`: "actual", "expected", "difference".
std::filesystem::path report_picture(const std::string& entry, long frame, const char* kind);

// The judges of an entry's pictures and motion share this context.
struct EntryContext {
    const Baseline& entry;
    EntryResult& result;
    const std::string renderer;  // id of what draws it
    const Tolerance& tolerance;
    const References references;
    ReferenceUpdate update;
    std::optional<std::filesystem::path> report;  // folder of the report, for pictures that are not identical
    output::FileList& report_files;
};

class EntryPictures {
  public:
    explicit EntryPictures(EntryContext& test);

    void judge(long frame, const render::Image& image);  // from any thread
    void conclude();                                     // after all are judged
    // An update only records the digests of this renderer: it is another one than those that are recorded, and draws
    // pictures within the tolerance.
    bool adds_digests() const;

  private:
    FrameResult compare(long frame, const output::Raster& actual) const;
    bool is_within_tolerance(const PictureComparison& comparison) const;
    bool is_recorded(long frame, const std::string& digest) const;
    void report_pictures(long frame, const output::Raster& actual, FrameResult& result) const;
    std::filesystem::path write(long frame, const char* kind, const output::Raster& picture) const;
    void collect_update();
    std::string message(const ChangedFrames& changed) const;

    EntryContext& test_;
    const Digests digests_;  // that are recorded
    std::mutex mutex_;       // guards the frames of the result and the update
};

}  // namespace beamcam::scenes
