#include "sim/sweep/flight_series.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/sweep/constants.hpp"

namespace beamcam::sim {

// With s = sin θ, c = cos θ: j s_j = Σ i a_i c_{j−i}, j c_j = −Σ i a_i s_{j−i}, (j+1)(j+2) a_{j+2} = −k c_j + α δ_{j0};
// a tangent obeys δ̈ = k s δ.                                                                                 (S83)
void FlightSeries::expand(const RodState& from, bool tangent) {
    tangent_ = tangent;
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
    if (tangent) {
        d_[0] = from.d_theta;
        d_[1] = from.d_rate;
        for (int j = 0; j + 2 <= kOrder; ++j) {
            double sum = 0;
            for (int i = 0; i <= j; ++i) sum += s[i] * d_[j - i];
            d_[j + 2] = k_ * sum / ((j + 1) * (j + 2));
        }
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

double FlightSeries::value(const double* a, double dt) {
    if (dt == 0) return a[0];
    double sum = a[kOrder];
    for (int j = kOrder - 1; j >= 0; --j) sum = sum * dt + a[j];
    return sum;
}

double FlightSeries::slope(const double* a, double dt) {
    if (dt == 0) return a[1];
    double sum = kOrder * a[kOrder];
    for (int j = kOrder - 1; j >= 1; --j) sum = sum * dt + j * a[j];
    return sum;
}

RodState FlightSeries::at(double dt) const {
    if (!tangent_) return {theta(dt), rate(dt), 0, 0};
    return {theta(dt), rate(dt), value(d_, dt), slope(d_, dt)};
}

double FlightSeries::acceleration(double theta) const { return alpha_ - k_ * std::cos(theta); }

}  // namespace beamcam::sim
