#include "render/draw/painter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <numbers>
#include <utility>

#include "render/base/error.hpp"
#include "render/draw/cairo_support.hpp"
#include "render/draw/letters.hpp"

namespace beamcam::render {

void Painter::begin(cairo_surface_t* surface, const std::string& what) {
    surface_ = surface;
    cr_ = cairo_create(surface);
    exceptions_ = std::uncaught_exceptions();
    if (cairo_status(cr_) == CAIRO_STATUS_NO_MEMORY) throw std::bad_alloc();
    if (cairo_status(cr_) != CAIRO_STATUS_SUCCESS)
        throw PictureError(fmt::format("{} cannot be drawn: {}", what, cairo_status_to_string(cairo_status(cr_))));
    cairo_set_line_join(cr_, CAIRO_LINE_JOIN_ROUND);
}

void Painter::end() {
    if (!cr_) return;
    cairo_status_t status = cairo_status(cr_);
    cairo_destroy(std::exchange(cr_, nullptr));
    cairo_surface_finish(surface_);  // writes the rest of a document
    if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_status(surface_);
    cairo_surface_destroy(surface_);
    if (std::uncaught_exceptions() == exceptions_) require_success(status);
}

void Painter::set_source(Color color) {
    const Color c = recolor_ ? recolor_(color) : color;
    cairo_set_source_rgba(cr_, c.r, c.g, c.b, c.a);
}

std::vector<double> dashes(const std::vector<double>& pattern, double unit) {
    std::vector<double> out = pattern;
    for (double& length : out) length *= unit;
    return out;
}

// ---- painted tiles -----------------------------------------------------------------------------

void Painter::mark_painted(const Box& box) {
    if (!touched) return;
    const Box wide = box.inset(-1);  // antialiased edges extend into the next pixel
    if (!limit_) return touched->add(wide);
    const double x = std::max(wide.x, limit_->x), y = std::max(wide.y, limit_->y);
    const Box within{x, y, std::min(wide.right(), limit_->right()) - x, std::min(wide.bottom(), limit_->bottom()) - y};
    if (!within.empty()) touched->add(within);
}

void Painter::mark_path(double around) {
    if (!touched || !cairo_has_current_point(cr_)) return;
    double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    cairo_path_extents(cr_, &x0, &y0, &x1, &y1);
    mark_painted(Box{x0, y0, x1 - x0, y1 - y0}.inset(-around));
}

// ---- paths -------------------------------------------------------------------------------------

void Painter::move_to(Vec2 p) { cairo_move_to(cr_, p.x, p.y); }
void Painter::line_to(Vec2 p) { cairo_line_to(cr_, p.x, p.y); }
void Painter::close() { cairo_close_path(cr_); }

void Painter::polyline(std::span<const Vec2> points) {
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

void Painter::arc(Vec2 c, double radius, double from, double to) {
    if (to >= from)
        cairo_arc_negative(cr_, c.x, c.y, radius, -from, -to);
    else
        cairo_arc(cr_, c.x, c.y, radius, -from, -to);
}

void Painter::circle(Vec2 c, double radius) {
    cairo_new_sub_path(cr_);
    cairo_arc(cr_, c.x, c.y, radius, 0, 2 * std::numbers::pi);
    cairo_close_path(cr_);
}

void Painter::rectangle(const Box& b) { cairo_rectangle(cr_, b.x, b.y, b.w, b.h); }

// A shaft and a filled head; an arrow shorter than its head is only a smaller head.
void Painter::arrow(Vec2 from, Vec2 to, const Pen& pen, const ArrowHead& head) {
    const Vec2 way = to - from;
    const double length = norm(way);
    if (!(length > 0)) return;
    const Vec2 u = way * (1 / length), v = sim::perp(u);
    const double tip = std::min(head.length, length);
    const auto add_head = [&] {
        move_to(to);
        line_to(to - u * tip + v * (head.half_width * tip));
        if (head.back < 1) line_to(to - u * (head.back * tip));
        line_to(to - u * tip - v * (head.half_width * tip));
        close();
    };
    if (length > tip) line(from, to - u * (0.8 * tip), {pen.color, pen.width, pen.dash, Cap::butt});
    add_head();
    if (halo_of_all) stroke({*halo_of_all, pen.width + 1}), add_head();
    fill(pen.color);
}

// ---- painting ----------------------------------------------------------------------------------

void Painter::boxed_text(Vec2 at, std::string_view markup, const TextStyle& style) {
    const Box ink = measure(markup, style);
    const double left = style.align == HAlign::left ? 0 : style.align == HAlign::centre ? ink.w / 2 : ink.w;
    rectangle(Box{at.x - left, at.y + ink.y, ink.w, ink.h}.inset(-0.15 * style.size));
    fill(style.halo.value());
    text(at, markup, style);
}

void Painter::fill(Color c) {
    fill_keeping_path(c);
    new_path();
}
void Painter::fill_keeping_path(Color c) {
    mark_path(0);
    set_source(c);
    cairo_fill_preserve(cr_);
}
void Painter::new_path() { cairo_new_path(cr_); }

// The path's box would be far larger than what is painted of a slanted body: each edge marks its own.
void Painter::fill_between(std::span<const Vec2> outer, std::span<const Vec2> inner, Color color) {
    for (std::size_t i = 0; i < outer.size(); ++i) {
        const std::size_t next = (i + 1) % outer.size();
        Bounds edge;
        for (const Vec2 p : {outer[i], outer[next], inner[i], inner[next]}) edge.add(p);
        mark_painted(edge.box());
    }
    polyline(outer);
    close();
    const std::vector<Vec2> back(inner.rbegin(), inner.rend());
    polyline(back);
    close();
    set_source(color);
    cairo_fill(cr_);
}

void Painter::without_halo(const std::function<void()>& draw) {
    const std::optional<Color> before = std::exchange(halo_of_all, std::nullopt);
    draw();
    halo_of_all = before;
}

void Painter::stroke(const Pen& pen) {
    const double halo = halo_of_all ? 1.6 * pen.width + 1 : pen.width;
    mark_path(halo / 2);  // joins are round
    cairo_set_line_cap(cr_, pen.cap == Cap::round ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
    cairo_set_dash(cr_, pen.dash.data(), static_cast<int>(pen.dash.size()), 0);
    if (halo_of_all && halo_of_all->faded(0) != pen.color.faded(0)) {
        set_source(halo_of_all->faded(pen.color.a * pen.color.a));  // faint lines have hardly any
        cairo_set_line_width(cr_, halo);
        cairo_stroke_preserve(cr_);
    }
    set_source(pen.color);
    cairo_set_line_width(cr_, pen.width);
    cairo_stroke(cr_);
}
void Painter::line(Vec2 from, Vec2 to, const Pen& pen) {
    move_to(from);
    line_to(to);
    stroke(pen);
}
void Painter::curve(std::span<const Vec2> points, const Pen& pen) {
    polyline(points);
    stroke(pen);
}

// ---- clips, images, labels ----------------------------------------------------------------------

void Painter::clip(const Box& b, const std::function<void()>& draw) {
    cairo_save(cr_);
    cairo_rectangle(cr_, b.x, b.y, b.w, b.h);
    cairo_clip(cr_);
    const Box* before = std::exchange(limit_, &b);
    draw();
    limit_ = before;
    cairo_restore(cr_);
}

void Painter::layer(double opacity, const std::function<void()>& draw) {
    cairo_push_group(cr_);
    draw();
    cairo_pop_group_to_source(cr_);
    cairo_paint_with_alpha(cr_, opacity);
    set_source({});
}

void Painter::erase(const Box& box, double share) {
    cairo_set_operator(cr_, CAIRO_OPERATOR_DEST_OUT);
    rectangle(box);
    fill(rgb(0).faded(share));
    cairo_set_operator(cr_, CAIRO_OPERATOR_OVER);
}

void Painter::pixels(const Image& image, const Box& into) {
    cairo_surface_t* const surface = surface_of(image);
    cairo_save(cr_);
    cairo_translate(cr_, into.x, into.y);
    cairo_scale(cr_, into.w / image.width, into.h / image.height);
    cairo_set_source_surface(cr_, surface, 0, 0);
    cairo_pattern_set_filter(cairo_get_source(cr_), CAIRO_FILTER_NEAREST);
    cairo_paint(cr_);
    cairo_restore(cr_);
    set_source({});
    cairo_surface_destroy(surface);
    mark_painted(into);
}

double Painter::halo_width(const TextStyle& style) { return 0.20 * style.size; }

void Painter::draw_halo(const SetLabel& label, Vec2 at, const TextStyle& style, Color color) {
    for (const SetRun& run : label.runs) {
        PangoLayout* letters = layout_of(*fonts_, run, style);
        const Vec2 from = at + Vec2{run.x, run.y};
        cairo_move_to(cr_, from.x, from.y - baseline_of(letters));
        pango_cairo_layout_path(cr_, letters);
    }
    stroke({color, halo_width(style)});
}

void Painter::draw_label(const SetLabel& label, Vec2 at, const TextStyle& style) {
    for (const SetRun& run : label.runs) {
        const Color color = run.run.color ? rgb(*run.run.color) : style.color;
        set_source(color);
        write(run, at + Vec2{run.x, run.y}, style);
        // Dots are above the middle of the slanted letter.
        for (int k = 0; k < run.run.dots; ++k) {
            const double across = (k - 0.5 * (run.run.dots - 1)) * 0.22 * run.size;
            circle(at + Vec2{run.x + 0.58 * run.advance + across, run.y - run.top - 0.14 * run.size}, 0.065 * run.size);
            fill(color);
        }
    }
}

void Painter::write(const SetRun& run, Vec2 at, const TextStyle& style) {
    PangoLayout* letters = layout_of(*fonts_, run, style);
    cairo_move_to(cr_, at.x, at.y - baseline_of(letters));
    pango_cairo_show_layout(cr_, letters);
    new_path();
}

}  // namespace beamcam::render
