// A palette of 256 colours for a film, and the conversion of pixels to it.
//
// The colours are computed once, from a few frames, so that the film does not flicker: by median cut of all colours, in
// which small areas weigh more, then by Lloyd's iteration. For the conversion, each of 64³ cells of the
// colour cube lists the few colours that can be nearest in it. Transparent pixels show over white.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "render/draw/dirty_tiles.hpp"
#include "render/draw/image.hpp"

namespace beamcam::output {

class PaletteMaker {
  public:
    void add(const render::Image& image);
    std::vector<std::uint32_t> colors() const;  // 0xffRRGGBB, at most 256; exact colours of large flat areas

  private:
    void refine(std::vector<std::uint32_t>& colors, std::size_t fixed) const;
    std::map<std::uint32_t, std::uint64_t> counts_;  // of all colours, over white
    std::uint64_t pixels_ = 0;
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
