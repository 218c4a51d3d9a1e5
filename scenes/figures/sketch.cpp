#include "scenes/figures/sketch.hpp"

#include <algorithm>
#include <numbers>
#include <utility>
#include <vector>

namespace beamcam::scenes {
namespace {

using sim::Vec2;

// Places of the labels of the disc about its centre, in its radius.
struct DiscSymbols {
    Vec2 radius;         // direction of the arrow R
    Vec2 radius_label;   // from the middle of the arrow, in letters
    double turning = 0;  // of the arrow ω, its middle
};

constexpr double kTurn = 0.8;  // radius of the arrow ω

// From C, on the side away from B or, where the rim is, on the other side; in letters.
Vec2 beside_c(const sim::Cam& cam, double letter) {
    const Vec2 along = sim::unit(cam.phase), across = sim::perp(along);
    const bool at_rim = cam.eccentricity / cam.radius + 1.3 * letter > 1;
    return (at_rim ? 0.85 : -0.85) * along + (at_rim ? -0.35 : 0.2) * across;
}

// First and last angle of the arrow ω.
std::pair<double, double> turn_of(const sim::Cam& cam, const DiscSymbols& s) {
    const double way = cam.speed > 0 ? -1 : 1;
    return {s.turning - 0.9 * way + 0.2, s.turning + 0.5 * way + 0.2};
}

// The least distance between two of the labels R, ω, e, B and C, or between one of them and the lines of another, or
// between lines. Lines may be nearer than labels.
double room(const sim::Cam& cam, const DiscSymbols& s, double letter) {
    const Vec2 along = sim::unit(cam.phase), across = sim::perp(along);
    const Vec2 c = -cam.eccentricity / cam.radius * along;
    const Vec2 labels[] = {0.5 * s.radius + letter * s.radius_label,
                           (0.8 - 0.85 * letter) * sim::unit(s.turning + 0.05),
                           0.3 * across + 0.2 * along + letter * (0.6 * along + 0.1 * across),
                           letter * (0.85 * along - 0.35 * across), c + letter * beside_c(cam, letter)};
    std::vector<Vec2> radius, turn, dimension{c};
    for (int tenth = 2; tenth <= 10; ++tenth) radius.push_back(0.1 * tenth * s.radius);
    const auto [from, to] = turn_of(cam, s);
    for (int k = 0; k <= 12 && cam.speed != 0; ++k) turn.push_back(kTurn * sim::unit(from + (to - from) * k / 12));
    for (const Vec2 foot : {c, Vec2{0, 0}})
        for (int tenth = 1; tenth <= 3; ++tenth) dimension.push_back(foot + 0.1 * tenth * across);
    dimension.push_back(c + 0.3 * across - 0.2 * along);
    double least = 1;
    const auto keep = [&](Vec2 point, const std::vector<Vec2>& line, double nearer) {
        for (const Vec2 p : line) least = std::min(least, norm(point - p) + nearer * letter);
    };
    for (std::size_t a = 0; a < std::size(labels); ++a) {
        for (std::size_t b = 0; b < a; ++b) least = std::min(least, norm(labels[a] - labels[b]));
        if (a != 0) keep(labels[a], radius, 0.3);
        if (a != 1) keep(labels[a], turn, 0.3);
    }
    keep(labels[0], dimension, 0.3);
    for (const Vec2 p : turn) keep(p, radius, 0.9), keep(p, dimension, 0.9);
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
        to.label(c, "$C$", beside_c(cam, letter));
    else
        to.label(c, "$B$ = $C$", {-0.85, 0.9});
    if (cam.speed == 0) return;
    const auto [from, end] = turn_of(cam, at);
    to.add({.kind = Sketch::Kind::turn,
            .centre = b,
            .radius = kTurn * radius,
            .from = from,
            .to = end,
            .color = Sketch::kInk,
            .width = 0.8});
    to.label(b + kTurn * radius * sim::unit(at.turning + 0.1), "$ω$", -0.85 * sim::unit(at.turning));
}

}  // namespace beamcam::scenes
