#include "scenes/sweep/problem_family.hpp"

#include <fmt/format.h>

#include "scenes/scene/exit_code.hpp"
#include "sim/base/ode.hpp"
#include "sim/problem/number_keys.hpp"

namespace beamcam::scenes {

sim::Problem ProblemFamily::at(double value) const {
    sim::Problem problem = problem_;
    if (!sim::set_number(problem, key_, value))
        throw SceneError(fmt::format("{} = {:.10g} is outside its range or not a whole number", key_, value));
    for (const sim::Issue& finding : sim::validate(problem))
        if (finding.fatal)
            throw SceneError(fmt::format("at {} = {:.10g}: {}: {}", key_, value, finding.path, finding.message));
    return problem;
}

sim::Problem ProblemFamily::operator()(double value) const try { return at(value); } catch (const SceneError& error) {
    throw sim::StepFailure(error.what());
}

}  // namespace beamcam::scenes
