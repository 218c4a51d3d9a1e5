#include "sim/integrate/bristle_step.hpp"

namespace beamcam::sim {

void BristleStep::begin(FrictionState state, double deflection, double h) {
    state_ = state;
    start_ = deflection;
    h_ = h;
}

// While the bristle sticks, F_t = −(kz + cv_t) and z = z₀ + ∫v_t; the integral of a response of v_t is that of the
// displacement. While it slides, F_t = −sμN.                                                           (S35), (S36)
bool BristleStep::eliminate(const NodalCompliance& across, const NodalCompliance& along, NodalCompliance& normal) {
    across_ = across;
    const double k = law_.stiffness, c = law_.damping;
    inverse_ = by_normal_ = {};
    for (int l = 0; l < kNodes; ++l) inverse_[static_cast<std::size_t>(l)][l] = 1;
    decays_ = 0;
    if (state_ == FrictionState::stick) {
        NodalMatrix matrix = inverse_, coupling;
        Lanes moved{};  // by a unit force from the start on
        for (std::size_t l = 0; l < kNodes; ++l) {
            matrix[l] += k * along.value[l] + c * along.rate[l];
            coupling[l] = k * across.value[l] + c * across.rate[l];
            moved += along.rate[l];
        }
        decays_ = c * largest(moved);
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
    if (state_ == FrictionState::stick) return -(law_.stiffness * at_nodes(start_, h_, slip) + law_.damping * slip);
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

bool BristleStep::settle(const Lanes& normal, const Lanes& slip, Lanes& friction, Lanes& rate) {
    friction = force(normal, slip);
    rate = Lanes{};
    if (state_ == FrictionState::stick) {
        rate = slip;
    } else if (law_.lags) {  // ż = r(z_s − z), r = k/c, z_s = sμN/k
        const double r = law_.stiffness / law_.damping;
        const Lanes sliding = (FrictionLaw::sign(state_) * law_.kinetic / law_.stiffness) * normal;
        NodalMatrix matrix;
        for (std::size_t l = 0; l < kNodes; ++l) {
            matrix[l] = (r * h_) * Collocation::get().integrate[l];
            matrix[l][static_cast<int>(l)] += 1;
        }
        rate = r * (sliding - start_);
        if (!solve_dense(matrix, {&rate, 1})) return false;
    }
    nodes_ = at_nodes(start_, h_, rate);
    return true;
}

}  // namespace beamcam::sim
