#include "sim/orbit/periodic_orbit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/base/linear_algebra.hpp"
#include "sim/base/numerics.hpp"
#include "sim/orbit/exponents.hpp"
#include "sim/orbit/section_map.hpp"

namespace beamcam::sim {
namespace {

constexpr int kMaxOrbitNewton = 16;   // iterations
constexpr double kOrbitLost = 1e3;    // residual over the orbit's size without hope
constexpr double kLongestStep = 0.5;  // of the size: largest Newton step
constexpr double kReturn = 0.2;       // of the size: distance after some turns at which Newton's method is tried
constexpr int kThrows = 24;           // cam angles of throws; as many between them if no orbit is found
constexpr double kRise = 0.4;         // of the period: the thrown beam is in flight at this time
constexpr double kAboveCam = 1e-6;    // [rad] so that the throw does not start with a touch
constexpr double kSameOrbit = 1e-6;   // relative difference of impact speeds: closer orbits are one

// The cam angle some time later, in [−π, π].
double section_after(const Problem& problem, double section, double t) {
    return std::remainder(section - problem.cam->speed * t, 2 * std::numbers::pi);
}

// A state of a motion and the cam angle at that instant.
struct Place {
    double section;
    InitialState state;
};

// The middle of the longest flight within the duration; `from` itself if there is no flight.
Place longest_flight(const Problem& problem, const Place& from, double duration, const Progress& progress) {
    const Problem here = at_section(problem, from.section);
    const FlowMap seen = flow_map(here, from.state, duration, false, progress);
    double longest = 0, middle = 0;
    for (const TangentTouch& touch : seen.touches)
        if (touch.flight > longest) {
            longest = touch.flight;
            middle = touch.t - 0.5 * touch.flight;
        }
    if (middle == 0) return from;
    const FlowMap there = flow_map(here, from.state, middle, false, progress);
    return {section_after(problem, from.section, middle), there.end};
}

// Newton's method from y; nothing if it does not converge.
std::optional<PeriodicOrbit> newton(const SectionMap& map, Eigen::VectorXd y) {
    const Eigen::Index n = y.size();
    double last = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kMaxOrbitNewton; ++i) {
        const SectionMap::Value value = map.at(y, true);
        const Eigen::VectorXd residual = value.image - y;
        const double size = residual.norm();
        if (!std::isfinite(size) || size > kOrbitLost) return std::nullopt;
        if (size < kOrbitConverged || (size < kNegligible && size > 0.5 * last)) return map.orbit(y, value);
        last = size;
        Eigen::VectorXd step = solve(value.derivative - Eigen::MatrixXd::Identity(n, n), -residual);
        if (step.norm() > kLongestStep) step *= kLongestStep / step.norm();
        y += step;
    }
    return std::nullopt;
}

std::optional<PeriodicOrbit> newton_quietly(const SectionMap& map, const Eigen::VectorXd& y) {
    try {
        return newton(map, y);
    } catch (const SolverError&) {  // an iterate cannot be integrated
        return std::nullopt;
    }
}

// True if the orbit consists of repetitions of a shorter one.
bool repeats_itself(const PeriodicOrbit& orbit) {
    for (int times = 2; times <= orbit.turns; ++times)
        if (repeats(orbit, times, kSameOrbit)) return true;
    return false;
}

// The orbit near the place with the smallest number of turns after which the motion returns to it.
std::optional<PeriodicOrbit> orbit_through(const Problem& problem, const Place& place, const OrbitRequest& request,
                                           const Progress& progress) {
    const Problem here = at_section(problem, place.section);
    FlowMap map = flow_map(here, place.state, cam_period(problem), false, progress);
    const Eigen::VectorXd units = map.units;
    const auto n = units.size();
    const auto y_of = [&](const InitialState& s) {
        return Eigen::VectorXd(units.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(s.y.data(), n)));
    };
    const Eigen::VectorXd start = y_of(place.state);
    const double size = size_of(problem, map, start);
    const int first = request.turns > 0 ? request.turns : 1, last = request.turns > 0 ? first : request.most_turns;
    for (int turns = 1; turns <= last; ++turns) {
        if (turns > 1) map = flow_map(here, map.end, cam_period(problem), false, progress);
        if (turns < first || (request.turns == 0 && (y_of(map.end) - start).norm() > kReturn * size)) continue;
        const SectionMap section(problem, place.section, turns, place.state, {units, size}, progress);
        if (auto orbit = newton_quietly(section, start / size); orbit && !repeats_itself(*orbit)) return orbit;
    }
    return std::nullopt;
}

// A place in flight of the straight beam that is thrown off the cam at this cam angle with a speed for which it would
// return after `period`. Nothing if no such flight exists.
std::optional<Place> thrown(const Problem& problem, double section, double period, std::size_t size,
                            const Progress& progress) {
    System at(at_section(problem, section));
    const auto n = static_cast<std::size_t>(at.coordinates());
    InitialState state{std::vector<double>(size, 0.0), Phase{}, false};
    const auto contact = [&] { return at.contact(0, state.y.data()); };
    const auto gap = [&](double angle) {
        state.y[0] = angle;
        return contact().gap;
    };
    const Vec2 centre = problem.cam->centre;
    const double low = std::atan2(centre.y, centre.x), high = low + 0.5 * std::numbers::pi;
    if (!(gap(low) < 0 && gap(high) > 0)) return std::nullopt;
    state.y[0] = find_root(gap, low, high) + kAboveCam;
    const double pull = -at.free_gap_acceleration(0, state.y.data());
    const double still = contact().gap_rate;
    state.y[n] = 1;
    const double arm = contact().gap_rate - still;
    if (!(pull > 0) || !(arm > 0)) return std::nullopt;
    state.y[n] = 0.5 * pull * period / arm;
    const FlowMap risen = flow_map(at.problem(), state, kRise * period, false, progress);
    if (!risen.touches.empty() || risen.end.phase.touching) return std::nullopt;
    return Place{section_after(problem, section, kRise * period), risen.end};
}

