// Shapes of drawings in the order in which they are drawn, and the disc of a cam with its symbols.
#pragma once

#include <utility>
#include <vector>

#include "render/plot/figure.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::scenes {

class Sketch {
  public:
    using Shape = render::figure::Shape;
    using Vec2 = sim::Vec2;
    using Kind = Shape::Kind;
    static constexpr render::Color kInk = render::rgb(0x000000), kBlue = render::rgb(0x0072B2),
                                   kGrey = render::rgb(0x777777), kSteel = render::rgb(0xE6E8EC);

    std::vector<Shape> take() { return std::move(shapes_); }

    void add(Shape shape) { shapes_.push_back(std::move(shape)); }
    void line(Vec2 a, Vec2 b, render::Color color, double width = 0, std::vector<double> dash = {}) {
        add({.kind = Kind::line, .points = {a, b}, .color = color, .width = width, .dash = std::move(dash)});
    }
    void arrow(Vec2 a, Vec2 b, render::Color color = kInk, double width = 0) {
        add({.kind = Kind::arrow, .points = {a, b}, .color = color, .width = width});
    }
    void label(Vec2 at, const char* markup, Vec2 shift, render::Color color = kInk) {
        add({.kind = Kind::label, .points = {at}, .color = color, .markup = markup, .shift = shift});
    }
    void dot(Vec2 at, render::Color color = kInk, double radius = 1.5) {
        add({.kind = Kind::disc, .centre = at, .radius_points = radius, .color = color});
    }
    // Between the two points, with both heads.
    void dimension(Vec2 a, Vec2 b, render::Color color = kGrey) {
        const Vec2 middle = 0.5 * (a + b);
        arrow(middle, a, color);
        arrow(middle, b, color);
    }
    void circle(Vec2 at, double radius, render::Color color, double width) {
        add({.kind = Kind::circle, .centre = at, .radius = radius, .color = color, .width = width});
    }
    // An arrow about the centre in the sense of a cam of this speed, at the direction `middle`.
    void rotation(Vec2 centre, double radius, double middle, double speed) {
        const double half = speed > 0 ? -0.5 : 0.5;
        add({.kind = Kind::turn, .centre = centre, .radius = radius, .from = middle - half, .to = middle + half});
        label(centre + radius * sim::unit(middle), "$ω$", 0.8 * sim::unit(middle));
    }
    void disc(Vec2 at, double radius, render::Color fill = kSteel, double outline = 0.9) {
        add({.kind = Kind::disc, .centre = at, .radius = radius, .color = fill});
        circle(at, radius, kInk, outline);
    }

  private:
    std::vector<Shape> shapes_;
};

// The symbols R, e, B, C and ω on the disc drawn `zoom` times as large, its centre B here. `letter`: size of letters,
// in radii of the disc.
void draw_disc_symbols(const sim::Cam& cam, sim::Vec2 b, double zoom, double letter, Sketch& to);

}  // namespace beamcam::scenes
