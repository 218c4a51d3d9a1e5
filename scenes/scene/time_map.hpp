// Maps film time to the time of the motion: real time, constant speeds, slow motion around impacts, freezes.
//
// The speed s(t) is a function of the motion's time t: `factor` within certain spans, the base speed elsewhere. In
// between log s follows a smoothstep over `ease` seconds of the motion, so that the speed and its rate are continuous.
// Film time is τ(t) = ∫ dt / s(t) plus the freezes before t; Newton's method inverts it to rounding.
#pragma once

#include <optional>
#include <vector>

#include "scenes/scene/scene.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::scenes {

class TimeMap {
  public:
    // A film from t = `from` to `to`. `impacts` are used for slow motion only; intervals must have increasing times and
    // must not overlap.
    TimeMap(double from, double to, const Speed& speed, const std::vector<sim::Impact>& impacts);

    // Freezes the picture at time t.
    void freeze(double t, double seconds);

    double duration() const;            // of the film [s]
    double instant(double film) const;  // time of the motion at a film time in 0…duration
    double speed(double film) const;    // 0 while frozen
    double film_time(double t) const;   // at a freeze: its beginning
    double speed_at(double t) const;    // without freezes

  private:
    struct Span {
        double from, to;       // the speed is `factor` between them [s]
        double factor;         // of real time
        double before, after;  // transitions to and from it [s]
    };
    struct Piece {
        double t0, t1;  // of the motion
        double tau0;    // film time of t0 without freezes
        bool flat;      // constant speed
    };
    struct Freeze {
        double t, tau, seconds;  // tau: film time of t without freezes
    };
    double elapsed(const Piece& piece, double t) const;  // ∫ dt/s from the piece's start
    double unfrozen(double film, bool& frozen) const;

    double from_, to_, base_;
    std::vector<Span> spans_;
    std::vector<Piece> pieces_;
    std::vector<Freeze> freezes_;
    double length_ = 0;  // without freezes [s]
};

// The time of an instant; "last" is the end of the motion. For an event that does not occur find_instant returns
// nullopt, and instant_of throws render::PictureError with the number of events.
std::optional<double> find_instant(const Instant& instant, const sim::Result& motion);
double instant_of(const Instant& instant, const sim::Result& motion);
// Adds what finds this event to a request. `scene_end`: end of the scene [s], where the last bend ends.
void record_event(const Instant& event, double scene_end, sim::Request& request);

// Replaces events at the ends of a span by their times.
template <class Span>
Span with_times(Span span, const sim::Result& motion) {
    if (span.from_event) span.from = instant_of(*std::exchange(span.from_event, {}), motion);
    if (span.to_event) span.to = instant_of(*std::exchange(span.to_event, {}), motion);
    return span;
}

}  // namespace beamcam::scenes
