// The motions behind the outputs of one plan: asked for before they are made, taken when they are.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "scenes/motions/motion_store.hpp"
#include "scenes/motions/pose_spool.hpp"
#include "scenes/plan/plan.hpp"

namespace beamcam::scenes {

// The poses of a picture on disk, so that memory does not grow with their number.
struct StoredPoses {
    std::shared_ptr<PoseSpool> frames;
    std::shared_ptr<SampledPoses> survey;  // by which scales are chosen
};

struct PlanResults {
    sim::Result run;                                       // of the scene's own motion
    std::vector<sim::Result> ends;                         // as Simulation::ends
    std::vector<std::vector<sim::Result>> figures;         // one for each study of each figure
    std::vector<std::vector<sim::Result>> compared;        // one for each motion of each picture
    std::vector<StoredPoses> poses;                        // of each picture; none where results bring theirs
    std::vector<std::vector<StoredPoses>> compared_poses;  // as `compared`

    // The run as if it had ended with this picture.
    const sim::Result& seen_by(const Pictures& p) const { return p.until ? ends.at(*p.until) : run; }
    Results of_figure(std::size_t figure) const;
};

class PlanMotions {
  public:
    // The plan is settled before anything is asked for; all must outlive this.
    PlanMotions(const Plan& plan, const sim::Problem& problem, MotionStore& motions)
        : plan_(plan), problem_(problem), motions_(motions) {}

    void request_all();     // for all
    void request_others();  // than the scene's own, whose results `take` is given then
    PlanResults take_results();
    PlanResults take_results(std::vector<sim::Result> own);  // as requests_of the plan
    // The scene's own motion as far as a failed run came; nothing where another motion failed.
    const sim::Result* partial_results() const;

  private:
    const Plan& plan_;
    const sim::Problem& problem_;
    MotionStore& motions_;
    std::optional<std::size_t> own_;   // wish for the scene's own motion
    std::vector<std::size_t> others_;  // wishes for others, in the order of `take`
    PlanResults results_;              // so far the stores of poses
};

}  // namespace beamcam::scenes
