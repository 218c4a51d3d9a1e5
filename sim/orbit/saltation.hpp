// How small differences of neighbouring motions pass the events of a motion: touches, strikes, releases, changes of
// grip. MODEL.md §16a.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/orbit/modal_jets.hpp"

namespace beamcam::sim {

struct TangentTouch {
    double t = 0;         // [s]
    double approach = 0;  // −ġ before it [m/s]
    double flight = 0;    // since the beam left the cam, or since the start [s]
    double x = 0;         // of the foot along the beam [m]
    double overhang = 0;  // of the foot over the tip: negative between root and tip [m]
};

class Saltation {
  public:
    // `jets` and `units` (of the rows of tangents) must outlive this.
    Saltation(const System& system, ModalJets& jets, const Eigen::VectorXd& units);

    // Tangents, in units, pass the event between the states before and after, if it is one.
    void pass(double t, const double* before, const Phase& was, const double* after, const Phase& is,
              Eigen::MatrixXd& tangents);
    // A start on the cam with tangents that remain on it.
    void start_on_cam(double t, const double* y, const Phase& is, Eigen::MatrixXd& tangents);

    const std::vector<TangentTouch>& touches() const { return touches_; }
    long holds() const { return holds_; }  // strikes that sustained contact followed
    long lifts() const { return lifts_; }  // ends of sustained contact

  private:
    struct Instant {  // of an event
        double t;
        const double *before, *after;
        const Phase &was, &is;
    };
    void strike(const Instant& at, Eigen::MatrixXd& tangents);
    void begin_touch(const Instant& at, Eigen::MatrixXd& tangents);
    void change_grip(const Instant& at, Eigen::MatrixXd& tangents);
    void release(Eigen::MatrixXd& tangents);
    void keep_on_cam(double t, const double* y, Eigen::MatrixXd& tangents);
    JetState jets_before(const Instant& at, const Eigen::MatrixXd& tangents, Eigen::Index first);
    std::vector<double> flow_after(const Instant& at);
    void note_touch(const Instant& at);

    System probe_;  // evaluates at events, so that the motion does not depend on it
    ModalJets& jets_;
    const Eigen::VectorXd& units_;
    int n_, rows_;
    ContactState near_;  // at the last event
    std::vector<TangentTouch> touches_;
    double left_ = 0;  // when the beam left the cam last [s]
    long holds_ = 0, lifts_ = 0;
};

}  // namespace beamcam::sim
