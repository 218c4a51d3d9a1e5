// The instants, views and speeds that pictures and films of the mechanism show.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "output/film/video_format.hpp"
#include "render/film/film.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::scenes {

using output::Encoding, output::FrameRate;

struct Size {
    int width = 1920, height = 1080;  // [px]
    bool operator==(const Size&) const = default;
};

// An instant of the motion: a time, the end, or an event counted from 1.
struct Instant {
    enum class Kind { time, last, impact, release, collision, peak, liftoff, bend, apex };
    Kind kind = Kind::time;
    double t = 0;    // [s], >= 0
    int number = 1;  // of the event
    bool operator==(const Instant&) const = default;

    bool is_event() const { return kind != Kind::time && kind != Kind::last; }
};
// Notation of events: "impact:3"; some words mean the first event, "touch".
struct EventWord {
    std::string_view word;  // singular
    Instant::Kind kind;
    std::string_view meaning;
    bool alone = false;  // valid without a number, for the first event
};
inline constexpr EventWord kEventWords[] = {
    {"impact", Instant::Kind::impact, "The first touch of an impact."},
    {"release", Instant::Kind::release, "The end of an impact; `release` is the first.", true},
    {"collision", Instant::Kind::collision,
     "The first touch of a collision: impacts that are closer than `contact.collision_gap` are one."},
    {"peak", Instant::Kind::peak, "The largest contact force of a collision."},
    {"liftoff", Instant::Kind::liftoff, "The end of a collision, after its last impact; `liftoff` is the first.", true},
    {"bend", Instant::Kind::bend,
     "The largest deflection of the tip, to either side, from the beginning of a collision to that of the next, or to "
     "the end of the scene."},
    {"apex", Instant::Kind::apex,
     "The largest θ of a rebound: between two collisions, or after the last one if θ decreases before the end; without "
     "collisions, maxima of θ."},
    {"touch", Instant::Kind::impact, "The same as `impact`; `touch` is the first.", true}};
std::string name_of(const Instant& at);  // "impact 3", "0.2 s"
std::string event_notations();           // "impact:N, release:N, …"

// The playback speed of a film.
struct SlowMotion {
    double factor = 0.02;  // of real time, around impacts
    // Seconds of the motion: slow motion lasts from `before` the first touch of an impact to `after` its release, with
    // a transition of `ease` on both sides.
    double before = 2e-3, after = 10e-3, ease = 20e-3;
    std::vector<double> collisions = {};  // only around the impacts of these, counted from 1; empty: all
    bool operator==(const SlowMotion&) const = default;
};
struct SpeedInterval {
    Instant from, to;
    double factor = 0.1;  // of real time
    bool operator==(const SpeedInterval&) const = default;
};
struct Speed {
    double factor = 1;  // of real time, outside of impacts and intervals
    std::optional<SlowMotion> around = {};
    std::vector<SpeedInterval> intervals = {};  // in place of `around`
    double ease = 20e-3;                        // transition at their ends [s of the motion]
    bool real_time() const { return factor == 1 && !around && intervals.empty(); }
    bool operator==(const Speed&) const = default;
};

// A freeze or a text of a film at an instant.
struct FilmEvent {
    Instant at;
    double freeze = 0;                // [s] of the film
    std::string text;                 // plain, with formulas between dollars
    std::optional<double> show = {};  // until the next text at most [s of the film]; nullopt: 1.5 s
    double fade = 0;                  // duration of fading in and out [s of the film]
};

// One motion of a comparison: the mechanics of this or another scene with changes.
struct Compared {
    std::string label;
    sim::Problem problem;
};

// The camera at an instant. Absent values are those of the previous keyframe.
struct Keyframe {
    Instant at;
    std::optional<double> zoom = {};
    std::optional<render::Anchor> follow = {};
    std::optional<double> yaw = {}, pitch = {};  // [rad]
    std::optional<double> over = {};  // duration of the movement [s of the film]; nullopt: since the previous keyframe
    render::Ease ease = render::Ease::smooth;
};
struct View : render::View {
    std::vector<Keyframe> keyframes = {};
};

// What a film tells of a motion with collisions; see plan/story.hpp.
enum class Story { impact, settle };
inline std::span<const sim::Named<Story>> names(Story) {
    static constexpr sim::Named<Story> all[] = {{Story::impact, "impact"}, {Story::settle, "settle"}};
    return all;
}

// The keys of a film that a story makes, and that may not stand beside it.
inline constexpr const char* kKeysOfStories[] = {"to", "speed", "duration", "hold", "events"};

// The keys of all pictures.
struct Picture {
    Size size;
    View view;
    std::optional<render::LayoutNode> layout;  // nullopt: the standard layout
    // Empty: only the motion of the scene. The first is the main motion; the scene itself must be listed to be shown.
    std::vector<Compared> compare;
    render::Comparison comparison = render::Comparison::panels;
};

// Frames at the times k / fps with from <= k / fps < to, by rounded frame numbers. With another speed than real time,
// or with events, k / fps is film time.
struct FrameSpan {
    FrameRate fps;
    double from = 0;                // [s] of the motion, >= 0
    std::optional<double> to = {};  // [s], > from; nullopt: the end of the scene
    Speed speed = {};
    std::optional<double> duration = {};  // of the film with its freezes, in place of a speed [s], > 0
    std::optional<Story> story = {};      // in place of speed, duration, hold, events and `to`
    double hold = 0;                      // duration of the last picture [s]
    std::vector<FilmEvent> events = {};
    std::optional<Instant> from_event = {}, to_event = {};  // in place of `from` and `to`
    std::optional<Instant> poster = {};                     // of a video: the frame that is also written as a picture

    bool real_time() const { return speed.real_time() && events.empty() && !duration && hold == 0 && !story; }
    std::vector<Instant> instants() const;  // all that its keys name
    bool needs_events() const;              // the frames depend on events
};

}  // namespace beamcam::scenes
