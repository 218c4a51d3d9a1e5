// The derivatives of the equations of motion by the state and the time: of the vector field within a phase, and of the
// contact and the reset of impacts at events. They are central differences of System, for every model; the slopes of
// the contact law, which is not smooth where the bodies touch, are exact. MODEL.md (S70).
//
// A derivative has a row for each value and these columns: ξ, ξ̇, the bristle's deflection z, the approach speed δ̇₋ of a
// compliant touch (S72), and the time. With a prescribed hub the columns of its angle and rate are zero.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "sim/dynamics/system.hpp"

namespace beamcam::sim {

// The rate of the hub in motions of this problem, that of the cam or of a pendulum [1/s].
double typical_rate(const Problem& problem);

class Variation {
  public:
    explicit Variation(const System& system);  // copies it

    // Places of z, δ̇₋ and t among the columns.
    int bristle() const { return 2 * n_; }
    int approach() const { return 2 * n_ + 1; }
    int time() const { return 2 * n_ + 2; }

    // All that follow refer to this state; `y` has the coordinates, rates and bristle of System.
    void set(double t, const double* y, const Phase& phase);

    // ξ̈ and, of stick–slip friction, ż.
    Eigen::MatrixXd field();
    // Gap and gap rate.
    Eigen::MatrixXd contact();
    // Normal and friction force of compliant contact.
    Eigen::MatrixXd forces();
    // ξ̇ after an impact with this restitution, by the problem's impact law and friction.
    Eigen::MatrixXd impact(double restitution);

  private:
    using Values = std::function<bool(double t, const double* y, Eigen::VectorXd& values)>;  // true: at an end
    Eigen::MatrixXd differences(Eigen::Index rows, const Values& values);
    ContactState contact_at(double t, const double* y);
    Eigen::MatrixXd geometry();
    void set_exact(Eigen::Ref<Eigen::MatrixXd> geometry);
    Eigen::MatrixXd force_slopes(const Eigen::MatrixXd& geometry) const;
    Eigen::Matrix<double, 2, 5> impulse_slopes(const Compliance& c, double v_n, double v_t, double restitution) const;
    bool acceleration(double t, const double* y, double normal, double friction, Eigen::VectorXd& values);

    System system_;
    const int n_;
    Eigen::VectorXd step_;  // of the differences by each coordinate and rate
    double time_step_;      // [s]
    double t_ = 0;
    Eigen::VectorXd y_, perturbed_;
    ContactState at_;  // the contact of the state
};

}  // namespace beamcam::sim
