#include "scenes/plan/picture_times.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "render/base/error.hpp"
#include "scenes/plan/figure_times.hpp"

namespace beamcam::scenes {
namespace {

// A still of an instant is chosen by what led to it; one of an impact, which is found in the whole motion, by that.
double surveyed_until(const Pictures& p) { return p.at.kind == Instant::Kind::time ? p.at.t : p.end_time; }

sim::Request events_until(double end, bool apexes) {
    sim::Request request;
    request.end_time = end;
    request.turning_points = apexes;
    return request;
}

bool looks_at_apexes(const Pictures& p) {
    std::vector<Instant> named = p.span.instants();
    named.push_back(p.at);
    for (const Keyframe& key : p.picture.view.keyframes) named.push_back(key.at);
    return std::ranges::any_of(named, [](const Instant& at) { return at.kind == Instant::Kind::apex; });
}

FilmTimes with_moves(const Pictures& p, FilmTimes times, const sim::Result& motion) {
    if (!times.frames.empty()) add_moves(times, p.picture.view, p.span.fps.value(), motion, p.span.to.has_value());
    add_exposures(times, p.picture.view, p.span.fps.value(), p.end_time);
    return times;
}

// Slow around the impacts of all that is shown; "impact:N" counts those of the first.
FilmTimes times_of_compared(const Pictures& p, const FindImpacts& find) {
    const sim::Result first = find(p.compared.front().problem, events_until(p.end_time, looks_at_apexes(p)));
    std::vector<sim::Impact> all = first.impacts;
    for (std::size_t i = 1; i < p.compared.size(); ++i) {
        const sim::Result other = find(p.compared[i].problem, events_until(p.end_time, false));
        all.insert(all.end(), other.impacts.begin(), other.impacts.end());
    }
    std::ranges::stable_sort(all, {}, &sim::Impact::t_start);
    return with_moves(p,
                      p.kind == Pictures::Kind::still ? still_times(p.at, first, surveyed_until(p))
                                                      : film_times(p.span, p.end_time, first, all),
                      first);
}

}  // namespace

FilmTimes times_of(const Pictures& p, const sim::Result& motion) {
    return with_moves(p,
                      p.kind == Pictures::Kind::still ? still_times(p.at, motion, surveyed_until(p), p.collisions)
                                                      : film_times(p.span, p.end_time, motion, p.collisions),
                      motion);
}

void choose_frames(Pictures& p, const FilmTimes& times) {
    p.first_frame = times.first;
    const auto count = static_cast<long>(times.frames.size());
    const long begin = p.first_frame, end = begin + count;
    long from = begin, to = end;
    if (p.kind != Pictures::Kind::still && p.ask.frames) {
        from = std::max(begin, p.ask.frames->first);
        to = std::min(end, p.ask.frames->second);
    } else if (p.kind != Pictures::Kind::still && p.ask.shards > 1) {
        from = begin + count * (p.ask.shard - 1) / p.ask.shards;
        to = begin + count * p.ask.shard / p.ask.shards;
    }
    if (p.kind == Pictures::Kind::video && (from > begin || to < end))
        p.part = fmt::format("{}:{} of {}:{}", from, to, begin, end);
    p.draw.clear();
    for (long k = from; k < to; ++k)
        if (!p.there.contains(k)) p.draw.push_back(static_cast<int>(k - begin));
}

void put_times(Pictures& p, sim::Request& request, FilmTimes times) {
    choose_frames(p, times);
    p.speeds = std::move(times.speeds);
    p.callouts = std::move(times.callouts);
    p.moves = std::move(times.moves);
    p.unshown = std::move(times.unshown);
    p.poster = times.poster;
    std::vector<double>& poses = times.exposures.empty() ? times.frames : times.exposures;
    for (ComparedMotion& other : p.compared) {
        other.request.poses.front().times = poses;
        other.request.poses.back().times = times.survey;
        other.request.tables.front().times = times.chart;
        if (other.problem.cam) other.request.tables[1].times = times.trace;
    }
    if (!p.compared.empty()) return;
    request.poses[p.poses].times = std::move(poses);
    request.poses[p.survey].times = std::move(times.survey);
    request.tables[p.chart].times = std::move(times.chart);
    if (p.trace) request.tables[*p.trace].times = std::move(times.trace);
}

namespace {

const FigureOutput& output_of(const FigureFile& f, const Scene& scene) {
    return std::get<FigureOutput>(scene.outputs[f.output]);
}

bool looks_at_apexes(const Plan& plan, const Scene& scene) {
    const auto figure_does = [&](const FigureFile& f) { return !f.settled && looks_at_apexes(output_of(f, scene)); };
    return std::ranges::any_of(plan.pictures, [](const Pictures& p) { return looks_at_apexes(p); }) ||
           std::ranges::any_of(plan.figures, figure_does);
}

// What cannot be settled is refused, and leaves the list.
template <class T, class Settle>
void settle_each(std::vector<T>& all, const RefusePicture& refuse, const Settle& settle_one) {
    for (T& each : all) {
        if (each.settled) continue;
        try {
            settle_one(each);
            each.settled = true;
        } catch (const render::PictureError& error) {
            if (!refuse) throw;
            refuse(each.output, error.what());
        }
    }
    std::erase_if(all, [](const T& each) { return !each.settled; });
}

}  // namespace

void settle(Plan& plan, const Scene& scene, const FindImpacts& find, const RefusePicture& refuse) {
    std::optional<sim::Result> found;
    const auto own = [&]() -> const sim::Result& {
        if (!found) found = find(scene.problem, events_until(*plan.impacts_until, looks_at_apexes(plan, scene)));
        return *found;
    };
    settle_each(plan.pictures, refuse, [&](Pictures& p) {
        sim::Request none;
        if (p.compared.empty())
            put_times(p, plan.simulation->request, times_of(p, own()));
        else
            put_times(p, none, times_of_compared(p, find));
    });
    settle_each(plan.figures, refuse, [&](FigureFile& f) {
        const FigureOutput& how = output_of(f, scene);
        const sim::Problem& counted = counted_motion(scene, how);
        const double end = scene.end_time;
        prepare_figure(f, scene,
                       &counted == &scene.problem
                           ? with_event_times(how, own(), end)
                           : with_event_times(how, find(counted, events_until(end, looks_at_apexes(how))), end));
    });
    plan.impacts_until.reset();
}

}  // namespace beamcam::scenes
