#include "scenes/plan/story.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "render/base/error.hpp"
#include "render/plot/lang.hpp"
#include "render/plot/ticks.hpp"
#include "scenes/scene/time_map.hpp"

namespace beamcam::scenes {
namespace {

using render::Lang, render::LayoutNode, render::PanelKind, render::PanelSpec, render::phrase, render::quantity;
using sim::ChannelKind;

constexpr double kShown = 2.5, kFade = 0.2;  // of captions [s of the film]
constexpr double kNear = 1.4, kMove = 1.2;   // zoom at the contact; duration of the camera's movement [s of the film]

// In other pictures the whole beam needs the width.
bool is_wide(const Size& size) { return size.width >= 1.4 * size.height; }

Instant at_time(double t) { return {.kind = Instant::Kind::time, .t = t}; }

// The speed 1, 2 or 5 times a power of ten, nearest in ratio, at which this time lasts `seconds` of the film. Real time
// is kept if the film then lasts between two thirds of that and one and a half times it.
double speed_for(double time, double seconds) {
    const double exact = time / seconds;
    if (exact > 2.0 / 3 && exact < 1.5) return 1;
    const double below = render::round_down_125(exact), above = render::round_up_125(exact);
    return exact / below < above / exact ? below : above;
}

// Appends a caption.
void tell(PictureOutput& film, double t, std::string text, double freeze = 0) {
    film.span.events.push_back(
        {.at = at_time(t), .freeze = freeze, .text = std::move(text), .show = kShown, .fade = kFade});
}

LayoutNode leaf(PanelSpec spec, double share = 1) { return {.share = share, .panel = std::move(spec)}; }
LayoutNode group(LayoutNode::Kind kind, std::vector<LayoutNode> parts, double share = 1) {
    return {.kind = kind, .share = share, .children = std::move(parts)};
}

// Appends a caption about the start, where it is true for certain.
void tell_beginning(PictureOutput& film, const sim::Problem& problem) {
    const bool free = std::holds_alternative<sim::FreeDrive>(problem.hub.drive) && !problem.hub.spring;
    const bool falls = free && problem.gravity > 0 && problem.initial.angular_velocity == 0;
    if (falls && film.span.from == 0) tell(film, 0, phrase(film.view.lang, "falls under gravity"));
}

std::string touch_of(const sim::Collision& c, Lang lang) {
    return phrase(lang, "touches {} from the hub", quantity(c.x, "m")) + ", " +
           phrase(lang, "at {}", quantity(std::abs(c.v_n_before), "m/s"));
}

// The index of the first collision that begins at `from` or later, but not with the motion itself.
std::size_t collision_after(double from, const sim::Result& motion) {
    const auto found =
        std::ranges::find_if(motion.collisions, [&](const auto& c) { return c.t_start > 0 && c.t_start >= from; });
    if (found == motion.collisions.end())
        throw render::PictureError(fmt::format(
            "the story needs a collision, but the motion has none that begins between {:g} s and {:g} s{}", from,
            motion.end_time, motion.collisions.empty() ? "" : "; another \"from\" or a larger time.end may have one"));
    return static_cast<std::size_t>(found - motion.collisions.begin());
}

// A film that begins with a touch begins at the apex before it instead, or with the motion.
void begin_before(double touch, const sim::Result& motion, FrameSpan& span) {
    if (span.from < touch) return;
    span.from = 0;
    for (const sim::Apex& apex : sim::rebounds(motion))
        if (apex.t < touch) span.from = apex.t;
}

// ---- "impact" ----------------------------------------------------------------------------------

// What became, at the apex of the rebound, of the energy of the touch and of what cam, drive and fall have added.
std::string energy_at_apex(double touch, double apex, const sim::Problem& problem, const FindEvents& find, Lang lang) {
    using enum ChannelKind;
    sim::Request request;
    request.end_time = apex;
    sim::TableRequest& table = request.tables.emplace_back();
    table.times = {std::nextafter(touch, 0), apex};  // before the impulse of a touch without duration
    for (const ChannelKind kind : {energy_kinetic, energy_elastic, energy_contact, energy_potential, energy_spring,
                                   loss_structural, loss_contact, loss_friction, loss_hub, work_cam, work_drive})
        table.channels.push_back({kind, 0});
    const sim::Table found = find(problem, request).tables.front();
    using Kinds = std::initializer_list<ChannelKind>;
    const auto sum = [&](Kinds kinds, std::size_t row) {
        double all = 0;
        for (std::size_t c = 0; c < found.channels.size(); ++c)
            if (std::ranges::find(kinds, found.channels[c].kind) != kinds.end()) all += found.values[c][row];
        return all;
    };
    const auto gained = [&](Kinds kinds) { return sum(kinds, 1) - sum(kinds, 0); };
    const Kinds moving{energy_kinetic, energy_elastic, energy_contact};
    const double rebound = gained({energy_potential, energy_spring}), cam = gained({work_cam}),
                 drive = gained({work_drive});
    struct Part {
        double size;
        const char* name;
    };
    const Part sources[] = {{sum(moving, 0), "{} at the touch"},
                            {cam, "{} from the cam"},
                            {drive, "{} from the drive"},
                            {-rebound, "{} from the fall"}},
               uses[] = {{rebound, "{} rebound"},
                         {sum(moving, 1), "{} vibration"},
                         {gained({loss_structural, loss_contact, loss_friction, loss_hub}), "{} lost"},
                         {-cam, "{} to the cam"},
                         {-drive, "{} to the drive"}};
    double all = 0;
    for (const Part& each : sources) all += std::max(each.size, 0.0);
    if (!(all > 0)) return {};
    std::string from, to;
    int shown = 0;
    for (const Part& each : sources)  // parts below half a percent are left out
        if (each.size > 0.005 * all)
            from += (shown++ == 0 ? "" : ", ") + phrase(lang, each.name, quantity(each.size, "J"));
    if (shown > 1) from = fmt::format("{} ({})", quantity(all, "J"), from);
    std::vector<double> percents;
    for (const Part& each : uses) percents.push_back(std::round(100 * std::max(each.size, 0.0) / all));
    // The largest part takes what rounding leaves.
    *std::ranges::max_element(percents) += 100 - std::accumulate(percents.begin(), percents.end(), 0.0);
    for (std::size_t i = 0; i < percents.size(); ++i)
        if (percents[i] > 0)
            to += (to.empty() ? "" : ", ") + phrase(lang, uses[i].name, fmt::format("{:.0f}\u00A0%", percents[i]));
    return phrase(lang, "energy {}", from) + ": " + to;
}

// The mechanism, the contact in micrometres, and the force of the collision.
LayoutNode impact_layout(bool has_force, const Size& size, double text_scale) {
    using enum LayoutNode::Kind;
    LayoutNode near = leaf({.kind = PanelKind::mechanism}, 1.9);
    if (!has_force) return near;
    const LayoutNode contact = leaf({.kind = PanelKind::close_up}),
                     force = leaf({.kind = PanelKind::strip,
                                   .channels = {{ChannelKind::contact_force, 0}},
                                   .by_collision = true});
    const bool small = size.height < 540 || text_scale > 1.2;  // without room for four panels
    if (!is_wide(size)) return group(rows, {near, contact, force});
    if (small) return group(columns, {leaf({.kind = PanelKind::mechanism}, 1.55), force});
    return group(rows, {group(columns, {near, contact}, 1.9), force});
}

// The largest force, which many modes change: with their number.
std::string force_of(const sim::Collision& c, const sim::Problem& problem, Lang lang) {
    std::string force = phrase(lang, "largest force {}", quantity(*c.force_peak, "N"));
    if (problem.beam.model == sim::ModelKind::rigid) return force;
    return phrase(lang, "{} with {}", force,
                  phrase(lang, problem.beam.modes == 1 ? "{} mode" : "{} modes", problem.beam.modes));
}

// The captions of a collision, from the first touch to `liftoff`. How many impacts it has depends on the modes.
void tell_collision(PictureOutput& film, const sim::Collision& c, const sim::Problem& problem, double liftoff,
                    bool stays) {
    constexpr double kAtTouch = 0.8, kAtPeak = 1.5, kAtLiftoff = 1.5;  // freezes [s]
    const double touch = c.t_start;
    const Lang lang = film.view.lang;
    tell(film, touch, touch_of(c, lang), kAtTouch);
    if (liftoff == touch) film.span.events.back().show = kAtTouch;  // it is true while they touch
    if (c.t_peak && c.force_peak && *c.t_peak < liftoff)
        tell(film, *c.t_peak,
             force_of(c, problem, lang) + ", " + phrase(lang, "{} after the touch", quantity(*c.t_peak - touch, "s")),
             kAtPeak);
    if (stays)
        tell(film, liftoff, phrase(lang, "stays in contact"));
    else if (c.t_end && liftoff > touch)
        tell(film, liftoff, phrase(lang, "the collision ends after {}", quantity(liftoff - touch, "s")), kAtLiftoff);
}

PictureOutput told_impact(PictureOutput film, const Scene& scene, const sim::Result& motion, const FindEvents& find) {
    constexpr double kApproach = 2.5, kCollision = 3, kHold = 2.5;  // durations in the film [s]
    FrameSpan& span = film.span;
    const std::size_t number = collision_after(span.from, motion);
    const sim::Collision& c = motion.collisions[number];
    const double touch = c.t_start;
    begin_before(touch, motion, span);
    // Of a contact that lasts, the film shows as much as of the time before it, and the last touch.
    const sim::Impact& last = motion.impacts.back();
    const double shown = std::max(last.t_end ? 0 : last.t_start, touch + (touch - span.from)),
                 liftoff = c.t_end.value_or(std::min(motion.end_time, shown)), length = liftoff - touch;
    const bool is_last = number + 1 == motion.collisions.size();
    const double next = is_last ? motion.end_time : motion.collisions[number + 1].t_start;
    const std::vector<sim::Apex> apexes = sim::rebounds(motion);
    const auto apex = std::ranges::find_if(apexes, [&](const sim::Apex& a) { return a.t > liftoff && a.t < next; });
    const bool rebounds = c.t_end && apex != apexes.end();
    span.to = rebounds ? apex->t : c.t_end ? std::min(next, liftoff + std::max(length, touch - span.from)) : liftoff;

    span.speed = {.factor = speed_for(touch - span.from + *span.to - liftoff, kApproach)};
    const double slow = length > 0 ? speed_for(length, kCollision) : span.speed.factor;
    if (slow != span.speed.factor) {
        span.speed.intervals = {{at_time(std::max(span.from, touch - 0.05 * length)),
                                 at_time(std::min(*span.to, liftoff + 0.05 * length)), slow}};
        span.speed.ease = length;
    }
    tell_beginning(film, scene.problem);
    tell_collision(film, c, scene.problem, liftoff, !c.t_end && !last.t_end);
    if (rebounds)
        tell(film, *span.to, energy_at_apex(touch, *span.to, scene.problem, find, film.view.lang), kHold);
    else if (!c.t_end)
        span.hold = kHold;
    if (is_wide(film.size))
        film.view.keyframes = {{.at = at_time(touch),
                                .zoom = kNear,
                                .follow = render::Anchor{render::Anchor::Kind::contact},
                                .over = kMove},
                               {.at = at_time(liftoff + 0.01 * (*span.to - liftoff)),
                                .zoom = 1,
                                .follow = render::Anchor{},
                                .over = kMove}};
    if (!film.layout) film.layout = impact_layout(c.force_peak.has_value(), film.size, film.view.text_scale);
    return film;
}

// ---- "settle" ----------------------------------------------------------------------------------

PictureOutput told_settle(PictureOutput film, const Scene& scene, const sim::Result& motion) {
    constexpr double kFirst = 4, kMiddle = 5, kLast = 3, kAtTouch = 1.5, kAtRest = 1.5;  // durations in the film [s]
    constexpr std::size_t kBounces = 3;                                                  // collisions in the first part
    const Lang lang = film.view.lang;
    FrameSpan& span = film.span;
    const std::size_t number = collision_after(span.from, motion), later = number + kBounces;
    const sim::Collision& first = motion.collisions[number];
    begin_before(first.t_start, motion, span);
    const sim::Impact& last = motion.impacts.back();
    if (last.t_end)
        throw render::PictureError(
            fmt::format("the story \"settle\" needs a contact that lasts, but the motion has none at the end, {:g} s; "
                        "a larger time.end may have one",
                        motion.end_time));
    const double settled = last.t_start;
    const double slow_until = later < motion.collisions.size() ? motion.collisions[later].t_start : settled;
    const double speed = scene.problem.cam ? std::abs(scene.problem.cam->speed) : 0;
    // A cam at rest moves nothing any more.
    span.to = speed > 0 ? std::min(motion.end_time, settled + 2 * std::numbers::pi / speed) : settled;
    const auto part = [&](double from, double to, double seconds) {
        if (to > from) span.speed.intervals.push_back({at_time(from), at_time(to), speed_for(to - from, seconds)});
    };
    part(span.from, slow_until, kFirst);
    part(slow_until, settled, kMiddle);
    part(settled, *span.to, kLast);
    for (std::size_t k = 1; k < span.speed.intervals.size(); ++k)  // the film never slows down
        span.speed.intervals[k].factor = std::max(span.speed.intervals[k].factor, span.speed.intervals[k - 1].factor);
    tell_beginning(film, scene.problem);
    tell(film, first.t_start, touch_of(first, lang), kAtTouch);
    const double touching = (first.t_end.value_or(*span.to) - first.t_start) / span.speed.intervals.front().factor;
    film.span.events.back().show = std::min(kShown, kAtTouch + touching);  // it is true while they touch
    const auto strongest = std::ranges::max_element(motion.collisions, {},
                                                    [](const sim::Collision& c) { return c.force_peak.value_or(0); });
    if (strongest->t_peak && strongest->t_start > first.t_start && *strongest->t_peak < slow_until)
        tell(film, *strongest->t_peak,
             force_of(*strongest, scene.problem, lang) + ", " +
                 phrase(lang, "in collision {}", strongest - motion.collisions.begin() + 1));
    const auto impacts_between = [&](double from, double to) {
        return std::ranges::count_if(motion.impacts,
                                     [&](const sim::Impact& i) { return i.t_start >= from && i.t_start < to; });
    };
    const auto all = impacts_between(first.t_start, settled);
    const bool endless = scene.problem.contact.model != sim::ContactModel::compliant && all > 1;
    const std::string impacts = endless ? phrase(lang, "infinitely many impacts")
                                        : phrase(lang, all == 1 ? "{} impact" : "{} impacts", all),
                      rest = fmt::format("{:.4g}\u00A0s", settled);
    if (impacts_between(slow_until, settled) > 1) tell(film, slow_until, phrase(lang, "{} until {}", impacts, rest));
    tell(film, settled, phrase(lang, "stays in contact from {} on", rest) + ", " + phrase(lang, "after {}", impacts),
         kAtRest);
    return film;
}

}  // namespace

PictureOutput told(PictureOutput film, const Scene& scene, const sim::Result& motion, const FindEvents& find) {
    const Story story = *std::exchange(film.span.story, {});
    film.span = with_times(film.span, motion);
    return story == Story::impact ? told_impact(std::move(film), scene, motion, find)
                                  : told_settle(std::move(film), scene, motion);
}

}  // namespace beamcam::scenes
