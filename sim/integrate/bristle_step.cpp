#include "sim/integrate/bristle_step.hpp"

namespace beamcam::sim {

void BristleStep::begin(FrictionState state, double deflection, double h) {
    state_ = state;
    start_ = deflection;
    h_ = h;
}

// While the bristle sticks, F_t = −kz and z = z₀ + ∫v_t; the integral of a response of v_t is that of the
// displacement. While it slides, F_t = −sμN.                                                           (S35), (S36)
bool BristleStep::eliminate(const NodalCompliance& across, const NodalCompliance& along, NodalCompliance& normal) {
    across_ = across;
    const double k = law_.stiffness;
    inverse_ = by_normal_ = {};
    for (int l = 0; l < kNodes; ++l) inverse_[static_cast<std::size_t>(l)][l] = 1;
    if (state_ == FrictionState::stick) {
        NodalMatrix matrix = inverse_, coupling;
        for (std::size_t l = 0; l < kNodes; ++l) {
            matrix[l] += k * along.value[l];
            coupling[l] = k * across.value[l];
        }
        if (!solve_dense(matrix, inverse_)) return false;
        by_normal_ = inverse_ * coupling;
    } else {
        const double ratio = FrictionLaw::sign(state_) * law_.kinetic;
        for (int l = 0; l < kNodes; ++l) by_normal_[static_cast<std::size_t>(l)][l] = ratio;
    }
    const NodalMatrix value = across.value * by_normal_, rate = across.rate * by_normal_;
    for (std::size_t l = 0; l < kNodes; ++l) {
        normal.value[l] -= value[l];
        normal.rate[l] -= rate[l];
    }
    return true;
}

Lanes BristleStep::force(const Lanes& normal, const Lanes& slip) const {
    if (state_ == FrictionState::stick) return -law_.stiffness * at_nodes(start_, h_, slip);
    return (-FrictionLaw::sign(state_) * law_.kinetic) * normal;
}

Lanes BristleStep::guess(const Lanes& normal, double slip) const { return force(normal, Lanes{} + slip); }

Lanes BristleStep::ahead(const Lanes& normal, const Lanes& friction, const Lanes& slip, Lanes& gap,
                         Lanes& gap_rate) const {
    const Lanes change = inverse_ * (force(normal, slip) - friction);
    gap = across_.value * change;
    gap_rate = across_.rate * change;
    return change;
}

void BristleStep::settle(const Lanes& normal, const Lanes& slip, Lanes& friction, Lanes& rate) {
    friction = force(normal, slip);
    rate = state_ == FrictionState::stick ? slip : Lanes{};
    nodes_ = at_nodes(start_, h_, rate);
}

}  // namespace beamcam::sim
