// The resets of state and phase at events, one function for each kind of event. MODEL.md §§8–10.
#pragma once

#include "sim/run/run_state.hpp"

namespace beamcam::sim {

class Transitions {
  public:
    // `system` is integrated by `integrator`.
    Transitions(System& system, Integrator& integrator, RunState& state)
        : system_(system), integrator_(integrator), state_(state) {}

    // At the start of the run. `continued`: the contact that the motion continues; null: a new one, if there is one.
    void start(const InitialContact* continued);
    // Observers learn that the motion starts in contact, once they know its phase.
    void announce_start();
    void apply(const Event& event);
    void end_chatter();  // summed-up chatter ends: the beam rests on the cam (S57)
    void enter_phase() { system_.set_phase(state_.phase); }

  private:
    void touch();
    void release();
    void change_friction();
    void impact();
    void lift();
    void hold();
    bool sum_up_chatter(const ContactState& c, const ImpactResult& impact, const ImpactResult& plastic);
    void announce(decltype(&Observer::touch) event, const std::vector<double>& y, const ContactState& c);
    void record_rebound(const std::vector<double>& y, ContactState c, const ImpactResult& impact);
    void cancel_gap_rounding();
    void begin_flight();
    void start_friction();
    ContactState contact_now() { return system_.contact(state_.t, state_.y.data()); }
    double pull_on_cam() { return -system_.free_gap_acceleration(state_.t, state_.y.data()); }
    double& bristle() { return state_.y[static_cast<std::size_t>(2 * system_.coordinates())]; }
    const Problem& problem() const { return system_.problem(); }

    System& system_;
    Integrator& integrator_;
    RunState& state_;
    double first_approach_ = 0, last_rebound_ = 0;  // [m/s]
    std::optional<double> last_release_;            // [s]
};

}  // namespace beamcam::sim
