// An undamped mode within a step of the collocation in closed form: q = p(t) + a cos(ωt + φ), where the polynomial p
// follows the forcing without vibration. Its crests are enumerated without evaluating the state. MODEL.md §12, (S59).
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/integrate/integrator.hpp"
#include "sim/integrate/step_polynomial.hpp"

namespace beamcam::sim {

class UndampedMode {
  public:
    // Mode i of the step that begins at t0; the natural frequency in rad/s. `other`: bound of what else the channel is.
    UndampedMode(const ModalBounds& step, std::size_t i, double natural_frequency, double t0, double other);

    // The vibration is so much faster than p that every maximum is within 1 rad of one of the vibration.
    bool has_crests() const { return has_crests_; }
    // Calls visit(a, b, high) for each maximum of sign·q in [from, to], those at its ends aside: it is in [a, b], and
    // at most `high`.
    template <class Visit>
    void each_crest(double sign, double from, double to, Visit&& visit) const;

  private:
    // Of aω² and aω: |p̈| and |ṗ| are less. cos 1 = 0.54; then a cos ωt + p has no maximum beyond 1 rad.
    static constexpr double kMostBend = 0.1, kMostSlope = 0.4, kLeastBend = 0.44;
    struct Slope {
        double value, rate;
    };
    Slope followed(double t) const;  // p, ṗ

    StepPolynomial steady_, speed_;  // p, ṗ
    double t0_, h_, frequency_, amplitude_ = 0, phase_ = 0;
    double error_;  // of all this, in the channel
    bool has_crests_ = false;
};

// Within 1 rad of a crest of the vibration q̈ <= −kaω², k = cos 1 − |p̈|/aω²: from a point with the slope r on, q rises
// by at most ½r²/(kaω²) and, at the distance d from the end of the interval, rd; it is smaller by 2e beyond the
// distance (2r + 2√(kaω²e))/(kaω²).
template <class Visit>
void UndampedMode::each_crest(double sign, double from, double to, Visit&& visit) const {
    const double period = 2 * std::numbers::pi / frequency_, reach = 1 / frequency_;
    const double stiff = amplitude_ * frequency_ * frequency_, bend = kLeastBend * stiff;
    const double first = t0_ - (phase_ + (sign < 0 ? std::numbers::pi : 0)) / frequency_;
    for (double k = std::ceil((from - reach - first) / period); first + k * period < to + reach; ++k) {
        const double crest = first + k * period, low = std::max(from, crest - reach),
                     high = std::min(to, crest + reach);
        const double near = std::clamp(crest, low, high);
        const double t = std::clamp(near + sign * followed(near).rate / stiff, low, high);
        const auto [value, rate] = followed(t);
        const double x = frequency_ * (t - crest);
        const double slope = sign * rate - amplitude_ * frequency_ * std::sin(x);
        const double rise = slope > 0 ? std::min(0.5 * slope / bend, high - t) : std::max(0.5 * slope / bend, low - t);
        const double around = 2 * (std::fabs(slope) + std::sqrt(bend * error_)) / bend;
        visit(std::max(low, t - around), std::min(high, t + around),
              sign * value + amplitude_ * std::cos(x) + slope * rise + error_);
    }
}

}  // namespace beamcam::sim
