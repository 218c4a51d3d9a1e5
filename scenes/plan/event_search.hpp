// A first look at a motion, for the instants of its events: no further than those that are asked for.
#pragma once

#include <optional>
#include <vector>

#include "scenes/plan/plan.hpp"

namespace beamcam::scenes {

using Bounds = std::vector<std::optional<Instant>>;  // where something begins or ends; absent: not at an event

Bounds bounds_of(const Pictures& p);
Bounds bounds_of(const SeriesKeys& keys);

sim::Request events_request(double end, bool apexes);

// The motion as far as the request looks, or until it has all of these bounds; none: it is looked at until its end.
sim::Result find_events(const sim::Problem& problem, sim::Request request, const Bounds& bounds,
                        const FindEvents& find);

}  // namespace beamcam::scenes
