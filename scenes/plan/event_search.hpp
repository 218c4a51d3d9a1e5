// The search for the events at which pictures and figures begin or end: a run of the motion that ends as soon as they
// are found.
#pragma once

#include <optional>
#include <vector>

#include "scenes/plan/plan.hpp"

namespace beamcam::scenes {

using EventBounds = std::vector<std::optional<Instant>>;  // events at which outputs begin or end

inline EventBounds bounds_of(const Pictures& p) { return {p.span.from_event, p.span.to_event}; }
inline EventBounds bounds_of(const SeriesKeys& keys) { return {keys.from_event, keys.to_event, keys.at}; }

// A motion until `end` [s], recorded by its events alone.
sim::Request events_request(double end, bool apexes);
// The motion until the end of the request, or until all bounds are found. Without bounds: until the end.
sim::Result find_events(const sim::Problem& problem, sim::Request request, const EventBounds& bounds,
                        const FindEvents& find);

}  // namespace beamcam::scenes
