// The outputs of one scene; `run` (run.cpp) calls the steps in this order, each for all scenes.
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
    // Finds up-to-date files and plans the others. Both must outlive this.
    SceneRun(const Scene& scene, RunContext& context);

    const Plan& plan() const { return plan_; }

    // Rejects outputs that cannot be written.
    void prepare();
    // Finds the events on which times of outputs depend.
    void find_events();
    void request_motions() { motions_.request_all(); }
    void take_motions() { results_ = motions_.take_results(); }
    // Computes the points of the scene's sweep, if outputs need them.
    void compute_sweep();
    void write_outputs();
    // Writes the tables and impacts of a failed run under other names.
    void write_partial_data();

  private:
    void report_up_to_date();
    void check_libraries();
    // Of this motion of the scene. `file`: null for standard output.
    DataSource source_of(const sim::Result& run, const output::Target* file) const;
    void write_data(const DataFile& data);
    void write_figure(std::size_t figure);
    void write_pictures(std::size_t picture);
    void write_page(const Pictures& p, const std::string& bytes);
    void warn_of_omissions(const Pictures& p) const;
    void attempt(std::size_t output, const std::function<void()>& work);
    void reject(std::size_t output, const std::string& why);

    const Scene& scene_;
    RunContext& context_;
    const UpToDate up_to_date_;
    Plan plan_;  // complete after find_events
    OutputFiles files_;
    PlanMotions motions_;
    PlanResults results_;
    std::unique_ptr<SweepRun> sweep_;
    bool rejected_ = false;  // some output
};

}  // namespace beamcam::scenes
