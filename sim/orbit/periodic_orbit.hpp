// Periodic orbits of a machine whose cam turns at constant speed: Newton's method on the section map, with the exact
// derivative. MODEL.md §16a.
#pragma once

#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "sim/dynamics/initial.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::sim {

struct OrbitImpact {
    double cam_angle = 0;  // ψ at the touch, of the turn it lies in: counted from the section [rad]
    double approach = 0;   // −ġ before it [m/s]
    double x = 0;          // of the contact along the beam [m]
    double overhang = 0;   // of the foot over the tip: negative between root and tip [m]
};

struct PeriodicOrbit {
    double section = 0;    // cam angle ψ where `start` lies [rad]
    InitialState start;    // state and phase there
    Initial initial;       // the same as a scene would give it: θ, θ̇, q, q̇
    double cam_phase = 0;  // of the section: turns of the cam after the scene's own start, 0 … 1
    int turns = 1;         // n: the period in turns of the cam
    double period = 0;     // [s]
    double residual = 0;   // of the section map, over the orbit's size
    std::vector<OrbitImpact> impacts;
    std::vector<std::complex<double>> multipliers;  // of the section map, the largest first

    long holds = 0, lifts = 0;  // of impulsive contact: how often chatter ends in rest on the cam, and rest in flight

    bool chatters() const { return holds > 0; }  // rests on the cam for a while after impacts
    bool stable() const { return multipliers.empty() || std::abs(multipliers.front()) < 1; }
    bool always_touching() const { return impacts.empty() && start.phase.touching; }
    double slowest_impact() const;  // [m/s]; 0 without impacts
};

// Nothing where orbits of this problem can be sought; else why not, with the remedy.
std::optional<std::string> orbit_refusal(const Problem& problem);

struct OrbitRequest {
    double transient = 20;  // before the search [s], rounded up to turns
    int turns = 0;          // of the period; 0: the fewest up to `most_turns`
    int most_turns = 8;
    std::optional<int> impacts = {};  // only orbits with so many
};

// First the orbit to which the motion tends, if it is periodic or near an orbit. Where that one chatters, is none or
// not wanted, then orbits that throws of the beam from the cam lead to, stable ones first. Throws Interrupted;
// std::invalid_argument for what `orbit_refusal` refuses.
std::vector<PeriodicOrbit> find_orbits(const Problem& problem, const OrbitRequest& request,
                                       const Progress& progress = {});

// The same orbit with its section in the middle of its longest flight.
PeriodicOrbit recentred(const Problem& problem, PeriodicOrbit orbit);

// The same machine, begun on the orbit in the middle of a flight. Nothing where the beam never leaves the cam. Throws
// SolverError, Interrupted.
std::optional<Problem> begun_on(const Problem& problem, const PeriodicOrbit& orbit);

}  // namespace beamcam::sim
