#include "scenes/scene/film_times.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/base/error.hpp"
#include "scenes/scene/time_map.hpp"

namespace beamcam::scenes {
namespace {

// Rows of strip charts: a resolution of a quarter of a millisecond, at most two points for each of ten thousand
// columns, and enough for a smooth curve in a very short film.
constexpr double kChartRate = 4000;  // [Hz]
constexpr double kMostChartPoints = 20000, kFewestChartPoints = 2000;
constexpr double kFinePoints = 40000;                    // in slow motion
constexpr double kLatest = 0.05, kLatestRate = 40'000;   // [s], [Hz]: rows before a still
constexpr int kFineSteps = 8;                            // between two frames
constexpr double kLasting = 1, kLongestCollision = 0.1;  // [s]: a strip shows less of a contact that lasts
// Samples for the choice of scales; collisions have additional samples.
constexpr int kSurveyed = 300;

std::vector<double> surveyed(double from, double to) {
    if (!(to > from)) return {from};
    std::vector<double> out;
    for (int k = 0; k < kSurveyed; ++k) out.push_back(from + (to - from) * k / kSurveyed);
    out.push_back(to);
    return out;
}

// The path of the tip has at least as many points as in a film of 30 frames per second.
std::vector<double> between(const std::vector<double>& frames) {
    constexpr double kFarthest = 1.0 / 30, kMost = 64, kSlack = 0.01;
    std::vector<double> out;
    for (std::size_t k = 1; k < frames.size(); ++k) {
        const double from = frames[k - 1], step = frames[k] - from;
        const double count = std::clamp(std::ceil(step / kFarthest - kSlack), 1.0, kMost);
        for (int i = 1; i < count; ++i) out.push_back(from + step * i / count);
    }
    return out;
}

double chart_rate(double duration) {
    const double seconds = std::max(duration, 1e-12);
    return std::clamp(kChartRate, kFewestChartPoints / seconds, kMostChartPoints / seconds);
}

void merge(std::vector<double>& into, const std::vector<double>& more) {
    into.insert(into.end(), more.begin(), more.end());
    std::ranges::sort(into);
    into.erase(std::unique(into.begin(), into.end()), into.end());
}

FilmTimes real_time(const FrameSpan& span, double to) {
    FilmTimes out;
    const auto [first, end] = frames_between(span.from, to, span.fps.value());
    out.first = std::lround(first);
    for (long k = out.first; k < std::lround(end); ++k)
        out.frames.push_back(static_cast<double>(k) * span.fps.denominator / span.fps.numerator);
    return out;
}

// nullopt for an event after an explicit end of the film; otherwise the event must occur.
std::optional<double> reached(const Instant& at, const FrameSpan& span, double to, const sim::Result& motion) {
    if (at.kind == Instant::Kind::last) return to;
    return span.to ? find_instant(at, motion) : instant_of(at, motion);
}

struct ShownEvent {
    const FilmEvent* event;
    double t;
};

// A text ends when the next one begins.
std::vector<render::Callout> callouts_of(const std::vector<ShownEvent>& shown, const TimeMap& map, double fps) {
    constexpr double kDefaultDuration = 1.5;  // [s]
    std::vector<render::Callout> out;
    for (std::size_t i = 0; i < shown.size(); ++i) {
        const auto& [event, t] = shown[i];
        if (event->text.empty()) continue;
        double from = map.film_time(t);
        for (std::size_t j = 0; j < i && event->freeze > 0; ++j)  // freezes at the same instant follow each other
            if (shown[j].t == t) from += shown[j].event->freeze;
        const double length = std::max(event->show.value_or(kDefaultDuration), event->freeze);
        const int first = static_cast<int>(std::ceil(from * fps - 1e-6)),
                  last = static_cast<int>(std::floor((from + length) * fps + 1e-6));
        const int fade = std::min(static_cast<int>(std::lround(event->fade * fps)), (last - first) / 2);
        out.push_back({first, last, event->text, std::max(fade, 0)});
    }
    for (render::Callout& each : out)
        for (const render::Callout& next : out)
            if (next.first > each.first) each.last = std::min(each.last, next.first - 1);
    return out;
}

// A given duration makes the speed constant in the time outside of freezes and hold.
Speed speed_of(const FrameSpan& span, double to, const sim::Result& motion) {
    if (!span.duration) {
        Speed speed = span.speed;
        for (SpeedInterval& each : speed.intervals)
            for (Instant* end : {&each.from, &each.to})
                *end = {.kind = Instant::Kind::time, .t = reached(*end, span, to, motion).value_or(to)};
        for (std::size_t i = 0; i < speed.intervals.size(); ++i) {
            const SpeedInterval& each = speed.intervals[i];
            if (!(each.from.t < each.to.t) || (i > 0 && each.from.t < speed.intervals[i - 1].to.t))
                throw render::PictureError(fmt::format(
                    "the speed's interval from {:g} s to {:g} s {}", each.from.t, each.to.t,
                    each.from.t < each.to.t ? "overlaps or precedes the previous one" : "ends before it begins"));
        }
        return speed;
    }
    double left = *span.duration - span.hold;
    for (const FilmEvent& event : span.events)
        if (const auto t = reached(event.at, span, to, motion); t && *t >= span.from && *t <= to) left -= event.freeze;
    if (!(left > 0)) throw render::PictureError(pauses_fill(span));
    return {.factor = (to - span.from) / left};
}

// The events within the film, whose freezes go into the map. The others go into `unreached`.
std::vector<ShownEvent> place_events(const FrameSpan& span, double to, const sim::Result& motion, TimeMap& map,
                                     std::vector<std::string>& unreached) {
    std::vector<ShownEvent> shown;
    for (const FilmEvent& event : span.events) {
        const std::optional<double> t = reached(event.at, span, to, motion);
        if (t && *t >= span.from && *t <= to) {
            shown.push_back({&event, *t});
            if (event.freeze > 0) map.freeze(*t, event.freeze);
        } else if (event.at.is_event()) {  // the reader has warned about times
            unreached.push_back(name_of(event.at));
        }
    }
    return shown;
}

// Adds the collisions of `span.speed` without an impact in the film to `unreached`.
void find_unreached_collisions(const FrameSpan& span, double to, const sim::Result& motion,
                               const std::vector<sim::Impact>& slowed, std::vector<std::string>& unreached) {
    if (!span.speed.around) return;
    for (const double number : span.speed.around->collisions) {
        const bool slow = std::ranges::any_of(slowed, [&](const sim::Impact& i) {
            return i.collision == number && i.t_start <= to && i.t_end.value_or(to) >= span.from;
        });
        if (slow) continue;
        const Instant collision{.kind = Instant::Kind::collision, .number = static_cast<int>(number)};
        (void)reached(collision, span, to, motion);  // throws if it does not occur at all
        unreached.push_back("the slow motion of " + name_of(collision));
    }
}

// Frames at film times k/fps. Where the speed is below one half, charts get rows between frames.
FilmTimes warped(const FrameSpan& span, double to, const sim::Result& motion, const std::vector<sim::Impact>& slowed,
                 std::vector<double>& fine) {
    TimeMap map(span.from, to, speed_of(span, to, motion), slowed);
    FilmTimes out;
    const std::vector<ShownEvent> shown = place_events(span, to, motion, map, out.unreached_events);
    find_unreached_collisions(span, to, motion, slowed, out.unreached_events);
    map.freeze(to, span.hold);
    const double fps = span.fps.value(), count = frame_count(span, span.duration.value_or(map.duration()));
    const int steps = std::clamp(static_cast<int>(kFinePoints / count), 1, kFineSteps);
    double previous = span.from;
    for (long k = 0; k < static_cast<long>(count); ++k) {
        const double film = static_cast<double>(k) * span.fps.denominator / span.fps.numerator;
        // Rounding at a freeze between frames must not decrease the time.
        previous = std::max(previous, map.instant(film));
        out.frames.push_back(previous);
        out.speeds.push_back(map.speed(film));
        for (int i = 1; i < steps && out.speeds.back() < 0.5 && out.speeds.back() > 0; ++i)
            fine.push_back(map.instant(film + i / (steps * fps)));
    }
    out.callouts = callouts_of(shown, map, fps);
    return out;
}

// The charts of whole collisions want a row for each column and a short margin; a page wants the force of each impact.
enum class Contacts { collisions, impacts };

// Rows that resolve contacts; fewer of each if there are many.
std::vector<double> rows_of(Contacts which, const std::vector<sim::Impact>& impacts, double from, double to) {
    const bool whole = which == Contacts::collisions;
    struct Span {
        double low, high;
    };
    std::vector<Span> spans;
    std::optional<int> last;
    for (const sim::Impact& i : impacts) {
        if (i.t_start > to) break;
        if (!whole || last != i.collision) spans.push_back({i.t_start, i.t_start});
        last = i.collision;
        spans.back().high = std::max(spans.back().high, std::min(i.t_end.value_or(to), to));
    }
    std::vector<double> out;
    const double count = std::clamp(kFinePoints / std::max(1.0, double(spans.size())), 4.0, whole ? 600.0 : 1000.0);
    for (const Span& s : spans) {
        const double length = std::clamp(s.high - s.low, whole ? 1e-4 : 0.0, kLongestCollision),
                     margin = whole ? 0.15 * length : 0;
        if (s.high < from || length == 0) continue;
        for (const double t :
             rows(std::max(from, s.low - margin), std::min(to, s.low + length + margin), count / (length + 2 * margin)))
            out.push_back(t);
    }
    return out;
}

// The end of the collision at `t` with a short margin, or of what a strip shows of a contact that lasts; `t` if there
// is none.
double end_of_collision(const sim::Result& motion, double t) {
    std::optional<int> which;
    double begin = t, end = t;
    for (const sim::Impact& i : motion.impacts) {
        if (!which && i.t_start == t) which = i.collision;
        if (which != i.collision) continue;
        const bool lasts = !i.t_end || *i.t_end > t + kLasting;
        end = std::max(end, lasts ? t + kLongestCollision : *i.t_end);
    }
    return end + 0.15 * (end - begin);
}

// The middle frame of the instant: in a freeze its caption has faded in.
int middle_at(const std::vector<double>& frames, double t) {
    const int first = first_at(frames, t);
    const auto after = std::ranges::upper_bound(frames, frames[static_cast<std::size_t>(first)]) - frames.begin();
    return (first + static_cast<int>(after) - 1) / 2;
}

}  // namespace

int first_at(const std::vector<double>& frames, double t) {
    const auto at = std::ranges::lower_bound(frames, t - 1e-12 * std::max(1.0, t));
    return static_cast<int>(std::min(at - frames.begin(), std::ssize(frames) - 1));
}

std::vector<double> rows(double from, double to, double rate) {
    std::vector<double> times;
    const double first = std::ceil(from * rate), last = std::floor(to * rate);
    times.reserve(static_cast<std::size_t>(std::max(0.0, last - first)) + 2);
    for (long k = 0; first + static_cast<double>(k) <= last; ++k)
        times.push_back((first + static_cast<double>(k)) / rate);
    // k/rate and `to` may be equal except for rounding.
    if (!times.empty() && std::abs(times.back() - to) < 1e-9 * std::min(1 / rate, to)) times.back() = to;
    if (times.empty() || times.back() < to) times.push_back(to);
    return times;
}

FilmTimes film_times(const FrameSpan& with_events, double end_time, const sim::Result& motion,
                     const std::vector<sim::Impact>& slowed, bool collisions) {
    const FrameSpan span = resolved(with_events, end_time, motion);
    const double to = span.to.value_or(end_time);
    std::vector<double> fine;
    FilmTimes out = span.real_time() ? real_time(span, to) : warped(span, to, motion, slowed, fine);
    if (span.poster) {
        if (const std::optional<double> t = reached(*span.poster, span, to, motion))
            out.poster = middle_at(out.frames, *t);
        else
            out.unreached_events.push_back(name_of(*span.poster) + ", its poster");
    }
    out.chart = rows(span.from, to, chart_rate(to - span.from));
    out.trace = rows(0, to, chart_rate(to));  // the trace includes the time before the film
    // The frames' times are rows, so that the curve agrees with the values of each frame.
    merge(out.chart, out.frames);
    if (!fine.empty()) {
        fine.insert(fine.end(), out.frames.begin(), out.frames.end());
        merge(out.chart, fine);
        merge(out.trace, fine);
    }
    if (collisions) merge(out.chart, rows_of(Contacts::collisions, slowed, span.from, to));
    out.survey = surveyed(span.from, to);
    out.path = between(out.frames);
    return out;
}

FilmTimes page_times(const FrameSpan& span, double end_time, const sim::Result& motion) {
    FilmTimes out = film_times(span, end_time, motion, motion.impacts);
    merge(out.frames, rows_of(Contacts::impacts, motion.impacts, span.from, span.to.value_or(end_time)));
    return out;
}

FilmTimes still_times(const Instant& at, const sim::Result& motion, double until,
                      const std::vector<sim::Impact>& impacts, double turn) {
    FilmTimes out;
    const double t = instant_of(at, motion);
    out.frames = {t};
    // An impact is not visible at its first touch: the charts continue to the end of its collision.
    // One of the beginning shows the first turn of the cam.
    const double ahead = t == 0                           ? std::min(turn, until)
                         : at.kind == Instant::Kind::time ? t
                                                          : std::max(t, std::min(end_of_collision(motion, t), until));
    out.chart = rows(0, t, std::max(chart_rate(t), std::min(kLatestRate, kMostChartPoints / t)));
    if (ahead > t) merge(out.chart, rows(t, ahead, chart_rate(ahead - t)));
    // The collision that a still shows may be milliseconds long.
    merge(out.chart, rows(std::max(0.0, t - kLatest), t, kLatestRate));
    out.trace = out.chart;
    merge(out.chart, rows_of(Contacts::collisions, impacts, 0, std::max(t, ahead)));
    out.survey = surveyed(0, std::max(t, until));
    return out;
}

}  // namespace beamcam::scenes
