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
    largest_.resize(n_);
    end.resize(static_cast<std::size_t>(state_size));
    const std::size_t groups = form_->groups.size();
    lanes_q_.resize(groups * kPoints);
    lanes_v_.resize(groups * kPoints);
    lanes_f_.resize(groups * kNodes);
    taylor_.resize(groups * kNodes);
}

double ExponentialSegment::theta_dot_at(double p, const double* x) const {
    double quadratic = 0;
    auto column = form_->inertia_rows.begin();
    for (std::size_t first = 0; column != form_->inertia_rows.end(); first += kNodes) {
        Lanes rows{};
        for (std::size_t j = 0; j < n_; ++j) rows += x[j] * *column++;
        for (std::size_t i = first; i < std::min(n_, first + kNodes); ++i)
            quadratic += rows[static_cast<int>(i - first)] * x[i];
    }
    return p / (form_->J + quadratic);
}

void ExponentialSegment::transpose() const {
    if (transposed_) return;
    transposed_ = true;
    for (std::size_t i = 0; i < n_; ++i) {
        const std::size_t group = i / kNodes;
        const int lane = static_cast<int>(i % kNodes);
        lanes_q_[group * kPoints][lane] = q0[i];
        lanes_v_[group * kPoints][lane] = v0[i];
        for (int k = 0; k < kNodes; ++k) {
            const auto point = static_cast<std::size_t>(k) + 1;
            lanes_q_[group * kPoints + point][lane] = q[i][k];
            lanes_v_[group * kPoints + point][lane] = v[i][k];
            lanes_f_[group * kNodes + static_cast<std::size_t>(k)][lane] = f[i][k];
        }
    }
}

// The start of the step or the last node before t = t0 + sh, or at t but for its rounding.
int ExponentialSegment::last_point(double t, double s) const {
    const Collocation& gauss = Collocation::get();
    const double at = s + std::numeric_limits<double>::epsilon() * std::fabs(t) / h;
    int point = 0;
    while (point < kNodes && gauss.point[static_cast<std::size_t>(point) + 1] <= at) ++point;
    return point;
}

// Derivatives of the forcing at the start of the step or at a node.
void ExponentialSegment::expand(int at) const {
    if (expanded_ == at) return;
    expanded_ = at;
    std::array<Lanes, kNodes> factors = Collocation::get().derive[static_cast<std::size_t>(at)];
    double inverse = 1;
    for (Lanes& factor : factors) {
        factor *= inverse;
        inverse /= h;
    }
    for (std::size_t g = 0; g < form_->groups.size(); ++g) {
        combine(factors, lanes_f_.data() + g * kNodes, taylor_.data() + g * kNodes);
    }
}

// q and q̇ of a group at t = t0 + sh, from the last point before.
void ExponentialSegment::evolve(std::size_t g, double t, double s, Lanes& x, Lanes& dx) const {
    transpose();
    const int point = last_point(t, s);
    const double tau = (s - Collocation::get().point[static_cast<std::size_t>(point)]) * h;
    const Lanes& from_q = lanes_q_[g * kPoints + static_cast<std::size_t>(point)];
    const Lanes& from_v = lanes_v_[g * kPoints + static_cast<std::size_t>(point)];
    if (!(tau > std::numeric_limits<double>::epsilon() * std::fabs(t))) {
        x = from_q;
        dx = from_v;
        return;
    }
    expand(point);
    Lanes r[kResponse];
    const OscillatorLanes& group = form_->groups[g];
    respond(group, tau, r);
    const Lanes &unit_rate = r[0], &unit = r[1], *derivatives = taylor_.data() + g * kNodes;
    x = (unit_rate + group.damping * unit) * from_q + unit * from_v;
    dx = unit_rate * from_v - group.square * unit * from_q;
    for (int j = 0; j < kNodes; ++j) {
        x += derivatives[j] * r[2 + j];
        dx += derivatives[j] * r[1 + j];
    }
}

double ExponentialSegment::coordinate(double t, std::size_t index, double* y) const {
    if (!form_->by_arrays() || t == t1) return Segment::coordinate(t, index, y);
    if (index == 0) return frame_angle(t);
    const std::size_t mode = index - 1;
    Lanes x, dx;
    evolve(mode / kNodes, t, (t - t0) / h, x, dx);
    return x[static_cast<int>(mode % kNodes)];
}

void ExponentialSegment::coordinates(double t, double* y) const {
    if (!form_->by_arrays() || t == t1) return value_without_vibration_work(t, y);
    evolve_all(t, (t - t0) / h, y);
    y[0] = frame_angle(t);
}

void ExponentialSegment::evolve_all(double t, double s, double* y) const {
    double* rates = y + 1 + n_;
    for (std::size_t g = 0; g < form_->groups.size(); ++g) {
        Lanes x, dx;
        evolve(g, t, s, x, dx);
        for (std::size_t i = g * kNodes; i < std::min(n_, (g + 1) * kNodes); ++i) {
            y[1 + i] = x[static_cast<int>(i % kNodes)];
            rates[1 + i] = dx[static_cast<int>(i % kNodes)];
        }
    }
}

void ExponentialSegment::value(double t, double* y) const {
    if (t == t1)
        std::copy(end.begin(), end.end(), y);
    else
        evaluate(t, true, y);
}

void ExponentialSegment::value_without_vibration_work(double t, double* y) const {
    if (t == t1)
        std::copy(end.begin(), end.end(), y);
    else
        evaluate(t, false, y);
}

void ExponentialSegment::motion_inside(double t, double* y) const {
    oscillate(t, y);
    form_->to_coordinates(y);
}

// The modes and the frame, with their rates.
void ExponentialSegment::oscillate(double t, double* y) const {
    const double s = (t - t0) / h;
    double* rates = y + 1 + n_;
    evolve_all(t, s, y);
    if (form_->prescribed) {
        const HubMotion motion = drive_.motion(t);
        y[0] = motion.angle;
        rates[0] = motion.rate;
    } else {
        y[0] = theta0 + h * hub().turn(2 * s - 1);
        rates[0] = theta_dot_at(p0 + h * hub().momentum(2 * s - 1), y + 1);
    }
}

void ExponentialSegment::evaluate(double t, bool vibration_work, double* y) const {
    const double s = (t - t0) / h;
    oscillate(t, y);
    const bool ledger = ledger_changes && (touching || vibration_work);  // else it is that at the start
    const bool integrates = ledger || (touching && has_bristle());
    const Lanes weights = integrates ? Collocation::get().weights_to(s) : Lanes{};
    if (has_bristle()) y[2 * (n_ + 1)] = touching ? bristle0 + h * sum(weights * bristle_rate) : end[2 * (n_ + 1)];
    if (ledger)
        set_ledger(weights, y);
    else
        std::copy_n(ledger0, kLedgerSize, y + controlled_);
    if (ledger && vibration_work) add_vibration_work(t, s, y);
    form_->to_coordinates(y);
}

double ExponentialSegment::frame_angle(double t) const {
    return form_->prescribed ? drive_.motion(t).angle : theta0 + h * hub().turn(2 * ((t - t0) / h) - 1);
}

const ExponentialSegment::Hub& ExponentialSegment::hub() const {
    if (!hub_known_) {
        hub_known_ = true;
        hub_.turn = StepPolynomial::through(theta_dot).integral();
        hub_.momentum = StepPolynomial::through(p_dot).integral();
    }
    return hub_;
}

}  // namespace beamcam::sim
