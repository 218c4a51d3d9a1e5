// Shapes from which drawings of the system are made: lines, arrows, dots and labels, in the order in which they are
// added.
#pragma once

#include <utility>
#include <vector>

#include "render/plot/figure.hpp"
#include "sim/base/vec2.hpp"

namespace beamcam::scenes {

class Sketch {
  public:
    using Vec2 = sim::Vec2;
    using Kind = render::figure::Shape::Kind;
    static constexpr render::Color kInk = render::rgb(0x000000), kBlue = render::rgb(0x0072B2),
                                   kRed = render::rgb(0xD55E00), kGrey = render::rgb(0x777777),
                                   kSteel = render::rgb(0xE6E8EC);

    std::vector<render::figure::Shape> take() { return std::move(shapes_); }

    void add(render::figure::Shape shape) { shapes_.push_back(std::move(shape)); }
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
    void disc(Vec2 at, double radius) {
        add({.kind = Kind::disc, .centre = at, .radius = radius, .color = kSteel});
        add({.kind = Kind::circle, .centre = at, .radius = radius, .color = kInk, .width = 0.9});
    }

  private:
    std::vector<render::figure::Shape> shapes_;
};

}  // namespace beamcam::scenes
