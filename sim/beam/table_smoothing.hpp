// Smoothing of measured tables: the step of their numbers, and the smoothing spline. MODEL.md (S93).
#pragma once

#include <optional>
#include <vector>

namespace beamcam::sim {

// The step of which all differences between neighbouring values are multiples, as those of an encoder; absent: there is
// none, or too few values show it.
std::optional<double> table_step(const std::vector<double>& values);

// Root mean square of the values' second derivative, by differences, and the part that rounding to steps explains.
struct Roughness {
    double found = 0, by_steps = 0;
    // A table of equal increments has no curvature but for rounding errors.
    bool is_dominated_by_steps() const { return found > 1e-3 * by_steps && found * found < 2 * by_steps * by_steps; }
};
Roughness roughness(const std::vector<double>& t, const std::vector<double>& values, double step);

// Values at t of the natural cubic spline with the least ∫s″² dt among those whose root mean square distance from the
// points is at most `deviation` >= 0. The natural spline through the result is that spline.
std::vector<double> smoothed(const std::vector<double>& t, const std::vector<double>& y, double deviation);

}  // namespace beamcam::sim
