#include "sim/orbit/contact_pattern.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/base/counted.hpp"

namespace beamcam::sim {

constexpr double kNearSection = 0.1;  // of its flight: an impact so close to the section moves it

bool same_pattern(const PeriodicOrbit& a, const PeriodicOrbit& b) {
    return (a.chatters() || a.impacts.size() == b.impacts.size()) && a.holds == b.holds && a.lifts == b.lifts &&
           a.start.phase.touching == b.start.phase.touching;
}

std::string change_of_pattern(const PeriodicOrbit& orbit, const PeriodicOrbit* beyond) {
    if (orbit.always_touching()) return "the beam no longer follows the cam all the time";
    const std::string impacts = counted(orbit.impacts.size(), "impact");
    if (beyond && beyond->always_touching()) return "the beam follows the cam all the time";
    // The end of a flight that vanishes is too slow to bounce again and again.
    if (orbit.chatters() && orbit.impacts.size() <= 1) return "the flight before the rest on the cam vanishes";
    if (orbit.chatters()) return "the rest on the cam vanishes";
    if (beyond && beyond->chatters()) return "a rest on the cam appears";
    if (beyond && beyond->impacts.size() != orbit.impacts.size())
        return fmt::format("{} become{} {}", impacts, orbit.impacts.size() == 1 ? "s" : "", beyond->impacts.size());
    return fmt::format("the orbit cannot be followed with its {}", impacts);
}

bool near_section(const PeriodicOrbit& orbit) {
    if (orbit.impacts.empty() || orbit.chatters()) return false;
    const double first = std::fabs(orbit.impacts.front().cam_angle - orbit.section);
    const double last = std::fabs(orbit.impacts.back().cam_angle - orbit.section);
    const double rest = 2 * std::numbers::pi * orbit.turns - last;
    return std::min(first, rest) < kNearSection * (first + rest);
}

}  // namespace beamcam::sim
