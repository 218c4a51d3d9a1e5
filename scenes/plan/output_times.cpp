#include "scenes/plan/output_times.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "render/base/error.hpp"
#include "scenes/motions/identity.hpp"
#include "scenes/scene/time_map.hpp"
#include "sim/observe/recorder_set.hpp"
#include "sim/observe/request.hpp"

namespace beamcam::scenes {

// ---- events ------------------------------------------------------------------------------------
// A run of the motion that ends as soon as the events are found at which pictures and figures begin or end.

namespace {

using EventBounds = std::vector<std::optional<Instant>>;

EventBounds bounds_of(const Pictures& p) { return {p.span.from_event, p.span.to_event}; }
EventBounds bounds_of(const SeriesKeys& keys) { return {keys.from_event, keys.to_event, keys.at}; }

// The events after which the run may end. The end of a collision and the apex of a rebound are
// certain when the next collision begins. nullopt: the
// whole motion is needed.
std::optional<sim::EventCounts> enough_for(const EventBounds& bounds) {
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
            case Instant::Kind::liftoff:
            case Instant::Kind::apex:
                raise(enough.collisions, each->number + 1);
                break;
        }
    }
    return enough.touches + enough.releases + enough.collisions > 0 ? std::optional(enough) : std::nullopt;
}

// A motion until `end` [s], recorded by its events alone.
sim::Request events_request(double end, bool apexes) {
    sim::Request request;
    request.end_time = end;
    request.apexes = apexes;
    return request;
}

// The motion until the end of the request, or until all bounds are found. Without bounds: until the end.
sim::Result find_events(const sim::Problem& problem, sim::Request request, const EventBounds& bounds,
                        const FindEvents& find) {
    request.enough = enough_for(bounds);
    sim::Result found = find(problem, request);
    const auto lacks = [&](const std::optional<Instant>& at) { return at && !find_instant(*at, found); };
    if (!(found.end_time < request.end_time) || std::ranges::none_of(bounds, lacks)) return found;
    request.enough.reset();  // two successive collisions had no apex between them
    return find(problem, request);
}

}  // namespace

// ---- figures -----------------------------------------------------------------------------------

void prepare_figure(FigureFile& figure, const Scene& scene, const FigureOutput& how) {
    const FigureType* type = figure_type(how.figure);
    if (!type) throw std::logic_error("unknown figure: " + how.figure);
    Studies studies;
    figure.make = [make = type->prepare(scene, how, studies), height = how.series.height](const Results& results) {
        render::figure::Figure made = make(results);
        if (height) made.height = *height * 1e3;
        return made;
    };
    figure.studies = studies.take();
    const std::string own = motion_key(scene.problem);
    for (Study& study : figure.studies) study.of_scene = study.key == own;
}

static bool needs_apexes(const FigureOutput& how) {
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
    return with_event_times(how, find_events(counted, request, ends_at_event ? bounds_of(keys) : EventBounds(), find),
                            scene.end_time);
}

FigureOutput without_events(FigureOutput how) {
    SeriesKeys& keys = how.series;
    if (keys.from_event || keys.at) keys.from = 0;
    if (keys.to_event || keys.at) keys.to.reset();
    keys.from_event.reset(), keys.to_event.reset(), keys.at.reset();
    return how;
}

// ---- pictures ----------------------------------------------------------------------------------

namespace {

// End of the motion that determines the scales of a still [s]: its instant, or the end of the scene if it shows an
// event.
double scales_until(const Pictures& p) { return p.at.kind == Instant::Kind::time ? p.at.t : p.end_time; }

void end_at_event(Pictures& p, const sim::Result& motion) {
    if (!p.ends_at_event()) return;
    p.end_time = instant_of(*p.span.to_event, motion);
    if (p.kind == Pictures::Kind::page)
        p.span.fps = rate_of_page(p.span.fps, with_times(p.span, motion).from, p.end_time);
}

bool needs_apexes(const Pictures& p) {
    std::vector<Instant> named = p.span.instants();
    named.push_back(p.at);
    for (const Keyframe& key : p.view.keyframes) named.push_back(key.at);
    return std::ranges::any_of(named, [](const Instant& at) { return at.kind == Instant::Kind::apex; });
}

FilmTimes with_moves(const Pictures& p, FilmTimes times, const sim::Result& motion) {
    const bool shortened = p.span.to || p.ends_at_event();
    if (!times.frames.empty()) add_moves(times, p.view, p.span.fps.value(), motion, shortened);
    return times;
}

// Slow motion is around the impacts of all motions; "impact:N" counts those of the first motion.
FilmTimes times_of_compared(Pictures& p, const FindEvents& find) {
    const sim::Result first = find_events(p.shown.front().problem, events_request(p.end_time, needs_apexes(p)),
                                          p.ends_at_event() ? bounds_of(p) : EventBounds(), find);
    end_at_event(p, first);
    std::vector<sim::Impact> all = first.impacts;
    for (std::size_t i = 1; i < p.shown.size(); ++i) {
        const sim::Result other = find(p.shown[i].problem, events_request(p.end_time, false));
        all.insert(all.end(), other.impacts.begin(), other.impacts.end());
    }
    std::ranges::stable_sort(all, {}, &sim::Impact::t_start);
    return with_moves(p,
                      p.kind == Pictures::Kind::still ? still_times(p.at, first, scales_until(p))
                                                      : film_times(p.span, p.end_time, first, all),
                      first);
}

}  // namespace

