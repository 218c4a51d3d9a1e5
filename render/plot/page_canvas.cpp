#include "render/plot/page_canvas.hpp"

#include <cairo.h>
#include <fmt/format.h>
#include <pango/pangocairo.h>

#include <cmath>
#include <numbers>

#include "render/base/error.hpp"
#include "render/draw/cairo_support.hpp"
#include "render/draw/letters.hpp"
#include "render/plot/style.hpp"

namespace beamcam::render::figure {
namespace {

constexpr double kLargestSide = 16384;  // [px]: a picture beyond it is a mistake, and 1 GB

}  // namespace

PageCanvas::PageCanvas(Medium medium, const Paper& paper, const Fonts& fonts, const Document& document)
    : Painter(fonts), medium_(medium), paper_(paper) {
    if (paper.dark) recolor_ = on_dark;
    const double scale = paper.dpi / kPointsPerInch;
    const std::string what =
        fmt::format("a figure of {:.4g} × {:.4g} mm", paper.width / points(1), paper.height / points(1));
    if (!(paper.width > 0 && paper.height > 0 && std::max(paper.width, paper.height) * scale <= kLargestSide))
        throw PictureError(
            fmt::format("{} at {:g} dpi cannot be drawn; its sides must be positive and at most {:g} pixels", what,
                        paper.dpi, kLargestSide));
    double unit = 1;  // device units of a point
    if (medium == Medium::png) {
        // Rounded up to cover the page.
        image_ = Image(static_cast<int>(std::ceil(paper.width * scale - 1e-6)),
                       static_cast<int>(std::ceil(paper.height * scale - 1e-6)));
        unit = scale;
        begin(surface_of(image_), what);
    } else {
        file_.emplace(medium, paper.width, paper.height, document);
        unit = file_->unit();
        begin(file_->surface(), what);
    }
    cairo_scale(cr_, unit, unit);
    set_source(rgb(0xFFFFFF));
    cairo_paint(cr_);
}
PageCanvas::~PageCanvas() noexcept(false) { end(); }

// A quarter of a pixel, or of the 1/600 inch of a good printer.
double PageCanvas::grain() const { return kPointsPerInch / (4 * (medium_ == Medium::png ? paper_.dpi : 600)); }

void PageCanvas::curve(std::span<const Vec2> points, const Pen& pen) {
    // Cairo's rasterizer tracks all edges of a path in every row, so a long path is drawn in pieces, whose round ends
    // are the joins. A vector file keeps the path whole.
    constexpr std::size_t kLongPath = 10'000, kPointsOfAPiece = 128;  // points
    if (medium_ != Medium::png || points.size() <= kLongPath || !pen.dash.empty()) return Painter::curve(points, pen);
    const Pen part{pen.color, pen.width, {}, Cap::round};
    for (std::size_t from = 0; from + 1 < points.size(); from += kPointsOfAPiece - 1) {
        polyline(points.subspan(from, std::min(kPointsOfAPiece, points.size() - from)));
        stroke(part);
    }
}

void PageCanvas::gradient(const Box& box, std::span<const Color> colors) {
    cairo_pattern_t* pattern = cairo_pattern_create_linear(0, box.bottom(), 0, box.y);
    for (std::size_t i = 0; i < colors.size(); ++i) {
        const Color color = shown(colors[i]);
        cairo_pattern_add_color_stop_rgb(pattern, static_cast<double>(i) / static_cast<double>(colors.size() - 1),
                                         color.r, color.g, color.b);
    }
    cairo_set_source(cr_, pattern);
    rectangle(box);
    cairo_fill(cr_);
    cairo_pattern_destroy(pattern);
}

// ---- letters -------------------------------------------------------------------------------------

Box PageCanvas::measure(std::string_view markup, const TextStyle& style) const {
    const SetLabel label = set_text(*fonts_, markup, style);
    return {0, -label.ascent, label.width, label.ascent + label.descent};
}

Box PageCanvas::text(Vec2 at, std::string_view markup, const TextStyle& style) {
    const SetLabel label = set_text(*fonts_, markup, style);
    double dx = 0, dy = 0;
    if (style.align == HAlign::centre) dx = -label.width / 2;
    if (style.align == HAlign::right) dx = -label.width;
    if (style.valign == VAlign::top) dy = label.ascent;
    if (style.valign == VAlign::middle) dy = cap_height(style.size) / 2;
    if (style.valign == VAlign::bottom) dy = -label.descent;
    cairo_save(cr_);
    cairo_translate(cr_, at.x, at.y);
    cairo_rotate(cr_, -style.turned);
    // Rounded to Cairo's numbers, 1/256 of a unit, so that the letters of a label keep their distances.
    cairo_move_to(cr_, dx, dy);
    cairo_get_current_point(cr_, &dx, &dy);
    new_path();
    if (style.halo) draw_halo(label, {dx, dy}, style, *style.halo);
    draw_label(label, {dx, dy}, style);
    cairo_restore(cr_);

    // The box around the turned corners.
    Bounds around;
    for (const double x : {dx, dx + label.width})
        for (const double y : {dy - label.ascent, dy + label.descent})
            around.add({at.x + x * std::cos(style.turned) + y * std::sin(style.turned),
                        at.y - x * std::sin(style.turned) + y * std::cos(style.turned)});
    const Box box = around.box();
    if (!label.runs.empty()) written.push_back({box, label.smallest_letter, std::string(markup)});
    return box;
}

// ---- the end -------------------------------------------------------------------------------------

Image PageCanvas::image() {
    end();
    return std::move(image_);
}

std::string PageCanvas::bytes() {
    end();
    return file_->take_bytes();
}

}  // namespace beamcam::render::figure
