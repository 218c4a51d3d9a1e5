#include "sim/integrate/step_errors.hpp"

#include <algorithm>
#include <cmath>

namespace beamcam::sim {

constexpr double kLeastDecay = 1.0 / 30;        // of Legendre coefficients: the smoothest forcing assumed
constexpr double kLeastQuadratureDecay = 1e-5;  // the same for the quadrature, the fourth power of a decay
constexpr double kNegligibleChange = 1e-6;      // of the tolerance: the rounding of a motion that has hardly begun

LegendreDecay legendre_decay(const Lanes& nodal, double rounding) {
    const Lanes c = Collocation::get().legendre_coefficients(nodal);
    const auto size = [&](int j) { return std::fabs(c[j]); };
    // In this order of arguments NaN stays NaN, and no step is accepted with it.
    const double last = std::max(std::max(size(6), size(7)) - rounding, 0.0), before = std::max(size(4), size(5));
    return {last, last == 0 ? 0 : std::min(1.0, last / before)};
}

LegendreRange legendre_range(const Lanes& nodal) {
    const Lanes c = Collocation::get().legendre_coefficients(nodal);
    LegendreRange range{c[0], 0, 0};
    for (int j = 1; j < kNodes; ++j) {
        range.spread += std::fabs(c[j]);
        range.slope += j * (j + 1) * std::fabs(c[j]);
    }
    return range;
}

double interpolation_error(const Lanes& nodal) {
    const auto [last, ratio] = legendre_decay(nodal);
    return last * ratio * std::max(ratio, kLeastDecay);
}

double quadrature_error(const Lanes& nodal, double rounding) {
    const auto [last, ratio] = legendre_decay(nodal, rounding);
    const double r2 = ratio * ratio;
    return last * std::max(r2 * r2, kLeastQuadratureDecay);
}

FixedPoint::Status FixedPoint::add(double change) {
    if (!std::isfinite(change)) return Status::failed;
    const int sweep = sweeps_++;
    const double ratio = change / before_;
    before_ = change;
    if (sweep > 0) {
        const bool contracts = ratio < 0.5;
        enough_ = enough_ || change == 0 || (contracts && change * ratio / (1 - ratio) < kShareOfIteration);
        if (enough_ && (!contracts || change * std::max(ratio, contraction_) / (1 - ratio) < share_))
            return Status::settled;
        if (ratio > kStalled && change <= std::max(rounding_ * largest_, kNegligibleChange)) return Status::settled;
        if (ratio > growth_ && sweep > patience_) return enough_ ? Status::settled : Status::failed;
    }
    largest_ = std::max(largest_, change);
    return Status::going;
}

}  // namespace beamcam::sim
