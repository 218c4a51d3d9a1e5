// A palette of 256 colours for a film, and the conversion of pixels to it.
//
// The colours are computed once, from a few frames, so that the film does not flicker: by median cut of a histogram
// with 5 bits per channel, in which rare colours weigh more than their area, then by Lloyd's iteration. For the
// conversion, each of 64³ cells of the colour cube lists the few colours that can be nearest in it. Transparent pixels
// show over white.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <unordered_map>
#include <vector>

#include "render/draw/dirty_tiles.hpp"
#include "render/draw/image.hpp"

namespace beamcam::output {

class PaletteMaker {
  public:
    PaletteMaker();
    void add(const render::Image& image);
    std::vector<std::uint32_t> colors() const;  // 0xffRRGGBB, at most 256; exact colours of large flat areas

  private:
    struct Cell {
        double count = 0, r = 0, g = 0, b = 0;
    };
    std::vector<std::uint32_t> frequent() const;
    void refine(std::vector<std::uint32_t>& colors, std::size_t fixed) const;
    std::vector<Cell> cells_;                               // 32³
    std::map<std::uint32_t, std::uint64_t> frequent_;       // counts of the colours of flat areas
    std::unordered_map<std::uint32_t, std::uint64_t> all_;  // counts of all colours
};

class PaletteTable {
  public:
    explicit PaletteTable(std::span<const std::uint32_t> colors);  // 1 to 256
    // One byte per pixel, rows of `stride` bytes; writes only `part`.
    void convert(const render::Image& image, std::uint8_t* to, std::ptrdiff_t stride,
                 const render::DirtyTiles& part) const;

  private:
    std::uint8_t index_of(std::uint32_t pixel) const;
    struct Cell {
        std::uint32_t first = 0;  // in `candidates_`
        std::uint16_t count = 0;
    };
    std::vector<std::uint32_t> colors_;
    std::vector<Cell> cells_;               // 64³: by the upper 6 bits of each channel
    std::vector<std::uint8_t> candidates_;  // of each cell: the colours that are nearest somewhere in it
};

}  // namespace beamcam::output
