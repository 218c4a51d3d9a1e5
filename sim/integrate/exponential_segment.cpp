#include "sim/integrate/exponential_segment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace beamcam::sim {

ExponentialSegment::ExponentialSegment(std::shared_ptr<const ModalForm> modal_form, const DriveLaw& drive_law,
                                       int state_size)
    : form_(std::move(modal_form)), drive_(drive_law), n_(static_cast<std::size_t>(form_->n)) {
    controlled_ = static_cast<std::size_t>(state_size) - kLedgerSize;
    q0.resize(n_);
    v0.resize(n_);
    q.resize(n_);
    v.resize(n_);
    f.resize(n_);
    end.resize(static_cast<std::size_t>(state_size));
}

double ExponentialSegment::inertia(const double* x) const {
    double bq[kMaxModes] = {}, total = form_->J;  // B is symmetric
    const double* column = form_->inertia.data();
    for (std::size_t j = 0; j < n_ && column; ++j, column += n_)
        for (std::size_t i = 0; i < n_; ++i) bq[i] += column[i] * x[j];
    for (std::size_t i = 0; i < n_; ++i) total += bq[i] * x[i];
    return total;
}

void ExponentialSegment::integrate_hub() {
    turn_ = StepPolynomial::through(theta_dot).integral();
    momentum_ = StepPolynomial::through(p_dot).integral();
}

// The start of the step or the last node before t = t0 + sh, or at t but for its rounding.
std::size_t ExponentialSegment::last_point(double t, double s) const {
    const Collocation& gauss = Collocation::get();
    const double at = s + std::numeric_limits<double>::epsilon() * std::fabs(t) / h;
    std::size_t point = 0;
    while (point < kNodes && gauss.point[point + 1] <= at) ++point;
    return point;
}

// q and q̇ of the modes at t = t0 + sh, from the last point before.
void ExponentialSegment::evolve(double t, double s, double* y) const {
    const std::size_t point = last_point(t, s);
    const double tau = (s - Collocation::get().point[point]) * h;
    double *x = y + 1, *dx = y + 2 + n_;
    for (std::size_t i = 0; i < n_; ++i) {
        const int node = static_cast<int>(point) - 1;
        x[i] = point == 0 ? q0[i] : q[i][node];
        dx[i] = point == 0 ? v0[i] : v[i][node];
    }
    if (!(tau > std::numeric_limits<double>::epsilon() * std::fabs(t))) return;
    const Derivatives derive = derivatives_at(point, h);
    for (std::size_t i = 0; i < n_; ++i) {
        const Propagation p = propagate(form_->oscillators[i], derive, tau);
        const double from = x[i];
        x[i] = p.qq * from + p.qv * dx[i] + sum(p.forced_q * f[i]);
        dx[i] = p.vq * from + p.vv * dx[i] + sum(p.forced_v * f[i]);
    }
}

void ExponentialSegment::value(double t, double* y) const {
    if (t == t1)
        std::copy(end.begin(), end.end(), y);
    else
        value_inside(t, y);
}

// The modes and the frame, with their rates.
void ExponentialSegment::evaluate(double t, double* y) const {
    const double s = (t - t0) / h;
    double* rates = y + 1 + n_;
    evolve(t, s, y);
    if (form_->prescribed) {
        const HubMotion motion = drive_.motion(t);
        y[0] = motion.angle;
        rates[0] = motion.rate;
    } else {
        y[0] = theta0 + h * turn_(2 * s - 1);
        rates[0] = (p0 + h * momentum_(2 * s - 1)) / inertia(y + 1);
    }
}

void ExponentialSegment::motion_inside(double t, double* y) const {
    evaluate(t, y);
    form_->to_coordinates(y);
}

void ExponentialSegment::value_inside(double t, double* y) const {
    const double s = (t - t0) / h;
    evaluate(t, y);
    if (has_bristle())
        y[2 * (n_ + 1)] =
            touching ? bristle0 + h * sum(Collocation::get().weights_to(s) * bristle_rate) : end[2 * (n_ + 1)];
    put_ledger(t, s, y);
    form_->to_coordinates(y);
}

}  // namespace beamcam::sim
