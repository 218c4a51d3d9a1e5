// Images as sources of Cairo. Seen by what draws with Cairo alone.
#pragma once

#include <cairo.h>

#include "render/draw/image.hpp"

namespace beamcam::render {

// To be destroyed by the caller, while the image lives.
inline cairo_surface_t* surface_of(const Image& image) {
    // Cairo writes only through surfaces that are drawn to; sources are read.
    auto* bytes = reinterpret_cast<unsigned char*>(const_cast<std::uint32_t*>(image.pixels.data()));
    return cairo_image_surface_create_for_data(bytes, CAIRO_FORMAT_ARGB32, image.width, image.height, 4 * image.width);
}

}  // namespace beamcam::render
