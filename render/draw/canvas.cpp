#include "render/draw/canvas.hpp"

#include <cairo.h>
#include <fmt/format.h>
#include <pango/pangocairo.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "render/draw/cairo_support.hpp"
#include "render/draw/font_handles.hpp"
#include "render/draw/formula.hpp"

namespace beamcam::render {

std::string escape(std::string_view plain) {
    char* escaped = g_markup_escape_text(plain.data(), static_cast<gssize>(plain.size()));
    std::string out = escaped;
    g_free(escaped);
    return out;
}

// At 112 % the x-height of STIX equals that of Inter.
std::string math(std::string_view symbol) {
    return fmt::format("<span face='STIXGeneral,STIX Two Text' style='italic' weight='normal' size='112%'>{}</span>",
                       symbol);
}

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

// Tabular digits, so that changing numbers do not jitter.
LetterFace face_of(const TextStyle& style) {
    return {.family = "Inter,STIXGeneral,STIX Two Text,Noto Sans CJK SC",
            .size = style.size,
            .weight = style.weight,
            .tabular = true,
            .max_width = style.max_width};
}

constexpr double kHalo = 0.30,
                 kOutline = 0.18;  // widths relative to the size: of a text's own halo, and of the outline of all texts

struct Metrics {
    Box ink;          // relative to the baseline's start
    double advance;   // [px]
    double baseline;  // from the layout's top
};

Metrics metrics(PangoLayout* layout) {
    PangoRectangle ink, logical;
    pango_layout_get_extents(layout, &ink, &logical);
    const double k = 1.0 / PANGO_SCALE, baseline = pango_layout_get_baseline(layout) * k;
    return {{ink.x * k, ink.y * k - baseline, ink.width * k, ink.height * k}, logical.width * k, baseline};
}

}  // namespace

Canvas::Canvas(Image& image, const Fonts& fonts) : image_(image), fonts_(fonts) {
    begin(surface_of(image), fmt::format("a picture of {}×{} pixels", image.width, image.height));
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
    add_to_key('O', {b.x, b.y, b.w, b.h, r});
    extend_path_box(b);
}

void Canvas::paint(Color c) {
    set_source(c);
    cairo_paint(cr_);
    if (touched) touched->add_all();
}

namespace {
// Rounded outwards to whole pixels within the source.
Box whole_part(const Image& source, const Box& part) {
    const double x0 = std::clamp(std::floor(part.x), 0.0, double(source.width));
    const double y0 = std::clamp(std::floor(part.y), 0.0, double(source.height));
    const double x1 = std::clamp(std::ceil(part.right()), x0, double(source.width));
    const double y1 = std::clamp(std::ceil(part.bottom()), y0, double(source.height));
    return {x0, y0, x1 - x0, y1 - y0};
}
}  // namespace

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

void Canvas::replace_part(const Image& source, int x, int y, const Box& part) {
    cairo_set_operator(cr_, CAIRO_OPERATOR_SOURCE);
    image_part(source, x, y, part);
    cairo_set_operator(cr_, CAIRO_OPERATOR_OVER);
}

void Canvas::paint_pixels(const std::function<void(const PixelView&, DirtyTiles*)>& paint) {
    if (limit_) throw std::logic_error("Canvas::paint_pixels: not allowed within a clip");
    cairo_surface_t* surface = cairo_get_target(cr_);
    cairo_surface_flush(surface);
    auto* pixels = reinterpret_cast<std::uint32_t*>(cairo_image_surface_get_data(surface));
    paint({pixels, image_.width, image_.height, image_.width}, touched);
    cairo_surface_mark_dirty(surface);
}

std::string Canvas::drawable(std::string_view plain) const {
    std::string out;
    const char* end = plain.data() + plain.size();
    for (const char* at = plain.data(); at < end; at = g_utf8_next_char(at)) {
        const gunichar character = g_utf8_get_char_validated(at, end - at);
        if (character >= gunichar(-2)) break;  // invalid UTF-8, which the scene reader has already rejected
        const std::string one(at, static_cast<std::size_t>(g_utf8_next_char(at) - at));
        // Joiners and variation selectors are not visible.
        if (character == 0x200D || (character >= 0xFE00 && character <= 0xFE0F)) continue;
        if (character >= 0x80) {
            if (pango_layout_get_unknown_glyphs_count(layout_of(fonts_, face_of({}), escape(one))) > 0) continue;
        }
        out += one;
    }
    return out;
}

Box Canvas::text(Vec2 baseline, const std::string& markup, const TextStyle& style) {
    if (markup.empty()) return {baseline.x, baseline.y, 0, 0};
    if (has_formula(markup)) {
        if (style.align != HAlign::left)
            baseline.x -= set_parts({}, markup, style, false).w * (style.align == HAlign::centre ? 0.5 : 1);
        return set_parts(baseline, markup, style, true);
    }
    PangoLayout* layout = layout_of(fonts_, face_of(style), markup);
    const Metrics m = metrics(layout);
    double x = baseline.x;
    if (style.align == HAlign::centre) x -= m.advance / 2;
    if (style.align == HAlign::right) x -= m.advance;
    cairo_move_to(cr_, x, baseline.y - m.baseline);
    std::optional<Color> halo = style.halo;
    if (outline) halo = outline->faded(style.color.a);
    const double wide = (outline ? kOutline : kHalo) * style.size;
    if (halo && halo->faded(0) == style.color.faded(0))
        halo.reset();  // a halo of the same colour would only thicken the letters
    if (halo) {
        pango_cairo_layout_path(cr_, layout);
        add_to_key('t', {x, baseline.y}, face_of(style).key(markup));
        extend_path_box({x + m.ink.x, baseline.y + m.ink.y, m.ink.w, m.ink.h});
        uncased([&] { stroke({*halo, wide}); });
        cairo_move_to(cr_, x, baseline.y - m.baseline);
    }
    set_source(style.color);
    pango_cairo_show_layout(cr_, layout);
    new_path();
    const Box ink{x + m.ink.x, baseline.y + m.ink.y, m.ink.w, m.ink.h};
    mark_painted(ink.inset(halo ? -1 - wide / 2 : -1));  // glyphs are placed at whole pixels
    if (record) record->push_back(ink);
    return {x, ink.y, m.advance, ink.h};
}

Box Canvas::measure(const std::string& markup, const TextStyle& style) {
    if (has_formula(markup)) return set_parts({}, markup, style, false);
    PangoLayout* layout = layout_of(fonts_, face_of(style), markup);
    const Metrics m = metrics(layout);
    return {0, m.ink.y, m.advance, m.ink.h};
}

std::string first_that_fits(Canvas& canvas, std::initializer_list<std::string> texts, const TextStyle& style,
                            double room) {
    for (const std::string& text : texts)
        if (canvas.measure(text, style).w <= room) return text;
    return *(texts.end() - 1);
}

}  // namespace beamcam::render
