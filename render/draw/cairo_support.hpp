// Images as Cairo surfaces, and Cairo's errors. Included only by files that call Cairo.
#pragma once

#include <cairo.h>
#include <fmt/format.h>

#include <new>
#include <stdexcept>

#include "render/draw/image.hpp"

namespace beamcam::render {

// The caller destroys it while the image still exists.
inline cairo_surface_t* surface_of(const Image& image) {
    // Cairo writes only through surfaces that are drawn to; sources are read.
    auto* bytes = reinterpret_cast<unsigned char*>(const_cast<std::uint32_t*>(image.pixels.data()));
    return cairo_image_surface_create_for_data(bytes, CAIRO_FORMAT_ARGB32, image.width, image.height, 4 * image.width);
}

// Cairo stores the first error of a context and then draws nothing more; an unchecked error would give a wrong picture.
// Throws std::bad_alloc if memory ran out, otherwise std::runtime_error.
inline void require_success(cairo_status_t status) {
    if (status == CAIRO_STATUS_SUCCESS) return;
    if (status == CAIRO_STATUS_NO_MEMORY) throw std::bad_alloc();
    throw std::runtime_error(fmt::format("Cairo could not draw a picture: {}", cairo_status_to_string(status)));
}

}  // namespace beamcam::render
