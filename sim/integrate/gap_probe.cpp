#include "sim/integrate/gap_probe.hpp"

#include <cmath>

#include "sim/integrate/modal_form.hpp"

namespace beamcam::sim {

constexpr int kMostCentres = 8;        // until the expansion contains the foot
constexpr double kSettledFoot = 3e-3;  // of the length: corrections by less have converged

GapProbe::GapProbe(System& system) : system_(system) {
    if (!system.has_cam() || !ModalForm::exists(system)) return;
    expansion_ = std::make_unique<ContactExpansion>(system);
    hq_.resize(expansion_->scratch());
}

ContactState GapProbe::evaluate(double t, const double* y) {
    ContactState c;
    if (!expansion_ || system_.phase().held || !expanded(t, y, c)) return system_.contact(t, y);
    ++system_.gap_evaluations;
    return c;
}

bool GapProbe::expanded(double t, const double* y, ContactState& c) {
    const double length = system_.model().length();
    const int n = system_.coordinates();
    const TurningCam& cam = system_.cam();
    double hub = y[0], rate = y[n];
    if (system_.drive().prescribed()) {
        const HubMotion motion = system_.drive().motion(t);
        hub = motion.angle;
        rate = motion.rate;
    }
    const Frame<double> frame = frame_of(cam, t, hub, rate);
    if (!system_.gap_bound().nearly_straight(y + 1)) return false;
    const Vec2 along{frame.cos, frame.sin}, across = perp(along);
    const Vec2 facing = cam.disc(t, dot(across, cam.axis()) < 0 ? across : -across).centre;
    double x = dot(facing, along) - system_.problem().hub.radius;
    ContactKinematics<double> touch;
    for (int i = 0; i < kMostCentres; ++i) {
        if (!(x > 0 && x < length)) break;
        expansion_->centre_near(x);
        touch.dx = x - expansion_->at();
        const double guess = x;
        expansion_->evaluate(y + 1, y + n + 1, frame, system_.phase().gap_offset, hq_.data(), touch, kFootCorrections);
        x = expansion_->at() + touch.dx;
        if (!(std::fabs(touch.dx) < expansion_->range()) || !(std::fabs(x - guess) < kSettledFoot * length)) continue;
        if (!(x > 0 && x < length)) break;
        c.x = x;
        c.gap = touch.gap;
        c.gap_rate = touch.gap_rate;
        c.slip = touch.slip;
        c.normal = {touch.nx * frame.cos - touch.ny * frame.sin, touch.nx * frame.sin + touch.ny * frame.cos};
        c.tangent = -perp(c.normal);
        c.disc = cam.disc(t, c.normal);
        if (system_.phase().touching) system_.add_forces(c, y);
        return true;
    }
    return false;
}

}  // namespace beamcam::sim
