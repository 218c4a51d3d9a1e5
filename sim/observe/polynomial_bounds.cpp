#include "sim/observe/polynomial_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "sim/integrate/collocation.hpp"
#include "sim/integrate/constants.hpp"
#include "sim/observe/constants.hpp"

namespace beamcam::sim {
namespace {

Lanes derivative(const Lanes& nodal, double h) {
    Lanes out{};
    for (int l = 0; l < kNodes; ++l) out += (nodal[l] / h) * Collocation::get().slope[static_cast<std::size_t>(l)];
    return out;
}

// A bound of |f| from its values at nodes and ends, and a bound of |f″|: between two neighbours it leaves the line
// through them by at most an eighth of the square of their distance.
double bound_between(double largest_value, double second, double h) {
    const double gap = kWidestNodeGap * h;
    return largest_value + 0.125 * second * gap * gap;
}

double largest_of(const Lanes& nodal, double first, double last) {
    return std::max({largest(nodal), std::fabs(first), std::fabs(last)});
}

}  // namespace

PolynomialBounds::PolynomialBounds(const ModeBasis& basis) : basis_(basis), q_(basis.size()), rate_(q_), force_(q_) {
    modes_.modes.resize(basis.size());
    for (auto* v : {&first_, &last_, &first_rate_, &last_rate_}) v->resize(basis.size() + 1);
}

void PolynomialBounds::set(System& system, double from, double to, const States& states) {
    const std::size_t size = basis_.size() + 1;
    for (std::size_t k = 0; k < kNodes + 2; ++k) {
        double x[kMaxSize], v[kMaxSize];
        std::copy_n(states[k], size, x);
        std::copy_n(states[k] + size, size, v);
        basis_.to_modes(x);
        basis_.to_modes(v);
        if (k == 0 || k == kNodes + 1) {
            std::copy_n(x, size, k == 0 ? first_.data() : last_.data());
            std::copy_n(v, size, k == 0 ? first_rate_.data() : last_rate_.data());
            continue;
        }
        const int node = static_cast<int>(k) - 1;
        angle_[node] = x[0];
        theta_dot_[node] = v[0];
        for (std::size_t i = 0; i + 1 < size; ++i) {
            q_[i][node] = x[1 + i];
            rate_[i][node] = v[1 + i];
        }
    }
    const double h = to - from;
    for (std::size_t i = 0; i + 1 < size; ++i) modes_.modes[i] = bound(i, h, rate_[i], force_[i]);
    modes_.q = q_;
    modes_.rate = rate_;
    modes_.force = force_;
    modes_.angle = angle_;
    modes_.theta_dot = theta_dot_;
    modes_.h = h;
    modes_.resolved = true;
    bound_hub(system, from, to);
    bound_points();
    bound_power(system, h, states);
}

ModalBounds::Mode PolynomialBounds::bound(std::size_t i, double h, Lanes& rate, Lanes& force) {
    const ModeBasis::Mode& of = basis_.modes[i];
    const Lanes acceleration = derivative(rate, h);
    force = acceleration + of.damping * rate + (of.omega * of.omega) * q_[i];
    const Lanes jerk = derivative(acceleration, h);
    const double third = kNodeOvershoot * largest(jerk), fourth = kNodeOvershoot * largest(derivative(jerk, h));
    ModalBounds::Mode mode;
    mode.acceleration = kNodeOvershoot * largest(acceleration);
    mode.amplitude = bound_between(largest_of(q_[i], first_[i + 1], last_[i + 1]), mode.acceleration, h);
    mode.rate = bound_between(largest_of(rate, first_rate_[i + 1], last_rate_[i + 1]), third, h);
    mode.set_frequencies(third, fourth);
    double low = std::min(first_[i + 1], last_[i + 1]), high = std::max(first_[i + 1], last_[i + 1]);
    for (int k = 0; k < kNodes; ++k) {
        low = std::min(low, q_[i][k]);
        high = std::max(high, q_[i][k]);
    }
    mode.low = low - bound_between(0, mode.acceleration, h);
    mode.high = high + bound_between(0, mode.acceleration, h);
    return mode;
}

void PolynomialBounds::bound_hub(System& system, double from, double to) {
    const double h = to - from;
    if (system.drive().prescribed()) {
        const Lanes at = from + h * Collocation::get().c;
        for (int k = 0; k < kNodes; ++k) {
            angle_[k] = system.drive().motion(at[k]).angle;
            theta_dot_[k] = system.drive().motion(at[k]).rate;
        }
        for (auto [t, x, v] : {std::tuple{from, &first_, &first_rate_}, std::tuple{to, &last_, &last_rate_}}) {
            (*x)[0] = system.drive().motion(t).angle;
            (*v)[0] = system.drive().motion(t).rate;
        }
        modes_.angle = angle_;
        modes_.theta_dot = theta_dot_;
    }
    const Lanes acceleration = derivative(theta_dot_, h);
    MotionBounds& m = motion_ = {};
    m.theta_ddot = kNodeOvershoot * largest(acceleration);
    m.theta_dot = bound_between(largest_of(theta_dot_, first_rate_[0], last_rate_[0]),
                                kNodeOvershoot * largest(derivative(acceleration, h)), h);
    const auto [low, high] = std::minmax(first_[0], last_[0]);
    m.angle_low = low - 0.5 * m.theta_dot * h;
    m.angle_high = high + 0.5 * m.theta_dot * h;
}

void PolynomialBounds::bound_points() {
    for (std::size_t i = 0; i < basis_.size(); ++i) {
        const ModeBasis::Mode& of = basis_.modes[i];
        const ModalBounds::Mode& mode = modes_.modes[i];
        motion_.deflection_speed += of.shape * mode.rate;
        motion_.slope_speed += of.slope * mode.rate;
    }
}

// The ledger is a polynomial, too.
void PolynomialBounds::bound_power(System& system, double h, const States& states) {
    const auto power = [&](Ledger entry) {
        const auto at = static_cast<std::size_t>(system.controlled + entry);
        Lanes values;
        for (int k = 0; k < kNodes; ++k) values[k] = states[static_cast<std::size_t>(k) + 1][at];
        return kNodeOvershoot * largest(derivative(values, h));
    };
    modes_.power_cam = power(kWorkCam);
    modes_.power_drive = power(kWorkDrive);
}

}  // namespace beamcam::sim
