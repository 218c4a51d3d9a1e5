// Channels and poses of a motion at one instant.
#pragma once

#include <optional>
#include <vector>

#include "sim/beam/natural_modes.hpp"
#include "sim/cam/lever.hpp"
#include "sim/dynamics/system.hpp"
#include "sim/integrate/gap_probe.hpp"
#include "sim/observe/beam_loads.hpp"
#include "sim/observe/channels.hpp"
#include "sim/observe/pose.hpp"

namespace beamcam::sim {

// Channel values at one instant; the state of the model, energy balance, contact and accelerations are computed once,
// when first needed.
class ChannelEvaluator {
  public:
    explicit ChannelEvaluator(const System& system);
    ChannelEvaluator(const ChannelEvaluator&) = delete;  // its probe refers to its system
    ChannelEvaluator& operator=(const ChannelEvaluator&) = delete;
    void set_phase(const Phase& phase) { system_.set_phase(phase); }
    void set_start_energy(double total) { start_total_ = total; }
    void set(double t, const double* y);
    double value(Channel channel);
    Pose pose(int stations);
    System& system() { return system_; }
    const System& system() const { return system_; }
    Model& model();  // in that state
    const System::EnergyBalance& energy_balance();
    const ContactState& contact();
    const NaturalModes& natural_modes();  // of the straight beam

  private:
    const double* acceleration();  // ξ̈
    const BeamLoads& loads();
    double hub_acceleration();  // θ̈
    double spring_energy();
    double ledger(Ledger entry) const { return y_[static_cast<std::size_t>(system_.ledger_at + entry)]; }
    double component(int index, int first) const;
    double hub_angle();
    double tip(ChannelKind kind);
    double place_on_rim();
    double followed_angle();  // of a straight lever
    double separation(ChannelKind kind);
    double resisted_force();
    const BeamLoads& resisted_loads();
    double stress(ChannelKind kind);
    double root_moment();
    double pivot(ChannelKind kind);
    double drive_power();

    System system_;
    GapProbe probe_;
    double t_ = 0, start_total_ = 0;
    std::vector<double> y_;
    bool placed_ = false;  // the model is in that state
    bool balance_known_ = false, contact_known_ = false, acceleration_known_ = false;
    System::EnergyBalance balance_;
    ContactState contact_;
    double acceleration_[kMaxSize] = {}, drive_power_ = 0;
    std::optional<BeamLoads> loads_, resisted_loads_;
    std::optional<NaturalModes> natural_modes_;
    std::optional<Lever> lever_;
    bool loads_known_ = false, largest_known_ = false;
    Vec2 largest_moment_;  // its place, and its magnitude
};

}  // namespace beamcam::sim
