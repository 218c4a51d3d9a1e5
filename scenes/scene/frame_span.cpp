// The frames of a film in real time.
#include <fmt/format.h>

#include <cmath>

#include "render/base/error.hpp"
#include "scenes/scene/film_times.hpp"
#include "scenes/scene/time_map.hpp"

namespace beamcam::scenes {
namespace {

// Why a film of this length has no frames, or too many; empty if it is valid.
std::string problem_with_length(const FrameSpan& span, double seconds) {
    const double count = std::round(seconds * span.fps.value());
    if (count > kMostFrames)
        return fmt::format("the film would have {:.0f} frames, but the maximum is {:.0f}; reduce {} or \"fps\"{}",
                           count, kMostFrames, span.duration ? "\"duration\"" : "\"to\"",
                           span.duration ? "" : ", or increase \"speed\"");
    if (!(count >= 1))
        return span.duration ? "the film has no frame; increase \"duration\" or \"fps\""
                             : "the film has no frame at this speed; reduce the speed, or increase \"fps\"";
    return {};
}

std::string order_remedy(const FrameSpan& span) {
    return span.to ? "\"to\" must be later than \"from\"" : "\"from\" must be earlier than the end of the scene";
}

}  // namespace

double frame_count(const FrameSpan& span, double seconds) {
    if (const std::string problem = problem_with_length(span, seconds); !problem.empty())
        throw render::PictureError(problem);
    return std::round(seconds * span.fps.value());
}

std::string pauses_fill(const FrameSpan& span) {
    return fmt::format("the freezes and the hold fill the film of {:g} s; increase \"duration\"", *span.duration);
}

std::string problem_with_span(const FrameSpan& span, double end_time) {
    const double to = span.to.value_or(end_time), fps = span.fps.value();
    double pauses = span.hold;  // without freezes at events, whose times are not known here
    for (const FilmEvent& event : span.events)
        if (event.at.kind == Instant::Kind::time && event.at.t >= span.from && event.at.t <= to) pauses += event.freeze;
    if (span.duration && *span.duration <= pauses) return pauses_fill(span);
    if (span.duration)
        if (std::string problem = problem_with_length(span, *span.duration); !problem.empty()) return problem;
    if (span.from_event || span.to_event) return {};
    if (!span.real_time()) {
        if (to > span.from) return {};  // the number of frames depends on the motion
        return fmt::format("the film begins at {:g} s and ends at {:g} s; {}", span.from, to, order_remedy(span));
    }
    const auto [first, end] = frames_between(span.from, to, fps);
    if (!(end > first))
        return fmt::format(
            "the film from {:g} s to {:g} s has no frame at {:g} frames a second; {}", span.from, to, fps,
            to > span.from ? "show a longer interval, increase \"fps\", or reduce \"speed\" (slow motion)"
                           : order_remedy(span));
    if (end - first > kMostFrames)
        return fmt::format(
            "{:.0f} frames are too many: an output has at most {:.0f}; use \"from\" and \"to\", or reduce \"fps\"",
            end - first, kMostFrames);
    return {};
}

std::pair<double, double> frames_between(double from, double to, double fps) {
    return {std::round(from * fps), std::round(to * fps)};
}

FrameSpan resolved(const FrameSpan& span, double end_time, const sim::Result& motion) {
    FrameSpan out = with_times(span, motion);
    if (const std::string problem = problem_with_span(out, end_time); !problem.empty())
        throw render::PictureError(problem);
    return out;
}

}  // namespace beamcam::scenes
