// An integrator that carries, beside the motion, tangents of the flow: small differences of neighbouring motions, to
// first order. The motion is that of the integrator it is given, bit by bit; tangents follow each of its steps once
// that is final (tangent_step.hpp). A Run starts its integrator anew after each event: that is where the saltation is
// applied (saltation.hpp). MODEL.md §16a.
//
// Tangents have 2n + 2 rows: ξ, ξ̇, z, δ̇₋, each in units (`units`) in which a row of one stands for about the same
// energy.
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
    // `system` is what the run integrates, by `motion`. `tangents` has 2n rows, in units, and any number of columns.
    TangentIntegrator(System& system, std::unique_ptr<Integrator> motion, double rtol, const Eigen::MatrixXd& tangents);

    void start(double t, const double* y) override;
    const Segment& step() override;
    const Segment& shorten(double t1) override;

    // The motion's steps end at this instant, too.
    void end_at(double t) { end_ = t; }
    // When the tangents have come to this instant, `pause` is called, which may change them and gives the next one. It
    // is called after each touch, too: an impact may shrink a tangent by any factor.
    void pause_at(double t, std::function<double(double t)> pause) {
        next_pause_ = t;
        pause_ = std::move(pause);
    }
    // A start on the cam lets the tangents keep what remains on it; else gap and gap rate are free there, and decay
    // as (S45) has it.
    void start_on_cam() { starts_kept_ = true; }
    // After the run: the tangents come to its end.
    void finish(double t) {
        if (segment_) advance(t);
    }
    // Where they are; ξ̇ in units of its canonical momentum (S73) where `canonical`.
    Eigen::MatrixXd tangents(bool canonical = false) const;
    void set_tangents(const Eigen::MatrixXd& tangents, bool canonical = false);

    // Takes out of them what would leave the cam, where the beam rests on it.
    void keep_on_cam() {
        if (phase_.held) saltation_.start_on_cam(t_, y_.data(), phase_, tangents_);
    }

    double inertia_share() const;  // there (S73)

    // Of the rows [1/s-like magnitudes: √J Ω, √m ω_i; √J, √m; …].
    const Eigen::VectorXd& units() const { return units_; }
    const std::vector<TangentTouch>& touches() const { return saltation_.touches(); }
    long holds() const { return saltation_.holds(); }  // strikes that sustained contact followed
    long lifts() const { return saltation_.lifts(); }  // ends of sustained contact

  private:
    const Segment& took(const Segment& segment);
    void advance(double t);

    System& system_;
    System probe_;  // evaluates along the motion, so that it does not depend on it
    ModalJets jets_;
    std::unique_ptr<Integrator> motion_;
    int n_;
    Eigen::VectorXd units_;
    Eigen::MatrixXd tangents_;  // at t_, in units
    double t_ = 0;
    std::vector<double> y_;  // the state there
    TangentStep tangent_step_;
    Saltation saltation_;
    const Segment* segment_ = nullptr;  // the last of the motion
    Phase phase_;                       // of the last start
    double next_pause_ = std::numeric_limits<double>::infinity(), end_ = next_pause_;
    std::function<double(double)> pause_;
    bool starts_kept_ = false;
};

}  // namespace beamcam::sim
