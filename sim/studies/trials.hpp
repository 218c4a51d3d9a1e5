// Timed simulations of variants of a problem for the study of accuracy, within limits of time.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sim/base/clock.hpp"
#include "sim/observe/channels.hpp"
#include "sim/observe/result.hpp"
#include "sim/studies/accuracy.hpp"

namespace beamcam::sim {

inline constexpr int kInstants = 1000;  // at which motions are compared

inline constexpr const char* kLeftOut = "left out";  // begins the note of a run that takes too long

// One simulation with samples of the compared angle.
struct TrialRun {
    std::vector<double> angle;
    Result result;
    double seconds = 0;
};

class Trials {
  public:
    using Report = std::function<bool(double share)>;

    Trials(const Problem& problem, double target, const Report& report)
        : angle_(compared_angle(problem)), target_(target), report_(report) {}

    bool of_tip() const { return angle_.of_tip(); }

    // The completed fraction of the whole before the next trials, and what these add.
    void begin(double share, double more);
    // With samples of the angle if `sampled`. Nothing after `limit` seconds. Throws the exceptions of simulate.
    std::optional<TrialRun> simulate_until(const Problem& problem, double end, double limit, bool sampled);
    // Simulates a variant that may be impossible: `note` states the reason.
    std::optional<TrialRun> try_until(const Problem& variant, double end, double limit, std::string& note);
    // Compares a variant of the problem with `truth` over [0, end]. Timed without samples.
    void measure(AccuracyRow& row, const Problem& variant, const TrialRun& truth, double end, double limit,
                 int repeats);
    // Times `repeats` runs, or fewer once `enough` seconds have passed since the first trial.
    std::optional<Timing> time(const Problem& variant, double end, double limit, int repeats, double enough);

  private:
    bool report(double part);
    void compare(AccuracyRow& row, const TrialRun& run, const TrialRun& truth, double end) const;

    const ComparedAngle angle_;
    const double target_;  // [rad]
    const Report& report_;
    double share_ = 0, more_ = 0, progress_ = 0;
    int runs_ = 0;
    Clock::time_point started_ = Clock::now();
};

}  // namespace beamcam::sim
