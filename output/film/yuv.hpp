// From picture to film colours: R'G'B' to Y'CbCr of ITU-R BT.709, 8 bits, limited range, 4:2:0 with chroma
// sited in the centre of its four pixels. Exact integer arithmetic: the same bytes on every machine.
//
//     Y'  =  16 + 219 (0.2126 R' + 0.7152 G' + 0.0722 B')
//     Cb  = 128 + 224 (B' − Y)/1.8556          R', G', B', Y in 0…1
//     Cr  = 128 + 224 (R' − Y)/1.5748
//
// Rounded to nearest; greys have Cb = Cr = 128 exactly. Transparent pixels show over black.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "render/draw/dirty_tiles.hpp"
#include "render/draw/image.hpp"

namespace beamcam::output {

// Planes Y, Cb, Cr of somebody else's memory; the last two are half as wide and high.
struct YuvPlanes {
    std::array<std::uint8_t*, 3> plane{};
    std::array<std::ptrdiff_t, 3> stride{};  // [bytes]
};

// Width and height must be even, and the planes large enough. With `part`, all else stays as it is.
void convert_to_yuv420(const render::Image& image, const YuvPlanes& to, const render::DirtyTiles& part);
void convert_to_yuv420(const render::Image& image, const YuvPlanes& to);

// The same with transparency: colours not premultiplied, and a fourth plane of alpha, 0…255, full range. Chroma is the
// mean of four pixels weighted by their alpha, so that what cannot be seen tints nothing.
struct YuvaPlanes {
    std::array<std::uint8_t*, 4> plane{};
    std::array<std::ptrdiff_t, 4> stride{};  // [bytes]
};
void convert_to_yuva420(const render::Image& image, const YuvaPlanes& to, const render::DirtyTiles& part);
void convert_to_yuva420(const render::Image& image, const YuvaPlanes& to);

// 4:4:4 in 10 bits (16-bit words, native order), limited range, with 10 bits of full-range alpha.
void convert_to_yuva444p10(const render::Image& image, const YuvaPlanes& to, const render::DirtyTiles& part);
void convert_to_yuva444p10(const render::Image& image, const YuvaPlanes& to);

}  // namespace beamcam::output
