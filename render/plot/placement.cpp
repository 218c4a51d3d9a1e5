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

void OccupancyGrid::cover_row(int row, double from, double to, double weight) {
    const Cells c = touched({from, area_.y, to - from, 0});
    cover(Cells{c.left, row, c.right, row + 1}, weight);
}

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

void OccupancyGrid::cover_convex(std::span<const Vec2> corners, double weight) {
    Bounds all;
    for (Vec2 p : corners) all.add(p);
    const Cells c = touched(all.box());
    for (int row = c.top; row < c.bottom; ++row) {
        const double top = top_of(row), bottom = top + cell_;
        Bounds part;  // of the edges within the row
        for (std::size_t i = 0; i < corners.size(); ++i) {
            Vec2 a = corners[i], b = corners[(i + 1) % corners.size()];
            if (a.y > b.y) std::swap(a, b);
            if (b.y < top || a.y > bottom) continue;
            const auto at = [&](double y) {
                return b.y > a.y ? a + (b - a) * std::clamp((y - a.y) / (b.y - a.y), 0.0, 1.0) : a;
            };
            part.add(at(top)), part.add(at(bottom));
            if (!(b.y > a.y)) part.add(b);
        }
        if (part.x0 <= part.x1) cover_row(row, part.x0, part.x1, weight);
    }
}

void OccupancyGrid::cover_disc(Vec2 centre, double radius) {
    const Cells c = touched({centre.x - radius, centre.y - radius, 2 * radius, 2 * radius});
    for (int row = c.top; row < c.bottom; ++row) {
        const double top = top_of(row), off = std::clamp(centre.y, top, top + cell_) - centre.y;
        const double half = std::sqrt(std::max(0.0, radius * radius - off * off));
        cover_row(row, centre.x - half, centre.x + half, 1);
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

double OccupancyGrid::covered(const Box& box) const {
    const Cells c = touched(box);
    const double cells = std::max(0, c.right - c.left) * std::max(0, c.bottom - c.top);
    const double within = std::max(0.0, std::min(box.right(), area_.right()) - std::max(box.x, area_.x)) *
                          std::max(0.0, std::min(box.bottom(), area_.bottom()) - std::max(box.y, area_.y));
    // Up to rounding.
    const double inside = box.empty() ? 0 : std::min(1.0, within / (box.w * box.h) * (1 + 1e-9));
    return 1 - inside + inside * (cells > 0 ? weight(c) / cells : 0);
}

std::vector<Box> OccupancyGrid::covered_boxes() const {
    constexpr double kCounted = 0.5;
    std::vector<Box> out;
    for (int row = 0; row < rows_; ++row) {
        const auto cell = cells_.begin() + static_cast<std::ptrdiff_t>(row) * columns_;
        for (int i = 0, end; i < columns_; i = end) {
            for (end = i; end < columns_ && (cell[end] >= kCounted) == (cell[i] >= kCounted);) ++end;
            if (cell[i] >= kCounted) out.push_back({area_.x + i * cell_, top_of(row), (end - i) * cell_, cell_});
        }
    }
    return out;
}

Box OccupancyGrid::choose(std::span<const Box> places) const {
    const Box* best = &places.front();
    double least = covered(*best);
    for (const Box& place : places.subspan(1)) {
        if (least == 0) break;
        if (const double here = covered(place); here < least) best = &place, least = here;
    }
    return *best;
}

Box OccupancyGrid::nearest_free(const Box& wanted) const {
    const double most_x = std::max(area_.x, area_.right() - wanted.w);
    const double most_y = std::max(area_.y, area_.bottom() - wanted.h);
    const Box start{std::clamp(wanted.x, area_.x, most_x), std::clamp(wanted.y, area_.y, most_y), wanted.w, wanted.h};
    if (covered(start) == 0) return start;
    // Covered cells cost more than any distance, so that distance decides only among equals.
    const double diagonal = std::hypot(area_.w, area_.h);
    Box best = start;
    double least = 1e9;
    const auto first = [&](double from, double low) { return static_cast<int>(std::ceil((low - from) / cell_)); };
    const auto last = [&](double from, double high) { return static_cast<int>(std::floor((high - from) / cell_)); };
    for (int j = first(start.y, area_.y); j <= last(start.y, most_y); ++j)
        for (int i = first(start.x, area_.x); i <= last(start.x, most_x); ++i) {
            const Box place{start.x + i * cell_, start.y + j * cell_, wanted.w, wanted.h};
            const double way = std::hypot(place.x - wanted.x, place.y - wanted.y) / diagonal;
            if (way >= least) continue;
            const double hidden = covered(place);
            const double cost = way + (hidden > 0 ? 2 + 4 * hidden : 0);
            if (cost < least) best = place, least = cost;
        }
    return best;
}

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

std::vector<Box> places_along(const Box& room, Vec2 size, Corner first) {
    const double right = std::max(room.x, room.right() - size.x), bottom = std::max(room.y, room.bottom() - size.y);
    const auto at = [&](double across, double down) {
        return Box{room.x + across * (right - room.x), room.y + down * (bottom - room.y), size.x, size.y};
    };
    // From the first corner: 0 is there, 1 opposite.
    const auto from = [&](double across, double down) {
        return first == Corner::top_left ? at(across, down) : at(1 - across, 1 - down);
    };
    std::vector<Box> out{from(0, 0), from(1, 0), from(0, 1), from(1, 1)};
    constexpr int kSteps = 24;
    for (const double far : {0.0, 1.0}) {
        for (int i = 1; i < kSteps; ++i) out.push_back(from(double(i) / kSteps, far));
        for (int i = 1; i < kSteps; ++i) out.push_back(from(far, double(i) / kSteps));
    }
    return out;
}

}  // namespace beamcam::render
