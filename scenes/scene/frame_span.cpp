// Which spans of a film have frames.
#include <fmt/format.h>

#include <cmath>

#include "render/base/error.hpp"
#include "scenes/scene/film_times.hpp"
#include "scenes/scene/time_map.hpp"

namespace beamcam::scenes {

std::string pauses_fill(const FrameSpan& span) {
    return fmt::format("the freezes and the hold fill the film of {:g} s; increase \"duration\"", *span.duration);
}

static std::string order_remedy(const FrameSpan& span) {
    return span.to ? "\"to\" must be later than \"from\"" : "\"from\" must be earlier than the end of the scene";
}

std::string problem_with_span(const FrameSpan& span, double end_time) {
    const double to = span.to.value_or(end_time), fps = span.fps.value();
    double pauses = span.hold;  // without freezes at events, whose times are not known here
    for (const FilmEvent& event : span.events)
        if (event.at.kind == Instant::Kind::time && event.at.t >= span.from && event.at.t <= to) pauses += event.freeze;
    if (span.duration && *span.duration <= pauses) return pauses_fill(span);
    if (span.from_event || span.to_event) return {};
    if (!span.real_time()) {
        if (to > span.from) return {};  // the number of frames depends on the motion
        return fmt::format("the film begins at {:g} s and ends at {:g} s; {}", span.from, to, order_remedy(span));
    }
    const double first = std::round(span.from * fps), last = std::round(to * fps);
    if (!(last > first))
        return fmt::format("no frame lies between {:g} s and {:g} s at {:g} frames a second; {}", span.from, to, fps,
                           to > span.from ? "increase \"to\" or \"fps\"" : order_remedy(span));
    if (last - first > kMostFrames)
        return fmt::format(
            "{:.0f} frames are too many: an output has at most {:.0f}; use \"from\" and \"to\", or reduce \"fps\"",
            last - first, kMostFrames);
    return {};
}

FrameSpan resolved(const FrameSpan& span, double end_time, const sim::Result& motion) {
    FrameSpan out = with_times(span, motion);
    if (const std::string problem = problem_with_span(out, end_time); !problem.empty())
        throw render::PictureError(problem);
    return out;
}

}  // namespace beamcam::scenes
