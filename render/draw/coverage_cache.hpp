// Coverage of the shapes that a film draws again where they were: the arrow of the cam, the hub, every piece of the
// tip's trail. Finding out which part of each pixel a path covers costs far more than painting it; a path that the
// picture before had at the same place is painted through what was found out then. The pixels are those that Cairo
// paints: its formulas for opaque and for translucent colours, rounding included.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <unordered_map>
#include <vector>

#include "render/draw/color.hpp"
#include "render/draw/geometry.hpp"

using cairo_t = struct _cairo;  // NOLINT(bugprone-reserved-identifier): the library's own name

namespace beamcam::render {

class CoverageCache {
  public:
    // Whether the Cairo and pixman that run paint as these formulas say: tried once in a process, on a small picture.
    // Where they do not, a film is drawn without stencils, so that its pixels never depend on what was drawn before.
    static bool exact();

    // Paints the shape called `key` over the image surface of `cr` if it was painted in an earlier picture and in every
    // one since; false: the caller has to. The key names everything that coverage depends on. `box` holds all of it
    // [px]; `ink` paints the shape with any source.
    bool paint(const std::string& key, const Box& box, Color color, cairo_t* cr,
               const std::function<void(cairo_t*)>& ink);
    // What the last picture did not show is forgotten.
    void next_picture();

  private:
    // Rows of coverage from (x, y) on, 255: all of the pixel.
    struct Stencil {
        int x = 0, y = 0, width = 0, height = 0, stride = 0;  // [px]
        std::vector<std::uint8_t> cover;                      // empty: not yet worth it
    };
    struct Known {
        long picture = 0;  // that showed it last
        long first = 0;
        Stencil stencil;
    };
    static Stencil stencil_of(const Box& box, cairo_t* cr, const std::function<void(cairo_t*)>& ink);
    static void paint(const Stencil& stencil, Color color, cairo_t* cr);

    long picture_ = 0;
    std::unordered_map<std::string, Known> known_;
};

}  // namespace beamcam::render
