// Makes the outputs of one scene, step by step; `run` (run.cpp) calls the steps of all its scenes in turn.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "scenes/outputs/output_files.hpp"
#include "scenes/outputs/plan_motions.hpp"
#include "scenes/plan/up_to_date.hpp"
#include "scenes/sweep/sweep_run.hpp"

namespace beamcam::scenes {

class SceneRun {
  public:
    // Looks at what is there and plans the rest. Both must outlive this.
    SceneRun(const Scene& scene, RunContext& context);

    const Plan& plan() const { return plan_; }
    const std::string& motion() const { return found_.motion; }

    // All that can be refused before any work.
    void prepare();
    // Slow motion and pictures of impacts ask where the impacts are, before anything else can be asked. `far`: until
    // when the scene's motion is wanted [s].
    void find_impacts(double far);
    // The points of the scene's sweep, if outputs show them.
    void make_sweep();
    void ask_for_motions() { motions_.request_all(); }
    void take_motions() { results_ = motions_.take_results(); }
    void write_outputs();
    // What a failed run reached is worth looking at, under a name that no script takes for the result.
    void keep_partial_tables();

  private:
    void say_what_is_left();
    void try_encoders();
    void write_data(const DataFile& data);
    void write_figure(std::size_t figure);
    void write_pictures(std::size_t picture);
    void write_document(const Pictures& p, const std::string& bytes);
    void warn_of_missing(const Pictures& p) const;
    void attempt(std::size_t output, const std::function<void()>& work);
    void refuse(std::size_t output, const std::string& why);

    const Scene& scene_;
    RunContext& context_;
    const UpToDate found_;
    Plan plan_;  // settled by find_impacts
    OutputFiles files_;
    PlanMotions motions_;
    PlanResults results_;
    std::unique_ptr<SweepRun> sweep_;
    bool refused_ = false;  // an output
};

}  // namespace beamcam::scenes
