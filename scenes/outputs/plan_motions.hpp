// The motions of one plan: their requests and their results.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "scenes/motions/motion_store.hpp"
#include "scenes/motions/pose_spool.hpp"
#include "scenes/plan/plan.hpp"

namespace beamcam::scenes {

// The poses of a picture, on disk.
struct StoredPoses {
    std::shared_ptr<PoseSpool> frames;
    std::shared_ptr<PoseSpool> survey;  // for the choice of scales
    std::shared_ptr<PoseSpool> path;    // of the tip between frames
};

struct PlanResults {
    sim::Result run;                                // of the scene's motion
    std::vector<std::vector<sim::Result>> shown;    // one for each motion of each picture
    std::vector<std::vector<StoredPoses>> poses;    // the same; null where the results contain the poses
    std::vector<std::vector<sim::Result>> figures;  // one for each study of each figure

    Results of_figure(std::size_t figure) const;
};

class PlanMotions {
  public:
    // The times of the plan are known before the first request; all must outlive this.
    PlanMotions(const Plan& plan, MotionStore& motions) : plan_(plan), motions_(motions) {}

    void request_all();     // for all
    void request_others();  // all but the scene's own motion, whose results take_results gets
    PlanResults take_results();
    PlanResults take_results(std::vector<sim::Result> own);  // `own`: of requests_of(plan)
    // The partial result of the scene's motion if it failed; null if another motion failed.
    const sim::Result* partial_results() const;

  private:
    const Plan& plan_;
    MotionStore& motions_;
    std::optional<std::size_t> own_;   // request for the scene's motion
    std::vector<std::size_t> others_;  // requests for others, in the order of take_results
    PlanResults results_;              // until take_results only the poses
};

}  // namespace beamcam::scenes
