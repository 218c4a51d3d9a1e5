// The derivative of the flow map by differences of neighbouring motions. MODEL.md (S70)–(S73).
//
// A difference of two states has 2n + 2 rows: ξ, ξ̇, the bristle's deflection z and the approach speed δ̇₋ of a
// compliant touch.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "sim/orbit/flow_map.hpp"

namespace beamcam::sim {

inline constexpr Eigen::Index kMemories = 2;  // the rows z and δ̇₋

// Units that give each row about the same energy: √J Ω and √K_ii of ξ, √M_ii of ξ̇, then those of z and δ̇₋.
Eigen::VectorXd difference_units(const Problem& problem);

// The size of a motion in these units: the speed of its fastest impact or, without impacts, the norm of its start.
double motion_size(const Problem& problem, const FlowMap& map, const InitialState& start);

// The problem with the tightest tolerances that rounding allows.
Problem with_tight_tolerance(Problem problem);

// The problem whose time 0 is the time t of this one.
Problem begun_at(Problem problem, double t);

// Differences between two motions, or Richardson's extrapolation of those between four.                        (S71)
enum class Differences { central, extrapolated };

class Neighbours {
  public:
    // All rows are divided by `scale`.
    Neighbours(const Problem& problem, Eigen::VectorXd scale, Differences kind, Progress progress);

    // The derivative along the columns of `directions` of the flow from `start` at time t. `shortest`: duration of the
    // shortest flight in which the motion starts or ends [s].
    Eigen::MatrixXd along(double t, const InitialState& start, double duration, const Eigen::MatrixXd& directions,
                          double shortest) const;
    // The same over the whole of a motion that begins at time t: the product of the derivatives between its pauses
    // (S70). `at_pause` may change the columns before they are mapped further.
    Eigen::MatrixXd along(double t, const InitialState& start, double duration, const FlowMap& map,
                          Eigen::MatrixXd directions, const std::function<void(Eigen::MatrixXd&)>& at_pause = {}) const;

  private:
    Problem problem_;
    Eigen::VectorXd scale_;
    Differences kind_;
    Progress progress_;
};

}  // namespace beamcam::sim
