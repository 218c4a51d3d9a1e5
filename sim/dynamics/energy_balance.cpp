// The energy balance of a System (S38).
#include "sim/dynamics/system.hpp"

namespace beamcam::sim {

System::EnergyBalance System::mechanical_balance(double t, const double* y) {
    set_state(t, y);
    const double* ledger = y + controlled;
    EnergyBalance b;
    b.energies = model_->energies();
    b.loss_structural = ledger[kLossStructural];
    b.loss_contact = ledger[kNormalWork];
    b.loss_friction = ledger[kFrictionWork];
    b.work_cam = ledger[kWorkCam];
    b.work_drive = ledger[kWorkDrive];
    return b;
}

System::EnergyBalance System::energy_balance(double t, const double* y, double gap) {
    EnergyBalance b = mechanical_balance(t, y);
    b.contact = law_.stored_energy(-gap);
    b.loss_contact -= b.contact;
    return b;
}

System::EnergyBalance System::energy_balance(double t, const double* y, const ContactState* contact) {
    EnergyBalance b = mechanical_balance(t, y);
    double normal = 0, bristle_energy = 0;
    if (phase_.touching && (!phase_.held || has_bristle())) {
        const ContactState c = contact ? *contact : current_contact(t, y, false);
        normal = phase_.held ? 0 : law_.stored_energy(-c.gap);
        if (has_bristle()) {
            const bool state = phase_.friction == FrictionState::stick || friction_.lags;
            const double z = state ? y[2 * n_] : friction_.sliding_bristle(phase_.friction, c.force);
            bristle_energy = 0.5 * friction_.stiffness * z * z;
        }
    }
    // The work done on the contact is stored or lost (S38).
    b.contact = normal + bristle_energy;
    b.loss_contact -= normal;
    b.loss_friction -= bristle_energy;
    return b;
}

}  // namespace beamcam::sim
