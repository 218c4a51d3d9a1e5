#include "sim/beam/shapes.hpp"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "sim/base/assert.hpp"
#include "sim/base/linear_algebra.hpp"
#include "sim/base/numerics.hpp"

namespace beamcam::sim {
namespace {

using std::numbers::pi;

// βL of the i-th clamped–free mode, i = 1, 2, …: cos b + 1/cosh b = 0 (S1). The root is near (i − ½)π, far from the
// ends of this interval.
double clamped_eigenvalue(int i) {
    const auto f = [](double b) { return std::cos(b) + 1 / std::cosh(b); };
    return find_root(f, (i - 1) * pi + (i == 1 ? 1.0 : 0.2), i * pi - 0.2);
}

// Rows: moment and shear at the tip, displacement and moment at the root, of the four terms
// (cos, sin, e^{−βx}, e^{−β(L−x)}) in units of the length; b = βL, kappa = a/L, h = I_h/(ρA L³) (S2).
// Rows are scaled by positive factors, which do not change the sign of the determinant.
Eigen::Matrix4d hub_beam_conditions(double b, double kappa, double h) {
    const double c = std::cos(b), s = std::sin(b), decay = std::exp(-b);
    const double lever = kappa * b, turn = h * b * b * b;
    Eigen::Matrix4d m;
    m.row(0) << -c, -s, decay, 1;
    m.row(1) << s, -c, -decay, 1;
    // y(0) − a y′(0)
    m.row(2) << 1, -lever, 1 + lever, decay * (1 - lever);
    // [y″(0) − a y‴(0)]/b² + h b² y′(0), y′(0) = b(B − C + D decay)
    m.row(3) << -1, lever + turn, 1 + lever - turn, decay * (1 - lever + turn);
    m.row(2) /= 1 + std::fabs(lever);
    m.row(3) /= 1 + std::fabs(lever) + turn;
    return m;
}

}  // namespace

Shapes Shapes::of(const Problem& problem) {
    const Beam& beam = problem.beam;
    if (beam.model == ModelKind::rigid) return {};
    if (resolved_basis(problem) == Basis::cantilever) return cantilever(beam.modes, beam.length);
    return hub_beam(beam.modes, beam.length, problem.hub.radius, problem.hub.inertia / beam.line_density());
}

Shapes Shapes::cantilever(int count, double length) {
    Shapes shapes;
    shapes.length_ = length;
    for (int i = 1; i <= count; ++i) {
        const double b = clamped_eigenvalue(i);
        const double c = std::cos(b), s = std::sin(b), decay = std::exp(-b);
        // φ = cosh − cos − σ(sinh − sin), σ = (cosh b + cos b)/(sinh b + sin b). The growing exponentials are combined
        // into e^{−β(L−x)}, so that no difference of large numbers occurs.
        const double denominator = 1 + 2 * s * decay - decay * decay;
        const double sigma = (1 + 2 * c * decay + decay * decay) / denominator;
        const double one_minus_sigma_times_exp_b = 2 * (s - c - decay) / denominator;
        shapes.beta_.push_back(b / length);
        shapes.coefficients_.push_back({-1, sigma, 0.5 * (1 + sigma), 0.5 * one_minus_sigma_times_exp_b});
    }
    return shapes;
}

Shapes Shapes::hub_beam(int count, double length, double radius, double inertia) {
    Shapes shapes;
    shapes.length_ = length;
    const double kappa = radius / length, h = inertia / (length * length * length);
    const auto f = [&](double b) { return hub_beam_conditions(b, kappa, h).determinant(); };
    // Clamping the hub adds one constraint, so by interlacing exactly one mode with a free hub lies between
    // neighbouring clamped ones. With a heavy hub it coincides with the lower one, up to rounding.
    double low = clamped_eigenvalue(1);
    for (int i = 1; i <= count; ++i) {
        const double high = clamped_eigenvalue(i + 1);
        const double f_low = f(low), f_high = f(high);
        const double b = std::signbit(f_low) != std::signbit(f_high) ? find_root(f, low, high, f_low, f_high)
                         : std::fabs(f_low) <= std::fabs(f_high)     ? low
                                                                     : high;
        const Eigen::Matrix4d conditions = hub_beam_conditions(b, kappa, h);
        // With a heavy hub the row of moments at the root is ill-conditioned; the other three determine the shape.
        Eigen::Vector4d v = null_vector(conditions.topRows<3>());
        const double decay = std::exp(-b);
        if (b * (v[1] - v[2] + decay * v[3]) < 0) v = -v;  // y′(0) > 0
        Coefficients c{v[0], v[1], v[2], v[3]};
        shapes.beta_.push_back(b / length);
        shapes.coefficients_.push_back(c);
        low = high;
    }
    // Mass normalization, with enough nodes for the square of the highest shape.
    const Quadrature rule = gauss_legendre(2 * count + 24, length);
    Eigen::ArrayXd y(count), y1(count), sum = Eigen::ArrayXd::Zero(count);
    for (Eigen::Index k = 0; k < rule.x.size(); ++k) {
        shapes.evaluate(rule.x[k], y.data(), nullptr, nullptr);
        sum += rule.w[k] * y.square();
    }
    shapes.evaluate(0, nullptr, y1.data(), nullptr);
    sum += inertia * y1.square();
    for (int i = 0; i < count; ++i) {
        const double scale = std::sqrt(length / sum[i]);
        Coefficients& c = shapes.coefficients_[static_cast<std::size_t>(i)];
        c = {c.a * scale, c.b * scale, c.c * scale, c.d * scale};
    }
    return shapes;
}

double Shapes::bound(int i) const {
    const Coefficients& k = coefficients_[static_cast<std::size_t>(i)];
    return std::hypot(k.a, k.b) + std::fabs(k.c) + std::fabs(k.d);
}

void Shapes::evaluate(double x, double* y, double* y1, double* y2, double* y3) const {
    // NaN passes: states that overflowed, or come from a damaged file, are evaluated before they are rejected.
    BEAMCAM_ASSERT(beta_.empty() || !(x < 0 || x > length_ * (1 + 1e-12)));
    for (std::size_t i = 0; i < beta_.size(); ++i) {
        const Coefficients& k = coefficients_[i];
        const double beta = beta_[i], bx = beta * x;
        const double c = std::cos(bx), s = std::sin(bx);
        const double near = k.c * std::exp(-bx), far = k.d * std::exp(-beta * (length_ - x));
        const double wave = k.a * c + k.b * s;
        if (y) y[i] = wave + near + far;
        if (y1) y1[i] = beta * (k.b * c - k.a * s - near + far);
        if (y2) y2[i] = beta * beta * (near + far - wave);
        if (y3) y3[i] = beta * beta * beta * (k.a * s - k.b * c - near + far);
    }
}

}  // namespace beamcam::sim
