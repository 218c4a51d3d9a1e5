#include "scenes/figures/sketch.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace beamcam::scenes {
namespace {

using sim::Vec2;

// Places of the labels of the disc about its centre, in its radius.
struct DiscSymbols {
    Vec2 radius;         // direction of the arrow R
    Vec2 radius_label;   // from the middle of the arrow, in letters
    double turning = 0;  // of the arrow ω, its middle
};

// The least distance between two of the labels R, ω, e, B and C, or between one and the arrow of another.
double room(const sim::Cam& cam, const DiscSymbols& s, double letter) {
    const Vec2 along = sim::unit(cam.phase), across = sim::perp(along);
    const Vec2 c = -cam.eccentricity / cam.radius * along;
    const Vec2 labels[] = {0.5 * s.radius + letter * s.radius_label,
                           (0.8 - 0.85 * letter) * sim::unit(s.turning + 0.05),
                           0.3 * across + 0.2 * along + letter * (0.6 * along + 0.1 * across),
                           letter * (0.85 * along - 0.35 * across), c - letter * (0.85 * along - 0.2 * across)};
    double least = 1;
    for (std::size_t a = 0; a < std::size(labels); ++a) {
        for (std::size_t b = 0; b < a; ++b) least = std::min(least, norm(labels[a] - labels[b]));
        for (int tenth = 2; a > 0 && tenth <= 10; ++tenth)
            least = std::min(least, norm(labels[a] - 0.1 * tenth * s.radius) + 0.3 * letter);
    }
    for (const Vec2 foot : {c, Vec2{0, 0}})  // the lines of the dimension e
        for (int tenth = 1; tenth <= 3; ++tenth)
            least = std::min(least, norm(labels[0] - foot - 0.1 * tenth * across) + 0.3 * letter);
    return least;
}

// The default places if they have room, else the best of others.
DiscSymbols disc_symbols(const sim::Cam& cam, double letter) {
    constexpr double kPi = std::numbers::pi;
    const double enough = 1.4 * letter;
    DiscSymbols best{sim::unit(-0.72 * kPi), {0.75, -0.35}, 0};
    double most = room(cam, best, letter);
    if (most >= enough || cam.eccentricity == 0) return best;
    constexpr int kDirections = 24;
    for (int r = 0; r < kDirections; ++r)
        for (const double side : {0.85, -0.85})
            for (int turn = 0; turn < kDirections; ++turn) {
                const Vec2 out = sim::unit(2 * kPi * r / kDirections);
                const DiscSymbols other{out, side * sim::perp(out), 2 * kPi * turn / kDirections};
                if (const double each = room(cam, other, letter); each > most) most = each, best = other;
            }
    return best;
}

}  // namespace

void draw_disc_symbols(const sim::Cam& cam, Vec2 b, double zoom, double letter, Sketch& to) {
    const double radius = zoom * cam.radius;
    const Vec2 c = b - zoom * cam.eccentricity * sim::unit(cam.phase);
    const DiscSymbols at = disc_symbols(cam, letter);
    const Vec2 along = sim::unit(cam.phase), rim = b + radius * at.radius;
    to.arrow(b, rim);
    to.label(0.5 * (b + rim), "$R$", at.radius_label);
    if (cam.eccentricity > 0) {
        const Vec2 across = sim::perp(along) * (0.30 * radius);
        to.line(c, c + 1.15 * across, Sketch::kGrey);
        to.line(b, b + 1.15 * across, Sketch::kGrey);
        to.arrow(c + across - along * (0.2 * radius), c + across, Sketch::kGrey);
        to.arrow(b + across + along * (0.2 * radius), b + across, Sketch::kGrey);
        to.label(b + across + along * (0.2 * radius), "$e$", 0.6 * along + 0.1 * sim::perp(along));
        to.label(b, "$B$", 0.85 * along - 0.35 * sim::perp(along));
    }
    to.dot(c);
    to.dot(b, Sketch::kInk, 1.2);
    if (cam.eccentricity > 0)
        to.label(c, "$C$", -0.85 * along + 0.2 * sim::perp(along));
    else
        to.label(c, "$B$ = $C$", {-0.85, 0.9});
    if (cam.speed == 0) return;
    const double way = cam.speed > 0 ? -1 : 1, r = 0.8 * radius;
    to.add({.kind = Sketch::Kind::turn,
            .centre = b,
            .radius = r,
            .from = at.turning - 0.9 * way + 0.2,
            .to = at.turning + 0.5 * way + 0.2,
            .color = Sketch::kInk,
            .width = 0.8});
    to.label(b + r * sim::unit(at.turning + 0.1), "$ω$", -0.85 * sim::unit(at.turning));
}

}  // namespace beamcam::scenes
