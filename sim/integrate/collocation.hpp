// Gauss collocation with eight nodes on [0, 1]: nodes, weights, integration to the nodes, and derivatives of the
// interpolation polynomial. Computed once. MODEL.md §12.
//
// Sources: Hairer, Nørsett & Wanner II.7; derivatives by Legendre coefficients (Trefethen, "Spectral Methods").
#pragma once

#include <array>

#include "sim/base/lanes.hpp"

namespace beamcam::sim {

struct Collocation {
    static const Collocation& get();

    Lanes c;                              // nodes, ascending
    Lanes b;                              // weights, sum 1
    std::array<Lanes, kNodes> integrate;  // [l][k]: ∫₀^{c_k} ℓ_l
    std::array<Lanes, kNodes> integrate_twice;
    // Points where expansions start: 0, then the nodes. derive[i][j][l] = ℓ_l^{(j)} at point i.
    std::array<double, kNodes + 1> point;
    std::array<std::array<Lanes, kNodes>, kNodes + 1> derive;
    // legendre[j][l]: nodal values to the coefficient of P_j(2s − 1).
    std::array<Lanes, kNodes> legendre;
    Lanes legendre_coefficients(const Lanes& nodal) const;
    std::array<Lanes, kNodes> slope;  // [l][k]: ℓ_l′(c_k)
    // monomial[j][l]: nodal values to the coefficient of (2s − 1)ʲ.
    std::array<Lanes, kNodes> monomial;

    Lanes weights_to(double s) const;  // [l]: ∫₀ˢ ℓ_l, for any s

  private:
    Collocation();
    std::array<Lanes, kNodes> legendre_of_node_;  // `legendre`, transposed
};

// A quantity that is `start` at the start of a step of length h, by its rate at the nodes.
Lanes at_nodes(double start, double h, const Lanes& rate);

}  // namespace beamcam::sim
