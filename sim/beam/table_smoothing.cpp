#include "sim/beam/table_smoothing.hpp"

#include <algorithm>
#include <cmath>

#include "sim/base/numerics.hpp"

namespace beamcam::sim {
namespace {

// Tables: fewer values do not show that they are multiples of a step; and the largest distance from a multiple, as a
// share of the step, to which a table in text rounds its values.
constexpr std::size_t kFewestSteppedValues = 20;
constexpr double kStepError = 0.15;
constexpr double kLeastLogSmoothing = -14;  // of the dimensionless λ: the spline passes through the points

// Reinsch's equations (R + λQᵀQ)c = Qᵀy, s = y − λQc for the second derivatives c at the inner points (S93). Times are
// divided by their mean distance, so that λ has no dimension.
class SmoothingSpline {
  public:
    SmoothingSpline(const std::vector<double>& t, const std::vector<double>& y)
        : y_(y), inner_(t.size() - 2), inverse_(t.size() - 1), c_(inner_) {
        const double mean = (t.back() - t.front()) / static_cast<double>(inverse_.size());
        for (std::size_t i = 0; i < inverse_.size(); ++i) inverse_[i] = mean / (t[i + 1] - t[i]);
    }

    double rms_distance(double lambda) {
        solve(lambda);
        double sum = 0;
        for (std::size_t i = 0; i < y_.size(); ++i) sum += std::pow(distance(lambda, i), 2);
        return std::sqrt(sum / static_cast<double>(y_.size()));
    }
    std::vector<double> values(double lambda) {
        solve(lambda);
        std::vector<double> out = y_;
        for (std::size_t i = 0; i < out.size(); ++i) out[i] -= distance(lambda, i);
        return out;
    }

  private:
    // Column i of Q has these three entries, from row i on.
    double first(std::size_t i) const { return inverse_[i]; }
    double middle(std::size_t i) const { return -inverse_[i] - inverse_[i + 1]; }
    double last(std::size_t i) const { return inverse_[i + 1]; }

    // λ(Qc)ᵢ
    double distance(double lambda, std::size_t i) const {
        double sum = 0;
        if (i < inner_) sum += first(i) * c_[i];
        if (i >= 1 && i - 1 < inner_) sum += middle(i - 1) * c_[i - 1];
        if (i >= 2) sum += last(i - 2) * c_[i - 2];
        return lambda * sum;
    }

    // LDLᵀ of the matrix, which has two diagonals beside the main one.
    void solve(double lambda) {
        std::vector<double> d(inner_), beside(inner_), second(inner_);
        for (std::size_t i = 0; i < inner_; ++i) {
            const double h = 1 / inverse_[i], next = 1 / inverse_[i + 1];
            d[i] = (h + next) / 3 + lambda * (first(i) * first(i) + middle(i) * middle(i) + last(i) * last(i));
            if (i + 1 < inner_) beside[i] = next / 6 + lambda * (middle(i) * first(i + 1) + last(i) * middle(i + 1));
            if (i + 2 < inner_) second[i] = lambda * last(i) * first(i + 2);
            c_[i] = first(i) * y_[i] + middle(i) * y_[i + 1] + last(i) * y_[i + 2];
            if (i >= 1) {
                d[i] -= d[i - 1] * beside[i - 1] * beside[i - 1];
                beside[i] -= d[i - 1] * beside[i - 1] * second[i - 1];
                c_[i] -= beside[i - 1] * c_[i - 1];
            }
            if (i >= 2) {
                d[i] -= d[i - 2] * second[i - 2] * second[i - 2];
                c_[i] -= second[i - 2] * c_[i - 2];
            }
            beside[i] /= d[i];
            second[i] /= d[i];
        }
        for (std::size_t i = inner_; i-- > 0;) {
            c_[i] /= d[i];
            if (i + 1 < inner_) c_[i] -= beside[i] * c_[i + 1];
            if (i + 2 < inner_) c_[i] -= second[i] * c_[i + 2];
        }
    }

    const std::vector<double>& y_;
    std::size_t inner_;
    std::vector<double> inverse_;  // of the distances in time
    std::vector<double> c_;
};

}  // namespace

// The step is refined from the smallest differences to the largest ones, whose multiples it decides.
std::optional<double> table_step(const std::vector<double>& values) {
    std::vector<double> differences;
    for (std::size_t i = 1; i < values.size(); ++i)
        if (values[i] != values[i - 1]) differences.push_back(std::fabs(values[i] - values[i - 1]));
    if (values.size() < kFewestSteppedValues || differences.empty()) return std::nullopt;
    std::ranges::sort(differences);
    double step = differences.front(), sum = 0, multiples = 0;
    for (const double difference : differences) {
        const double multiple = std::round(difference / step);
        if (std::fabs(difference - multiple * step) > kStepError * step) return std::nullopt;
        sum += difference;
        multiples += multiple;
        step = sum / multiples;
    }
    return step;
}

// Independent errors of step²/12 give a second difference of three values the variance step²/2.
Roughness roughness(const std::vector<double>& t, const std::vector<double>& values, double step) {
    Roughness out;
    for (std::size_t i = 1; i + 1 < t.size(); ++i) {
        const double left = t[i] - t[i - 1], right = t[i + 1] - t[i], mean = 0.5 * (left + right);
        const double slopes = (values[i + 1] - values[i]) / right - (values[i] - values[i - 1]) / left;
        out.found += std::pow(slopes / mean, 2);
        out.by_steps += 0.5 * std::pow(step / (mean * mean), 2);
    }
    const double count = std::max(1.0, static_cast<double>(t.size()) - 2);
    return {std::sqrt(out.found / count), std::sqrt(out.by_steps / count)};
}

// The distance grows with λ, from 0 to that of the regression line.
std::vector<double> smoothed(const std::vector<double>& t, const std::vector<double>& y, double deviation) {
    if (t.size() < 3 || !(deviation > 0)) return y;
    SmoothingSpline spline(t, y);
    const auto excess = [&](double log) { return spline.rms_distance(std::exp(log)) - deviation; };
    const double highest = 4 * std::log(static_cast<double>(t.size()));
    double low = kLeastLogSmoothing, high = low;
    while (high < highest && excess(high) < 0) low = high, high += 1;
    if (high >= highest || high == low) return spline.values(std::exp(high));
    return spline.values(std::exp(find_root(excess, low, high)));
}

}  // namespace beamcam::sim
