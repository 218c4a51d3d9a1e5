#include "sim/orbit/flow_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "sim/orbit/constants.hpp"
#include "sim/run/constants.hpp"
#include "sim/run/run.hpp"

namespace beamcam::sim {
namespace {

// Records touches, changes of sustained contact and pauses of a motion.
class Follower final : public MotionObserver {
  public:
    // `probe` evaluates the beam at touches.
    Follower(System& probe, double duration, const InitialState& start)
        : system_(probe), end_(duration), phase_(start.phase) {}

    double end() const override { return end_; }
    bool done() const override { return false; }
    void resume(double t, const std::vector<double>& y, const Phase& phase) override {
        if (phase.held && !phase_.held) ++map_.holds;
        if (phase_.held && !phase.touching) ++map_.lifts;
        if (phase_.touching && !phase.touching) left(t);
        phase_ = phase;
        started_ = true;
        map_.end = {y, phase};
    }
    void segment(const SegmentInterval& s) override {
        if (phase_.touching) return;
        for (const double share : {0.25, 0.5, 0.75, 1.0}) {
            Pause& at = flight_.emplace_back(std::lerp(s.from, s.to, share), InitialState{map_.end.y, phase_}, 0.0);
            s.segment->value(at.t, at.state.y.data());
        }
    }
    void touch(double t, const std::vector<double>& y, const ContactState& contact) override {
        if (!started_ || !(-contact.gap_rate > kRestSpeed)) return;
        const double flight = t - left_;
        BeamPoint p;
        system_.set_state(t, y.data());
        system_.model().point(contact.x, p);
        // Beyond an end of the beam the foot is on its straight extension.
        const double beyond = -dot(p.r1, p.r - system_.cam(t).disc) / dot(p.r1, p.r1);
        map_.touches.push_back(
            {t, -contact.gap_rate, flight, contact.x, contact.x + beyond - system_.problem().beam.length});
        const auto off = [&](const Pause& at) { return std::fabs(at.t - (t - 0.5 * flight)); };
        const auto middle = std::ranges::min_element(flight_, {}, off);
        if (middle != flight_.end() && off(*middle) < kPausePlace * flight) {
            middle->flight = flight;
            flights_.push_back(*middle);
        }
        flight_.clear();
    }
    void release(double t, const std::vector<double>&, const ContactState&) override { left(t); }

    FlowMap take(const RunState& end) {
        map_.end = {end.y, end.phase};
        double longest = 0;
        for (const Pause& pause : flights_) longest = std::max(longest, pause.flight);
        for (Pause& pause : flights_)
            if (pause.flight > kPauseFlight * longest && pause.t > map_.touches.front().t)
                map_.pauses.push_back(std::move(pause));
        return std::move(map_);
    }

  private:
    void left(double t) {
        left_ = t;
        flight_.clear();
    }

    System& system_;
    double end_;
    Phase phase_;
    double left_ = 0;  // instant of the last release [s]
    bool started_ = false;
    FlowMap map_;
    std::vector<Pause> flight_;   // places in the present flight
    std::vector<Pause> flights_;  // their middles
};

// A run that starts in contact continues it.
InitialState continuing(InitialState state, const System& system) {
    if (state.phase.touching && !state.continued)
        state.continued = InitialContact{.approach_speed = state.phase.approach,
                                         .friction = state.phase.friction,
                                         .bristle = system.bristle(state.y.data()),
                                         .gap_offset = state.phase.gap_offset};
    return state;
}

// Moves a start in sustained contact onto the cam: its hub by the gap, its rates by an impulse. (S72)
InitialState on_cam(InitialState state, System& system) {
    if (!state.phase.held || is_prescribed(system.problem().hub.drive)) return state;
    system.set_phase(state.phase);
    for (int round = 0; round < kOnCamRounds; ++round) {
        const ContactState c = system.contact(0, state.y.data());
        BeamPoint p;
        system.model().point(c.x, p);
        state.y[0] -= c.gap / cross(p.r, c.normal);
    }
    system.hold(0, 0, state.y.data());
    return state;
}

}  // namespace

bool same_events(const FlowMap& a, const FlowMap& b) {
    return a.touches.size() == b.touches.size() && a.holds == b.holds && a.lifts == b.lifts &&
           a.end.phase.touching == b.end.phase.touching;
}

FlowMap flow_map(System& system, const InitialState& start, double duration, const Progress& progress) {
    const InitialState from = continuing(on_cam(start, system), system);
    system.set_phase({});
    Follower follower(system, duration, from);
    Run run(system.problem(), {}, progress, {.observer = &follower, .start = &from, .like = &system});
    run.integrate();
    return follower.take(run.state());
}

FlowMap flow_map(const Problem& problem, const InitialState& start, double duration, const Progress& progress) {
    System system(problem);
    return flow_map(system, start, duration, progress);
}

InitialState motion_end(const Problem& problem, const InitialState& start, double duration, const Progress& progress) {
    return flow_map(problem, start, duration, progress).end;
}

}  // namespace beamcam::sim
