#include "scenes/plan/resolve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <numbers>
#include <optional>
#include <utility>

#include "render/base/error.hpp"
#include "scenes/figures/figure_types.hpp"
#include "scenes/plan/story.hpp"
#include "scenes/scene/time_map.hpp"

namespace beamcam::scenes {
namespace {

// ---- searches ----------------------------------------------------------------------------------

// A run of one motion that finds events.
struct Search {
    double until = 0;                                 // at most [s]
    bool whole = false;                               // it does not end at the events below
    std::vector<std::optional<Instant>> bounds = {};  // the events at which outputs begin and end
    std::vector<Instant> others = {};                 // further events of outputs

    std::vector<Instant> events() const {
        std::vector<Instant> all = others;
        for (const auto& each : bounds)
            if (each) all.push_back(*each);
        return all;
    }
    void add(const Search& other) {
        until = std::max(until, other.until);
        whole = whole || other.whole;
        bounds.insert(bounds.end(), other.bounds.begin(), other.bounds.end());
        others.insert(others.end(), other.others.begin(), other.others.end());
    }
};

// The events after which the run may end. The apex of a rebound is certain when the next collision begins. nullopt: the
// whole motion is needed.
std::optional<sim::EventCounts> enough_for(const Search& search) {
    sim::EventCounts enough;
    const auto raise = [](std::size_t& count, int number) {
        count = std::max(count, static_cast<std::size_t>(number));
    };
    if (search.whole) return std::nullopt;
    for (const std::optional<Instant>& each : search.bounds) {
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
            case Instant::Kind::peak:
            case Instant::Kind::liftoff:
            case Instant::Kind::bend:
            case Instant::Kind::apex:
                raise(enough.collisions, each->number + 1);
                break;
        }
    }
    return enough.touches + enough.releases + enough.collisions > 0 ? std::optional(enough) : std::nullopt;
}

// `scene_end` [s]
sim::Result run(const Search& search, double scene_end, const sim::Problem& problem, const FindEvents& find) {
    sim::Request request;
    request.end_time = search.until;
    for (const Instant& each : search.events()) record_event(each, scene_end, request);
    request.enough = enough_for(search);
    sim::Result found = find(problem, request);
    const auto lacks = [&](const std::optional<Instant>& at) { return at && !find_instant(*at, found); };
    if (!(found.end_time < search.until) || std::ranges::none_of(search.bounds, lacks)) return found;
    request.enough.reset();  // two successive collisions had no apex between them
    return find(problem, request);
}

// ---- figures -----------------------------------------------------------------------------------

// The event at which a figure without "to" ends, if the motion has it.
std::optional<Instant> usual_end(const FigureOutput& how) {
    const FigureType* type = figure_type(how.figure);
    const SeriesKeys& keys = how.series;
    return type && !keys.to && !keys.to_event && !keys.to_last ? type->ends : std::nullopt;
}

bool needs_events(const FigureOutput& how) { return how.series.needs_events() || usual_end(how); }

Search search_of(const FigureOutput& how, const Scene& scene) {
    const SeriesKeys& keys = how.series;
    const std::optional<Instant> end = keys.to_event ? keys.to_event : usual_end(how);
    return {.until = keys.to.value_or(scene.end_time), .whole = !end, .bounds = {keys.from_event, end}};
}

// `end_time`: of the scene [s].
FigureOutput with_times_of(FigureOutput how, const sim::Result& motion, double end_time) {
    const auto text = [](const std::optional<Instant>& event, double t) {
        return event ? fmt::format("{} at {:g} s", name_of(*event), t) : fmt::format("{:g} s", t);
    };
    const auto from_event = how.series.from_event, to_event = how.series.to_event;
    const std::optional<Instant> usual = usual_end(how);
    // A figure that begins at an event or ends at a first one ends with the scene if the motion lacks that end.
    std::optional<Instant>& to = how.series.to_event;
    if (to && (to->number == 1 || from_event) && !find_instant(*to, motion)) to.reset();
    SeriesKeys series = with_times(std::move(how.series), motion);
    if (const FigureType* type = figure_type(how.figure); usual && type->begins && !from_event && series.from == 0)
        series.from = find_instant(*type->begins, motion).value_or(0);
    if (const auto end_of_type = usual ? find_instant(*usual, motion) : std::nullopt)
        if (*end_of_type > series.from) series.to = end_of_type;
    const double end = series.to.value_or(end_time);
    if (!(series.from < end))
        throw render::PictureError(fmt::format("figure {}: \"from\" = {} is not before \"to\" = {}", how.figure,
                                               text(from_event, series.from), text(to_event, end)));
    how.series = std::move(series);
    return how;
}

// ---- pictures ----------------------------------------------------------------------------------

// End of the motion that sets the scales [s]: a still has those of the whole scene.
double end_of(const PictureOutput& p, const Scene& scene) {
    if (p.kind != PictureOutput::Kind::still) return p.span.to.value_or(scene.end_time);
    return p.at.kind == Instant::Kind::time ? std::max(p.at.t, scene.end_time) : scene.end_time;
}

// A strip of one collision at a time needs more rows than one of the whole time, a page more instants. A still by time
// has enough of them.
bool shows_collisions(const PictureOutput& p, const Scene& scene) {
    if (p.kind == PictureOutput::Kind::page) return scene.problem.cam.has_value();
    if (p.kind == PictureOutput::Kind::still && !p.at.is_event() && !p.layout) return false;
    return std::ranges::any_of(panels_of(p, scene, end_of(p, scene)), &render::PanelSpec::by_collision);
}

bool ends_at_event(const PictureOutput& p) { return p.kind != PictureOutput::Kind::still && p.span.to_event; }

Search search_of(const PictureOutput& p, const Scene& scene) {
    std::vector<Instant> named = p.span.instants();
    if (p.span.story) named.push_back({.kind = Instant::Kind::apex});
    named.push_back(p.at);
    for (const Keyframe& key : p.view.keyframes) named.push_back(key.at);
    return {.until = end_of(p, scene),
            .whole = !ends_at_event(p),
            .bounds = {p.span.from_event, p.span.to_event},
            .others = std::move(named)};
}

// Poses per second of a page between two times [s]: `fps`, or more for a short motion.
FrameRate rate_of_page(FrameRate fps, double from, double to) {
    constexpr double kFewestPoses = 1000, kHighestRate = 1e9;  // [Hz]
    const double rate = kFewestPoses / std::max(to - from, 1e-9);
    return rate > fps.value() ? FrameRate{static_cast<int>(std::min(std::ceil(rate), kHighestRate)), 1} : fps;
}

// `motion` contains the events that the picture names, `slowed` the impacts of all motions, for slow motion.
ResolvedOutput resolved_picture(std::size_t index, PictureOutput p, const Scene& scene, const sim::Result& motion,
                                const std::vector<sim::Impact>& slowed) {
    const double end = ends_at_event(p) ? instant_of(*p.span.to_event, motion) : end_of(p, scene);
    const bool collisions = shows_collisions(p, scene);
    FilmTimes times;
    switch (p.kind) {
        case PictureOutput::Kind::still:
            times = still_times(p.at, motion, end, collisions ? slowed : std::vector<sim::Impact>{},
                                2 * std::numbers::pi / std::abs(scene.problem.cam ? scene.problem.cam->speed : 0.0));
            break;
        case PictureOutput::Kind::page:
            p.view.style = render::Style::flat;
            p.span.fps = rate_of_page(p.span.fps, with_times(p.span, motion).from, end);
            times = page_times(p.span, end, motion);
            break;
        default:
            times = film_times(p.span, end, motion, slowed, collisions);
    }
    if (!times.frames.empty()) add_moves(times, p.view, p.span.fps.value(), motion, p.span.to || ends_at_event(p));
    return {index, std::move(p), end, std::move(times)};
}

// Slow motion is around the impacts of all motions; "impact:N" counts those of the first motion.
ResolvedOutput resolved_comparison(std::size_t index, const PictureOutput& p, const Scene& scene,
                                   const FindEvents& find) {
    Search search = search_of(p, scene);
    const sim::Result first = run(search, scene.end_time, p.compare.front().problem, find);
    std::vector<sim::Impact> all = first.impacts;
    const double end = ends_at_event(p) ? instant_of(*p.span.to_event, first) : search.until;
    for (std::size_t i = 1; i < p.compare.size(); ++i) {
        const sim::Result other = run({.until = end, .whole = true}, end, p.compare[i].problem, find);
        all.insert(all.end(), other.impacts.begin(), other.impacts.end());
    }
    std::ranges::stable_sort(all, {}, &sim::Impact::t_start);
    return resolved_picture(index, p, scene, first, all);
}

// ---- all outputs -------------------------------------------------------------------------------

// The events of the scene's own motion, which are searched for when the first output needs them.
class OwnEvents {
  public:
    OwnEvents(const Scene& scene, const std::set<std::size_t>& without, const FindEvents& find)
        : scene_(scene), found_(std::async(std::launch::deferred, [this, &find] {
              return run(search_, scene_.end_time, scene_.problem, find);
          })) {
        for (std::size_t i = 0; i < scene.outputs.size(); ++i) {
            const Output& output = scene.outputs[i];
            if (without.contains(i) || !needs_events(output, scene)) continue;
            if (const auto* p = std::get_if<PictureOutput>(&output); p && p->compare.empty())
                search_.add(search_of(*p, scene));
            if (const auto* f = std::get_if<FigureOutput>(&output); f && f->series.compare.empty())
                search_.add(search_of(*f, scene));
        }
    }
    const sim::Result& get() const { return found_.get(); }

