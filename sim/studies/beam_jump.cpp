#include "sim/studies/beam_jump.hpp"

#include <cmath>

namespace beamcam::sim {
namespace {

constexpr int kTurns = 6;        // vibration that the first turns excite has added up or decayed
constexpr double kStep = 1.02;   // from one speed of the search to the next: narrower intervals of jumps are not seen
constexpr double kClose = 1e-5;  // of the speed

bool leaves_cam(Problem problem, double speed, const Progress& progress) {
    problem.cam->speed = std::copysign(speed, problem.cam->speed);
    problem.initial = {};
    problem.initial.shape = InitialShape::resting;
    Request request;
    request.end_time = kTurns * cam_period(problem);
    const std::vector<Impact> impacts = simulate(problem, request, progress).impacts;
    return impacts.size() != 1 || impacts.front().t_end;
}

}  // namespace

std::optional<BeamJump> beam_jump(const Problem& problem, double around, const Progress& progress) {
    int motions = 0;
    const auto leaves = [&](double speed) {
        ++motions;
        return leaves_cam(problem, speed, [&](double) { return !progress || progress(motions); });
    };
    BeamJump jump{0, 0.25 * around};
    while (!leaves(jump.leaves)) {
        if (jump.leaves > 2 * around) return std::nullopt;
        jump = {jump.leaves, kStep * jump.leaves};
    }
    while (jump.follows > 0 && jump.leaves - jump.follows > kClose * jump.leaves) {
        const double middle = 0.5 * (jump.follows + jump.leaves);
        (leaves(middle) ? jump.leaves : jump.follows) = middle;
    }
    return jump;
}

}  // namespace beamcam::sim
