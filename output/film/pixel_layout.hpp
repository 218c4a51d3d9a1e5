// How the pixels of a frame lie in memory for its encoder.
#pragma once

#include "output/film/palette.hpp"
#include "output/film/video_library.hpp"
#include "render/draw/image.hpp"

namespace beamcam::output {

enum class PixelLayout { yuv420, yuva420, yuva444p10, bgra, rgba, rgb, indices };

// Writes `part` of the picture into the frame. `table`: of a film of indices; else unused.
void convert(const render::Image& image, PixelLayout layout, const PaletteTable* table, const FramePlanes& frame,
             const render::DirtyTiles& part);

}  // namespace beamcam::output
