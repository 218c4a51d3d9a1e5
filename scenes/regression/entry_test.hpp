// One entry of a file of baselines during a test. Several threads judge its pictures and its motion; afterwards the
// entry decides how the baselines change.
#pragma once

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

class EntryTest {
  public:
    // `renderer` draws the entry. All references must outlive this. Throws IoError.
    EntryTest(const Baselines& baselines, const Baseline& entry, const RegressionOptions& options,
              const Fingerprint& renderer, ReferenceUpdate& update, output::Manifest& report_files,
              EntryResult& result);

    const Baseline& entry() const { return test_.entry; }
    bool needs_motion() const { return test_.result.motion.has_value(); }
    void ignore_motion() { test_.result.motion.reset(); }
    bool is_updated() const { return test_.references.is_replaced(); }
    // Acceptance depends on the horizon to which the motion is reproducible.
    bool needs_horizon() const { return is_updated() || test_.report.folder; }
    EntryResult& result() { return test_.result; }
    EntryPictures& pictures() { return pictures_; }  // from any thread
    EntryMotion& motion() { return motion_; }
    void judge_file();
    void finish();

    // The picture shows the motion until `until`. If the motion is not reproducible so long, another processor draws
    // other pixels: throws PictureError on an update, else notes it in the result.
    void require_reproducible(const sim::Result& motion, double until);

    // The entry cannot be judged; the program ends with `exit_code`.
    void fail(const std::string& reason, Verdict verdict = Verdict::different, int exit_code = kDiffers);
    // Runs `work`; its errors fail this entry alone. False: it failed.
    bool attempt(const std::function<void()>& work);

    // If no picture of this renderer is accepted and nothing else is wrong with the entry, similar pictures get the
    // verdict new_renderer.
    void judge_renderer();
    // The change of the baselines file, if this entry changes it.
    std::optional<BaselineEdit> edit();
    // Digests of the new reference pictures by file name, after `edit`.
    std::map<std::string, std::string> new_pictures() const { return pictures_.new_pictures(is_updated()); }

  private:
    std::string renderer_message() const;
    bool has_new_motion_only() const;

    const Baselines& baselines_;
    const RegressionOptions& options_;
    const Fingerprint& renderer_;
    EntryContext test_;
    EntryPictures pictures_;
    EntryMotion motion_;
    bool has_new_renderer_ = false;
};

}  // namespace beamcam::scenes
