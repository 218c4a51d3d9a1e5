#include "sim/studies/paper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/base/numerics.hpp"
#include "sim/problem/derived.hpp"

namespace beamcam::sim {

// EI w₁ = q l x³/(6c) − q l² x³/(12 l₁ c) − q x⁴/(24c) + C₁x,   0 ≤ x ≤ l₁
// EI w₂ = −q (l − x)⁴/(24c) + C₂x + D₂,                          l₁ ≤ x ≤ l,   c = cos θ        (S47)
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

namespace {

// Distances of several points of the beam as it falls without a cam; where the cam is follows from the
// time alone.
std::vector<std::vector<double>> distances(const Problem& problem, const std::vector<double>& points,
                                           const std::vector<double>& times, Printing printing) {
    Problem fall = problem;
    fall.cam.reset();
    Request request;
    for (double x : points) request.points.push_back({x, times});
    const Result result = simulate(fall, request);
    const Cam& cam = *problem.cam;
    std::vector<std::vector<double>> out(points.size(), std::vector<double>(times.size()));
    for (std::size_t i = 0; i < times.size(); ++i) {
        const Vec2 centre = printing == Printing::printed ? cam.centre : disc_centre(cam, times[i]);
        for (std::size_t p = 0; p < points.size(); ++p)
            out[p][i] = norm(result.points[p][i] - centre) - cam.radius;  // (S49)
    }
    return out;
}

constexpr double kNever = std::numeric_limits<double>::infinity();

std::vector<double> spread(double from, double to, int count) {
    std::vector<double> t;
    for (int i = 0; i <= count; ++i) t.push_back(from + (to - from) * i / count);
    return t;
}

// Index of the first interval in which d falls to zero, or the size.
std::size_t first_fall(const std::vector<double>& d) {
    for (std::size_t i = 1; i < d.size(); ++i)
        if (d[i - 1] > 0 && d[i] <= 0) return i - 1;
    return d.size();
}

// When each point reaches the cam: a coarse table, then a fine one around each fall, then a parabola.
std::vector<double> arrivals(const Problem& problem, const std::vector<double>& points, double end_time,
                             Printing printing) {
    const std::vector<double> coarse = spread(0, end_time, 2000);
    const std::vector<std::vector<double>> d = distances(problem, points, coarse, printing);
    std::vector<double> found(points.size(), kNever);
    for (std::size_t p = 0; p < points.size(); ++p) {
        const std::size_t k = first_fall(d[p]);
        if (k == d[p].size()) continue;
        const std::vector<double> fine = spread(coarse[k], coarse[k + 1], 32);
        const std::vector<double> e = distances(problem, {points[p]}, fine, printing)[0];
        const std::size_t j = std::clamp<std::size_t>(first_fall(e), 1, e.size() - 2);
        const auto parabola = [&](double t) {
            const double h = fine[1] - fine[0], s = (t - fine[j]) / h;
            return e[j] + s * 0.5 * (e[j + 1] - e[j - 1]) + 0.5 * s * s * (e[j + 1] - 2 * e[j] + e[j - 1]);
        };
        found[p] = find_root(parabola, fine[j - 1], fine[j + 1]);
    }
    return found;
}

}  // namespace

std::vector<double> point_distance(const Problem& problem, double x, const std::vector<double>& times,
                                   Printing printing) {
    return distances(problem, {x}, times, printing)[0];
}

std::optional<TrialContact> trial_contact(const Problem& problem, const std::vector<double>& points, double end_time,
                                          double resolution, Printing printing) {
    TrialContact trial;
    trial.points = points;
    std::sort(trial.points.begin(), trial.points.end());
    trial.instants = arrivals(problem, trial.points, end_time, printing);
    std::vector<double> at = trial.points, when = trial.instants;
    for (;;) {
        const auto first = std::min_element(when.begin(), when.end());
        if (first == when.end() || *first == kNever) return std::nullopt;
        const auto k = static_cast<std::size_t>(first - when.begin());
        trial.x = at[k];
        trial.t = *first;
        const double low = at[k > 0 ? k - 1 : k], high = at[std::min(k + 1, at.size() - 1)];
        if (high - low <= 2 * resolution) return trial;
        // Subdivide between the neighbours of the first, as the paper does.
        at = spread(low, high, 8);
        when = arrivals(problem, at, end_time, printing);
    }
}

// t = ∫ dθ/θ̇ with θ̇² = 3kg/L (sin θ₀ − sin θ); θ = θ₀ − s² takes the root out of the integrand (S51).
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
