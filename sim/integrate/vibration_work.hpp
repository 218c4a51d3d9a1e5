// ∫₀ˢ g q̇ over a collocation step, for a polynomial g and the part of the motion of one oscillator that the nodes do
// not resolve: in closed form, by parts. MODEL.md §12.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "sim/integrate/step_polynomial.hpp"

namespace beamcam::sim {

// The nodes do not resolve vibration that turns by more radians, or decays by more, in a step.
inline constexpr double kResolvedRadians = 3;

bool resolved(const Oscillator& oscillator, double h);  // by the nodes of a step of length h

class VibrationWork {
  public:
    struct Position {
        double q = 0, rate = 0;
    };
    // g and the forcing per mass f: at the nodes. `start`: of the step of length h [s].
    VibrationWork(const Oscillator& oscillator, const Lanes& g, const Lanes& f, double h, Position start);
    // Up to z, where the oscillator is at `now` [unit of g times that of q].
    double operator()(double z, Position now) const;

  private:
    using ProductIntegral = StepPowers<2 * kNodes>;  // ∫ a b dt, from z = 0 on
    static ProductIntegral integral_of_product(const StepPolynomial& a, const StepPolynomial& b, double h);
    struct Vibration {
        StepPolynomial steady, speed;  // the motion that follows the forcing without vibration, and its rate
        ProductIntegral on_steady;
        double at_start = 0;  // of the integral
    };
    // The part x of q with ẋ = −rate x + factor f: it follows the forcing, but for a rest that decays.         (S52a)
    struct Decay {
        double rate, other, factor;
        StepPolynomial steady;
        ProductIntegral on_steady;
        double at_start = 0;
        double part(Position p) const { return factor * (p.rate + other * p.q); }
    };
    void add_decay(bool fast, const Lanes& f, double h, Position start);
    double integral(const Vibration& of, double z, Position at) const;
    double integral(const Decay& of, double z, Position at) const;

    Oscillator oscillator_;
    std::array<StepPolynomial, kNodes> g_;  // and its derivatives
    std::optional<Vibration> vibration_;    // below critical damping
    std::vector<Decay> decays_;             // else
};

}  // namespace beamcam::sim
