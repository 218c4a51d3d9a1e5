#include "sim/integrate/gap_probe.hpp"

#include <cmath>

#include "sim/integrate/constants.hpp"

namespace beamcam::sim {
GapProbe::GapProbe(System& system, bool apart) : system_(system), apart_(apart) {
    if (!system.has_cam()) return;
    expansion_ = std::make_unique<ContactExpansion>(system);
    hq_.resize(expansion_->scratch());
}

void GapProbe::forget() {
    x_ = -1;
    if (expansion_ && !apart_) expansion_->forget();
}

ContactState GapProbe::evaluate(double t, const double* y, bool search) {
    ContactState c;
    if (expansion_ && expanded(t, y, search, c)) {
        ++system_.gap_evaluations;
        return c;
    }
    c = system_.contact(t, y, search || !system_.phase().touching);
    x_ = c.at_end ? -1 : c.x;
    return c;
}

bool GapProbe::expanded(double t, const double* y, bool search, ContactState& c) {
    const double length = system_.model().length();
    const int n = system_.coordinates();
    const CamPose pose = system_.cam(t);
    double hub = y[0], rate = y[n];
    if (system_.drive().prescribed()) {
        const HubMotion motion = system_.drive().motion(t);
        hub = motion.angle;
        rate = motion.rate;
    }
    const Frame<double> frame{std::sin(hub), std::cos(hub),   rate,           pose.disc.x,
                              pose.disc.y,   pose.velocity.x, pose.velocity.y};
    if (!system_.gap_bound().nearly_straight(y + 1)) return false;
    if (search || x_ < 0) {
        x_ = frame.disc_x * frame.cos + frame.disc_y * frame.sin - system_.problem().hub.radius;
    }
    ContactKinematics<double> touch;
    for (int i = 0; i < kMostCentres; ++i) {
        if (!(x_ > 0 && x_ < length)) break;
        if (apart_)
            expansion_->centre_near(x_);
        else
            expansion_->centre(x_);
        touch.dx = x_ - expansion_->at();
        const double guess = x_;
        expansion_->evaluate(y + 1, y + n + 1, frame, system_.phase().gap_offset, hq_.data(), touch, kFootCorrections);
        x_ = expansion_->at() + touch.dx;
        if (!(std::fabs(touch.dx) < expansion_->range()) || !(std::fabs(x_ - guess) < kSettledFoot * length)) continue;
        if (!(x_ > 0 && x_ < length)) break;
        c.x = x_;
        c.gap = touch.gap;
        c.gap_rate = touch.gap_rate;
        c.slip = touch.slip;
        c.normal = {touch.nx * frame.cos - touch.ny * frame.sin, touch.nx * frame.sin + touch.ny * frame.cos};
        return true;
    }
    x_ = -1;
    return false;
}

}  // namespace beamcam::sim
