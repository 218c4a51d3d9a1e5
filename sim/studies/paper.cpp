#include "sim/studies/paper.hpp"

#include <cmath>

#include "sim/base/numerics.hpp"

namespace beamcam::sim {

// EI v₁ = q l x³/(6c) − q l² x³/(12 l₁ c) − q x⁴/(24c) + C₁x,   0 ≤ x ≤ l₁
// EI v₂ = −q (l − x)⁴/(24c) + C₂x + D₂,                          l₁ ≤ x ≤ l,   c = cos θ        (S47)
StaticDeflection supported_beam(const Problem& problem, double angle, double support, double x, Printing printing,
                                bool overhang) {
    const double c = std::cos(angle), l = problem.beam.length * c, l1 = support, l2 = l - l1;
    const double q = problem.beam.line_density() * problem.gravity;  // mg/L
    const double c1 = q * l1 * l1 * l1 / (24 * c) + q * l * l * l1 / (12 * c) - q * l * l1 * l1 / (6 * c);
    double c2 = -q * l2 * l2 * l1 / (6 * c) - q * l2 * l2 * l2 / (6 * c);
    double d2 = q * l1 * l1 * l2 * l2 / (6 * c) + q * l2 * l2 * l2 * l1 / (6 * c) + q * l2 * l2 * l2 * l2 / (24 * c);
    double scale = 1 / problem.beam.bending_stiffness();
    if (printing != Printing::printed) {
        c2 += q * l1 * l1 * l1 / (24 * c);
        d2 -= q * l1 * l1 * l1 * l1 / (24 * c);
    }
    // Along the rod the arc is x/c, so curvature integrates twice with 1/c² (S48).
    if (printing == Printing::corrected) scale /= c * c;
    if (!overhang)
        return {scale * (q * l * x * x * x / (6 * c) - q * l * l * x * x * x / (12 * l1 * c) -
                         q * x * x * x * x / (24 * c) + c1 * x),
                scale * (q * l * x * x / (2 * c) - q * l * l * x * x / (4 * l1 * c) - q * x * x * x / (6 * c) + c1)};
    const double r = l - x;
    return {scale * (-q * r * r * r * r / (24 * c) + c2 * x + d2), scale * (q * r * r * r / (6 * c) + c2)};
}

// t = ∫ dθ/θ̇ with θ̇² = 3kg/L (sin θ₀ − sin θ); the substitution θ = θ₀ − s² removes the singularity (S51).
double rod_fall_time(double length, double gravity, double angle, double torque_factor) {
    const double span = std::sqrt(angle);
    const Quadrature rule = gauss_legendre(60, span);
    double time = 0;
    for (Eigen::Index k = 0; k < rule.x.size(); ++k) {
        const double s = rule.x[k], half = 0.5 * s * s;
        // sin θ₀ − sin θ = 2 cos(θ₀ − s²/2) sin(s²/2)
        const double drop = 2 * std::cos(angle - half) * std::sin(half);
        time += rule.w[k] * 2 * s / std::sqrt(3 * torque_factor * gravity / length * drop);
    }
    return time;
}

double tangent_distance(const Cam& cam, double psi, Printing printing) {
    const double d = norm(cam.centre), e = cam.eccentricity;
    const double axis = std::atan2(cam.centre.y, cam.centre.x);
    const double square = printing == Printing::printed ? d * d : d * d + e * e + 2 * d * e * std::cos(psi - axis);
    return std::sqrt(square - cam.radius * cam.radius);
}

}  // namespace beamcam::sim
