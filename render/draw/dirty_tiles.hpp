// The changed part of a picture as a set of tiles, small enough to follow a slanted beam. The next picture restores,
// draws and converts these tiles only.
#pragma once

#include <cstdint>
#include <vector>

#include "render/draw/geometry.hpp"
#include "render/draw/image.hpp"

namespace beamcam::render {

class DirtyTiles {
  public:
    // Even, so that the four pixels of a chroma sample lie in one tile; rows of 128 bytes.
    static constexpr int kWidth = 32, kHeight = 16;  // [px]

    DirtyTiles() = default;
    DirtyTiles(int width, int height);  // of the picture [px]; the set is empty

    // Adds the tiles that the box intersects within the picture; all tiles if the box contains a NaN.
    void add(const Box& box);
    void add(const DirtyTiles& others);  // of a picture of the same size
    void add_all();
    void clear();
    bool any() const;

    // Calls take(left, top, right, bottom) for each run of neighbouring tiles in a row, clipped to the picture.
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

// Copies the pixels within the tiles. All three have the same size.
void copy(const Image& from, Image& to, const DirtyTiles& tiles);

}  // namespace beamcam::render
