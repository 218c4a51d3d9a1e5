// The problem of a scene as a function of one of its keys.
#pragma once

#include <string>
#include <utility>

#include "sim/problem/problem.hpp"

namespace beamcam::scenes {

class ProblemFamily {
  public:
    ProblemFamily(sim::Problem problem, std::string key) : problem_(std::move(problem)), key_(std::move(key)) {}

    sim::Problem at(double value) const;          // throws SceneError for an impossible problem
    sim::Problem operator()(double value) const;  // throws sim::StepFailure instead

  private:
    sim::Problem problem_;
    std::string key_;
};

}  // namespace beamcam::scenes