// The orbit once more, from the middle of its longest flight; a throw leaves it anywhere.                       (S75)
PeriodicOrbit centred(const Problem& problem, const PeriodicOrbit& orbit, const OrbitRequest& request,
                      const Progress& progress) {
    const Place middle = longest_flight(problem, {orbit.section, orbit.start}, 2 * orbit.period, progress);
    return orbit_through(problem, middle, request, progress).value_or(orbit);
}

// Orbits with few impacts that may coexist with the motion. If the motion has none of its own, throws are tried until
// there is one.
std::vector<PeriodicOrbit> orbits_by_throws(const Problem& problem, std::size_t size, const OrbitRequest& request,
                                            bool needed, const Progress& progress) {
    std::vector<PeriodicOrbit> found;
    OrbitRequest one = request;
    one.turns = std::max(1, request.turns);
    const double period = cam_period(problem) * one.turns;
    for (int i = 0; i < 2 * kThrows && (i < kThrows || (needed && found.empty())); ++i) {
        const double section = 2 * std::numbers::pi * (i + (i < kThrows ? 0 : 0.5)) / kThrows;
        try {
            const auto place = thrown(problem, section, period, size, progress);
            auto orbit = place ? orbit_through(problem, *place, one, progress) : std::nullopt;
            if (!orbit || orbit->impacts.empty() || orbit->chatters()) continue;
            if (request.impacts && static_cast<int>(orbit->impacts.size()) != *request.impacts) continue;
            if (std::ranges::none_of(found, [&](const auto& o) { return same_orbit(o, *orbit); }))
                found.push_back(centred(problem, *orbit, one, progress));
        } catch (const SolverError&) {  // this throw cannot be integrated
        }
    }
    std::ranges::stable_sort(found, [](const auto& a, const auto& b) { return a.stable() > b.stable(); });
    return found;
}

}  // namespace

double PeriodicOrbit::slowest_impact() const {
    double slowest = impacts.empty() ? 0 : impacts.front().approach;
    for (const OrbitImpact& impact : impacts) slowest = std::min(slowest, impact.approach);
    return slowest;
}

bool repeats(const PeriodicOrbit& orbit, int times, double difference) {
    const std::size_t count = orbit.impacts.size(), parts = static_cast<std::size_t>(times), once = count / parts;
    if (orbit.turns % times != 0 || count % parts != 0) return false;
    for (std::size_t i = 0; i + once < count; ++i)
        if (!(std::fabs(orbit.impacts[i].approach - orbit.impacts[i + once].approach) <
              difference * orbit.impacts[i].approach))
            return false;
    return true;
}

bool same_orbit(const PeriodicOrbit& a, const PeriodicOrbit& b) {
    return a.turns == b.turns && a.impacts.size() == b.impacts.size() &&
           std::fabs(a.slowest_impact() - b.slowest_impact()) < kSameOrbit * a.slowest_impact();
}

std::optional<std::string> orbit_refusal(const Problem& problem) {
    if (!problem.cam) return "periodic orbits need a cam";
    if (problem.cam->speed == 0) return "periodic orbits need a cam that turns: set cam.speed";
    if (!is_independent_of_time(problem.hub.drive))
        return "periodic orbits need a hub.drive that does not depend on time: free, or a constant torque";
    return std::nullopt;
}

std::vector<PeriodicOrbit> find_orbits(const Problem& given, const OrbitRequest& request, const Progress& progress) {
    require_valid(given);
    if (const auto refusal = orbit_refusal(given)) throw std::invalid_argument(*refusal);
    const Problem problem = for_orbits(given);
    const double turn = cam_period(problem);
    const InitialState begin = initial_state(problem);
    std::vector<PeriodicOrbit> found;
    try {
        Problem loose = problem;  // the start of the search need not be exact
        loose.solver = given.solver;
        Place place{problem.cam->phase, begin};
        if (request.transient > 0)
            place.state = motion_end(loose, begin, turn * std::ceil(request.transient / turn), progress);
        place = longest_flight(problem, place, (1 + std::max(request.turns, request.most_turns)) * turn, progress);
        auto orbit = orbit_through(problem, place, request, progress);
        if (orbit && (!request.impacts || static_cast<int>(orbit->impacts.size()) == *request.impacts))
            found.push_back(std::move(*orbit));
    } catch (const SolverError&) {  // the motion cannot be integrated, but orbits may exist
    }
    const bool flies = !found.empty() && !found.front().chatters();
    if (flies && found.front().stable() && !request.coexisting) return found;
    for (PeriodicOrbit& orbit : orbits_by_throws(problem, begin.y.size(), request, !flies, progress))
        if (found.empty() || !same_orbit(found.front(), orbit)) found.push_back(std::move(orbit));
    return found;
}

PeriodicOrbit recentred(const Problem& problem, PeriodicOrbit orbit, const Progress& progress) {
    const Place place = longest_flight(for_orbits(problem), {orbit.section, orbit.start}, 2 * orbit.period, progress);
    orbit.section = place.section;
    orbit.start = place.state;
    return orbit;
}

std::optional<Problem> begun_on(const Problem& problem, const PeriodicOrbit& orbit) {
    Place place{orbit.section, orbit.start};
    if (place.state.phase.touching) place = longest_flight(for_orbits(problem), place, orbit.period, {});
    if (place.state.phase.touching) return std::nullopt;
    Problem begun = at_section(problem, place.section);
    begun.initial = initial_of(System(begun), place.state.y);
    return begun;
}

}  // namespace beamcam::sim
