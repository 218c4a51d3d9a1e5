// The pixel formats of frames for encoders.
#pragma once

#include "output/film/palette.hpp"
#include "output/film/video_library.hpp"
#include "render/draw/image.hpp"

namespace beamcam::output {

// Writes `part` of the picture into the frame. `table`: only for `indices`.
void convert(const render::Image& image, PixelLayout layout, const PaletteTable* table, const FramePlanes& frame,
             const render::DirtyTiles& part);

}  // namespace beamcam::output
