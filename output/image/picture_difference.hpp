// The difference of two pictures of the same size, in numbers and as a picture.
#pragma once

#include <algorithm>
#include <cstddef>

#include "output/image/raster.hpp"

namespace beamcam::output {

struct PixelBox {  // [px], right and bottom not included
    int left = 0, top = 0, right = 0, bottom = 0;
    bool empty() const { return right <= left; }
    int width() const { return right - left; }
    int height() const { return bottom - top; }
    void add(int x, int y) {
        *this = empty()
                    ? PixelBox{x, y, x + 1, y + 1}
                    : PixelBox{std::min(left, x), std::min(top, y), std::max(right, x + 1), std::max(bottom, y + 1)};
    }
};

struct PictureDifference {
    std::size_t pixels = 0;
    std::size_t changed = 0;  // pixels with a channel that differs by more than the threshold
    int largest = 0;          // largest difference of a channel, 0…255
    PixelBox box;             // around the changed pixels
    double ssim = 1;          // mean structural similarity of brightness, −1…1

    bool identical() const { return largest == 0; }
    double share() const { return pixels == 0 ? 0 : static_cast<double>(changed) / static_cast<double>(pixels); }
};

// Structural similarity: Z. Wang et al., IEEE Trans. Image Process. 13 (2004) 600, of the brightness (BT.709) over
// white, in windows of 8 × 8 pixels four apart, as in FFmpeg's filter "ssim". Throws std::logic_error if the sizes
// differ.
PictureDifference difference(const Raster& a, const Raster& b, int threshold = 0);

// `a` in pale grey, with changed pixels in vermilion and a frame around them.
Raster difference_picture(const Raster& a, const Raster& b, int threshold = 0);

}  // namespace beamcam::output
