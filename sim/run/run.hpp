// The integration of one motion: steps, event location, transitions, output. MODEL.md §§11–12.
#pragma once

#include <memory>
#include <vector>

#include "sim/dynamics/failure.hpp"
#include "sim/dynamics/initial.hpp"
#include "sim/run/contact_guards.hpp"
#include "sim/run/simulate.hpp"
#include "sim/run/touch_search.hpp"
#include "sim/run/transitions.hpp"

namespace beamcam::sim {

struct RunOptions {
    double end = 0;  // the run extends to this instant, and to the ends of its observers [s]
    // A step ends at `end`, whose state has then the accuracy of a step, not that of dense output.
    bool step_ends_there = false;
    const InitialState* start = nullptr;  // initial state; null: that of the problem
};

class Run {
  public:
    // Throws StepFailure where the model has no motion at all.
    Run(const Problem& problem, const Progress& progress, const RunOptions& options = {});
    // `observer` must live until the run has ended.
    void add(Observer& observer) { state_.observers.push_back(&observer); }
    // To the end, or until all observers are done. Throws SolverError, without results, and Interrupted.
    void integrate();

    const System& system() const { return system_; }
    const RunState& state() const { return state_; }
    RunStatistics statistics() const;

  private:
    void start();
    const Segment& step();
    void process(const Segment& segment);
    Event first_event(const Segment& segment);
    bool reach(const Segment& segment, const Event& event);
    const Segment& shorten(double start, const Event& event, double& at);
    void record(const Segment& segment, double from, double until, bool event);
    void resume();
    void check_budget();
    void check_deflection() const;
    void check_lock();
    double next_kink() const;
    bool is_reached(double t) const;
    void pass_kinks();
    void report(double t) const;
    bool observers_are_done() const;
    std::string explain(const StepFailure& failure);

    const Problem problem_;
    const Progress progress_;
    const InitialState* start_;
    System system_;
    SegmentProbe probe_;
    RunState state_;
    const Method method_;  // of the integrator: what "auto" means here
    std::unique_ptr<Integrator> integrator_;
    TouchSearch touch_search_;
    ContactGuards contact_guards_;
    Transitions transitions_;
    std::vector<double> kinks_;  // of the drive, after the present time [s]
    double end_, step_end_;      // of the run; an instant at which a step ends [s]
    double last_step_ = 0;       // [s]
    long steps_ = 0;
    // Projection of the whole run's steps: the result, attempted steps and time at the last projection, and attempted
    // steps at the next one.
    double projected_steps_ = 0, projected_at_time_ = 0;
    long projected_at_step_ = 0, next_projection_;
    bool started_ = false;
};

}  // namespace beamcam::sim
