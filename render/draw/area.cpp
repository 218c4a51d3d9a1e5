#include "render/draw/area.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "render/draw/blend.hpp"

namespace beamcam::render {
namespace {

constexpr double kFlatness = 0.02;  // deviation of a polygon from its circle [px]
constexpr float kHalf = 0.5F;       // added before truncation, to round
constexpr int kBand = 32;           // rows that are accumulated at once

// A polygon whose corners lie as far outside the circle as the middles of its sides lie inside.
std::vector<Vec2> circle(Vec2 centre, double radius) {
    std::vector<Vec2> corners;
    if (!(radius > 0)) return corners;
    const double half = std::acos(1 - std::min(2 * kFlatness / radius, 0.5));  // of a side's angle
    const int sides = static_cast<int>(std::clamp(std::ceil(std::numbers::pi / half), 8.0, 5000.0));
    const double angle = 2 * std::numbers::pi / sides;
    const Vec2 turn{std::cos(angle), std::sin(angle)};
    Vec2 spoke{2 * radius / (1 + std::cos(angle / 2)), 0};
    for (int i = 0; i < sides; ++i) {
        corners.push_back(centre + spoke);
        spoke = {spoke.x * turn.x - spoke.y * turn.y, spoke.x * turn.y + spoke.y * turn.x};
    }
    return corners;
}

// Accumulates for each pixel the difference of coverage from its left neighbour, for kBand rows and `width` columns
// from `left` on.
class CoverageAccumulator {
  public:
    CoverageAccumulator(int left, int width)
        : left_(left),
          width_(width),
          stride_(static_cast<std::size_t>(width) + 2 + 2 * kEight),
          sums_(kBand * stride_, 0.0F) {}

    // Adds the part of an edge within the rows; `top` is the first row.
    void add(int top, Vec2 a, Vec2 b, float sense) {
        const double slope = (b.x - a.x) / (b.y - a.y);
        const double from = std::max<double>(a.y, top), to = std::min<double>(b.y, top + kBand);
        double x = a.x + slope * (from - a.y);
        for (double y = from; y < to;) {
            const int row = static_cast<int>(y);
            const double next = std::min<double>(row + 1, to);
            const double beyond = next < b.y ? a.x + slope * (next - a.y) : b.x;
            cross(row - top, std::min(x, beyond) - left_, std::max(x, beyond) - left_, sense * (next - y));
            x = beyond;
            y = next;
        }
    }

    // Calls take(x, part) for pixels covered in part (1 … 254) and fill(first, end) for runs of full pixels, from left
    // to right, and clears the row.
    template <class Take, class Fill>
    void take_row(int row, const Take& take, const Fill& fill) {
        Reach& reach = reach_[static_cast<std::size_t>(row)];
        float* sums = sums_.data() + static_cast<std::size_t>(row) * stride_;
        float covered = 0;
        for (int x = reach.first, end = std::min(reach.end, width_); x < end;) {
            covered += sums[x];
            sums[x] = 0;
            const int part = static_cast<int>(std::min(std::abs(covered), 1.0F) * 255 + kHalf);
            int next = x + 1;
            if (zeros(sums + next)) {  // no edge there
                do next += kEight;
                while (next < end && zeros(sums + next));
                next = std::min(next, end);
            }
            if (part == 255)
                fill(left_ + x, left_ + next);
            else if (part > 0)
                for (int at = x; at < next; ++at) take(left_ + at, static_cast<std::uint32_t>(part));
            x = next;
        }
        sums[width_] = sums[width_ + 1] = 0;
        reach = {};
    }

  private:
    static constexpr int kEight = 8;
    struct Reach {
        int first = 1 << 30, end = 0;
    };

    static bool zeros(const float* sums) {
        std::array<std::uint64_t, kEight / 2> words;
        std::memcpy(words.data(), sums, sizeof words);
        return (words[0] | words[1] | words[2] | words[3]) == 0;
    }

    // Adds an edge that spans from left to right in a row, with signed `height`. Parts outside the columns are moved to
    // their borders.
    void cross(int row, double left, double right, double height) {
        const auto end = static_cast<double>(width_);
        if (left < 0 || right > end) {
            if (right <= 0) return cross_inside(row, 0, 0, height);
            if (left >= end) return cross_inside(row, end, end, height);
            const double share = height / (right - left);
            if (left < 0) cross_inside(row, 0, 0, -left * share);
            if (right > end) cross_inside(row, end, end, (right - end) * share);
            height = (std::min(right, end) - std::max(left, 0.0)) * share;
            left = std::max(left, 0.0), right = std::min(right, end);
        }
        cross_inside(row, left, right, height);
    }

    void cross_inside(int row, double left, double right, double of_row) {
        const auto height = static_cast<float>(of_row);
        const int first = static_cast<int>(left), last = std::max(first, static_cast<int>(std::ceil(right)) - 1);
        float* sums = sums_.data() + static_cast<std::size_t>(row) * stride_;
        Reach& reach = reach_[static_cast<std::size_t>(row)];
        reach.first = std::min(reach.first, first);
        reach.end = std::max(reach.end, last + 2);
        if (first == last) {
            const auto beside =
                static_cast<float>((left + right) / 2 - first);  // share of the pixel that is not covered
            sums[first] += height * (1 - beside);
            sums[first + 1] += height * beside;
            return;
        }
        // Cumulative coverage: a triangle in the first pixel, then increments of `step`.
        const auto step = static_cast<float>(1 / (right - left));
        const auto head = static_cast<float>(first + 1 - left), tail = static_cast<float>(right - last);
        float before = 0;
        for (int x = first; x < last; ++x) {
            const float upto =
                x == first ? 0.5F * step * head * head : step * (head + static_cast<float>(x - first) - 0.5F);
            sums[x] += height * (upto - before);
            before = upto;
        }
        const float upto = 1 - 0.5F * step * tail * tail;
        // In the last pixel the edge leaves a triangle uncovered, in the one behind none.
        sums[last] += height * (upto - before);
        sums[last + 1] += height * (1 - upto);
    }

