#include "render/plot/placement.hpp"

#include <algorithm>
#include <cmath>

namespace beamcam::render::figure {

Occupancy::Occupancy(const Box& area, double cell)
    : area_(area),
      cell_(cell),
      columns_(std::clamp(static_cast<int>(std::ceil(area.w / cell)), 1, 4000)),
      rows_(std::clamp(static_cast<int>(std::ceil(area.h / cell)), 1, 4000)),
      cells_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0) {}

void Occupancy::add(int i, int j, double weight) {
    if (i < 0 || j < 0 || i >= columns_ || j >= rows_) return;
    float& cell =
        cells_[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(i)];
    cell = std::max(cell, static_cast<float>(weight));
    summed_ = false;
}

void Occupancy::cover(std::span<const Vec2> curve, double weight) {
    for (std::size_t k = 0; k + 1 < curve.size(); ++k) {
        const Vec2 a = curve[k], b = curve[k + 1];
        if (!(std::isfinite(a.x + a.y + b.x + b.y))) continue;
        // A segment beyond the area has few cells in it; the walk is bounded by the area's own size.
        const int steps = std::clamp(static_cast<int>(std::ceil(norm(b - a) / (0.5 * cell_))), 1, 20000);
        for (int s = 0; s <= steps; ++s) {
            const Vec2 p = a + (b - a) * (static_cast<double>(s) / steps);
            if (!area_.contains({p.x, p.y, 0, 0}, cell_)) continue;
            add(static_cast<int>((p.x - area_.x) / cell_), static_cast<int>((p.y - area_.y) / cell_), weight);
        }
    }
}

void Occupancy::cover(const Box& box, double weight) {
    const int i0 = std::max(0, static_cast<int>((box.x - area_.x) / cell_));
    const int i1 = std::min(columns_ - 1, static_cast<int>((box.right() - area_.x) / cell_));
    const int j0 = std::max(0, static_cast<int>((box.y - area_.y) / cell_));
    const int j1 = std::min(rows_ - 1, static_cast<int>((box.bottom() - area_.y) / cell_));
    for (int j = j0; j <= j1; ++j)
        for (int i = i0; i <= i1; ++i) add(i, j, weight);
}

void Occupancy::sum() const {
    const auto width = static_cast<std::size_t>(columns_) + 1;
    sums_.assign(width * (static_cast<std::size_t>(rows_) + 1), 0);
    for (std::size_t j = 0; j < static_cast<std::size_t>(rows_); ++j)
        for (std::size_t i = 0; i < static_cast<std::size_t>(columns_); ++i)
            sums_[(j + 1) * width + i + 1] = sums_[j * width + i + 1] + sums_[(j + 1) * width + i] -
                                             sums_[j * width + i] + cells_[j * static_cast<std::size_t>(columns_) + i];
    summed_ = true;
}

double Occupancy::cost(const Box& box) const {
    if (!area_.contains(box, 0.01)) return 1e6;
    if (!summed_) sum();
    const auto column = [&](double x) {
        return static_cast<std::size_t>(std::clamp(static_cast<int>((x - area_.x) / cell_), 0, columns_ - 1));
    };
    const auto row = [&](double y) {
        return static_cast<std::size_t>(std::clamp(static_cast<int>((y - area_.y) / cell_), 0, rows_ - 1));
    };
    const std::size_t width = static_cast<std::size_t>(columns_) + 1;
    const std::size_t i0 = column(box.x), i1 = column(box.right()) + 1, j0 = row(box.y), j1 = row(box.bottom()) + 1;
    return std::max(0.0,
                    sums_[j1 * width + i1] - sums_[j0 * width + i1] - sums_[j1 * width + i0] + sums_[j0 * width + i0]);
}

Place best_place(const Occupancy& taken, double width, double height, double margin) {
    const Box area = taken.area().inset(margin);
    Place best{{area.right() - width, area.y, width, height}, 1e9};
    constexpr int kSteps = 12;
    for (int j = 0; j <= kSteps; ++j)
        for (int i = 0; i <= kSteps; ++i) {
            const double u = static_cast<double>(i) / kSteps, v = static_cast<double>(j) / kSteps;
            const Box box{area.x + u * (area.w - width), area.y + v * (area.h - height), width, height};
            // Away from edges and corners a box must cover clearly less to be worth it; upper right wins ties.
            const double inwards = std::min(u, 1 - u) + std::min(v, 1 - v);
            const double cost = taken.cost(box) * 10 + 8 * inwards + 0.2 * (1 - u) + 0.1 * v;
            if (cost < best.cost) best = {box, cost};
        }
    best.cost = taken.cost(best.box);
    return best;
}

}  // namespace beamcam::render::figure
