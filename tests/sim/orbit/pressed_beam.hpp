// A beam that a constant torque presses on a fast cam, without gravity: flights of the rigid one are parabolas, so its
// orbits of one impact are known in closed form.
#pragma once

#include <numbers>

#include "sim/base/numerics.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::sim::testing {

struct PressedBeam {
    double eccentricity = 0.002, restitution = 0.5, alpha = 15;  // [m], [–], [rad/s²]
    double distance = 0.25, radius = 0.1;                        // D, R [m]

    // θ_c(ψ) = atan2(B_y, B_x) + asin(R/|B|), the angle at which the straight beam touches the disc.
    double angle(double psi) const {
        const Vec2 b{distance + eccentricity * std::cos(psi), eccentricity * std::sin(psi)};
        return std::atan2(b.y, b.x) + std::asin(radius / norm(b));
    }
    // Its derivatives by ψ, from finite differences of sixth order.
    double slope(double psi) const {
        const double h = 0.01;
        const auto d = [&](double s) { return angle(psi + s) - angle(psi - s); };
        return (45 * d(h) - 9 * d(2 * h) + d(3 * h)) / (60 * h);
    }
    double curve(double psi) const {
        const double h = 0.01;
        const auto d = [&](double s) { return slope(psi + s) - slope(psi - s); };
        return (45 * d(h) - 9 * d(2 * h) + d(3 * h)) / (60 * h);
    }
    // Where the cam of this speed strikes in the orbit of one impact a turn, on the branch that may be stable:
    // θ̇_c = (αT/2)(1 − r)/(1 + r), falling.
    double strike_phase(double speed) const {
        const double wanted = alpha * std::numbers::pi / speed * (1 - restitution) / (1 + restitution);
        // ψ = −ωt: θ̇_c = −ω θ_c′(ψ), θ̈_c = ω² θ_c″(ψ). The fastest rise is where the curve vanishes.
        double fastest = 0;
        for (int i = 1; i < 1000; ++i) {
            const double psi = 2 * std::numbers::pi * i / 1000;
            if (slope(psi) < slope(fastest)) fastest = psi;
        }
        const auto excess = [&](double back) { return -speed * slope(fastest - back) - wanted; };
        return fastest - find_root(excess, 0.0, std::numbers::pi);
    }

    Problem problem(double speed) const {
        Problem p;
        p.gravity = 0;
        p.beam.model = ModelKind::rigid;
        p.hub.drive = ConstantTorque{-alpha * p.beam.line_density() * std::pow(p.beam.length, 3) / 3};
        p.cam->centre = {distance, 0};
        p.cam->radius = radius;
        p.cam->eccentricity = eccentricity;
        p.cam->speed = speed;
        p.contact.model = ContactModel::restitution;
        p.contact.restitution = restitution;
        p.solver.method = Method::rk8;
        return p;
    }
    // The same, starting at the apex of the orbit of one impact a turn.
    Problem on_orbit(double speed) const {
        Problem p = problem(speed);
        const double period = 2 * std::numbers::pi / speed, phase = strike_phase(speed);
        p.initial.angle = angle(phase) + alpha * period * period / 8;
        p.cam->phase = phase - std::numbers::pi;
        return p;
    }
};

}  // namespace beamcam::sim::testing
