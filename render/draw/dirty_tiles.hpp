// Where a picture was painted: a set of tiles, small enough to follow a slanted beam. What moves is remembered in
// tiles, so that the next picture restores, draws and converts those and nothing else.
#pragma once

#include <cstdint>
#include <vector>

#include "render/draw/geometry.hpp"
#include "render/draw/image.hpp"

namespace beamcam::render {

class DirtyTiles {
  public:
    // Even, so that the four pixels of one chroma sample lie in one tile; rows of 128 bytes.
    static constexpr int kWidth = 32, kHeight = 16;  // [px]

    DirtyTiles() = default;
    DirtyTiles(int width, int height);  // of the picture [px]; empty

    // The tiles that the box meets; those beyond the picture do not exist. Anything but numbers: all tiles.
    void add(const Box& box);
    void add(const DirtyTiles& others);  // of a picture of the same size
    void add_all();
    void clear();
    bool any() const;

    // The tiles as rectangles within the picture, neighbours in a row as one: take(left, top, right, bottom).
    template <typename Take>
    void for_each_run(Take&& take) const {
        for (int row = 0; row < rows_; ++row) {
            const std::uint8_t* set = set_.data() + row * columns_;
            for (int from = 0; from < columns_; ++from) {
                if (!set[from]) continue;
                int to = from + 1;
                while (to < columns_ && set[to]) ++to;
                take(from * kWidth, row * kHeight, std::min(to * kWidth, width_),
                     std::min((row + 1) * kHeight, height_));
                from = to;
            }
        }
    }

  private:
    int width_ = 0, height_ = 0, columns_ = 0, rows_ = 0;
    std::vector<std::uint8_t> set_;  // 0 or 1, rows top to bottom
};

// Makes `to` what `from` is, within the tiles. All three are of one size.
void copy(const Image& from, Image& to, const DirtyTiles& tiles);

}  // namespace beamcam::render
