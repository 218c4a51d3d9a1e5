// Collects what the outputs of a scene need. Each output type adds its part (outputs/).
#pragma once

#include <string>
#include <vector>

#include "scenes/plan/plan.hpp"

namespace beamcam::scenes {

class Planner {
  public:
    Planner(const ResolvedScene& resolved, const ExistingWork& existing) : resolved_(resolved), existing_(existing) {}
    PlanWithFigures make();

    // ---- called by the output types ----

    const Scene& scene() const { return resolved_.scene; }
    // The request for data files, which extends to `t` [s].
    sim::Request& run_until(double t);
    // Adds a table to it; returns its index.
    std::size_t add_table(std::vector<double> times, std::vector<sim::Channel> channels);
    void require_sweep(const std::string& file, const Shard& shard = {}) {
        if (plan_.sweep.empty()) plan_.sweep = file, plan_.shard = shard;
    }
    void add(const ResolvedOutput& picture);
    void add(FigureFile figure, FigureMaker maker, std::vector<MotionRequest> motions);
    void add(DataFile data) { plan_.data.push_back(std::move(data)); }

  private:
    std::size_t add_motion(MotionRequest motion);
    const std::string& own_key();  // of the scene's motion

    const ResolvedScene& resolved_;
    const ExistingWork& existing_;
    PlanWithFigures plan_;
    std::string own_key_;
};

// The parts of the output types.
void plan(Planner& planner, const PictureOutput& output, const ResolvedOutput& resolved);
void plan(Planner& planner, const FigureOutput& output, const ResolvedOutput& resolved);
void plan(Planner& planner, const TrajectoryOutput& output, const ResolvedOutput& resolved);
void plan(Planner& planner, const ImpactsOutput& output, const ResolvedOutput& resolved);
void plan(Planner& planner, const StateOutput& output, const ResolvedOutput& resolved);
void plan(Planner& planner, const SummaryOutput& output, const ResolvedOutput& resolved);
void plan(Planner& planner, const SweepOutput& output, const ResolvedOutput& resolved);

}  // namespace beamcam::scenes
