// One entry of a file of baselines while it is tested: its picture and its motion are judged, by several threads, then
// it says what becomes of the entry.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "output/data/manifest.hpp"
#include "scenes/motions/fingerprint.hpp"
#include "scenes/regression/baseline_edit.hpp"
#include "scenes/regression/entry_motion.hpp"
#include "scenes/regression/entry_pictures.hpp"
#include "scenes/regression/regression.hpp"
#include "scenes/scene/exit_code.hpp"

namespace beamcam::scenes {

// How the folders of references are changed; what is empty may not be.
struct UpdateAccess {
    std::function<std::filesystem::path(const std::string&entry)> replace, extend;
    std::function<void(const std::string& entry)> keep;  // what the update begun does not replace
    std::function<void(const std::string& entry)> drop;
};

class EntryTest {
  public:
    // `renderer`: of what draws the entry. All references must outlive this.
    EntryTest(const Baselines& baselines, const Baseline& entry, const RegressionOptions& options,
              const Fingerprint& renderer, const UpdateAccess& update, output::Manifest& report_files,
              EntryResult& result);

    const Baseline& entry() const { return entry_; }
    bool asks_for_motion() const { return result_.motion.has_value(); }
    void ask_for_no_motion() { result_.motion.reset(); }
    bool is_updated() const { return references_.fresh.has_value(); }
    // Whether it is to be known until when the motion is reproducible: what is accepted depends on it.
    bool asks_for_horizon() const { return is_updated() || report_.folder; }
    EntryResult& result() { return result_; }
    EntryPictures& pictures() { return pictures_; }  // from any thread
    EntryMotion& motion() { return motion_; }
    void judge_file();
    void finish();

    // Another processor would draw other pixels of a motion whose last digits have grown: throws PictureError where it
    // is to be accepted, else it is noted.
    void require_reproducible(const sim::Result& motion, double until);

    // There is nothing to judge. `exit_code`: what the program is to end with.
    void make_impossible(const std::string& why, Verdict verdict = Verdict::different, int exit_code = kDiffers);
    // Does some work; what fails costs this entry alone. False: it has failed.
    bool attempt(const std::function<void()>& work);

    // Is nothing accepted yet of the renderer that drew the pictures, and nothing else wrong with the entry? Then the
    // verdict is its own where they look alike.
    void judge_renderer();
    // What the baselines file is to say, when this entry changes it.
    std::optional<BaselineEdit> edit();
    // Digests of the new reference pictures by file name; of an entry that is changed.
    std::map<std::string, std::string> new_pictures() const { return pictures_.new_pictures(is_updated()); }

  private:
    bool is_new_renderer() const;
    std::string about_renderer() const;
    bool is_motion_alone_new() const;
    void drop();

    const Baselines& baselines_;
    const Baseline& entry_;
    const RegressionOptions& options_;
    const UpdateAccess& update_;
    EntryResult& result_;
    const Fingerprint& renderer_;
    const std::string renderer_id_;
    const Tolerance tolerance_;
    EntryReferences references_;
    const EntryReport report_;
    EntryPictures pictures_;
    EntryMotion motion_;
    bool is_of_new_renderer_ = false;
};

}  // namespace beamcam::scenes
