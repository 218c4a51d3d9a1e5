// Channels and poses of a motion at one instant.
#pragma once

#include <vector>

#include "sim/dynamics/system.hpp"
#include "sim/observe/channels.hpp"
#include "sim/observe/pose.hpp"

namespace beamcam::sim {

// Channel values at one instant; the state of the model, energies, contact and accelerations are computed once, when
// first needed.
class ChannelEvaluator {
  public:
    explicit ChannelEvaluator(const System& system);
    void set_phase(const Phase& phase) { system_.set_phase(phase); }
    void set_start_energy(double total) { start_total_ = total; }
    void set(double t, const double* y);
    double value(Channel channel);
    // Needs no `set`: of channels that depend on the time and the coordinates, the first components of y, alone.
    bool is_of_coordinates(Channel channel) const;
    double value_of_coordinates(Channel channel, double t, const double* y);
    Pose pose(int stations);
    System& system() { return system_; }
    const System& system() const { return system_; }
    Model& model();  // in that state
    const System::EnergyBalance& energy_balance();
    const Energies& energies();
    // Both spare a computation whose result at this instant is available. The first is enough for the energy balance;
    // other channels of the contact are undefined until the next `set`.
    void set_gap(double gap, double force);
    void set_contact(const ContactState& contact);
    const ContactState& contact();

  private:
    // θ̈ with the forces of this contact, which only touching has.
    double hub_acceleration(const ContactState& c);
    System::EnergyBalance balance_without_beam();  // perhaps with the beam's energies
    double ledger(Ledger entry) const { return y_[static_cast<std::size_t>(system_.controlled + entry)]; }
    double rate_of_mode(int index) const;
    double tip(ChannelKind kind);
    double place_on_rim();
    double separation(ChannelKind kind);

    System system_;
    double t_ = 0, start_total_ = 0;
    std::vector<double> y_;
    bool placed_ = false;  // the model is in that state
    bool balance_known_ = false, energies_known_ = false, contact_known_ = false, acceleration_known_ = false;
    bool forces_known_ = false;  // of the contact set by `set_contact`
    System::EnergyBalance balance_;
    Energies energies_;
    ContactState contact_;
    double hub_acceleration_ = 0;
};

}  // namespace beamcam::sim
