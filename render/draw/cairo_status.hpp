// Cairo keeps the first error of a context and then draws nothing more: unchecked, it would be a wrong picture.
#pragma once

#include <cairo.h>
#include <fmt/format.h>

#include <new>
#include <stdexcept>

namespace beamcam::render {

// Throws std::bad_alloc for want of memory, else std::runtime_error.
inline void require_success(cairo_status_t status) {
    if (status == CAIRO_STATUS_SUCCESS) return;
    if (status == CAIRO_STATUS_NO_MEMORY) throw std::bad_alloc();
    throw std::runtime_error(fmt::format("Cairo could not draw a picture: {}", cairo_status_to_string(status)));
}

}  // namespace beamcam::render
