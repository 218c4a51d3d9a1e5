// An outline through points. MODEL.md (S105).
#include <algorithm>
#include <cmath>

#include "sim/base/numerics.hpp"
#include "sim/cam/profile_spans.hpp"

namespace beamcam::sim {
namespace {

// Second derivatives at the knots of the periodic cubic spline through `values`; `steps` are the knots' distances, the
// last one from the last knot to the first. Thomas's algorithm, with the corners of the matrix by Sherman and
// Morrison's formula.
std::vector<double> periodic_spline(const std::vector<double>& steps, const std::vector<double>& values) {
    const std::size_t n = values.size();
    std::vector<double> diagonal(n), right(n), corner(n, 0), upper(n);
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t before = (i + n - 1) % n, after = (i + 1) % n;
        diagonal[i] = 2 * (steps[before] + steps[i]);
        right[i] = 6 * ((values[after] - values[i]) / steps[i] - (values[i] - values[before]) / steps[before]);
    }
    const double edge = steps[n - 1], gamma = -diagonal[0];
    diagonal[0] -= gamma;
    diagonal[n - 1] -= edge * edge / gamma;
    corner[0] = gamma;
    corner[n - 1] = edge;
    for (std::size_t i = 0; i < n; ++i) {
        const double left = i > 0 ? steps[i - 1] : 0;
        const double pivot = diagonal[i] - (i > 0 ? left * upper[i - 1] : 0);
        upper[i] = steps[i] / pivot;
        right[i] = (right[i] - (i > 0 ? left * right[i - 1] : 0)) / pivot;
        corner[i] = (corner[i] - (i > 0 ? left * corner[i - 1] : 0)) / pivot;
    }
    for (std::size_t i = n - 1; i-- > 0;) {
        right[i] -= upper[i] * right[i + 1];
        corner[i] -= upper[i] * corner[i + 1];
    }
    const double share = (right[0] + edge / gamma * right[n - 1]) / (1 + corner[0] + edge / gamma * corner[n - 1]);
    for (std::size_t i = 0; i < n; ++i) right[i] -= share * corner[i];
    return right;
}

// The slopes at the knots of that spline.
std::vector<double> knot_slopes(const std::vector<double>& steps, const std::vector<double>& values) {
    const std::vector<double> bend = periodic_spline(steps, values);
    std::vector<double> out(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::size_t after = (i + 1) % values.size();
        out[i] = (values[after] - values[i]) / steps[i] - steps[i] * (2 * bend[i] + bend[after]) / 6;
    }
    return out;
}

std::vector<Vec2> counter_clockwise(const PointsProfile& profile) {
    std::vector<Vec2> points;
    for (std::size_t i = 0; i < std::min(profile.x.size(), profile.y.size()); ++i)
        points.push_back({profile.x[i], profile.y[i]});
    double size = 0, area = 0;
    for (const Vec2& p : points) size = std::max(size, norm(p));
    if (points.size() > 1 && norm(points.front() - points.back()) <= kNegligible * size) points.pop_back();
    for (std::size_t i = 0; i < points.size(); ++i) area += cross(points[i], points[(i + 1) % points.size()]);
    if (area < 0) std::ranges::reverse(points);
    return points;
}

}  // namespace

OrientedPoints oriented(const PointsProfile& profile) {
    OrientedPoints out{counter_clockwise(profile), {}};
    const std::size_t n = out.points.size();
    if (n < 3) return out;
    std::vector<double> steps(n), x(n), y(n);
    for (std::size_t i = 0; i < n; ++i) {
        x[i] = out.points[i].x;
        y[i] = out.points[i].y;
        steps[i] = norm(out.points[(i + 1) % n] - out.points[i]);
    }
    const std::vector<double> dx = knot_slopes(steps, x), dy = knot_slopes(steps, y);
    for (std::size_t i = 0; i < n; ++i) {
        double angle = std::atan2(-dx[i], dy[i]);
        if (i > 0) angle += kFullTurn * std::round((out.normals.back() - angle) / kFullTurn);
        out.normals.push_back(angle);
    }
    return out;
}

std::vector<ProfileSpan> spans_of(const PointsProfile& profile) {
    const OrientedPoints outline = oriented(profile);
    const std::size_t n = outline.points.size();
    std::vector<ProfileSpan> spans;
    if (n < 3) return spans;
    std::vector<double> steps(n), h(n);
    for (std::size_t i = 0; i < n; ++i) {
        h[i] = dot(outline.points[i], unit(outline.normals[i]));
        steps[i] = (i + 1 < n ? outline.normals[i + 1] : outline.normals[0] + kFullTurn) - outline.normals[i];
        if (!(steps[i] > 0)) return {};
    }
    const std::vector<double> bend = periodic_spline(steps, h);
    for (std::size_t i = 0; i < n; ++i) {
        const double from = outline.normals[i], step = steps[i], h0 = h[i], h1 = h[(i + 1) % n];
        const double bend0 = bend[i], bend1 = bend[(i + 1) % n];
        spans.push_back(
            {from, from + step, [=](double alpha) {
                 const double b = (alpha - from) / step, a = 1 - b;
                 CamPoint p;
                 p.h = a * h0 + b * h1 + ((a * a * a - a) * bend0 + (b * b * b - b) * bend1) * step * step / 6;
                 p.slope = (h1 - h0) / step + ((1 - 3 * a * a) * bend0 + (3 * b * b - 1) * bend1) * step / 6;
                 p.radius = p.h + a * bend0 + b * bend1;
                 return p;
             }});
    }
    return spans;
}

}  // namespace beamcam::sim
