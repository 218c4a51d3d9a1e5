// Tangents of the flow along a motion: differences of neighbouring motions, to first order. They are integrated over
// each accepted step of a run (tangent_step.hpp); the saltation is applied at each event (saltation.hpp). MODEL.md
// §16a.
//
// Tangents have 2n + 2 rows: ξ, ξ̇, z, δ̇₋, in units (`units`) that give each row about the same energy.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <vector>

#include "sim/observe/observer.hpp"
#include "sim/orbit/saltation.hpp"
#include "sim/orbit/tangent_step.hpp"

namespace beamcam::sim {

class Tangents final : public Observer {
  public:
    // `system` is that of the run. `tangents` has 2n rows, in units, and any number of columns. `progress` receives the
    // time that they have reached.
    Tangents(const System& system, double end, double rtol, const Eigen::MatrixXd& tangents, const Progress& progress);

    double end() const override { return end_; }
    bool done() const override { return false; }
    void resume(double t, const std::vector<double>& y, const Phase& phase) override;
    void step(const SegmentInterval& s) override;

    // `pause` is called when the tangents reach the instant t, and after each touch, because an impact may shrink a
    // tangent by any factor. It may change the tangents and returns the next instant.
    void pause_at(double t, std::function<double(double t)> pause) {
        next_pause_ = t;
        pause_ = std::move(pause);
    }
    // Projects the tangents of a start in sustained contact onto differences that remain on the cam. Without this, gap
    // and gap rate are free there, and decay according to (S45).
    void start_on_cam() { starts_kept_ = true; }
    // The tangents; `canonical`: with the momentum ∂T/∂ξ̇ in place of ξ̇ (S73).
    Eigen::MatrixXd tangents(bool canonical = false);
    // Makes the tangents orthonormal, in units. Returns the factor R by which they were the product QR.
    Eigen::MatrixXd factor();
    void set_canonical(const Eigen::MatrixXd& tangents);

    // In sustained contact: the same projection at the present instant.
    void keep_on_cam() {
        if (phase_.held) saltation_.start_on_cam(t_, y_.data(), phase_, tangents_);
    }

    // At the present instant: the ratio of volumes in (ξ, ∂T/∂ξ̇) and in (ξ, ξ̇), up to a constant (S73).
    double inertia_share();

    // Units of the rows: √J Ω and √m ω_i of ξ, √J and √m of ξ̇, then of z and δ̇₋.
    const Eigen::VectorXd& units() const { return units_; }
    const std::vector<TangentTouch>& touches() const { return saltation_.touches(); }
    long holds() const { return saltation_.holds(); }  // impacts followed by sustained contact
    long lifts() const { return saltation_.lifts(); }  // ends of sustained contact

  private:
    System probe_;  // evaluates the contact and the inertia along the motion
    Variation variation_;
    Eigen::MatrixXd inertia_;  // M of the straight beam, of a prescribed hub with the hub's row and column of 1
    int n_;
    Eigen::VectorXd units_;
    Eigen::MatrixXd tangents_;  // at t_, in units
    double t_ = 0;
    std::vector<double> y_;  // the state at t_
    TangentStep tangent_step_;
    Saltation saltation_;
    Phase phase_;  // since the last event
    double end_, next_pause_ = std::numeric_limits<double>::infinity();
    std::function<double(double)> pause_;
    bool starts_kept_ = false, begun_ = false;
};

}  // namespace beamcam::sim
