// The equations of a modal model as an exponential integrator reads them: oscillators, and what couples them, in
// plain arrays. Free hub in hub–beam shapes (no coupling through the inertia), or prescribed hub in any shapes.
#pragma once

#include <memory>
#include <vector>

#include "sim/dynamics/system.hpp"
#include "sim/integrate/oscillator.hpp"

namespace beamcam::sim {

struct ModalForm {
    // Null when the equations of this problem do not have the form: other models, clamped shapes with a free hub,
    // damping that couples the modes.
    static std::shared_ptr<const ModalForm> of(System& system);

    int n = 0;  // modes
    bool prescribed = false, paper = false, shortening = false, damped = false;
    double J = 0, S = 0, mass = 1, gravity = 0, radius = 0, length = 1;
    std::vector<Oscillator> oscillators;
    std::vector<OscillatorLanes> groups;  // the same, eight by eight
    // Row-major n × n. f_i = Θ̇² (inertia q)_i + Y (second q)_i + …, Y = g sin Θ, or −Θ̇²(al + ½l²) for `paper`;
    // per unit of mass.
    std::vector<double> spinning, second;
    std::vector<double> inertia;       // B of J + qᵀBq [kg]
    std::vector<double> weight;        // W/m
    std::vector<double> U;             // [kg m], zero for a free hub
    std::vector<double> h;             // θ = Θ + h·q
    std::vector<double> beta;          // wave numbers of the shapes [1/m]
    std::vector<double> shape;         // their largest values, at most
    std::vector<double> inertia_root;  // c with |B_ij| <= c_i c_j [√kg]
    std::vector<double> slope_norm;    // √∫φ′², if the beam shortens [1/√m]
};

}  // namespace beamcam::sim
