#include "render/brush.hpp"

#include <cairo.h>

#include <cmath>
#include <numbers>

namespace beamcam::render {

void Brush::end() {
    if (cr_) cairo_destroy(cr_);
    cr_ = nullptr;
}

void Brush::use(Color c) { cairo_set_source_rgba(cr_, c.r, c.g, c.b, c.a); }

void Brush::move_to(Vec2 p) { cairo_move_to(cr_, p.x, p.y); }
void Brush::line_to(Vec2 p) { cairo_line_to(cr_, p.x, p.y); }
void Brush::close() { cairo_close_path(cr_); }

void Brush::polyline(std::span<const Vec2> points) {
    bool pen_down = false;
    for (Vec2 p : points) {
        if (std::isnan(p.x) || std::isnan(p.y)) {
            pen_down = false;
        } else {
            pen_down ? line_to(p) : move_to(p);
            pen_down = true;
        }
    }
}

void Brush::arc(Vec2 c, double radius, double from, double to) {
    if (to >= from)
        cairo_arc_negative(cr_, c.x, c.y, radius, -from, -to);
    else
        cairo_arc(cr_, c.x, c.y, radius, -from, -to);
}

void Brush::circle(Vec2 c, double radius) {
    cairo_new_sub_path(cr_);
    cairo_arc(cr_, c.x, c.y, radius, 0, 2 * std::numbers::pi);
    cairo_close_path(cr_);
}

void Brush::rectangle(const Box& b) { cairo_rectangle(cr_, b.x, b.y, b.w, b.h); }

void Brush::fill(Color c) {
    use(c);
    cairo_fill(cr_);
}
void Brush::fill_keeping_path(Color c) {
    use(c);
    cairo_fill_preserve(cr_);
}
void Brush::stroke(const Pen& pen) {
    use(pen.color);
    cairo_set_line_width(cr_, pen.width);
    cairo_set_line_cap(cr_, pen.cap == Cap::round ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
    cairo_set_dash(cr_, pen.dash.data(), static_cast<int>(pen.dash.size()), 0);
    cairo_stroke(cr_);
}

}  // namespace beamcam::render
