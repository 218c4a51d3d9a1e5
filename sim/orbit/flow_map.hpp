// Where a motion goes from any state within a time, and the derivative of that by the state. MODEL.md §16a.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/dynamics/initial.hpp"
#include "sim/orbit/tangent_integrator.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::sim {

struct FlowMap {
    InitialState end;            // state and phase after the time; a new run may start there
    Eigen::MatrixXd derivative;  // ∂(ξ, ξ̇)/∂(ξ₀, ξ̇₀), 2n × 2n, in SI; empty if not asked for
    double inertia_share = 1;    // at the end (S73)
    Eigen::VectorXd units;       // of ξ and ξ̇: rows of one size in energy (tangent_integrator.hpp)
    std::vector<TangentTouch> touches;
    long holds = 0, lifts = 0;  // strikes that sustained contact followed; ends of sustained contact
    long steps = 0;
};

// What differences a derivative allows at a start in sustained contact.
enum class StartOnCam { free, kept };

// From `start` at t = 0, by the problem's method and tolerances, for what `require_tangents` lets pass. Throws
// SolverError, Interrupted.
FlowMap flow_map(const Problem& problem, const InitialState& start, double duration, bool derivative,
                 const Progress& progress = {}, StartOnCam on_cam = StartOnCam::free);

// Where the motion from `start` at t = 0 is after the time, by the problem's own method.
InitialState motion_end(const Problem& problem, const InitialState& start, double duration,
                        const Progress& progress = {});

// Throws std::invalid_argument with the reason of `tangent_refusal`, or of an impossible problem.
void require_tangents(const Problem& problem);

}  // namespace beamcam::sim
