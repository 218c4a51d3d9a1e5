#include "render/plot/free_room.hpp"

#include <algorithm>
#include <cmath>

namespace beamcam::render {

FreeRoom::FreeRoom(const Box& box, double cell)
    : box_(box),
      cell_(cell),
      columns_(std::max(1, static_cast<int>(std::ceil(box.w / cell)))),
      rows_(std::max(1, static_cast<int>(std::ceil(box.h / cell)))),
      taken_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

FreeRoom::Cells FreeRoom::touched(const Box& b) const {
    const auto index = [&](double at, int most) {
        return static_cast<int>(std::clamp(at, 0.0, static_cast<double>(most)));
    };
    return {index(std::floor((b.x - box_.x) / cell_), columns_), index(std::floor((b.y - box_.y) / cell_), rows_),
            index(std::floor((b.right() - box_.x) / cell_) + 1, columns_),
            index(std::floor((b.bottom() - box_.y) / cell_) + 1, rows_)};
}

void FreeRoom::take_row(int row, double from, double to) {
    const Cells c = touched({from, box_.y, to - from, 0});
    const auto begin = taken_.begin() + static_cast<std::ptrdiff_t>(row) * columns_;
    if (c.left < c.right) std::fill(begin + c.left, begin + c.right, true);
}

void FreeRoom::take(std::span<const Vec2> convex) {
    Bounds all;
    for (Vec2 p : convex) all.add(p);
    const Cells c = touched({all.x0, all.y0, all.x1 - all.x0, all.y1 - all.y0});
    for (int row = c.top; row < c.bottom; ++row) {
        const double top = box_.y + row * cell_, bottom = top + cell_;
        Bounds part;  // of the edges within the row
        for (std::size_t i = 0; i < convex.size(); ++i) {
            Vec2 a = convex[i], b = convex[(i + 1) % convex.size()];
            if (a.y > b.y) std::swap(a, b);
            if (b.y < top || a.y > bottom) continue;
            const auto at = [&](double y) {
                return b.y > a.y ? a + (b - a) * std::clamp((y - a.y) / (b.y - a.y), 0.0, 1.0) : a;
            };
            part.add(at(top)), part.add(at(bottom));
            if (!(b.y > a.y)) part.add(b);
        }
        if (part.x0 <= part.x1) take_row(row, part.x0, part.x1);
    }
}

void FreeRoom::take(Vec2 centre, double radius) {
    const Cells c = touched({centre.x - radius, centre.y - radius, 2 * radius, 2 * radius});
    for (int row = c.top; row < c.bottom; ++row) {
        const double top = box_.y + row * cell_, off = std::clamp(centre.y, top, top + cell_) - centre.y;
        const double half = std::sqrt(std::max(0.0, radius * radius - off * off));
        take_row(row, centre.x - half, centre.x + half);
    }
}

void FreeRoom::take(const Box& box) {
    const Cells c = touched(box);
    for (int row = c.top; row < c.bottom; ++row) take_row(row, box.x, box.right());
}

double FreeRoom::taken(const Box& box) const {
    const Cells c = touched(box);
    double count = 0;
    for (int row = c.top; row < c.bottom; ++row) {
        const auto begin = taken_.begin() + static_cast<std::ptrdiff_t>(row) * columns_;
        count += static_cast<double>(std::count(begin + c.left, begin + std::max(c.left, c.right), true));
    }
    const double cells = std::max(0, c.right - c.left) * std::max(0, c.bottom - c.top);
    const double within = std::max(0.0, std::min(box.right(), box_.right()) - std::max(box.x, box_.x)) *
                          std::max(0.0, std::min(box.bottom(), box_.bottom()) - std::max(box.y, box_.y));
    // All but what rounding takes away.
    const double inside = box.empty() ? 0 : std::min(1.0, within / (box.w * box.h) * (1 + 1e-9));
    return 1 - inside + inside * (cells > 0 ? count / cells : 0);
}

Box FreeRoom::choose(std::span<const Box> places) const {
    const Box* best = &places.front();
    double least = taken(*best);
    for (const Box& place : places.subspan(1)) {
        if (least == 0) break;
        if (const double here = taken(place); here < least) best = &place, least = here;
    }
    return *best;
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
    for (int i = 1; i < kSteps; ++i) out.push_back(from(double(i) / kSteps, 0));
    for (int i = 1; i < kSteps; ++i) out.push_back(from(0, double(i) / kSteps));
    for (int i = 1; i < kSteps; ++i) out.push_back(from(double(i) / kSteps, 1));
    for (int i = 1; i < kSteps; ++i) out.push_back(from(1, double(i) / kSteps));
    return out;
}

}  // namespace beamcam::render
