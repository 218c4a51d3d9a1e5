// Saltation: the jump of tangents (differences of neighbouring motions to first order) at touches, impacts, releases
// and stick–slip transitions. MODEL.md (S71), (S72).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/orbit/variation.hpp"

namespace beamcam::sim {

struct TangentTouch {
    double t = 0;         // [s]
    double approach = 0;  // −ġ before it [m/s]
    double flight = 0;    // duration of the flight before it [s]
    double x = 0;         // x_c [m]
    double overhang = 0;  // of the foot beyond the tip; negative between root and tip [m]
};

class Saltation {
  public:
    // `probe` evaluates the contact at events. It, `variation` and `units` (of the rows of tangents) must outlive this
    // object.
    Saltation(System& probe, Variation& variation, const Eigen::VectorXd& units);

    // Applies the event between the states `before` and `after`, if there is one, to the tangents (in units). Throws
    // StepFailure at an impact whose speed is zero: neighbouring motions touch at an instant without derivative.
    void pass(double t, const double* before, const Phase& was, const double* after, const Phase& is,
              Eigen::MatrixXd& tangents);
    // Start in sustained contact: projects the tangents onto differences that remain on the cam.
    void start_on_cam(double t, const double* y, const Phase& is, Eigen::MatrixXd& tangents);
    // Throws RunStopped if sustained contact between these states passes a jump of the cam's radius of curvature.
    void require_curvature(double t, const double* y, double to, const double* end, const Phase& phase);

    const std::vector<TangentTouch>& touches() const { return touches_; }
    long holds() const { return holds_; }  // impacts followed by sustained contact
    long lifts() const { return lifts_; }  // ends of sustained contact

  private:
    struct Instant {  // of an event
        double t;
        const double *before, *after;
        const Phase &was, &is;
    };
    void impact(const Instant& at, Eigen::MatrixXd& tangents);
    void begin_touch(const Instant& at, Eigen::MatrixXd& tangents);
    void change_friction(const Instant& at, Eigen::MatrixXd& tangents);
    void release(Eigen::MatrixXd& tangents);
    void keep_on_cam(double t, const double* y, Eigen::MatrixXd& tangents);
    Eigen::VectorXd flow(double t, const double* y, const Phase& phase);
    Eigen::MatrixXd in_si(const Eigen::MatrixXd& tangents) const;
    void record_touch(const Instant& at);

    System& probe_;
    Variation& variation_;
    const Eigen::VectorXd& units_;
    int n_, rows_;
    ContactState near_;  // at the last event
    std::vector<TangentTouch> touches_;
    double left_ = 0;  // instant of the last release [s]
    long holds_ = 0, lifts_ = 0;
};

}  // namespace beamcam::sim
