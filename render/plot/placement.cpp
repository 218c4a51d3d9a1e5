#include "render/plot/placement.hpp"

#include <algorithm>
#include <cmath>

namespace beamcam::render {

OccupancyGrid::OccupancyGrid(const Box& area, double cell)
    : area_(area),
      cell_(cell),
      columns_(std::max(1, static_cast<int>(std::ceil(area.w / cell)))),
      rows_(std::max(1, static_cast<int>(std::ceil(area.h / cell)))),
      cells_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0) {}

OccupancyGrid::Cells OccupancyGrid::touched(const Box& b) const {
    const auto index = [&](double at, int most) {
        return static_cast<int>(std::clamp(at, 0.0, static_cast<double>(most)));
    };
    return {index(std::floor((b.x - area_.x) / cell_), columns_), index(std::floor((b.y - area_.y) / cell_), rows_),
            index(std::floor((b.right() - area_.x) / cell_) + 1, columns_),
            index(std::floor((b.bottom() - area_.y) / cell_) + 1, rows_)};
}

void OccupancyGrid::cover(const Cells& c, double weight) {
    for (int row = c.top; row < c.bottom; ++row) {
        const auto begin = cells_.begin() + static_cast<std::ptrdiff_t>(row) * columns_;
        for (int i = c.left; i < c.right; ++i) begin[i] = std::max(begin[i], static_cast<float>(weight));
    }
    summed_ = false;
}

void OccupancyGrid::cover(const Box& box, double weight) { cover(touched(box), weight); }

void OccupancyGrid::cover(std::span<const Vec2> curve, double weight) {
    for (std::size_t k = 0; k + 1 < curve.size(); ++k) {
        const Vec2 a = curve[k], b = curve[k + 1];
        if (!(std::isfinite(a.x + a.y + b.x + b.y))) continue;
        // The number of steps is bounded.
        const int steps = std::clamp(static_cast<int>(std::ceil(norm(b - a) / (0.5 * cell_))), 1, 20000);
        for (int s = 0; s <= steps; ++s) {
            const Vec2 p = a + (b - a) * (static_cast<double>(s) / steps);
            if (!area_.contains({p.x, p.y, 0, 0}, cell_)) continue;
            const int i = static_cast<int>((p.x - area_.x) / cell_), j = static_cast<int>((p.y - area_.y) / cell_);
            if (i >= 0 && j >= 0 && i < columns_ && j < rows_) cover(Cells{i, j, i + 1, j + 1}, weight);
        }
    }
}

void OccupancyGrid::sum() const {
    const auto width = static_cast<std::size_t>(columns_) + 1;
    sums_.assign(width * (static_cast<std::size_t>(rows_) + 1), 0);
    for (std::size_t j = 0; j < static_cast<std::size_t>(rows_); ++j)
        for (std::size_t i = 0; i < static_cast<std::size_t>(columns_); ++i)
            sums_[(j + 1) * width + i + 1] = sums_[j * width + i + 1] + sums_[(j + 1) * width + i] -
                                             sums_[j * width + i] + cells_[j * static_cast<std::size_t>(columns_) + i];
    summed_ = true;
}

double OccupancyGrid::weight(const Cells& c) const {
    if (!summed_) sum();
    const auto above_left = [&](int i, int j) {
        return sums_[static_cast<std::size_t>(j) * (static_cast<std::size_t>(columns_) + 1) +
                     static_cast<std::size_t>(i)];
    };
    return std::max(0.0, above_left(c.right, c.bottom) - above_left(c.right, c.top) - above_left(c.left, c.bottom) +
                             above_left(c.left, c.top));
}

double OccupancyGrid::cost(const Box& box) const { return area_.contains(box, 0.01) ? weight(touched(box)) : 1e6; }

Place best_place(const OccupancyGrid& taken, double width, double height, double margin) {
    const Box area = taken.area().inset(margin);
    Place best{{area.right() - width, area.y, width, height}, 1e9};
    constexpr int kSteps = 12;
    for (int j = 0; j <= kSteps; ++j)
        for (int i = 0; i <= kSteps; ++i) {
            const double u = static_cast<double>(i) / kSteps, v = static_cast<double>(j) / kSteps;
            const Box box{area.x + u * (area.w - width), area.y + v * (area.h - height), width, height};
            // Places away from edges and corners cost extra; the upper right corner wins ties.
            const double inwards = std::min(u, 1 - u) + std::min(v, 1 - v);
            const double cost = taken.cost(box) * 10 + 8 * inwards + 0.2 * (1 - u) + 0.1 * v;
            if (cost < best.cost) best = {box, cost};
        }
    best.cost = taken.cost(best.box);
    return best;
}

}  // namespace beamcam::render
