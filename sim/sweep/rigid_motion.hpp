// The motion of a rigid beam with frictionless impulsive contact over thousands of cam turns: flight as a Taylor
// series, impacts by bounds on the closed form of the cam's surface, sustained contact by the sign of the contact
// force. Its sampler is that of a Run, with whose impacts these agree within its tolerance. MODEL.md (S80)–(S84).
#pragma once

#include <optional>

#include "sim/contact/chatter.hpp"
#include "sim/run/simulate.hpp"
#include "sim/sweep/cam_surface.hpp"
#include "sim/sweep/flight_series.hpp"
#include "sim/sweep/sampler.hpp"

namespace beamcam::sim {

class RigidMotion : private Segment {
  public:
    // Conditions: rigid beam, frictionless impulsive contact, a free hub or one with a constant torque, a contact that
    // stays between the ends of the beam and off the axis, method `auto`, samples at impacts or cam angles.
    static bool applies(const Problem& problem, const Sampling& sampling);

    // `start`: initial state; null: that of the problem.
    RigidMotion(const Problem& problem, const Sampling& sampling, const InitialState* start);
    // To be called once. Throws Interrupted.
    SampledMotion follow(const Progress& progress);

  private:
    // The problem with the beam on the counter-clockwise side of the disc, mirrored in the X axis if necessary.
    struct Mirrored {
        Cam cam;
        double side, k, alpha;  // θ̈ = α − k cos θ
    };
    static InitialState start_of(const Problem& problem, const InitialState* start);
    static Mirrored mirrored(const Problem& problem, double theta);

    void report();
    void fly();
    void stay_in_contact();
    SurfaceAngle surface_at(double s);  // caches the last result
    std::optional<double> first_touch(double h);
    void impact();
    bool sums_up_chatter(const SurfaceAngle& c, const Bounce& bounce) const;
    void rest_on(const SurfaceAngle& c);
    void lift(double until);
    void lift_after_impact();
    void move_to(double s);
    double time(double s) const { return static_cast<double>(turn_) * period_ + s; }  // since the start [s]
    double end() const { return static_cast<double>(span_.to - turn_) * period_; }    // within this turn [s]
    // The sampler's view of the motion: its state from s_ on, in the present flight or contact, and its events.
    void value(double t, double* y) const override;
    void put(const RodState& state, double* y) const;
    void show_until(double s);
    void resume(bool in_contact);
    void announce(decltype(&Observer::touch) event, const SurfaceAngle& c, double rate);

    const Problem& problem_;
    InitialState start_;
    SampleSpan span_;
    double period_;
    Mirrored mirrored_;
    CamSurface surface_;
    FlightSeries series_;
    double cached_at_ = kNan;
    SurfaceAngle cached_;

    long turn_ = 0;  // whole turns since the start
    double s_ = 0;   // time within the turn [s]
    RodState state_;
    bool in_contact_ = false;  // in sustained contact
    bool touched_ = false;     // the flight starts on the surface
    double clear_until_ = 0;   // no touch is possible before this time, after a lift
    double last_rebound_ = 0;
    const Progress* progress_ = nullptr;
    long places_ = 0;  // that were compared with the surface, and series
    Sampler sampler_;
    std::vector<double> y_;  // of a Run
};

}  // namespace beamcam::sim
