// 256 colours for a film, and the way from pixels to them.
//
// The colours are found once, from a few frames, so that nothing flickers: by median cut on a histogram of 5 bits a
// channel, in which rare colours weigh more than their area, then by Lloyd's steps to the means of their pixels; a
// table of 64³ cells, with the few colours that are nearest to any place in each, turns pixels into the indices of
// their nearest colours, one picture at a time. Transparent pixels show over white.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
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
    std::vector<std::uint32_t> colors() const;  // 0xffRRGGBB, at most 256, those of frequent flat areas exact

  private:
    struct Cell {
        double count = 0, r = 0, g = 0, b = 0;
    };
    std::vector<std::uint32_t> frequent() const;
    void refine(std::vector<std::uint32_t>& colors, std::size_t fixed) const;
    std::vector<Cell> cells_;                 // 32³
    std::vector<std::uint32_t> seen_colors_;  // flat colours, and how often
    std::vector<std::uint64_t> seen_counts_;
    std::unordered_map<std::uint32_t, std::uint64_t> all_;  // colours, and how often
};

class PaletteTable {
  public:
    explicit PaletteTable(std::span<const std::uint32_t> colors);  // 1 to 256
    // One byte a pixel, rows of `stride` bytes; what is not of the part stays.
    void convert(const render::Image& image, std::uint8_t* to, std::ptrdiff_t stride,
                 const render::DirtyTiles& part) const;
    void convert(const render::Image& image, std::uint8_t* to, std::ptrdiff_t stride) const;

  private:
    std::uint8_t index_of(std::uint32_t pixel) const;
    struct Cell {
        std::uint32_t first = 0;  // in `candidates_`
        std::uint16_t count = 0;
    };
    std::vector<std::uint32_t> colors_;
    std::vector<Cell> cells_;               // 64³: by the upper 6 bits of each channel
    std::vector<std::uint8_t> candidates_;  // of each cell: the colours that are nearest to a place in it
};

}  // namespace beamcam::output
