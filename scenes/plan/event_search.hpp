// A first run of a motion that finds the times of its events, and ends as soon as the needed ones are found.
#pragma once

#include <optional>
#include <vector>

#include "scenes/plan/plan.hpp"

namespace beamcam::scenes {

using Bounds = std::vector<std::optional<Instant>>;  // events at which outputs begin or end

Bounds bounds_of(const Pictures& p);
Bounds bounds_of(const SeriesKeys& keys);

sim::Request events_request(double end, bool apexes);

// The motion until the end of the request, or until all bounds are found. Without bounds: until the end.
sim::Result find_events(const sim::Problem& problem, sim::Request request, const Bounds& bounds,
                        const FindEvents& find);

}  // namespace beamcam::scenes
