// The energy balance of a System (S38).
#include "sim/dynamics/system.hpp"

namespace beamcam::sim {

System::EnergyBalance System::balance_without_beam(const double* y, const ContactState& c) const {
    const double* ledger = y + controlled;
    double normal = 0, bristle_energy = 0;
    if (phase_.touching) {
        normal = phase_.held ? 0 : law_.stored_energy(-c.gap);
        if (has_bristle()) {
            const bool state = phase_.friction == FrictionState::stick || friction_.lags;
            const double z = state ? y[2 * n_] : friction_.sliding_bristle(phase_.friction, c.force);
            bristle_energy = 0.5 * friction_.stiffness * z * z;
        }
    }
    // The work done on the contact is stored or lost (S38).
    EnergyBalance b;
    b.contact = normal + bristle_energy;
    b.loss_structural = ledger[kLossStructural];
    b.loss_contact = ledger[kNormalWork] - normal;
    b.loss_friction = ledger[kFrictionWork] - bristle_energy;
    b.work_cam = ledger[kWorkCam];
    b.work_drive = ledger[kWorkDrive];
    return b;
}

}  // namespace beamcam::sim
