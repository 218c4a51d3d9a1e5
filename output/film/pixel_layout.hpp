// The pixels of frames for encoders. Films in colour differences: R'G'B' to Y'CbCr of ITU-R BT.709, 8 bits, limited
// range, 4:2:0 with chroma sited in the centre of its four pixels. Integer arithmetic: the same bytes on every machine.
//
//     Y'  =  16 + 219 (0.2126 R' + 0.7152 G' + 0.0722 B')
//     Cb  = 128 + 224 (B' − Y)/1.8556          R', G', B', Y in 0…1
//     Cr  = 128 + 224 (R' − Y)/1.5748
//
// Rounded to nearest; greys have Cb = Cr = 128 exactly. Transparent pixels show over black.
//
// With alpha colours are not premultiplied, and a fourth plane has alpha in full range. In 4:2:0 chroma is the mean of
// four pixels weighted by their alpha, so that invisible pixels have no influence. 4:4:4 has 10 bits in 16-bit words of
// native order.
#pragma once

#include "output/film/palette.hpp"
#include "output/film/video_library.hpp"
#include "render/draw/image.hpp"

namespace beamcam::output {

// Writes `part` of the picture into the frame. 4:2:0 needs even width and height; its chroma planes have half of them.
// `table`: only for `indices`.
void convert(const render::Image& image, PixelLayout layout, const PaletteTable* table, const FramePlanes& to,
             const render::DirtyTiles& part);

}  // namespace beamcam::output
