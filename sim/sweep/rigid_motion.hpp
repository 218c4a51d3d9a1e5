// The motion of a rigid beam with impulsive contact and without friction, followed for thousands of cam turns: flight
// as a Taylor series, impacts by bounds on the closed form of the cam's surface, sustained contact by the sign of the
// contact force. The same impacts as Run's, to rounding and its tolerance. MODEL.md §18.
#pragma once

#include <optional>
#include <vector>

#include "sim/run/simulate.hpp"
#include "sim/sweep/cam_surface.hpp"
#include "sim/sweep/sampling.hpp"
#include "sim/sweep/swing_series.hpp"

namespace beamcam::sim {

class RigidMotion {
  public:
    // Whether this class follows such a motion: the model and its contact; a hub that is free or has a constant torque;
    // a contact that stays between the ends of the beam; method `auto`; samples at impacts or cam angles.
    static bool applies(const Problem& problem, const Sampling& sampling);

    // `start`: a state to begin with instead of the problem's.
    RigidMotion(const Problem& problem, const Sampling& sampling, const InitialState* start);
    // Once; `until_return`: no farther than to where the motion is known to repeat itself. Throws Interrupted.
    SampledMotion follow(const Progress& progress, bool until_return = false);
    // Lasting contact ended every difference of the state at least once.
    bool rested() const { return rested_; }
    // The turns and impacts between two lifts from lasting contact at the same phase, that is in the same state: the
    // period from then on.
    struct Return {
        long turns = 0, impacts = 0;
    };
    const std::optional<Return>& returned() const { return returned_; }

  private:
    // The problem with the beam on the counter-clockwise side of the disc: itself, or mirrored in the X axis.
    struct Mirrored {
        Cam cam;
        double side, k, alpha;  // θ̈ = α − k cos θ
    };
    static InitialState start_of(const Problem& problem, const InitialState* start);
    static Mirrored mirrored(const Problem& problem, double theta);

    void begin(const InitialState& start);
    void fly();
    void lie();
    SurfaceAngle surface_at(double s);  // asked for the same place twice in a row, it answers once
    std::optional<double> first_touch(double h);
    double falling(double t, double latest, double h);
    bool leaves(double dt) const;
    void strike();
    bool sums_up_chatter(const SurfaceAngle& c, double approach, double rebound) const;
    void rest_on(const SurfaceAngle& c);
    void lift(double until);
    void note_lift(std::size_t window);
    void start_of_lift();
    void move_to(double s);
    template <class At>
    void observe(double until, At&& at);
    void strobe(long turn, const Swing& state);
    MotionSample sample(double s, const Swing& state) const;
    void sample_impact(const SurfaceAngle& c, double rate_after);  // NaN: it lasts
    void end_lasting();
    double slip(const SurfaceAngle& c, double rate) const;
    double end() const { return static_cast<double>(span_.to - turn_) * period_; }  // from the start of this turn

    const Problem& problem_;
    const Sampling& sampling_;
    InitialState start_;
    SampleSpan span_;
    double period_;
    Mirrored mirrored_;
    CamSurface surface_;
    SwingSeries series_;
    double reach_, floor_;
    double centre_direction_;  // from the hub to the cam's axis, on the side of `mirrored_` [rad]
    double seen_at_ = kNan;
    SurfaceAngle seen_;

    long turn_ = 0;  // whole turns since the start
    double s_ = 0;   // time within the turn [s]
    Swing swing_;
    bool lying_ = false;  // in sustained contact
    bool rested_ = false;
    std::vector<std::optional<Return>> last_lifts_;  // by the windows of the surface: turn and impacts so far
    std::optional<Return> returned_;
    bool lasting_ = false;    // since the last sample
    bool touched_ = false;    // the flight starts on the surface
    double clear_until_ = 0;  // after a lift nothing touches before this time
    double last_rebound_ = 0;
    double section_phase_;  // of a section, in turns: 0 … 1
    bool follows_difference_ = false, left_ = false;
    bool forgot_ = false;                       // the difference began anew since the last strobe
    double growth_ = 0, growth_at_strobe_ = 0;  // logarithms of the difference's size
    long kept_impacts_ = 0;
    SampledMotion motion_;
};

}  // namespace beamcam::sim
