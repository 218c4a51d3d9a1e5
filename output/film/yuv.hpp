// Colour conversion for films: R'G'B' to Y'CbCr of ITU-R BT.709, 8 bits, limited range, 4:2:0 with chroma sited in the
// centre of its four pixels. Integer arithmetic: the same bytes on every machine.
//
//     Y'  =  16 + 219 (0.2126 R' + 0.7152 G' + 0.0722 B')
//     Cb  = 128 + 224 (B' − Y)/1.8556          R', G', B', Y in 0…1
//     Cr  = 128 + 224 (R' − Y)/1.5748
//
// Rounded to nearest; greys have Cb = Cr = 128 exactly. Transparent pixels show over black.
#pragma once

#include "output/film/video_library.hpp"
#include "render/draw/dirty_tiles.hpp"
#include "render/draw/image.hpp"

namespace beamcam::output {

// Each function writes `part` of the image into the planes Y, Cb, Cr of the frame. 4:2:0 needs even width and height;
// its chroma planes have half the width and height.
void convert_to_yuv420(const render::Image& image, const FramePlanes& to, const render::DirtyTiles& part);

// Converts with transparency: colours not premultiplied, and a fourth plane of alpha, 0…255, full range. Chroma is the
// mean of four pixels weighted by their alpha, so that invisible pixels have no influence.
void convert_to_yuva420(const render::Image& image, const FramePlanes& to, const render::DirtyTiles& part);

// 4:4:4 in 10 bits (16-bit words, native order), limited range, with 10 bits of full-range alpha.
void convert_to_yuva444p10(const render::Image& image, const FramePlanes& to, const render::DirtyTiles& part);

}  // namespace beamcam::output
