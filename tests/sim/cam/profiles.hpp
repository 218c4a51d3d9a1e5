// Cams that the tests of the outline share.
#pragma once

#include <numbers>

#include "sim/problem/problem.hpp"

namespace beamcam::sim::testing {

inline constexpr double kDegree = std::numbers::pi / 180;

// Dwell, cycloidal rise of 8°, dwell, 3-4-5 return, dwell.
inline LawProfile lift_and_return() {
    return {14 * kDegree,
            {{MotionLaw::dwell, 0, 60 * kDegree},
             {MotionLaw::cycloidal, 8 * kDegree, 100 * kDegree},
             {MotionLaw::dwell, 0, 40 * kDegree},
             {MotionLaw::polynomial_345, -8 * kDegree, 120 * kDegree},
             {MotionLaw::dwell, 0, {}}}};
}

inline Problem with_profile(Profile profile) {
    Problem p;
    p.cam->profile = std::move(profile);
    return p;
}

// Points of an outline at equal steps of the normal's angle, by its support function.
template <class Support>  // {h, h′} of α
PointsProfile points_of(int count, Support&& support) {
    PointsProfile points;
    for (int i = 0; i < count; ++i) {
        const double alpha = 2 * std::numbers::pi * i / count;
        const auto [h, slope] = support(alpha);
        const Vec2 p = h * unit(alpha) + slope * perp(unit(alpha));
        points.x.push_back(p.x);
        points.y.push_back(p.y);
    }
    return points;
}

// Four arcs, each tangent to the next: two flanks between a base and a nose, symmetric about the x axis.
inline ArcsProfile tangent_arcs() {
    // The flank of radius F touches the base of radius B about (0, 0) and the nose of radius N about (a, 0), from
    // inside.
    const double base = 0.03, nose = 0.008, flank = 0.09, apart = 0.032;
    const double to_base = flank - base, to_nose = flank - nose;
    const double x = (apart * apart + to_base * to_base - to_nose * to_nose) / (2 * apart);
    const double y = std::sqrt(to_base * to_base - x * x);
    return {{{{0, 0}, base}, {{x, y}, flank}, {{apart, 0}, nose}, {{x, -y}, flank}}};
}

}  // namespace beamcam::sim::testing
