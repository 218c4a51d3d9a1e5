#include "sim/integrate/friction_step.hpp"

#include <algorithm>
#include <cmath>

#include "sim/integrate/step_errors.hpp"
#include "sim/integrate/step_polynomial.hpp"

namespace beamcam::sim {

void FrictionStep::begin(FrictionState state, double deflection, double h, const NodalCompliance& gap,
                         const NodalCompliance& across, const NodalCompliance& along) {
    state_ = state;
    start_ = deflection;
    h_ = h;
    frictionless_ = gap;
    across_ = across;
    along_ = along;
}

// F_t falls by `resistance` with v_t, or while a bristle sticks with z = z₀ + ∫v_t, and by `ratio` with N. The integral
// of a response of v_t is that of the displacement. Coulomb's law is taken at its own pair of friction and slip next to
// the present one: at the slip itself it might be saturated, and the iteration would not end.   (S34), (S35), (S36)
bool FrictionStep::linearize(const Lanes& normal, const Lanes& friction, const Lanes& slip) {
    const bool sticks = law_.bristle && state_ == FrictionState::stick;
    Lanes resistance{}, ratio{}, mobility{}, at = slip;
    for (const Lanes& response : along_.rate) mobility += response;
    for (int k = 0; k < kNodes; ++k) {
        if (sticks) {
            resistance[k] = law_.stiffness;
        } else if (law_.bristle) {
            ratio[k] = FrictionLaw::sign(state_) * law_.kinetic;
        } else {
            at[k] = law_.slip_near(normal[k], friction[k], slip[k], mobility[k]);
            ratio[k] = -law_.ratio(at[k]);
            resistance[k] = law_.resistance(normal[k], ratio[k]);
        }
    }
    decay_ = law_.bristle ? 0 : largest(resistance * mobility);
    double least = resistance[0];
    for (int k = 1; k < kNodes; ++k) least = std::min(least, resistance[k]);
    least_decay_ = law_.bristle ? 0 : least * largest(mobility);
    const auto moved = law_.bristle ? &NodalCompliance::value : &NodalCompliance::rate;
    NodalMatrix matrix;
    std::array<Lanes, kNodes + 1> right;  // of the change with the normal force, and of the change without
    for (std::size_t l = 0; l < kNodes; ++l) {
        const int node = static_cast<int>(l);
        matrix[l] = resistance * (along_.*moved)[l];
        right[l] = resistance * (across_.*moved)[l];
        matrix[l][node] += 1;
        right[l][node] += ratio[node];
    }
    const Lanes by_law = sticks ? force(normal, slip) : -ratio * normal - resistance * (slip - at);
    right[kNodes] = by_law - friction;
    if (!solve_dense(matrix, right)) return false;
    std::copy_n(right.begin(), kNodes, by_normal_.begin());
    ahead_ = right[kNodes];
    const NodalMatrix value = across_.value * by_normal_, rate = across_.rate * by_normal_;
    for (std::size_t l = 0; l < kNodes; ++l) {
        gap_.value[l] = frictionless_.value[l] - value[l];
        gap_.rate[l] = frictionless_.rate[l] - rate[l];
    }
    return true;
}

Lanes FrictionStep::force(const Lanes& normal, const Lanes& slip) const {
    if (law_.bristle && state_ == FrictionState::stick) return -law_.stiffness * at_nodes(start_, h_, slip);
    Lanes friction;
    for (int k = 0; k < kNodes; ++k) friction[k] = law_.force(state_, normal[k], slip[k], 0);
    return friction;
}

Lanes FrictionStep::guess(const Lanes& normal, double slip) const { return force(normal, Lanes{} + slip); }

double FrictionStep::missed(double start_slip, const Lanes& slip, double end_slip) const {
    Lanes ratio;
    for (int k = 0; k < kNodes; ++k) ratio[k] = law_.ratio(slip[k]);
    const StepPolynomial between = StepPolynomial::through(ratio);
    const double off =
        std::max(std::fabs(law_.ratio(start_slip) - between(-1)), std::fabs(law_.ratio(end_slip) - between(1)));
    return std::max(0.0, off - legendre_decay(ratio).last) * std::min(Collocation::get().c[0], 1 / decay_);
}

void FrictionStep::settle(const Lanes& normal, const Lanes& slip, Lanes& friction, Lanes& rate) {
    friction = force(normal, slip);
    rate = state_ == FrictionState::stick ? slip : Lanes{};
    nodes_ = at_nodes(start_, h_, rate);
}

}  // namespace beamcam::sim
