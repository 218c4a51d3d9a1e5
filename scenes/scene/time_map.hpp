// From a film's time to the motion's: real time, any constant speed, slow motion around impacts, freezes.
//
// The speed s(t) is a function of the motion's time t: 1 away from certain spans, `factor` within them, and on the
// way between the two log s follows a smoothstep over `ease` seconds of the motion, so that both the speed and its
// rate are continuous. Film time is τ(t) = ∫ dt / s(t) plus the freezes before t; t(τ) is found by Newton's method to
// rounding, monotone by construction.
#pragma once

#include <optional>
#include <vector>

#include "scenes/scene/scene.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::scenes {

class TimeMap {
  public:
    // A film from t = `from` to `to`. `impacts` matter only to slow motion around them; intervals of other speeds have
    // times, increasing, and do not overlap.
    TimeMap(double from, double to, const Speed& speed, const std::vector<sim::Impact>& impacts);

    // Holds the picture of the instant t for so long.
    void freeze(double t, double seconds);

    double duration() const;            // of the film [s]
    double instant(double film) const;  // t of a film time in 0…duration
    double speed(double film) const;    // 0 while frozen
    double film_time(double t) const;   // when a freeze begins at t: its beginning
    double speed_at(double t) const;    // of the motion's time, freezes apart

  private:
    struct Span {
        double from, to;       // the speed is `factor` between them [s]
        double factor;         // of real time
        double before, after;  // how long it becomes so, and no longer is [s]
    };
    struct Piece {
        double t0, t1;  // of the motion
        double tau0;    // film time of t0, freezes apart
        bool flat;      // constant speed
    };
    struct Freeze {
        double t, tau, seconds;  // tau: film time of t, freezes apart
    };
    double elapsed(const Piece& piece, double t) const;  // ∫ dt/s from the piece's start
    double unfrozen(double film, bool& frozen) const;

    double from_, to_, base_;
    std::vector<Span> spans_;
    std::vector<Piece> pieces_;
    std::vector<Freeze> freezes_;
    double length_ = 0;  // freezes apart [s]
};

// The instant that a scene names, "last" being the motion's end. Where the motion has no such event: nothing, or
// render::PictureError that tells how many it has.
std::optional<double> find_instant(const Instant& instant, const sim::Result& motion);
double instant_of(const Instant& instant, const sim::Result& motion);

// What begins and ends at events, with their times instead.
template <class Span>
Span with_times(Span span, const sim::Result& motion) {
    if (span.from_event) span.from = instant_of(*std::exchange(span.from_event, {}), motion);
    if (span.to_event) span.to = instant_of(*std::exchange(span.to_event, {}), motion);
    return span;
}

}  // namespace beamcam::scenes
