// An integrator that carries tangents of the flow along with the motion: differences of neighbouring motions, to first
// order. The motion is that of the wrapped integrator, bit by bit. Tangents are integrated over each of its steps once
// the step is final (tangent_step.hpp). A Run restarts its integrator after each event, where the saltation is applied
// (saltation.hpp). MODEL.md §16a.
//
// Tangents have 2n + 2 rows: ξ, ξ̇, z, δ̇₋, in units (`units`) that give each row about the same energy.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "sim/integrate/integrator.hpp"
#include "sim/orbit/saltation.hpp"
#include "sim/orbit/tangent_step.hpp"

namespace beamcam::sim {

class TangentIntegrator final : public Integrator {
  public:
    // `system` is the system of the run, integrated by `motion`. `tangents` has 2n rows, in units, and any number of
    // columns. `progress` receives the time that the tangents have reached.
    TangentIntegrator(System& system, std::unique_ptr<Integrator> motion, double rtol, const Eigen::MatrixXd& tangents,
                      const Progress& progress);

    void start(double t, const double* y) override;
    const Segment& step() override;
    const Segment& shorten(double t1) override;

    // Makes a step of the motion end at this instant.
    void end_at(double t) { end_ = t; }
    // `pause` is called when the tangents reach the instant t, and after each touch, because an impact may shrink a
    // tangent by any factor. It may change the tangents and returns the next instant.
    void pause_at(double t, std::function<double(double t)> pause) {
        next_pause_ = t;
        pause_ = std::move(pause);
    }
    // Projects the tangents of a start in sustained contact onto differences that remain on the cam. Without this, gap
    // and gap rate are free there, and decay according to (S45).
    void start_on_cam() { starts_kept_ = true; }
    // After the run: integrates the tangents up to its end. Throws SolverError.
    void finish(double t);
    // The tangents; `canonical`: with the momentum ∂T/∂ξ̇ in place of ξ̇ (S73).
    Eigen::MatrixXd tangents(bool canonical = false) const;
    // Makes the tangents orthonormal, in units. Returns the factor R by which they were the product QR.
    Eigen::MatrixXd factor();
    void set_canonical(const Eigen::MatrixXd& tangents);

    // In sustained contact: the same projection at the present instant.
    void keep_on_cam() {
        if (phase_.held) saltation_.start_on_cam(t_, y_.data(), phase_, tangents_);
    }

    double inertia_share() const;  // at the present instant (S73)

    // Units of the rows: √J Ω and √m ω_i of ξ, √J and √m of ξ̇, then of z and δ̇₋.
    const Eigen::VectorXd& units() const { return units_; }
    const std::vector<TangentTouch>& touches() const { return saltation_.touches(); }
    long holds() const { return saltation_.holds(); }  // impacts followed by sustained contact
    long lifts() const { return saltation_.lifts(); }  // ends of sustained contact

  private:
    const Segment& accept(const Segment& segment);
    void advance(double t);

    System& system_;
    System probe_;  // a separate copy, so that evaluations do not affect the motion
    ModalJets jets_;
    std::unique_ptr<Integrator> motion_;
    int n_;
    Eigen::VectorXd units_;
    Eigen::MatrixXd tangents_;  // at t_, in units
    double t_ = 0;
    std::vector<double> y_;  // the state at t_
    TangentStep tangent_step_;
    Saltation saltation_;
    const Segment* segment_ = nullptr;  // the last step of the motion
    Phase phase_;                       // since the last start
    double next_pause_ = std::numeric_limits<double>::infinity(), end_ = next_pause_;
    std::function<double(double)> pause_;
    bool starts_kept_ = false;
};

}  // namespace beamcam::sim
