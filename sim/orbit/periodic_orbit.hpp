// Periodic orbits of a system whose cam rotates at constant speed: Newton's method on the section map, with the exact
// derivative. MODEL.md (S75).
#pragma once

#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "sim/dynamics/initial.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::sim {

struct OrbitImpact {
    double cam_angle = 0;  // ψ at the touch, continued from the section [rad]
    double approach = 0;   // −ġ before it [m/s]
    double x = 0;          // x_c [m]
    double overhang = 0;   // of the foot beyond the tip; negative between root and tip [m]
};

struct PeriodicOrbit {
    double section = 0;    // cam angle ψ of `start` [rad]
    InitialState start;    // state and phase at the section
    Initial initial;       // the same state in terms of a scene: θ, θ̇, q, q̇
    double cam_phase = 0;  // of the section: fraction of a turn after the scene's own start, 0 … 1
    int turns = 1;         // n, the period in turns of the cam
    double period = 0;     // [s]
    double residual = 0;   // of the section map, relative to the orbit's size
    std::vector<OrbitImpact> impacts;
    std::vector<std::complex<double>> multipliers;  // in descending order of magnitude

    long holds = 0, lifts = 0;  // impulsive contact: starts and ends of sustained contact

    bool chatters() const { return holds > 0; }  // chatter ends in sustained contact during each period
    double largest_multiplier() const { return multipliers.empty() ? 0 : std::abs(multipliers.front()); }
    bool stable() const { return largest_multiplier() < 1; }
    bool always_touching() const { return impacts.empty() && start.phase.touching; }
    double slowest_impact() const;  // [m/s]; 0 without impacts
};

// Nothing if this problem can have periodic orbits, else the reason and the remedy.
std::optional<std::string> orbit_refusal(const Problem& problem);

struct OrbitRequest {
    double transient = 20;  // before the search [s], rounded up to turns
    int turns = 0;          // of the period; 0: the smallest number up to `most_turns`
    int most_turns = 8;
    std::optional<int> impacts = {};  // only orbits with this number of impacts
    bool coexisting = false;          // search beside a stable orbit, too
};

// The orbit near the motion, if there is one that matches the request. If it is unstable or chatters, or if coexisting
// orbits are requested, also orbits found from throws of the beam off the cam, stable ones first. Throws Interrupted;
// std::invalid_argument where `orbit_refusal` has a reason.
std::vector<PeriodicOrbit> find_orbits(const Problem& problem, const OrbitRequest& request,
                                       const Progress& progress = {});

// The same period and the same impacts.
bool same_orbit(const PeriodicOrbit& a, const PeriodicOrbit& b);
// The orbit is a shorter one, so many times, up to this relative difference of the speeds of impacts.
bool repeats(const PeriodicOrbit& orbit, int times, double difference);

// The same orbit with its section in the middle of its longest flight. Throws SolverError, Interrupted.
PeriodicOrbit recentred(const Problem& problem, PeriodicOrbit orbit, const Progress& progress = {});

// The problem with a start on the orbit, in the middle of a flight. Nothing if the beam never leaves the cam. Throws
// SolverError, Interrupted.
std::optional<Problem> begun_on(const Problem& problem, const PeriodicOrbit& orbit);

}  // namespace beamcam::sim
