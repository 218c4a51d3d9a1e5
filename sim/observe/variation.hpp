// How far a function strays from the straight line between two of its values: f = line + Σ f_k with |f_k| ≤ a_k and
// |f_k″| ≤ a_k ω_k². Over an interval of length ℓ a slow part strays by at most a(ωℓ)²/8, a fast one by 2a. (S59)
#pragma once

#include <span>

#include "sim/base/lanes.hpp"
#include "sim/beam/model.hpp"

namespace beamcam::sim {

class Variation {
  public:
    // A vibration with these bounds; the frequency in rad/s.
    void add(double amplitude, double frequency);
    // The polynomial through values at the Gauss nodes of an interval of length h; its linear part does not stray.
    void add_polynomial(const Lanes& nodes, double h);
    // The error of that polynomial at both ends.
    void add_missed(const Lanes& nodes, double first, double last, double h);

    double strays(double length) const;
    // The same of f′ from the slope of the line.
    double slope_strays(double length) const;
    // How far f may rise above the higher of its values at the ends, which differ by `difference`.
    double rises(double length, double difference) const;
    // How far f may be from the parabola through its values at both ends and in the middle.
    double parabola_error(double length) const;
    // The contribution of all vibrations that turn by more than one radian.
    double unresolved(double length) const;

  private:
    struct Vibration {
        double amplitude, frequency;
    };
    std::span<const Vibration> vibrations() const { return {vibrations_, count_}; }

    // Seven of each mode, and those of a polynomial with what it misses.
    static constexpr std::size_t kMost = 7 * kMaxModes + kNodes;
    std::size_t count_ = 0;
    Vibration vibrations_[kMost];
};

}  // namespace beamcam::sim
