#include "render/figure/reduce.hpp"

#include <algorithm>
#include <cmath>

namespace beamcam::render::figure {
namespace {

bool broken(Vec2 p) { return !(std::isfinite(p.x) && std::isfinite(p.y)); }

bool increasing(std::span<const Vec2> points) {
    for (std::size_t i = 1; i < points.size(); ++i)
        if (points[i].x < points[i - 1].x) return false;
    return true;
}

// [from, to) is unbroken and increases in x.
void columns(std::span<const Vec2> p, double grain, std::vector<Vec2>& out) {
    for (std::size_t i = 0; i < p.size();) {
        const double column = std::floor(p[i].x / grain);
        std::size_t least = i, most = i, last = i;
        while (last + 1 < p.size() && std::floor(p[last + 1].x / grain) == column) {
            ++last;
            if (p[last].y < p[least].y) least = last;
            if (p[last].y > p[most].y) most = last;
        }
        const std::size_t inner[2] = {std::min(least, most), std::max(least, most)};
        out.push_back(p[i]);
        for (const std::size_t k : inner)
            if (k != i && k != last && p[k] != out.back()) out.push_back(p[k]);
        if (last != i) out.push_back(p[last]);
        i = last + 1;
    }
}

void steps(std::span<const Vec2> p, double grain, std::vector<Vec2>& out) {
    for (std::size_t i = 0; i < p.size(); ++i)
        if (i == 0 || i + 1 == p.size() || norm(p[i] - out.back()) >= grain) out.push_back(p[i]);
}

// All of `between` lie on the straight line from a to b.
bool straight(Vec2 a, Vec2 b, std::span<const Vec2> between, double tolerance) {
    const Vec2 way = b - a;
    const double length = norm(way);
    return length > 0 && std::all_of(between.begin(), between.end(), [&](Vec2 p) {
               const double along = dot(p - a, way) / length;
               return along >= 0 && along <= length && std::abs(cross(p - a, way)) <= tolerance * length;
           });
}

// Points that lie on the line between those before and behind them carry nothing.
std::vector<Vec2> straightened(const std::vector<Vec2>& p, double tolerance) {
    constexpr std::size_t kMost = 64;  // that one line stands for, so that the work stays linear
    std::vector<Vec2> out;
    std::size_t kept = 0;  // index of the last one in `out`
    for (std::size_t i = 0; i < p.size(); ++i) {
        const bool inner = i > 0 && i + 1 < p.size() && !broken(p[kept]) && !broken(p[i]) && !broken(p[i + 1]);
        if (inner && i - kept <= kMost && straight(p[kept], p[i + 1], {&p[kept + 1], i - kept}, tolerance)) continue;
        out.push_back(p[i]);
        kept = i;
    }
    return out;
}

}  // namespace

std::vector<Vec2> reduce(std::span<const Vec2> points, double grain) {
    std::vector<Vec2> out;
    for (std::size_t i = 0; i < points.size();) {
        if (broken(points[i])) {
            if (!out.empty() && !broken(out.back())) out.push_back({std::nan(""), std::nan("")});
            ++i;
            continue;
        }
        std::size_t end = i;
        while (end < points.size() && !broken(points[end])) ++end;
        const std::span<const Vec2> piece = points.subspan(i, end - i);
        increasing(piece) ? columns(piece, grain, out) : steps(piece, grain, out);
        i = end;
    }
    return straightened(out, 0.25 * grain);
}

}  // namespace beamcam::render::figure
