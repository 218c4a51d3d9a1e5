#include "render/draw/accumulated.hpp"

#include <algorithm>
#include <cmath>

namespace beamcam::render {

TimedPath thinned(const std::vector<double>& times, const std::vector<Vec2>& points, double least) {
    TimedPath out;
    const std::size_t n = std::min(times.size(), points.size());
    for (std::size_t i = 0; i < n; ++i) {
        const bool near = !out.points.empty() && norm(points[i] - out.points.back()) < least;  // false beside NaN
        if (near && i + 1 < n) continue;
        out.times.push_back(times[i]);
        out.points.push_back(points[i]);
    }
    return out;
}

void AccumulatedLayer::extend_to(double t, const TimedPath& path, const Fonts& fonts, const Pen& pen) {
    const auto last = static_cast<std::size_t>(std::ranges::upper_bound(path.times, t) - path.times.begin());
    if (last < drawn_) {
        std::ranges::fill(image_.pixels, 0U);
        painted_.clear();
        drawn_ = 0;
    }
    if (last == drawn_) return;
    Canvas canvas(image_, fonts);
    canvas.touched = &painted_;
    for (std::size_t i = std::max<std::size_t>(drawn_, 1); i < last; ++i) {
        const Vec2 a = path.points[i - 1], b = path.points[i];
        if (!std::isnan(a.x) && !std::isnan(b.x)) canvas.line(a, b, pen);
    }
    drawn_ = last;
}

void AccumulatedLayer::draw(Canvas& onto, Vec2 corner) const {
    painted_.for_each_run([&](int left, int top, int right, int bottom) {
        onto.image_part(image_, static_cast<int>(corner.x), static_cast<int>(corner.y),
                        {double(left), double(top), double(right - left), double(bottom - top)});
    });
}

}  // namespace beamcam::render
