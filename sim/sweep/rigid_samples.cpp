// The samples and strobes of RigidMotion.
#include <cmath>

#include "sim/sweep/rigid_motion.hpp"

namespace beamcam::sim {

void RigidMotion::strobe(const RodState& state) {
    motion_.strobes.push_back(
        {mirrored_.side * state.theta, mirrored_.side * state.rate, kept_impacts_, in_contact_, left_});
    left_ = !in_contact_;
}

MotionSample RigidMotion::sample(double s, const RodState& state) const {
    const double t = static_cast<double>(turn_) * period_ + s;
    MotionSample out;
    out.fill(kNan);
    out[kSampleTime] = t;
    out[kCamPhase] = turn_fraction(s / period_);
    out[kTheta] = mirrored_.side * state.theta;
    out[kThetaDot] = mirrored_.side * state.rate;
    out[kCamAngle] = problem_.cam->phase - problem_.cam->speed * t;
    return out;
}

void RigidMotion::sample_impact(const SurfaceAngle& c, double rate_after) {
    sample_lasts_ = false;
    if (turn_ < span_.from) return;
    ++kept_impacts_;
    if (sampling_.kind != SampleKind::impacts) return;
    MotionSample out = sample(s_, state_);
    out[kContactX] = c.lever - problem_.hub.radius;
    out[kNormalBefore] = c.lever * (state_.rate - surface_.rate(c));
    out[kTangentialBefore] = slip(c, state_.rate);
    sample_lasts_ = std::isnan(rate_after);
    if (!sample_lasts_) {
        out[kNormalAfter] = c.lever * (rate_after - surface_.rate(c));
        out[kTangentialAfter] = slip(c, rate_after);
        out[kDuration] = 0;
    }
    motion_.samples.push_back(out);
}

// The sampled contact that became sustained ends at the lift.
void RigidMotion::end_lasting_sample() {
    if (!sample_lasts_) return;
    sample_lasts_ = false;
    MotionSample& last = motion_.samples.back();
    last[kNormalAfter] = 0;
    last[kTangentialAfter] = slip(surface_.at(s_), state_.rate);
    last[kDuration] = static_cast<double>(turn_) * period_ + s_ - last[kSampleTime];
}

// v_t (S27).
double RigidMotion::slip(const SurfaceAngle& c, double rate) const {
    const CamPose pose = cam_pose(mirrored_.cam, s_);
    const double along = -dot(unit(c.angle), pose.velocity) - mirrored_.cam.speed * mirrored_.cam.radius;
    return mirrored_.side * (along + contact_offset(problem_) * rate);
}

}  // namespace beamcam::sim
