// Dormand and Prince's explicit Runge–Kutta method of order 8(5,3), with the continuous extension of order 7. Step-size
// control: Hairer, Nørsett & Wanner, "Solving Ordinary Differential Equations I", 2nd ed., II.4.
//
// The three extra stages of the continuous extension are computed only if a segment is evaluated inside.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "sim/base/assert.hpp"
#include "sim/integrate/integrator.hpp"
#include "sim/integrate/rk8_tableau.hpp"

namespace beamcam::sim {
namespace {

// Step-size factors of the published code of order 8: safety, and the least and most from one step to the next.
constexpr double kRk8Safety = 0.9, kRk8Shrink = 1.0 / 3.0, kRk8Growth = 6.0;

// Of the time. Steps become so short where the equations jump: one a few times as long passes the jump, whatever its
// error, but not two in a row.
constexpr double kShortestRk8 = 4e-16;

using namespace dop853;

constexpr std::size_t kDenseRows = 7;

// The continuous extension at the share s of the step: y out of its start and seven rows, each of n numbers.
void extend(double s, std::size_t n, const double* start, const double* rows, double* y) {
    for (std::size_t i = 0; i < n; ++i) {
        double v = 0;
        for (std::size_t k = kDenseRows; k-- > 0;) v = (v + rows[k * n + i]) * (k % 2 ? 1 - s : s);
        y[i] = start[i] + v;
    }
}

class Rk8 final : public Integrator, private Segment {
  public:
    Rk8(Ode& ode, double rtol, double atol)
        : ode_(ode), rtol_(rtol), atol_(atol), n_(static_cast<std::size_t>(ode.size)) {
        for (auto& k : k_) k.assign(n_, 0);
        dense_.assign(kDenseRows * n_, 0);
        y_.assign(n_, 0);
        end_.assign(n_, 0);
        work_.assign(n_, 0);
    }

    void start(double t, const double* y) override {
        std::copy_n(y, n_, end_.begin());
        t1 = t;
        evaluate(t, end_.data(), k_[12].data());
        next_ = limited(initial_step());
    }

    const Segment& step() override {
        t0 = t1;
        y_ = end_;
        k_[0] = k_[12];
        accept(false);
        ++counters.steps;
        return *this;
    }

    const Segment& shorten(double at) override {
        BEAMCAM_ASSERT(at > t0);  // an event may lie a little beyond the step that just missed it
        // The same as a step of this length; the longer one may have passed the error test by chance.
        const double error = advance(at - t0);
        if (error > 1) {
            reject(at - t0, error);
            accept(true);
            return *this;
        }
        arrive(at);
        return *this;
    }

    void value(double t, double* y) const override {
        if (t == t1) {
            std::copy(end_.begin(), end_.end(), y);
            return;
        }
        if (!dense_built_) const_cast<Rk8*>(this)->build_dense();
        extend((t - t0) / (t1 - t0), n_, y_.data(), dense_.data(), y);
    }

  private:
    // Tries steps from (t0, y_) until one keeps to the tolerance.
    void accept(bool rejected) {
        double error = std::numeric_limits<double>::infinity();
        for (;;) {
            double h = next_;
            const bool to_stop = t0 + 1.01 * h >= stop_;
            if (to_stop) h = stop_ - t0;
            const double shortest = kShortestRk8 * std::max(std::fabs(t0), 1e-300);
            const bool jumps = !(h > shortest);
            if (!std::isfinite(h) || (jumps && jumped_)) throw StepFailure(step_failure_reason(std::isfinite(error)));
            if (jumps) h = kRk8Growth * shortest;
            error = advance(h);
            if (jumps && !std::isfinite(error)) throw StepFailure(step_failure_reason(false));
            if (error <= 1 || jumps) {
                jumped_ = jumps;
                const double factor =
                    error == 0 ? kRk8Growth : std::clamp(kRk8Safety * std::pow(error, -0.125), kRk8Shrink, kRk8Growth);
                if (!to_stop || h * factor < next_) next_ = h * (rejected ? std::min(factor, 1.0) : factor);
                if (jumps) next_ = h;
                break;
            }
            reject(h, error);
            rejected = true;
        }
        arrive(t1);
    }
    void reject(double h, double error) {
        next_ = h * (std::isfinite(error) ? std::max(kRk8Safety * std::pow(error, -0.125), kRk8Shrink) : 0.1);
        ++counters.rejected;
    }
    void arrive(double t) {
        t1 = t;
        dense_built_ = false;
        evaluate(t1, end_.data(), k_[12].data());
    }

    void evaluate(double t, const double* y, double* dy) {
        ode_.rhs(t, y, dy);
        ++counters.rhs_evaluations;
    }

