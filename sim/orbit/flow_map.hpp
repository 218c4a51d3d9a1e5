// The flow map: the state of a motion after a given time as a function of its initial state, with the derivative.
// MODEL.md §16a.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/dynamics/initial.hpp"
#include "sim/orbit/tangents.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::sim {

struct FlowMap {
    InitialState end;            // final state and phase; a new run may start there
    Eigen::MatrixXd derivative;  // ∂(ξ, ξ̇)/∂(ξ₀, ξ̇₀), 2n × 2n, in SI units; empty if not requested
    // The derivative in `units` is the product of these factors, which are in the order of time. Each ends at a touch,
    // before any sustained contact, and is well conditioned where the derivative is not.
    std::vector<Eigen::MatrixXd> factors;
    Eigen::VectorXd units;  // of ξ and ξ̇ (Tangents::units)
    std::vector<TangentTouch> touches;
    long holds = 0, lifts = 0;  // impacts followed by sustained contact; ends of sustained contact
};

// For a start in sustained contact: neighbouring initial states may leave the cam (free), or remain on it (kept).
enum class StartOnCam { free, kept };

// From `start` at t = 0, by the problem's method and tolerances. Throws SolverError, Interrupted.
FlowMap flow_map(const Problem& problem, const InitialState& start, double duration, bool derivative,
                 const Progress& progress = {}, StartOnCam on_cam = StartOnCam::free);

// The state after the duration, from `start` at t = 0, by the problem's own method.
InitialState motion_end(const Problem& problem, const InitialState& start, double duration,
                        const Progress& progress = {});

}  // namespace beamcam::sim
