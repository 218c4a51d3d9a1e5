// The Runge–Kutta method of rk8.cpp for the state and, beside it, for tangents of the flow: small differences of
// neighbouring motions, to first order. A Run that is given this integrator carries them through its events, because it
// starts the integrator anew after each: that is where the saltation (S71) is applied. MODEL.md §16a.
//
// Tangents have 2n + 2 rows: ξ, ξ̇, z, δ̇₋, each in units (`unit`) in which a row of one stands for about the same
// energy.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "sim/integrate/integrator.hpp"
#include "sim/orbit/modal_jets.hpp"

namespace beamcam::sim {

struct TangentTouch {
    double t = 0;         // [s]
    double approach = 0;  // −ġ before it [m/s]
};

class TangentIntegrator final : public Integrator, private Segment {
  public:
    // `system` is what the run integrates. `tangents` has 2n rows, in units, and any number of columns.
    TangentIntegrator(System& system, double rtol, double atol, const Eigen::MatrixXd& tangents);
    ~TangentIntegrator() override;

    void start(double t, const double* y) override;
    const Segment& step() override;
    const Segment& shorten(double t1) override;

    // Steps end at this instant; then `pause` is called, which may change the tangents and gives the next instant. It
    // is called after each touch, too: an impact may shrink a tangent by any factor.
    void pause_at(double t, std::function<double(double t)> pause) {
        next_pause_ = t;
        pause_ = std::move(pause);
    }
    // A start on the cam lets the tangents keep what remains on it; else gap and gap rate are free there, and decay
    // as (S45) has it.
    void start_on_cam() { starts_free_ = false; }
    // At the end of the last step; ξ̇ in units of its canonical momentum (S73) where `canonical`.
    Eigen::MatrixXd tangents(bool canonical = false) const;
    void set_tangents(const Eigen::MatrixXd& tangents, bool canonical = false);
    // The state there.
    const double* state() const { return end_.data(); }

    double inertia_share() const;  // there (S73)

    // Of the rows [1/s-like magnitudes: √J Ω, √m ω_i; √J, √m; …].
    const Eigen::VectorXd& units() const { return units_; }
    const std::vector<TangentTouch>& touches() const { return touches_; }
    long holds() const { return holds_; }  // strikes that sustained contact followed

  private:
    class Flow;
    void value(double t, double* y) const override;
    void saltation(double t, const double* after, const Phase& was, const Phase& is);
    void strike(double t, const double* after, const Phase& was, const Phase& is);
    void begin_touch(double t, const Phase& was, const Phase& is);
    JetState event_jets(double t, const Phase& was, Eigen::Index first);
    void change_grip(double t, const double* after, const Phase& was, const Phase& is);
    void release();
    void keep_on_cam(double t, const double* y);
    const Segment& arrive(const Segment& inner);

    System& system_;
    System probe_;       // evaluates at events, so that the motion does not depend on it
    ContactState near_;  // at the last event
    ModalJets jets_;
    std::unique_ptr<Flow> flow_;
    std::unique_ptr<Integrator> inner_;
    int n_, rows_, columns_;
    Eigen::VectorXd units_;
    Eigen::MatrixXd tangents_;  // at the end of the last step, in units
    std::vector<double> end_;   // all of the inner state there
    mutable std::vector<double> scratch_;
    const Segment* segment_ = nullptr;  // of the inner integrator
    Phase phase_;                       // of the last start
    double next_pause_;
    std::function<double(double)> pause_;
    std::vector<TangentTouch> touches_;
    long holds_ = 0;
    bool starts_free_ = true;
};

}  // namespace beamcam::sim
