// The integration of one motion: steps, event location, transitions, output. MODEL.md §§11–12.
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

struct RunOptions {
    MotionObserver* observer = nullptr;   // follows the motion and may end the run
    const InitialState* start = nullptr;  // initial state; null: that of the problem
    // Wraps the integrator of the problem's solver into another one.
    std::function<std::unique_ptr<Integrator>(System&, std::unique_ptr<Integrator>)> around = {};
};

class Run {
  public:
    Run(const Problem& problem, std::span<const Request> requests, const Progress& progress, const RunOptions& options);

    // Throws SolverError with the partial results.
    std::vector<Result> integrate();
    Counters counters() const { return statistics().counters; }
    const RunState& state() const { return state_; }

  private:
    void start();
    const Segment& step();
    void process(const Segment& segment);
    Event first_event(const Segment& segment);
    bool reach(const Segment& segment, const Event& event);
    const Segment& shorten(double start, const Event& event, double& at);
    void record(const Segment& segment, double from, bool event);
    void resume();
    void check_budget();
    void check_deflection() const;
    void check_lock();
    double next_kink() const;
    bool is_reached(double t) const;
    void pass_kinks();
    void report(double t) const;
    RunStatistics statistics() const;
    std::string explain(const StepFailure& failure);

    const Problem problem_;
    const Progress progress_;
    const InitialState* start_;
    System dynamics_;
    SegmentProbe probe_;
    RunState state_;
    RunOutput output_;
    const Method method_;  // of the integrator: what "auto" means here
    std::unique_ptr<Integrator> integrator_;
    TouchSearch touch_search_;
    ContactGuards contact_guards_;
    Transitions transitions_;
    std::vector<double> kinks_;  // of the drive, after the present time [s]
    double end_;                 // [s]
    double last_step_ = 0;       // [s]
    long steps_ = 0;
    // Projection of the whole run's steps: the result, attempted steps and time at the last projection, and attempted
    // steps at the next one.
    double projected_steps_ = 0, projected_at_time_ = 0;
    long projected_at_step_ = 0, next_projection_ = kFirstProjection;
    bool started_ = false;  // an initial state was found
};

}  // namespace beamcam::sim
