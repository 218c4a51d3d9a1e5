// One entry of a file of baselines during a test: its plan, the verdicts on its pictures and its motion, and afterwards
// how the baselines change.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "output/data/manifest.hpp"
#include "scenes/motions/fingerprint.hpp"
#include "scenes/plan/plan.hpp"
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
    bool is_updated() const { return test_.references.are_replaced; }
    EntryResult& result() { return test_.result; }

    // An entry with a motion: plans it. The plan is its own, so that the pictures do not depend on other entries; it
    // may share the integration with them.
    void prepare();
    const std::vector<sim::Request>& requests() const { return requests_; }  // of the plan
    void judge(std::vector<sim::Result> results, RunOptions options);        // of these requests
    // An entry without a motion: pictures of another program, or a sweep.
    void judge_file();
    void judge_sweep(int threads, Progress& progress) { motion_.judge_sweep(threads, progress); }

    // Runs `work`; its errors fail this entry alone. False: it failed.
    bool attempt(const std::function<void()>& work);

    // If no picture of this renderer is accepted and nothing else is wrong with the entry, similar pictures get the
    // verdict new_renderer.
    void judge_renderer();
    // Whether the result is accepted, which it records.
    bool accept();

  private:
    bool needs_motion() const { return test_.result.motion.has_value(); }
    // Acceptance depends on the horizon to which the motion is reproducible.
    bool needs_horizon() const { return is_updated() || test_.tested.report; }
    void request_record();
    void request_compared_records();
    // The picture shows the motion until `until`. If the motion is not reproducible so long, another processor draws
    // other pixels: throws PictureError on an update, else notes it in the result.
    void require_reproducible(const sim::Result& motion, double until);
    void conclude();
    // The entry cannot be judged; the program ends with `exit_code`.
    void fail(const std::string& reason, Verdict verdict = Verdict::different, int exit_code = kDiffers);
    std::string renderer_message() const;

    const Baselines& baselines_;
    const RegressionOptions& options_;
    const Fingerprint& renderer_;
    EntryContext test_;
    EntryPictures pictures_;
    EntryMotion motion_;
    Plan plan_;
    std::vector<sim::Request> requests_;
    std::size_t recorded_ = 0;  // index of the recorded table in the plan's request
    double until_ = 0;          // the last instant that the entry shows [s]
    bool has_new_renderer_ = false;
};

}  // namespace beamcam::scenes
