// One integration of a motion: steps, events, transitions, output. MODEL.md §§11–12.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "sim/dynamics/failure.hpp"
#include "sim/dynamics/initial.hpp"
#include "sim/run/contact_guards.hpp"
#include "sim/run/simulate.hpp"
#include "sim/run/touch_search.hpp"
#include "sim/run/transitions.hpp"

namespace beamcam::sim {

// What a run may have besides its requests.
struct RunOptions {
    TrajectoryWriter* keep = nullptr;     // takes the trajectory down
    MotionObserver* observer = nullptr;   // follows the motion and may end the run
    const InitialState* start = nullptr;  // the state to begin with; else that of the problem
    // Another integrator around that of the problem's solver.
    std::function<std::unique_ptr<Integrator>(System&, std::unique_ptr<Integrator>)> around = {};
};

class Run {
  public:
    Run(const Problem& problem, std::span<const Request> requests, const Progress& progress, const RunOptions& options);

    // Throws SolverError with what was reached by then.
    std::vector<Result> integrate();
    Counters counters() const { return statistics().counters; }
    const RunState& state() const { return state_; }

  private:
    void start();
    const Segment& step();
    void take(const Segment& segment);
    Event first_event(const Segment& segment);
    bool reach(const Segment& segment, const Event& event);
    const Segment& shorten(double start, const Event& event, double& at);
    void record(const Segment& segment, double from, bool event);
    void resume();
    void keep_to_budget();
    void keep_in_bounds() const;
    double next_kink() const;
    bool has_come(double t) const;
    void pass_kinks();
    void report(double t) const;
    RunStatistics statistics() const;
    std::string explain(const StepFailure& failure);

    const Problem& problem_;
    const Progress& progress_;
    const InitialState* start_;
    System dynamics_;
    SegmentProbe probe_;
    RunState state_;
    RunOutput output_;
    std::unique_ptr<Integrator> integrator_;
    TouchSearch touch_search_;
    ContactGuards contact_guards_;
    Transitions transitions_;
    std::vector<double> kinks_;  // of the drive, still to come [s]
    double end_;                 // [s]
    double last_step_ = 0;       // [s]
    // The pace: steps that the whole run would take, when last projected; steps and time at the next and last
    // projection.
    double projected_steps_ = 0, paced_time_ = 0;
    long steps_ = 0, next_pace_ = kFirstPace, paced_ = 0;
    bool started_ = false;  // a state to begin with was found
};

}  // namespace beamcam::sim
