#include "sim/orbit/flow_map.hpp"

#include <stdexcept>

#include "sim/run/run.hpp"

namespace beamcam::sim {

void require_tangents(const Problem& problem) {
    for (const Finding& finding : validate(problem))
        if (finding.fatal) throw std::invalid_argument(finding.path + ": " + finding.message);
    if (const auto refusal = tangent_refusal(problem)) throw std::invalid_argument(*refusal);
}

FlowMap flow_map(const Problem& problem, const InitialState& start, double duration, bool derivative,
                 const Progress& progress) {
    require_tangents(problem);
    Request request;
    request.end_time = duration;
    request.turning_points = false;
    TangentIntegrator* tangents = nullptr;
    RunOrigin origin;
    origin.start = start;
    origin.integrator = [&](System& system) {
        const Eigen::Index n = 2 * system.coordinates();
        auto made = std::make_unique<TangentIntegrator>(system, problem.solver.rtol, problem.solver.atol,
                                                        Eigen::MatrixXd::Identity(n, derivative ? n : 0));
        made->pause_at(duration, {});
        tangents = made.get();
        return made;
    };
    Run run(problem, {&request, 1}, progress, nullptr, origin);
    FlowMap map;
    const std::vector<Result> results = run.integrate();
    map.end.y = run.state().y;
    map.end.phase = run.state().phase;
    map.touches = tangents->touches();
    map.inertia_share = tangents->inertia_share();
    for (const Impact& impact : results.front().impacts)
        if (impact.t_end) map.releases.push_back(*impact.t_end);
    map.steps = run.counters().steps;
    if (derivative) {
        const Eigen::Index n = tangents->tangents().cols();
        const auto units = tangents->units().head(n).array();
        map.derivative =
            (tangents->tangents().topRows(n).array().colwise() / units).matrix() * units.matrix().asDiagonal();
    }
    return map;
}

}  // namespace beamcam::sim
