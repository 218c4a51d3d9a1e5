#include "render/draw/canvas.hpp"

#include <cairo.h>
#include <fmt/format.h>
#include <pango/pangocairo.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "render/draw/cairo_support.hpp"
#include "render/draw/letters.hpp"

namespace beamcam::render {

namespace {

// Blends the source, with its corner at (x, y), within rectangles of whole pixels.
void blend(cairo_t* cr, const Image& source, int x, int y, std::span<const Box> within) {
    cairo_surface_t* surface = surface_of(source);
    cairo_set_source_surface(cr, surface, x, y);
    cairo_pattern_set_filter(cairo_get_source(cr), CAIRO_FILTER_NEAREST);
    for (const Box& b : within)
        if (!b.empty()) cairo_rectangle(cr, b.x, b.y, b.w, b.h);
    cairo_fill(cr);
    cairo_surface_destroy(surface);
}

// Rounded outwards to whole pixels within the source.
Box whole_part(const Image& source, const Box& part) {
    const double x0 = std::clamp(std::floor(part.x), 0.0, double(source.width));
    const double y0 = std::clamp(std::floor(part.y), 0.0, double(source.height));
    const double x1 = std::clamp(std::ceil(part.right()), x0, double(source.width));
    const double y1 = std::clamp(std::ceil(part.bottom()), y0, double(source.height));
    return {x0, y0, x1 - x0, y1 - y0};
}

}  // namespace

Canvas::Canvas(Image& image, const Fonts& fonts) : Painter(fonts), width_(image.width), height_(image.height) {
    begin(surface_of(image), fmt::format("a picture of {}×{} pixels", width_, height_));
}
Canvas::Canvas(VectorFile& file, int width, int height, const Fonts& fonts)
    : Painter(fonts), width_(width), height_(height), is_vector_(true) {
    begin(file.surface(), fmt::format("a drawing of {}×{} pixels", width_, height_));
    const double unit = file.unit() * kPointsPerPixel;
    cairo_scale(cr_, unit, unit);
}
Canvas::~Canvas() noexcept(false) { end(); }

void Canvas::rounded(const Box& b, double r) {
    constexpr double q = std::numbers::pi / 2;
    cairo_new_sub_path(cr_);
    cairo_arc(cr_, b.right() - r, b.y + r, r, -q, 0);
    cairo_arc(cr_, b.right() - r, b.bottom() - r, r, 0, q);
    cairo_arc(cr_, b.x + r, b.bottom() - r, r, q, 2 * q);
    cairo_arc(cr_, b.x + r, b.y + r, r, 2 * q, 3 * q);
    cairo_close_path(cr_);
}

void Canvas::paint(Color c) {
    set_source(c);
    cairo_paint(cr_);
    if (touched) touched->add_all();
}

void Canvas::fill_piece(std::span<const Vec2> corners, Color color) {
    polyline(corners);
    close();
    if (is_vector_) {
        fill_keeping_path(color);
        return stroke({color, 0.3});
    }
    mark_path(0);
    set_source(color);
    cairo_set_antialias(cr_, CAIRO_ANTIALIAS_NONE);
    cairo_fill(cr_);
    cairo_set_antialias(cr_, CAIRO_ANTIALIAS_DEFAULT);
}

void Canvas::image_part(const Image& source, int x, int y, const Box& part) {
    const Box b = whole_part(source, part), there{b.x + x, b.y + y, b.w, b.h};
    blend(cr_, source, x, y, {&there, 1});
    set_source({});
    if (!there.empty()) mark_painted(there);
}

void Canvas::image_tiles(const Image& source, int x, int y, const DirtyTiles& tiles) {
    std::vector<Box> runs;
    tiles.for_each_run([&](int left, int top, int right, int bottom) {
        const int x0 = std::max(left, x), y0 = std::max(top, y);
        const int x1 = std::min(right, x + source.width), y1 = std::min(bottom, y + source.height);
        runs.push_back({double(x0), double(y0), double(x1 - x0), double(y1 - y0)});
    });
    blend(cr_, source, x, y, runs);
    set_source({});
    if (touched) touched->add(tiles);
}

// Glyphs of images are placed at whole pixels. Cairo rounds points to 1/256 px first; the runs of a text share this
// rounding, else they might be in different rows.
Vec2 Canvas::rounded_start(Vec2 at, const SetLabel& label, const TextStyle& style) {
    if (is_vector_) return at;
    double baseline = 0;
    for (const SetRun& run : label.runs) baseline = std::max(baseline, baseline_of(layout_of(*fonts_, run, style)));
    cairo_move_to(cr_, at.x, at.y - baseline);
    cairo_get_current_point(cr_, &at.x, &at.y);
    cairo_new_path(cr_);
    return at + Vec2{0, baseline};
}

void Canvas::write(const SetRun& run, Vec2 at, const TextStyle& style) {
    if (is_vector_) return Painter::write(run, at, style);
    cairo_move_to(cr_, at.x, std::floor(at.y + 0.5));
    pango_cairo_show_layout_line(cr_, pango_layout_get_line_readonly(layout_of(*fonts_, run, style), 0));
    new_path();
}

Box Canvas::text(Vec2 at, std::string_view markup, const TextStyle& style) {
    const SetLabel label = set_text(*fonts_, markup, style);
    if (style.align != HAlign::left) at.x -= label.width * (style.align == HAlign::centre ? 0.5 : 1);
    Box ink = label.ink.box();
    ink.x += at.x, ink.y += at.y;
    std::optional<Color> halo = style.halo;
    if (halo_of_all) halo = halo_of_all->faded(style.color.a);
    if (halo && halo->faded(0) == style.color.faded(0))
        halo.reset();  // a halo of the same colour would only thicken the letters
    if (halo) draw_halo(label, at, style, *halo);
    draw_label(label, rounded_start(at, label, style), style);
    mark_painted(ink.inset(halo ? -1 - halo_width(style) / 2 : -1));
    if (record && !label.runs.empty()) record->push_back(ink);
    return {at.x, ink.y, label.width, ink.h};
}

Box Canvas::measure(std::string_view markup, const TextStyle& style) const {
    const SetLabel label = set_text(*fonts_, markup, style);
    return {0, label.ink.box().y, label.width, label.ink.box().h};
}

std::string first_that_fits(Canvas& canvas, std::initializer_list<std::string> texts, const TextStyle& style,
                            double room) {
    for (const std::string& text : texts)
        if (canvas.measure(text, style).w <= room) return text;
    return *(texts.end() - 1);
}

}  // namespace beamcam::render
