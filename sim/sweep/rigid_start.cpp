// The motions that RigidMotion applies to, and their start.
#include <algorithm>
#include <cmath>

#include "sim/sweep/rigid_motion.hpp"

namespace beamcam::sim {

constexpr double kInsideBeam = 1e-3;  // of the length: least distance of the contact from the beam's ends and the axis

bool RigidMotion::applies(const Problem& p, const Sampling& sampling) {
    const bool sampled = sampling.kind == SampleKind::impacts || sampling.kind == SampleKind::section;
    if (p.beam.model != ModelKind::rigid || !p.cam || p.cam->profile || p.hub.spring ||
        p.contact.model != ContactModel::restitution || !is_independent_of_time(p.hub.drive) ||
        !std::holds_alternative<NoFriction>(p.contact.friction) || p.solver.method != Method::automatic || !sampled)
        return false;
    const double away = norm(p.cam->centre), reach = p.cam->radius + contact_offset(p),
                 margin = kInsideBeam * p.beam.length;
    const double nearest = away - p.cam->eccentricity, farthest = away + p.cam->eccentricity;
    if (!(nearest > reach)) return false;
    const double shortest = std::sqrt(nearest * nearest - reach * reach),
                 longest = std::sqrt(farthest * farthest - reach * reach);
    return shortest > margin && shortest - p.hub.radius > margin && longest - p.hub.radius < p.beam.length - margin;
}

RigidMotion::Mirrored RigidMotion::mirrored(const Problem& p, double theta) {
    const double root = p.hub.radius, tip = root + p.beam.length, density = p.beam.line_density();
    const double inertia = p.hub.inertia + density * (tip * tip * tip - root * root * root) / 3;  // (S8)
    const auto* torque = std::get_if<ConstantTorque>(&p.hub.drive);
    const double k = p.gravity * density * (tip * tip - root * root) / 2 / inertia;
    const double alpha = (torque ? torque->value : 0) / inertia;
    const double side = cross(disc_centre(*p.cam, 0), unit(theta)) < 0 ? -1 : 1;
    Mirrored m{*p.cam, side, side * k, side * alpha};
    m.cam.centre.y *= side;
    m.cam.phase *= side;
    m.cam.speed *= side;
    return m;
}

// Without contact the initial state of a rigid beam is given directly.
InitialState RigidMotion::start_of(const Problem& problem, const InitialState* start) {
    if (start) return *start;
    if (problem.initial.shape == InitialShape::resting) return initial_state(problem);
    InitialState own;
    own.y = {problem.initial.angle, problem.initial.angular_velocity};
    return own;
}

RigidMotion::RigidMotion(const Problem& problem, const Sampling& sampling, const InitialState* start)
    : problem_(problem),
      start_(start_of(problem, start)),
      span_(sample_span(problem, sampling)),
      period_(span_.period),
      mirrored_(mirrored(problem, start_.y[0])),
      surface_(mirrored_.cam, problem.cam->radius + contact_offset(problem), mirrored_.k, mirrored_.alpha),
      series_(mirrored_.k, mirrored_.alpha),
      sampler_(System(problem), sampling),
      y_(2 + kLedgerSize) {
    state_ = {mirrored_.side * start_.y[0], mirrored_.side * start_.y[1]};
    const SurfaceAngle c = surface_.at(0);
    if (start_.phase.touching) {
        rest_on(c);
    } else {
        touched_ = state_.theta < c.angle;
        state_.theta = std::max(state_.theta, c.angle);
        resume(false);
    }
}

}  // namespace beamcam::sim
