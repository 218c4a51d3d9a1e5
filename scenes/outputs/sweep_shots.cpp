#include "scenes/outputs/sweep_shots.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "scenes/motions/progress.hpp"
#include "sim/sweep/sweep_point.hpp"

namespace beamcam::scenes {
namespace {

constexpr double kShotLength = 1;       // of the film, at one value, about [s]
constexpr double kGrowingShare = 0.35;  // of the time at one value

// 0…1: the diagram grows to the value of the shot, then stops.
double growth_at(const SweepShot& shot, int frame) {
    return std::min(1.0, double(frame + 1 - shot.first) / (shot.end - shot.first) / kGrowingShare);
}

}  // namespace

SweepOrder sweep_order(const SweepGrid& grid) {
    const std::vector<double>& values = grid.axes().front().values;
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return values[i]; });
    SweepOrder out;
    out.place.resize(grid.points());
    for (const bool down : {false, true}) {
        std::vector<std::uint64_t> seeds;
        for (std::uint64_t s = 0; s < grid.seeds(); ++s)
            if ((grid.seed(s) == SeedKind::carry_down) == down) seeds.push_back(s);
        if (seeds.empty()) continue;
        for (std::size_t r = 0; r < order.size(); ++r) {
            const std::uint64_t first = order[down ? order.size() - 1 - r : r] * grid.seeds();
            for (const std::uint64_t seed : seeds) out.place[first + seed] = out.beams.size();
            out.beams.push_back(first + seeds.front());
        }
    }
    return out;
}

std::size_t SweepShot::grown(int frame, int hold) const {
    const int seen = std::min(end - 1, first + (frame - first) / hold * hold + hold - 1);
    return from + static_cast<std::size_t>(std::floor(growth_at(*this, seen) * double(last - from)));
}

int frames_of(const SweepFilmOutput& how) {
    return std::max(1, static_cast<int>(std::lround(how.duration * how.fps.value())));
}

std::vector<SweepShot> sweep_shots(const SweepFilmOutput& how, const SweepGrid& grid, const SweepOrder& order) {
    const int frames = frames_of(how);
    const std::size_t places = order.beams.size(),
                      count = std::clamp<std::size_t>(std::lround(how.duration / kShotLength), 1, places);
    std::vector<SweepShot> shots(std::min<std::size_t>(count, static_cast<std::size_t>(frames)));
    for (std::size_t i = 0; i < shots.size(); ++i) {
        SweepShot& shot = shots[i];
        shot.first = static_cast<int>(i * static_cast<std::size_t>(frames) / shots.size());
        shot.end = static_cast<int>((i + 1) * static_cast<std::size_t>(frames) / shots.size());
        shot.from = i * places / shots.size();
        shot.last = (i + 1) * places / shots.size() - 1;
        shot.point = order.beams[shot.last];
        shot.problem = grid.problem(shot.point);
    }
    return shots;
}

void follow(const SweepFilmOutput& how, const output::StoredPoint& point, SweepShot& shot) {
    const double period = cam_period(shot.problem), turns = how.turns / how.fps.value();
    const double before = std::floor(shot.first * turns);
    sim::Request request;
    request.poses.emplace_back();
    for (int frame = shot.first; frame < shot.end; ++frame)
        request.poses.back().times.push_back((frame * turns - before) * period);
    request.end_time = request.poses.back().times.back();
    const std::optional<sim::InitialState> end = end_of(point);
    sim::Result result =
        end ? sim::motion_from(shot.problem, *end, request, until_interrupted)
            : sim::simulate(shot.problem, request, until_interrupted);  // without an end state: from its own start
    shot.poses = std::move(result.poses.front());
    shot.impacts = std::move(result.impacts);
}

SweepPoses::SweepPoses(const std::vector<SweepShot>& shots) : shots_(shots) {
    for (std::size_t i = 0; i < shots.size(); ++i)
        for (std::size_t k = 0; k < shots[i].poses.size(); ++k) places_.emplace_back(i, k);
}

}  // namespace beamcam::scenes
