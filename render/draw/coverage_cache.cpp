#include "render/draw/coverage_cache.hpp"

#include <cairo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "render/draw/blend.hpp"
#include "render/draw/cairo_support.hpp"

namespace beamcam::render {
namespace {

constexpr int kProbe = 24;  // [px]
using Probe = std::array<std::uint32_t, kProbe * kProbe>;

// Opaque and translucent pixels, premultiplied.
Probe probe_pixels() {
    Probe pixels{};
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const auto any = static_cast<std::uint32_t>(i * 2654435761U >> 7);
        pixels[i] = times(any | 0xff000000U, i % 3 == 0 ? any >> 16 & 0xff : 255, kPixmanHalf);
    }
    return pixels;
}

template <class Draw>
Probe probed(const Draw& draw) {
    Probe pixels = probe_pixels();
    cairo_surface_t* surface = cairo_image_surface_create_for_data(reinterpret_cast<unsigned char*>(pixels.data()),
                                                                   CAIRO_FORMAT_ARGB32, kProbe, kProbe, kProbe * 4);
    cairo_t* cr = cairo_create(surface);
    cairo_move_to(cr, 3.3, 5.9);
    cairo_curve_to(cr, 30.1, 2.2, 7.7, 16.4, 19.6, 21.2);
    cairo_line_to(cr, 5.1, 18.7);
    draw(cr);
    cairo_destroy(cr);
    cairo_surface_finish(surface);
    cairo_surface_destroy(surface);
    return pixels;
}

}  // namespace

bool CoverageCache::exact() {
    static const bool all_same = [] {
        for (const double alpha : {1.0, 0.93, 0.5, 0.14, 0.01})
            for (const bool stroke : {false, true}) {
                if (!stroke && alpha < 1) continue;  // translucent fills are never cached
                const Color color{0.84, 0.37, 0.09, alpha};
                const auto ink = [&](cairo_t* cr) {
                    cairo_set_line_width(cr, 2.7);
                    stroke ? cairo_stroke_preserve(cr) : cairo_fill_preserve(cr);
                };
                const Probe theirs = probed([&](cairo_t* cr) {
                    cairo_set_source_rgba(cr, color.r, color.g, color.b, color.a);
                    ink(cr);
                });
                const Probe ours = probed([&](cairo_t* cr) {
                    paint(stencil_of({0, 0, kProbe, kProbe}, cr, ink), color, cr);
                });
                if (ours != theirs) return false;
            }
        return true;
    }();
    return all_same;
}

bool CoverageCache::paint(const std::string& key, const Box& box, Color color, cairo_t* cr,
                          const std::function<void(cairo_t*)>& ink) {
    const auto [at, fresh] = entries_.try_emplace(key);
    Entry& known = at->second;
    known.picture = picture_;
    if (fresh) known.first = picture_;
    if (known.first == picture_) return false;
    if (known.stencil.cover.empty()) known.stencil = stencil_of(box, cr, ink);
    if (known.stencil.cover.empty()) return false;
    paint(known.stencil, color, cr);
    return true;
}

void CoverageCache::next_picture() {
    std::erase_if(entries_, [&](const auto& entry) { return entry.second.picture < picture_; });
    ++picture_;
}

// Draws Cairo's path displaced by whole pixels, which changes neither its coordinates nor their coverage.
CoverageCache::Stencil CoverageCache::stencil_of(const Box& box, cairo_t* cr,
                                                 const std::function<void(cairo_t*)>& ink) {
    if (std::isnan(box.x + box.y + box.right() + box.bottom())) return {};
    cairo_surface_t* picture = cairo_get_target(cr);
    Stencil s;
    const double width = cairo_image_surface_get_width(picture), height = cairo_image_surface_get_height(picture);
    const double x0 = std::clamp(std::floor(box.x), 0.0, width), y0 = std::clamp(std::floor(box.y), 0.0, height);
    s.x = static_cast<int>(x0);
    s.y = static_cast<int>(y0);
    s.width = static_cast<int>(std::clamp(std::ceil(box.right()), x0, width) - x0);
    s.height = static_cast<int>(std::clamp(std::ceil(box.bottom()), y0, height) - y0);
    if (s.width == 0 || s.height == 0) return {};
    s.stride = cairo_format_stride_for_width(CAIRO_FORMAT_A8, s.width);
    s.cover.resize(static_cast<std::size_t>(s.stride) * static_cast<std::size_t>(s.height));
    cairo_surface_t* surface =
        cairo_image_surface_create_for_data(s.cover.data(), CAIRO_FORMAT_A8, s.width, s.height, s.stride);
    cairo_surface_set_device_offset(surface, -x0, -y0);
    cairo_t* own = cairo_create(surface);
    cairo_path_t* path = cairo_copy_path(cr);
    cairo_append_path(own, path);
    cairo_path_destroy(path);
    cairo_set_line_join(own, cairo_get_line_join(cr));
    ink(own);
    const cairo_status_t status = cairo_status(own);
    cairo_destroy(own);
    cairo_surface_finish(surface);
    cairo_surface_destroy(surface);
    require_success(status);
    return s;
}

void CoverageCache::paint(const Stencil& s, Color color, cairo_t* cr) {
    cairo_surface_t* picture = cairo_get_target(cr);
    cairo_surface_flush(picture);
    unsigned char* bytes = cairo_image_surface_get_data(picture);
    const std::ptrdiff_t stride = cairo_image_surface_get_stride(picture);
    const std::uint32_t ink = pixel_of(color);
    const bool opaque = ink >> 24 == 255;
    for (int row = 0; row < s.height; ++row) {
        const std::uint8_t* cover = s.cover.data() + std::ptrdiff_t(row) * s.stride;
        auto* pixels = reinterpret_cast<std::uint32_t*>(bytes + (s.y + row) * stride) + s.x;
        for (int x = 0; x < s.width; ++x) {
            if (x + 8 <= s.width) {
                std::uint64_t eight = 0;
                std::memcpy(&eight, cover + x, sizeof eight);
                if (eight == 0) {
                    x += 7;
                    continue;
                }
            }
            const std::uint32_t part = cover[x];
            if (part == 0) continue;
            if (opaque) {
                pixels[x] = over(ink, part, pixels[x]);
            } else {
                const std::uint32_t source = times(ink, part, kPixmanHalf);
                pixels[x] = sum(source, times(pixels[x], 255 - (source >> 24), kPixmanHalf));
            }
        }
    }
    cairo_surface_mark_dirty(picture);
}

}  // namespace beamcam::render
