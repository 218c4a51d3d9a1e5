// The outputs of one scene; `run` (run.cpp) calls the steps in this order, each for all scenes.
#pragma once

#include <functional>
#include <memory>
#include <set>
#include <string>

#include "scenes/outputs/data_outputs.hpp"
#include "scenes/outputs/output_files.hpp"
#include "scenes/plan/up_to_date.hpp"
#include "scenes/sweep/sweep_run.hpp"

namespace beamcam::scenes {

class SceneRun {
  public:
    // Finds up-to-date files. Both must outlive this.
    SceneRun(const Scene& scene, RunContext& context);

    // The plan without integration: outputs at events wait.
    Plan dry_plan() const;
    // Rejects outputs that cannot be written.
    void prepare();
    // Finds the events on which times of outputs depend, and plans the outputs that are not up to date.
    void plan();
    bool needs_gl() const { return plan_.needs_gl(); }
    void request_motions();
    // Computes the points of the scene's sweep, if outputs need them.
    void compute_sweep();
    void write_outputs();

  private:
    void report_up_to_date();
    void report_kept_frames(const ResolvedOutput& sequence);
    void check_libraries();
    const Output& output_of(const DataFile& data) const { return scene_.outputs[data.output]; }
    // The results of motions of the plan. Throws the failure of one of them.
    std::vector<sim::Result*> results_of(const std::vector<std::size_t>& motions);
    // The source of data files, from this motion of the scene. `file`: null for standard output.
    DataSource source_of(const sim::Result& run, const output::FileTarget* file) const;
    void write_data_file(const DataFile& data);
    // Writes the tables and impacts of a failed run under other names.
    void write_partial_data();
    void write_figure(std::size_t figure);
    void write_pictures(const PlannedPictures& p);
    void write_drawing(const PlannedPictures& p, render::Film& film, const std::string& accuracy);
    void write_whole(const PlannedPictures& p, const std::string& bytes);
    void warn_of_omissions(const PlannedPictures& p) const;
    void attempt(std::size_t output, const std::function<void()>& work);
    void reject(std::size_t output, const std::string& why);

    const Scene& scene_;
    RunContext& context_;
    const std::vector<std::string> inputs_;  // keys of the outputs' inputs
    const ExistingWork existing_;
    OutputFiles files_;
    PlanWithFigures plan_;
    std::vector<std::size_t> requests_;  // numbers of the plan's motions in the pool
    std::unique_ptr<SweepRun> sweep_;
    bool rejected_ = false;  // some output
};

}  // namespace beamcam::scenes
