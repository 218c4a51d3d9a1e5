#include "render/figure/reduce.hpp"

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

// Points that lie on the line between their neighbours carry nothing.
std::vector<Vec2> straightened(const std::vector<Vec2>& p, double tolerance) {
    std::vector<Vec2> out;
    for (std::size_t i = 0; i < p.size(); ++i) {
        if (i > 0 && i + 1 < p.size() && !broken(p[i - 1]) && !broken(p[i]) && !broken(p[i + 1]) && !out.empty()) {
            const Vec2 a = out.back(), way = p[i + 1] - a;
            const double length = norm(way);
            const double along = length > 0 ? dot(p[i] - a, way) / length : -1;
            if (!broken(a) && along >= 0 && along <= length && length < 200 * tolerance &&
                std::abs(cross(p[i] - a, way)) <= tolerance * length)
                continue;
        }
        out.push_back(p[i]);
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