  private:
    const Scene& scene_;
    Search search_;
    std::shared_future<sim::Result> found_;  // keeps a failure, too
};

ResolvedOutput resolved_output(std::size_t index, const Scene& scene, const OwnEvents& own, const FindEvents& find) {
    static const sim::Result kNoEvents;
    const Output& output = scene.outputs[index];
    const bool events = needs_events(output, scene);
    if (const auto* figure = std::get_if<FigureOutput>(&output))
        return {index, !events                          ? with_times_of(*figure, kNoEvents, scene.end_time)
                       : figure->series.compare.empty() ? with_times_of(*figure, own.get(), scene.end_time)
                                                        : resolved(*figure, scene, find)};
    const auto* picture = std::get_if<PictureOutput>(&output);
    if (!picture) return {index, output};
    PictureOutput p = *picture;
    if (p.kind == PictureOutput::Kind::still && p.at.kind == Instant::Kind::last)
        p.at = {.kind = Instant::Kind::time, .t = scene.end_time};
    if (events && !p.compare.empty()) return resolved_comparison(index, p, scene, find);
    const sim::Result& motion = events ? own.get() : kNoEvents;
    if (p.span.story) p = told(std::move(p), scene, motion, find);
    return resolved_picture(index, std::move(p), scene, motion, motion.impacts);
}

}  // namespace

