// Taylor polynomials of time, the segments of CVODE.
#include <memory>
#include <span>
#include <stdexcept>

#include "sim/integrate/integrator.hpp"

namespace beamcam::sim {

void evaluate_taylor(std::span<const double> numbers, std::size_t n, double t, double* y) {
    const double s = t - numbers.front();
    const std::span<const double> rows = numbers.subspan(1);
    for (std::size_t i = 0; i < n; ++i) {
        double v = rows[rows.size() - n + i];
        for (std::size_t k = rows.size() / n - 1; k-- > 0;) v = v * s + rows[k * n + i];
        y[i] = v;
    }
}

namespace {

class StoredTaylor final : public StoredSegment {
  public:
    explicit StoredTaylor(int size) : n_(static_cast<std::size_t>(size)) {}
    void load(double begin, double end, std::span<const double> numbers) override {
        if (numbers.size() < 1 + n_ || (numbers.size() - 1) % n_ != 0)
            throw std::invalid_argument("a segment of the trajectory has the wrong length");
        t0 = begin;
        t1 = end;
        polynomial_ = numbers;
    }
    void value(double t, double* y) const override { evaluate_taylor(polynomial_, n_, t, y); }

  private:
    std::size_t n_;
    std::span<const double> polynomial_;
};

}  // namespace

std::unique_ptr<StoredSegment> make_stored_taylor(int size) { return std::make_unique<StoredTaylor>(size); }

}  // namespace beamcam::sim
