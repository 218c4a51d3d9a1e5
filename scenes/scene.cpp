#include "scenes/scene.hpp"

#include <algorithm>

namespace beamcam::scenes {

const std::string& file_of(const Output& output) {
    return std::visit([](const auto& o) -> const std::string& { return o.file; }, output);
}

const char* type_name(const Output& output) {
    struct Name {
        const char* operator()(const VideoOutput&) const { return "video"; }
        const char* operator()(const FramesOutput&) const { return "frames"; }
        const char* operator()(const StillOutput&) const { return "still"; }
        const char* operator()(const FigureOutput&) const { return "figure"; }
        const char* operator()(const TrajectoryOutput&) const { return "trajectory"; }
        const char* operator()(const ImpactsOutput&) const { return "impacts"; }
        const char* operator()(const SummaryOutput&) const { return "summary"; }
    };
    return std::visit(Name{}, output);
}

bool FrameSpan::looks_at_impacts() const {
    return speed.around || std::any_of(events.begin(), events.end(),
                                       [](const FilmEvent& event) { return event.at.kind != Instant::Kind::time; });
}

VideoOutput default_film(const Scene& scene) {
    VideoOutput film;
    film.file = scene.name + ".mp4";
    return film;
}

}  // namespace beamcam::scenes
