#include "sim/observe/undamped_mode.hpp"

#include "sim/integrate/collocation.hpp"
#include "sim/observe/constants.hpp"

namespace beamcam::sim {

// p = Σ (−1)ʲ f⁽²ʲ⁾/ω²⁺²ʲ
UndampedMode::UndampedMode(const ModalBounds& step, std::size_t i, double omega, double t0, double other)
    : t0_(t0), h_(step.h), frequency_(omega - step.modes[i].lag), error_(other) {
    const Collocation& gauss = Collocation::get();
    const double per_step = 2 / h_, square = omega * omega;
    std::array<double, kNodes> term{};
    for (std::size_t j = 0; j < kNodes; ++j) term[j] = sum(gauss.monomial[j] * step.force[i]) / square;
    for (int derivative = 0; derivative < kNodes; derivative += 2) {
        for (std::size_t j = 0; j < kNodes; ++j) powers_[j] += term[j];
        for (std::size_t j = 0; j < kNodes; ++j) {
            const auto power = static_cast<double>(j + 1);
            term[j] = j + 2 < kNodes ? -(power + 1) * power * per_step * per_step / square * term[j + 2] : 0;
        }
    }
    const auto time = [&](int k) { return t0_ + gauss.c[k] * h_; };
    const auto [value, rate] = followed(time(0));
    const double w = step.q[i][0] - value, u = (step.rate[i][0] - rate) / omega;
    amplitude_ = std::hypot(w, u);
    phase_ = std::atan2(-u, w) - frequency_ * (time(0) - t0_);
    double slope = 0, bend = 0;  // bounds of |ṗ|, |p̈|
    for (std::size_t j = 1; j < kNodes; ++j) {
        const auto power = static_cast<double>(j);
        slope += std::fabs(powers_[j]) * power * per_step;
        bend += std::fabs(powers_[j]) * power * (power - 1) * per_step * per_step;
    }
    const double stiff = amplitude_ * frequency_ * frequency_;
    has_crests_ = frequency_ > 0 && bend < kMostBend * stiff && slope * frequency_ < kMostSlope * stiff;
    if (!has_crests_) return;
    double farthest = 0;
    for (int k = 1; k < kNodes; ++k) {
        const double here = followed(time(k)).value + amplitude_ * std::cos(frequency_ * (time(k) - t0_) + phase_);
        farthest = std::max(farthest, std::fabs(here - step.q[i][k]));
    }
    error_ += kFormMargin * farthest;
    has_crests_ = error_ <= kFormRounding * amplitude_;
}

UndampedMode::Slope UndampedMode::followed(double t) const {
    const double z = 2 * (t - t0_) / h_ - 1;
    double value = 0, slope = 0;
    for (std::size_t j = kNodes; j-- > 0;) {
        slope = slope * z + value;
        value = value * z + powers_[j];
    }
    return {value, slope * 2 / h_};
}

}  // namespace beamcam::sim
