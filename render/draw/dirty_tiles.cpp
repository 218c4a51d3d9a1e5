#include "render/draw/dirty_tiles.hpp"

#include <algorithm>
#include <cmath>

namespace beamcam::render {

DirtyTiles::DirtyTiles(int width, int height)
    : width_(width),
      height_(height),
      columns_((width + kWidth - 1) / kWidth),
      rows_((height + kHeight - 1) / kHeight),
      set_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0) {}

void DirtyTiles::add(const Box& box) {
    const double right = box.right(), bottom = box.bottom();
    if (std::isnan(box.x + box.y + right + bottom)) return add_all();
    const auto tile = [](double at, int size, int count) {
        return static_cast<int>(std::clamp(std::floor(at / size), -1.0, static_cast<double>(count)));
    };
    const int x0 = std::max(tile(box.x, kWidth, columns_), 0),
              x1 = std::min(tile(right, kWidth, columns_), columns_ - 1);
    const int y0 = std::max(tile(box.y, kHeight, rows_), 0), y1 = std::min(tile(bottom, kHeight, rows_), rows_ - 1);
    if (x1 < x0) return;
    for (int y = y0; y <= y1; ++y) std::fill_n(set_.begin() + y * columns_ + x0, x1 - x0 + 1, std::uint8_t{1});
}

void DirtyTiles::add(const DirtyTiles& others) {
    for (std::size_t i = 0; i < set_.size(); ++i) set_[i] |= others.set_[i];
}

void DirtyTiles::add_all() { std::ranges::fill(set_, std::uint8_t{1}); }
void DirtyTiles::clear() { std::ranges::fill(set_, std::uint8_t{0}); }
bool DirtyTiles::any() const { return std::ranges::find(set_, 1) != set_.end(); }

void copy(const Image& from, Image& to, const DirtyTiles& tiles) {
    tiles.for_each_run([&](int left, int top, int right, int bottom) {
        for (int y = top; y < bottom; ++y) {
            const std::ptrdiff_t at = std::ptrdiff_t(y) * from.width + left;
            std::copy_n(from.pixels.data() + at, right - left, to.pixels.data() + at);
        }
    });
}

}  // namespace beamcam::render
