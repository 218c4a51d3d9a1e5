#include "sim/sweep/flight_series.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace beamcam::sim {

constexpr double kSeriesReach = 0.9;  // of the length that the last terms of the series allow
constexpr double kLongestTurn = 1;    // [rad] of a series without gravity, which is a polynomial

// With s = sin θ, c = cos θ: j s_j = Σ i a_i c_{j−i}, j c_j = −Σ i a_i s_{j−i}, (j+1)(j+2) a_{j+2} = −k c_j + α δ_{j0}.
// (S83)
void FlightSeries::expand(const RodState& from) {
    double s[kOrder], c[kOrder], turn[kOrder + 1];  // turn[i] = i a_i
    a_[0] = from.theta;
    a_[1] = turn[1] = from.rate;
    s[0] = std::sin(from.theta);
    c[0] = std::cos(from.theta);
    for (int j = 0;; ++j) {
        if (j > 0) {
            double sine = 0, cosine = 0;
            for (int i = 1; i <= j; ++i) {
                sine += turn[i] * c[j - i];
                cosine -= turn[i] * s[j - i];
            }
            s[j] = sine / j;
            c[j] = cosine / j;
        }
        if (j + 2 > kOrder) break;
        turn[j + 2] = (-k_ * c[j] + (j == 0 ? alpha_ : 0)) / (j + 1);
        a_[j + 2] = turn[j + 2] / (j + 2);
    }
    if (k_ == 0) {
        length_ = kLongestTurn / (std::fabs(from.rate) + std::sqrt(std::fabs(alpha_)) + 1e-30);
        return;
    }
    const auto reaches = [&](int order) {
        const double last = std::fabs(a_[order]);
        return last > 0 ? std::pow(kAngleRounding / last, 1.0 / order) : std::numeric_limits<double>::infinity();
    };
    length_ = kSeriesReach *
              std::min({reaches(kOrder), reaches(kOrder - 1), 1 / std::sqrt(std::fabs(k_) + std::fabs(alpha_))});
}

double FlightSeries::theta(double dt) const {
    if (dt == 0) return a_[0];
    double sum = a_[kOrder];
    for (int j = kOrder - 1; j >= 0; --j) sum = sum * dt + a_[j];
    return sum;
}

double FlightSeries::rate(double dt) const {
    if (dt == 0) return a_[1];
    double sum = kOrder * a_[kOrder];
    for (int j = kOrder - 1; j >= 1; --j) sum = sum * dt + j * a_[j];
    return sum;
}

}  // namespace beamcam::sim