    int left_, width_;
    std::size_t stride_;
    std::vector<float> sums_;
    std::array<Reach, kBand> reach_;
};

// Marks tiles dirty for runs of pixels, joining neighbours in a row.
class DirtySpans {
  public:
    explicit DirtySpans(DirtyTiles* touched) : touched_(touched) {}
    ~DirtySpans() { flush(); }
    DirtySpans(const DirtySpans&) = delete;
    DirtySpans& operator=(const DirtySpans&) = delete;

    void add(int y, int first, int end) {
        if (y == y_ && first <= end_ + DirtyTiles::kWidth) {
            end_ = end;
            return;
        }
        flush();
        y_ = y, first_ = first, end_ = end;
    }

  private:
    void flush() {
        if (touched_ && y_ >= 0) touched_->add({double(first_), double(y_), double(end_ - 1 - first_), 0});
    }
    DirtyTiles* touched_;
    int y_ = -1, first_ = 0, end_ = 0;
};

}  // namespace

void Area::put(std::span<const Vec2> corners, float sense) {
    double area = 0;  // twice the area; positive if the corners run clockwise on the screen
    Bounds box;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec2 a = corners[i], b = corners[(i + 1) % corners.size()];
        area += a.x * b.y - b.x * a.y;
        box.add(a);
    }
    if (!std::isfinite(area)) return;
    if (area < 0) sense = -sense;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec2 a = corners[i], b = corners[(i + 1) % corners.size()];
        if (a.y == b.y) continue;
        edges_.push_back(a.y < b.y ? Edge{a, b, -sense} : Edge{b, a, sense});
    }
    box_.add({box.x0, box.y0});
    box_.add({box.x1, box.y1});
}

void Area::add_circle(Vec2 centre, double radius) { add(circle(centre, radius)); }
void Area::cut_circle(Vec2 centre, double radius) { cut(circle(centre, radius)); }

void Area::paint(const PixelView& picture, Color opaque, DirtyTiles* touched) const {
    if (edges_.empty()) return;
    const auto whole = [](double at, int end) { return static_cast<int>(std::clamp(at, 0.0, double(end))); };
    const int left = whole(std::floor(box_.x0), picture.width), right = whole(std::ceil(box_.x1), picture.width);
    const int end = whole(std::ceil(box_.y1), picture.height);
    const std::uint32_t ink = pixel_of(opaque);
    DirtySpans dirty(touched);
    CoverageAccumulator sums(left, right - left);
    for (int top = whole(std::floor(box_.y0), picture.height); top < end; top += kBand) {
        const int bottom = std::min(top + kBand, end);
        for (const Edge& e : edges_)
            if (e.bottom.y > top && e.top.y < bottom) sums.add(top, e.top, e.bottom, e.sense);
        for (int y = top; y < bottom; ++y) {
            std::uint32_t* row = picture.pixels + y * picture.stride;
            sums.take_row(
                y - top,
                [&](int x, std::uint32_t part) {
                    row[x] = over(ink, part, row[x]);
                    dirty.add(y, x, x + 1);
                },
                [&](int first, int last) {
                    std::fill(row + first, row + last, ink);
                    dirty.add(y, first, last);
                });
        }
    }
}

void paint_quadrilateral(const std::array<Vec2, 4>& corners, const PixelView& picture, Color opaque,
                         DirtyTiles* touched) {
    // A side always runs downwards, so that it is the same one for both of its quadrilaterals.
    struct Side {
        Vec2 top, bottom;
    };
    std::array<Side, 4> sides;
    Bounds box;
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec2 a = corners[i], b = corners[(i + 1) % 4];
        sides[i] = a.y < b.y || (a.y == b.y && a.x < b.x) ? Side{a, b} : Side{b, a};
        box.add(a);
    }
    // Of pixels, the first whose centre is not before `at`.
    const auto first = [](double at, int end) {
        return static_cast<int>(std::clamp(std::ceil(at - 0.5), 0.0, static_cast<double>(end)));
    };
    const std::uint32_t ink = pixel_of(opaque);
    const int bottom = first(box.y1, picture.height);
    for (int y = first(box.y0, picture.height); y < bottom; ++y) {
        Bounds within;
        for (const auto& [a, b] : sides)
            if (a.y <= y + 0.5 && y + 0.5 < b.y)
                within.add({a.x + (b.x - a.x) * ((y + 0.5 - a.y) / (b.y - a.y)), y + 0.5});
        std::uint32_t* row = picture.pixels + y * picture.stride;
        const int from = first(within.x0, picture.width), to = first(within.x1, picture.width);
        if (from < to) std::fill(row + from, row + to, ink);
    }
    if (touched && !box.empty()) touched->add(box.box());
}

}  // namespace beamcam::render