FrameRate rate_of_page(FrameRate fps, double from, double to) {
    constexpr double kFewestPoses = 1000, kHighestRate = 1e9;  // [Hz]
    const double rate = kFewestPoses / std::max(to - from, 1e-9);
    return rate > fps.value() ? FrameRate{static_cast<int>(std::min(std::ceil(rate), kHighestRate)), 1} : fps;
}

FilmTimes times_of(const Pictures& p, const sim::Result& motion) {
    const auto times = [&] {
        switch (p.kind) {
            case Pictures::Kind::still:
                return still_times(p.at, motion, scales_until(p), p.collisions);
            case Pictures::Kind::page:
                return page_times(p.span, p.end_time, motion);
            default:
                return film_times(p.span, p.end_time, motion, p.collisions);
        }
    };
    return with_moves(p, times(), motion);
}

void choose_frames(Pictures& p, long first, long count) {
    p.first_frame = first;
    p.draw.clear();
    for (long k = 0; k < count; ++k)
        if (!p.existing.contains(first + k)) p.draw.push_back(static_cast<int>(k));
}

void put_times(Pictures& p, FilmTimes times) {
    choose_frames(p, times.first, std::ssize(times.frames));
    p.speeds = std::move(times.speeds);
    p.callouts = std::move(times.callouts);
    p.moves = std::move(times.moves);
    p.unreached_events = std::move(times.unreached_events);
    p.poster = times.poster;
    for (Study& motion : p.shown) {
        sim::Request& request = motion.request;
        request.end_time = p.end_time;
        request.poses[kFramePoses].times = times.frames;
        request.poses[kSurveyPoses].times = times.survey;
        request.poses[kPathPoses].times = times.path;
        request.tables[kChartTable].times = times.chart;
        if (motion.problem.cam) request.tables[kTraceTable].times = times.trace;
    }
}

// ---- all outputs -------------------------------------------------------------------------------

namespace {

const FigureOutput& output_of(const FigureFile& f, const Scene& scene) {
    return std::get<FigureOutput>(scene.outputs[f.output]);
}

bool needs_apexes(const Plan& plan, const Scene& scene) {
    const auto figure_does = [&](const FigureFile& f) { return !f.times_known && needs_apexes(output_of(f, scene)); };
    return std::ranges::any_of(plan.pictures, [](const Pictures& p) { return needs_apexes(p); }) ||
           std::ranges::any_of(plan.figures, figure_does);
}

// An output whose events do not occur is rejected and removed.
template <class T, class Resolve>
void resolve_each(std::vector<T>& all, const RejectOutput& reject, const Resolve& resolve) {
    for (T& each : all) {
        if (each.times_known) continue;
        try {
            resolve(each);
            each.times_known = true;
        } catch (const render::PictureError& error) {
            if (!reject) throw;
            reject(each.output, error.what());
        }
    }
    std::erase_if(all, [](const T& each) { return !each.times_known; });
}

}  // namespace

void resolve_event_times(Plan& plan, const Scene& scene, const FindEvents& find, const RejectOutput& reject) {
    EventBounds bounds;
    const auto add_bounds = [&](const EventBounds& more) { bounds.insert(bounds.end(), more.begin(), more.end()); };
    for (const Pictures& p : plan.pictures)
        if (!p.times_known && p.compare.empty()) add_bounds(bounds_of(p));
    for (const FigureFile& f : plan.figures)
        if (const SeriesKeys& keys = output_of(f, scene).series; !f.times_known && keys.compare.empty())
            add_bounds(bounds_of(keys));
    if (plan.all_events) bounds.clear();
    std::optional<sim::Result> found;
    const auto own = [&]() -> const sim::Result& {
        if (!found)
            found =
                find_events(scene.problem, events_request(*plan.events_until, needs_apexes(plan, scene)), bounds, find);
        return *found;
    };
    resolve_each(plan.pictures, reject, [&](Pictures& p) {
        if (!p.compare.empty()) return put_times(p, times_of_compared(p, find));
        end_at_event(p, own());
        put_times(p, times_of(p, own()));
        plan.simulation->simulate_until(p.end_time);
    });
    resolve_each(plan.figures, reject, [&](FigureFile& f) {
        const FigureOutput& how = output_of(f, scene);
        const bool of_scene = how.series.compare.empty();
        prepare_figure(f, scene,
                       of_scene ? with_event_times(how, own(), scene.end_time) : with_found_times(how, scene, find));
        for (const Study& study : f.studies)
            if (study.of_scene) plan.simulation->simulate_until(end_of(study.request));
    });
    plan.events_until.reset();
    if (plan.simulation) plan.simulation->ends_at_event = false;
}

}  // namespace beamcam::scenes
