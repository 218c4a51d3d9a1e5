#include "scenes/plan/figure_times.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "render/base/error.hpp"
#include "scenes/plan/event_search.hpp"
#include "scenes/scene/time_map.hpp"

namespace beamcam::scenes {

void prepare_figure(FigureFile& figure, const Scene& scene, const FigureOutput& how) {
    const Recipe* recipe = recipe_named(how.figure);
    if (!recipe) throw std::logic_error("unknown figure: " + how.figure);
    Studies studies;
    figure.make = [make = recipe->prepare(scene, how, studies), height = how.series.height](const Results& results) {
        render::figure::Figure made = make(results);
        if (height) made.height = *height * 1e3;
        return made;
    };
    figure.studies = studies.take();
    const std::string own = Studies::key(scene.problem);
    for (Study& study : figure.studies) study.of_scene = Studies::key(study.problem) == own;
}

bool needs_apexes(const FigureOutput& how) {
    for (const auto& each : {how.series.from_event, how.series.to_event, how.series.at})
        if (each && each->kind == Instant::Kind::apex) return true;
    return false;
}

FigureOutput with_event_times(FigureOutput how, const sim::Result& motion, double end_time) {
    const auto text = [](const std::optional<Instant>& event, double t) {
        return event ? fmt::format("{} at {:g} s", name_of(*event), t) : fmt::format("{:g} s", t);
    };
    const auto from_event = how.series.from_event, to_event = how.series.to_event;
    SeriesKeys series = with_times(std::move(how.series), motion);
    if (const auto at = std::exchange(series.at, {}))
        series.from = at->kind == Instant::Kind::last ? end_time : instant_of(*at, motion), series.to = series.from;
    const double end = series.to.value_or(end_time);
    if (!(series.from < end) && !(how.figure == "strobe" && series.from == end))
        throw render::PictureError(fmt::format("figure {}: \"from\" = {} is not before \"to\" = {}", how.figure,
                                               text(from_event, series.from), text(to_event, end)));
    how.series = std::move(series);
    return how;
}

FigureOutput with_found_times(const FigureOutput& how, const Scene& scene, const FindEvents& find) {
    const SeriesKeys& keys = how.series;
    if (!keys.needs_events()) return with_event_times(how, {}, scene.end_time);
    const sim::Problem& counted = keys.compare.empty() ? scene.problem : keys.compare.front().problem;
    const sim::Request request = events_request(keys.to.value_or(scene.end_time), needs_apexes(how));
    const bool ends_at_event = keys.to_event || keys.at;
    return with_event_times(how, find_events(counted, request, ends_at_event ? bounds_of(keys) : Bounds(), find),
                            scene.end_time);
}

FigureOutput without_events(FigureOutput how) {
    SeriesKeys& keys = how.series;
    if (keys.from_event || keys.at) keys.from = 0;
    if (keys.to_event || keys.at) keys.to.reset();
    keys.from_event.reset(), keys.to_event.reset(), keys.at.reset();
    return how;
}

}  // namespace beamcam::scenes
