#include "render/gl/soft_shadows.hpp"

#include <algorithm>
#include <cmath>

namespace beamcam::render {

ShadowVertex SoftShadows::vertex(Vec2 at, std::array<double, 4> inside, double opacity, double grey) const {
    const Vec2 p = view.to_pixels(ground == Ground::wall ? Vec3{at.x, at.y, level} : Vec3{at.x, level, at.y});
    return {{float(p.x), float(p.y)},
            {float(inside[0]), float(inside[1]), float(inside[2]), float(inside[3])},
            float(opacity),
            float(grey)};
}

void SoftShadows::rectangle(Vec2 low, Vec2 high, double soft, double opacity, double grey) {
    ribbon({{low, {low.x, high.y}, soft}, {{high.x, low.y}, high, soft}}, opacity, grey);
}

// Widened by the penumbra on all sides.
void SoftShadows::ribbon(const std::vector<Station>& line, double opacity, double grey) {
    const auto middle = [&](std::size_t i) { return (line[i].low + line[i].high) * 0.5; };
    const std::size_t last = line.size() - 1;
    double length = 0;
    for (std::size_t i = 0; i < last; ++i) length += norm(middle(i + 1) - middle(i));
    std::vector<std::array<ShadowVertex, 2>> pairs;
    const auto add = [&](const Station& s, Vec2 shift, double along) {
        const Vec2 up = normalized(s.high - s.low) * s.soft;
        const double across = norm(s.high - s.low) / s.soft + 1, from = along / s.soft, to = (length - along) / s.soft;
        pairs.push_back({vertex(s.low - up + shift, {-1, across, from, to}, opacity, grey),
                         vertex(s.high + up + shift, {across, -1, from, to}, opacity, grey)});
    };
    double along = 0;
    add(line[0], normalized(middle(0) - middle(1)) * line[0].soft, -line[0].soft);
    for (std::size_t i = 0; i <= last; ++i) {
        if (i > 0) along += norm(middle(i) - middle(i - 1));
        add(line[i], {}, along);
    }
    add(line[last], normalized(middle(last) - middle(last - 1)) * line[last].soft, length + line[last].soft);
    for (std::size_t i = 0; i + 1 < pairs.size(); ++i) {
        const auto& [a, b] = pairs[i];
        const auto& [c, d] = pairs[i + 1];
        corners.insert(corners.end(), {a, c, d, a, d, b});
    }
}

void SoftShadows::polygon(const std::vector<Vec2>& outline, const std::vector<Vec2>& outward, double soft,
                          double opacity) {
    Vec2 centre;
    for (const Vec2 p : outline) centre += p * (1 / static_cast<double>(outline.size()));
    double radius = soft;
    for (const Vec2 p : outline) radius = std::min(radius, norm(p - centre));
    const auto at = [&](std::size_t i, double inset) {
        return vertex(outline[i] - outward[i] * inset, {inset / soft, 1, 1, 1}, opacity, 0);
    };
    const ShadowVertex inmost = vertex(centre, {radius / soft, 1, 1, 1}, opacity, 0);
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const std::size_t k = (i + 1) % outline.size();
        const ShadowVertex a = at(i, radius), b = at(k, radius), c = at(i, -soft), d = at(k, -soft);
        corners.insert(corners.end(), {inmost, a, b, a, c, d, a, d, b});
    }
}

}  // namespace beamcam::render
