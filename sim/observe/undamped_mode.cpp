#include "sim/observe/undamped_mode.hpp"

#include "sim/integrate/collocation.hpp"
#include "sim/observe/constants.hpp"

namespace beamcam::sim {

UndampedMode::UndampedMode(const ModalBounds& step, std::size_t i, double omega, double t0, double other)
    : steady_(steady_motion({.omega = omega}, step.force[i], step.h)),
      speed_(steady_.derivative(step.h)),
      t0_(t0),
      h_(step.h),
      frequency_(omega - step.modes[i].lag),
      error_(other) {
    const Collocation& gauss = Collocation::get();
    const auto time = [&](int k) { return t0_ + gauss.c[k] * h_; };
    const auto [value, rate] = followed(time(0));
    const double w = step.q[i][0] - value, u = (step.rate[i][0] - rate) / omega;
    amplitude_ = std::hypot(w, u);
    phase_ = std::atan2(-u, w) - frequency_ * (time(0) - t0_);
    const double slope = speed_.bound(), bend = speed_.derivative(h_).bound();
    const double stiff = amplitude_ * frequency_ * frequency_;
    has_crests_ = frequency_ > 0 && bend < kMostBend * stiff && slope * frequency_ < kMostSlope * stiff;
    if (!has_crests_) return;
    double farthest = 0;
    for (const int k : {kNodes / 2, kNodes - 1}) {  // rounding is much the same at all of them
        const double here = followed(time(k)).value + amplitude_ * std::cos(frequency_ * (time(k) - t0_) + phase_);
        farthest = std::max(farthest, std::fabs(here - step.q[i][k]));
    }
    error_ += kFormMargin * farthest;
    has_crests_ = error_ <= kFormRounding * amplitude_;
}

UndampedMode::Slope UndampedMode::followed(double t) const {
    const double z = 2 * (t - t0_) / h_ - 1;
    return {steady_(z), speed_(z)};
}

}  // namespace beamcam::sim