bool needs_events(const Output& output, const Scene& scene) {
    if (const auto* figure = std::get_if<FigureOutput>(&output)) return needs_events(*figure);
    const auto* p = std::get_if<PictureOutput>(&output);
    if (!p) return false;
    return shows_collisions(*p, scene) || std::ranges::any_of(p->view.keyframes, &Instant::is_event, &Keyframe::at) ||
           (p->kind == PictureOutput::Kind::still ? p->at.is_event() : p->span.needs_events());
}

double events_until(const Output& output, const Scene& scene) {
    if (const auto* figure = std::get_if<FigureOutput>(&output)) return search_of(*figure, scene).until;
    return end_of(std::get<PictureOutput>(output), scene);
}

std::vector<render::PanelSpec> panels_of(const PictureOutput& p, const Scene& scene, double end_time) {
    if (p.layout) return render::panels_of(*p.layout);
    const sim::Problem* shown = p.compare.empty() ? &scene.problem : &p.compare.front().problem;
    for (const Compared& each : p.compare)
        if (!shown->cam) shown = &each.problem;
    return render::standard_panels(*shown, shows_latest_collision(p, end_time));
}

bool shows_latest_collision(const PictureOutput& p, double end_time) {
    constexpr double kSlow = 0.3;  // of real time
    if (p.kind == PictureOutput::Kind::still) return p.at.is_event() || !p.compare.empty();
    return p.span.speed.around || p.span.speed.factor <= kSlow ||
           (p.span.duration && !ends_at_event(p) && end_time - p.span.from <= kSlow * *p.span.duration);
}

FigureOutput resolved(const FigureOutput& how, const Scene& scene, const FindEvents& find) {
    if (!needs_events(how)) return with_times_of(how, {}, scene.end_time);
    const std::vector<Compared>& compare = how.series.compare;
    return with_times_of(
        how,
        run(search_of(how, scene), scene.end_time, compare.empty() ? scene.problem : compare.front().problem, find),
        scene.end_time);
}

ResolvedScene resolve(const Scene& scene, const std::set<std::size_t>& without, const FindEvents& find,
                      const AttemptOutput& attempt) {
    ResolvedScene resolved{scene, {}};
    OwnEvents own(scene, without, find);
    for (std::size_t i = 0; i < scene.outputs.size(); ++i)
        if (!without.contains(i)) attempt(i, [&] { resolved.outputs.push_back(resolved_output(i, scene, own, find)); });
    return resolved;
}

ResolvedScene resolve(const Scene& scene, const FindEvents& find) { return resolve(scene, {}, find); }

}  // namespace beamcam::scenes
