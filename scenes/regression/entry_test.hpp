// One entry of a file of baselines during a test: its plan, the verdicts on its pictures and its motion, and its
// update.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "output/data/file_list.hpp"
#include "scenes/motions/motion_pool.hpp"
#include "scenes/plan/plan.hpp"
#include "scenes/regression/entry_pictures.hpp"
#include "scenes/regression/regression.hpp"
#include "scenes/scene/exit_code.hpp"

namespace beamcam::scenes {

class EntryTest {
  public:
    // `renderer`: id of what draws the entry. All references must outlive this. Throws IoError.
    EntryTest(const Baselines& baselines, const Baseline& entry, const RegressionOptions& options,
              const std::string& renderer, output::FileList& report_files, EntryResult& result);

    const Baseline& entry() const { return test_.entry; }
    EntryResult& result() { return test_.result; }

    // An entry with a motion: plans it. The plan is its own, so that the pictures do not depend on other entries; it
    // may share the integration with them.
    void prepare();
    void request(MotionPool& pool);  // the motions of the plan
    void judge(MotionPool& pool, const RunOptions& options);
    void judge_sweep(int threads, Progress& progress);

    // Runs `work`; its errors fail this entry alone. False: it failed.
    bool attempt(const std::function<void()>& work);

  private:
    bool needs_motion() const { return test_.result.motion.has_value(); }
    sim::Request& run_request() { return plan_.motions[*plan_.run].request; }  // of the scene's motion
    void request_record();
    void request_compared_records();
    // An update throws render::PictureError if the motion is not reproducible as far as the entry shows it.
    void require_reproducible(const sim::Result& motion) const;
    double last_shown() const;  // the last instant of the picture [s]
    void update();
    // The entry cannot be judged; the program ends with `exit_code`.
    void fail(const std::string& reason, Verdict verdict = Verdict::different, int exit_code = kDiffers);

    const Baselines& baselines_;
    const RegressionOptions& options_;
    EntryContext test_;
    EntryPictures pictures_;
    PlanWithFigures plan_;
    std::vector<std::size_t> requests_;  // numbers of the plan's motions in the pool
    std::size_t recorded_ = 0;           // index of the recorded table in the plan's request
    double until_ = 0;                   // the end of the motion on which the entry depends [s]
};

}  // namespace beamcam::scenes
