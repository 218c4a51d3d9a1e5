// The problem of a scene at values of one of its keys.
#pragma once

#include <string>
#include <utility>

#include "sim/problem/problem.hpp"

namespace beamcam::scenes {

class ProblemFamily {
  public:
    ProblemFamily(sim::Problem problem, std::string key) : problem_(std::move(problem)), key_(std::move(key)) {}

    sim::Problem at(double value) const;          // throws SceneError where the problem is impossible
    sim::Problem operator()(double value) const;  // throws sim::StepFailure there, as an integration does

  private:
    sim::Problem problem_;
    std::string key_;
};

}  // namespace beamcam::scenes
