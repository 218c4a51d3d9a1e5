// Draws panels of shapes: schematics and stills.
#include <algorithm>
#include <cmath>
#include <vector>

#include "render/base/error.hpp"
#include "render/plot/panel.hpp"

namespace beamcam::render::figure {
namespace {

// The extent of all shapes, and of the anchor points of labels.
Bounds bounds_of(const std::vector<Shape>& shapes) {
    Bounds all;
    for (const Shape& s : shapes) {
        for (const Vec2 p : s.points) all.add(p);
        if (s.kind == Shape::Kind::circle || s.kind == Shape::Kind::disc) all.add(s.centre, s.radius);
        if (s.kind == Shape::Kind::turn)
            for (int k = 0; k <= 24; ++k) all.add(s.centre + s.radius * sim::unit(s.from + (s.to - s.from) * k / 24));
    }
    return all;
}

TextStyle lettering_of(const Shape& s, const PlotStyle& style) {
    return {.size = style.letters, .color = s.color, .align = s.align, .valign = s.valign};
}

Vec2 place_of(const Shape& label, const TextStyle& l, const Camera& camera) {
    return camera.to_pixels(label.points.at(0)) + Vec2{label.shift.x * l.size, -label.shift.y * l.size};
}

// The box that the text of a label takes.
Box label_box(const Shape& label, const PlotStyle& style, const PageCanvas& sheet, const Camera& camera) {
    const TextStyle l = lettering_of(label, style);
    const Vec2 at = place_of(label, l, camera);
    Box box = sheet.measure(label.markup, l);
    box.x = at.x - (l.align == HAlign::centre ? box.w / 2 : l.align == HAlign::right ? box.w : 0);
    if (l.valign == VAlign::top) box.y = 0;
    if (l.valign == VAlign::middle) box.y += sheet.cap_height(l.size) / 2;
    if (l.valign == VAlign::bottom) box.y = -box.h;
    box.y += at.y;
    return box;
}

// How far labels extend beyond the box to the left and to the right.
Vec2 beyond(const std::vector<Shape>& shapes, const PlotStyle& style, PageCanvas& sheet, const Camera& camera,
            const Box& box) {
    Vec2 out{0, 0};
    for (const Shape& s : shapes) {
        if (s.kind != Shape::Kind::label) continue;
        const Box label = label_box(s, style, sheet, camera);
        out = {std::max(out.x, box.x - label.x), std::max(out.y, label.right() - box.right())};
    }
    return out;
}

void draw_one(const Shape& s, const PlotStyle& style, PageCanvas& sheet, const Camera& camera) {
    const double width = s.width > 0 ? s.width : style.frame;
    const Pen pen{s.color, width, dashes(s.dash, width), Cap::butt};
    const double radius = s.radius_points > 0 ? s.radius_points : s.radius * camera.scale;
    std::vector<Vec2> points;
    for (const Vec2 p : s.points) points.push_back(camera.to_pixels(p));
    const Vec2 centre = camera.to_pixels(s.centre);
    const ArrowHead head{.length = 5.5 * style.letters / 8, .half_width = 0.36, .back = 0.78};
    switch (s.kind) {
        case Shape::Kind::line:
            sheet.polyline(points);
            return sheet.stroke(pen);
        case Shape::Kind::area:
            sheet.polyline(points);
            sheet.close();
            return sheet.fill(s.color);
        case Shape::Kind::circle:
            sheet.circle(centre, radius);
            return sheet.stroke(pen);
        case Shape::Kind::disc:
            sheet.circle(centre, radius);
            return sheet.fill(s.color);
        case Shape::Kind::turn: {
            // The head is a short arrow along the end of the arc, which stops before it.
            const double back =
                std::copysign(std::min(0.8 * head.length / radius, std::abs(s.to - s.from)), s.to - s.from);
            sheet.arc(centre, radius, s.from, s.to - back);
            sheet.stroke(pen);
            const auto on = [&](double angle) { return centre + radius * Vec2{std::cos(angle), -std::sin(angle)}; };
            const Vec2 tip = on(s.to), neck = on(s.to - 1.25 * back);
            const Vec2 u = (tip - neck) * (1 / norm(tip - neck));
            return sheet.arrow(tip - u * head.length, tip, pen, head);
        }
        case Shape::Kind::arrow:
            return sheet.arrow(points.at(0), points.at(1), pen, head);
        case Shape::Kind::label: {
            TextStyle l = lettering_of(s, style);
            l.halo = kWhite;
            sheet.text(place_of(s, l, camera), s.markup, l);
            return;
        }
    }
}

}  // namespace

void draw_shapes(const Panel& panel, const PlotStyle& style, PageCanvas& sheet, const Box& box) {
    const Bounds world = bounds_of(panel.shapes);
    if (!(std::isfinite(world.x0 + world.x1 + world.y0 + world.y1) && world.x1 > world.x0 && world.y1 > world.y0))
        throw PictureError("the schematic has no extent: its lengths are zero or not finite");
    const double margin = 1.2 * style.letters;
    Camera camera = fit(world, box.inset(margin));
    Box room = box;
    for (int pass = 0; pass < 100; ++pass) {  // a smaller drawing needs less room
        const auto [left, right] = beyond(panel.shapes, style, sheet, camera, box);
        if (left <= 0 && right <= 0) break;
        room = {room.x + left, room.y, room.w - left - right, room.h};
        camera = fit(world, room.inset(margin));
    }
    for (const Shape& s : panel.shapes) draw_one(s, style, sheet, camera);
}

}  // namespace beamcam::render::figure
