#include "scenes/plan/event_search.hpp"

#include <algorithm>
#include <cstddef>

#include "scenes/scene/time_map.hpp"
#include "sim/observe/request.hpp"

namespace beamcam::scenes {

// The events after which the run may end. The apex of a rebound is certain when the next collision begins. nullopt: the
// whole motion is needed.
static std::optional<sim::EventCounts> enough_for(const EventBounds& bounds) {
    sim::EventCounts enough;
    const auto raise = [](std::size_t& count, int number) {
        count = std::max(count, static_cast<std::size_t>(number));
    };
    for (const std::optional<Instant>& each : bounds) {
        switch (each.value_or(Instant{}).kind) {
            case Instant::Kind::time:
                break;
            case Instant::Kind::last:
                return std::nullopt;
            case Instant::Kind::impact:
                raise(enough.touches, each->number);
                break;
            case Instant::Kind::release:
                raise(enough.releases, each->number);
                break;
            case Instant::Kind::collision:
                raise(enough.collisions, each->number);
                break;
            case Instant::Kind::apex:
                raise(enough.collisions, each->number + 1);
                break;
        }
    }
    return enough.touches + enough.releases + enough.collisions > 0 ? std::optional(enough) : std::nullopt;
}

sim::Request events_request(double end, bool apexes) {
    sim::Request request;
    request.end_time = end;
    request.apexes = apexes;
    return request;
}

sim::Result find_events(const sim::Problem& problem, sim::Request request, const EventBounds& bounds,
                        const FindEvents& find) {
    request.enough = enough_for(bounds);
    sim::Result found = find(problem, request);
    const auto lacks = [&](const std::optional<Instant>& at) { return at && !find_instant(*at, found); };
    if (!(found.end_time < request.end_time) || std::ranges::none_of(bounds, lacks)) return found;
    request.enough.reset();  // two successive collisions had no apex between them
    return find(problem, request);
}

}  // namespace beamcam::scenes