    void stage(int index, double h) {
        const TableauRow& row = kRows[static_cast<std::size_t>(index)];
        work_ = y_;
        for (std::size_t j = 0; j < static_cast<std::size_t>(index); ++j) {
            if (row.a[j] == 0) continue;
            const double a = h * row.a[j];
            const double* k = k_[j].data();
            for (std::size_t i = 0; i < n_; ++i) work_[i] += a * k[i];
        }
        evaluate(t0 + row.c * h, work_.data(), k_[static_cast<std::size_t>(index)].data());
    }

    // end_ ← solution at t0 + h; returns the error in units of the tolerance.
    double advance(double h) {
        t1 = t0 + h;
        for (int i = 1; i < kStages; ++i) stage(i, h);
        double error5 = 0, error3 = 0;
        for (std::size_t i = 0; i < n_; ++i) {
            double sum = 0, e5 = 0;
            for (std::size_t j = 0; j < std::size(kUsed); ++j) {
                const double k = k_[static_cast<std::size_t>(kUsed[j])][i];
                sum += kB[j] * k;
                e5 += kE5[j] * k;
            }
            end_[i] = y_[i] + h * sum;
            if (i >= static_cast<std::size_t>(ode_.controlled)) continue;
            const double e3 = sum - kBhh0 * k_[0][i] - kBhh8 * k_[8][i] - kBhh11 * k_[11][i];
            const double scale = atol_ + rtol_ * std::max(std::fabs(y_[i]), std::fabs(end_[i]));
            error5 += (e5 / scale) * (e5 / scale);
            error3 += (e3 / scale) * (e3 / scale);
        }
        double denominator = error5 + 0.01 * error3;
        if (denominator <= 0) denominator = 1;
        const double error = std::fabs(h) * error5 / std::sqrt(ode_.controlled * denominator);
        return std::isfinite(error) ? error : std::numeric_limits<double>::infinity();
    }

    void build_dense() {
        dense_built_ = true;
        const double h = t1 - t0;
        // Not counted: the work of a motion must not depend on who evaluates it inside its steps.
        const long counted = counters.rhs_evaluations;
        for (int i = 13; i < kAllStages; ++i) stage(i, h);
        counters.rhs_evaluations = counted;
        for (std::size_t i = 0; i < n_; ++i) {
            const double difference = end_[i] - y_[i], bend = h * k_[0][i] - difference;
            dense_[i] = difference;
            dense_[n_ + i] = bend;
            dense_[2 * n_ + i] = difference - h * k_[12][i] - bend;
            for (std::size_t row = 0; row < 4; ++row) {
                double sum = 0;
                for (std::size_t j = 0; j < std::size(kDenseStages); ++j)
                    sum += kD[row][j] * k_[static_cast<std::size_t>(kDenseStages[j])][i];
                dense_[(3 + row) * n_ + i] = h * sum;
            }
        }
    }

    // Book, II.4: a step for which an Euler step moves y by about 1 % of its tolerance-weighted size.
    double initial_step() {
        double size = 0, slope = 0;
        const auto scale = [&](std::size_t i) { return atol_ + rtol_ * std::fabs(end_[i]); };
        for (std::size_t i = 0; i < static_cast<std::size_t>(ode_.controlled); ++i) {
            size += std::pow(end_[i] / scale(i), 2);
            slope += std::pow(k_[12][i] / scale(i), 2);
        }
        double h = size < 1e-10 || slope < 1e-10 ? 1e-6 : 0.01 * std::sqrt(size / slope);
        for (std::size_t i = 0; i < n_; ++i) work_[i] = end_[i] + h * k_[12][i];
        evaluate(t1 + h, work_.data(), k_[1].data());
        double bend = 0;
        for (std::size_t i = 0; i < static_cast<std::size_t>(ode_.controlled); ++i)
            bend += std::pow((k_[1][i] - k_[12][i]) / scale(i), 2);
        bend = std::sqrt(bend) / h;
        const double steepest = std::max(bend, std::sqrt(slope));
        const double second = steepest <= 1e-15 ? std::max(1e-6, h * 1e-3) : std::pow(0.01 / steepest, 0.125);
        return std::min(100 * h, second);
    }

    Ode& ode_;
    double rtol_, atol_;
    std::size_t n_;
    std::array<std::vector<double>, kAllStages> k_;
    std::vector<double> y_, end_, work_, dense_;
    double next_ = 0;
    bool dense_built_ = false, jumped_ = false;
};

}  // namespace

std::unique_ptr<Integrator> make_rk8(Ode& ode, double rtol, double atol) {
    return std::make_unique<Rk8>(ode, rtol, atol);
}

}  // namespace beamcam::sim
