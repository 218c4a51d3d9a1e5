#include "sim/orbit/flow_map.hpp"

#include <limits>
#include <utility>

#include "sim/run/run.hpp"

namespace beamcam::sim {

InitialState motion_end(const Problem& problem, const InitialState& start, double duration, const Progress& progress) {
    Run run(problem, progress, {.end = duration, .start = &start});
    run.integrate();
    return {run.state().y, run.state().phase, false};
}

FlowMap flow_map(const Problem& problem, const InitialState& start, double duration, bool derivative,
                 const Progress& progress, StartOnCam on_cam) {
    Run run(problem, progress, {.end = duration, .step_ends_there = true, .start = &start});
    const Eigen::Index rows = 2 * run.system().coordinates();
    Tangents tangents(run.system(), duration, problem.solver.rtol,
                      Eigen::MatrixXd::Identity(rows, derivative ? rows : 0), progress);
    if (on_cam == StartOnCam::kept) tangents.start_on_cam();
    FlowMap map;
    const auto factor = [&](double) {
        if (tangents.holds() == 0) map.factors.push_back(tangents.factor());
        return std::numeric_limits<double>::infinity();
    };
    if (derivative) tangents.pause_at(std::numeric_limits<double>::infinity(), factor);
    run.add(tangents);
    run.integrate();
    map.end.y = run.state().y;
    map.end.phase = run.state().phase;
    map.touches = tangents.touches();
    map.holds = tangents.holds();
    map.lifts = tangents.lifts();
    map.units = tangents.units().head(2 * (tangents.units().size() / 2 - 1));
    if (derivative) {
        const Eigen::Index n = tangents.tangents().cols();
        map.factors.push_back(tangents.tangents().topRows(n));
        Eigen::MatrixXd product = map.factors.back();
        for (std::size_t k = map.factors.size() - 1; k-- > 0;) product *= map.factors[k];
        map.derivative = map.units.cwiseInverse().asDiagonal() * product * map.units.asDiagonal();
    }
    return map;
}

}  // namespace beamcam::sim
