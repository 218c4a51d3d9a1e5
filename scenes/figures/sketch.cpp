#include "scenes/figures/sketch.hpp"

namespace beamcam::scenes {
using sim::Vec2;

// The symbols keep their places relative to the direction from C to B, along which they turn.
void draw_disc_symbols(const sim::Cam& cam, Vec2 b, double zoom, double letter, Sketch& to) {
    constexpr double kTurn = 0.8;  // radius of the arrow ω, in that of the disc
    constexpr double kRadius = -1.8,
                     kTurning = 1.57;  // directions of the arrows R and ω, which keep labels apart [rad]
    const double radius = zoom * cam.radius;
    const double phase = cam.eccentricity > 0 ? cam.phase : 0, turning = phase + kTurning;
    const Vec2 along = sim::unit(phase), across = sim::perp(along), out = sim::unit(phase + kRadius);
    const Vec2 c = b - zoom * cam.eccentricity * along, rim = b + radius * out;
    to.arrow(b, rim);
    to.label(0.5 * (b + rim), "$R$", 0.85 * sim::perp(out));
    if (cam.eccentricity > 0) {
        const Vec2 up = 0.30 * radius * across, outwards = 0.2 * radius * along;
        to.line(c, c + 1.15 * up, Sketch::kGrey);
        to.line(b, b + 1.15 * up, Sketch::kGrey);
        to.arrow(c + up - outwards, c + up, Sketch::kGrey);
        to.arrow(b + up + outwards, b + up, Sketch::kGrey);
        to.label(b + up + outwards, "$e$", 0.6 * along + 0.1 * across);
        to.label(b, "$B$", 0.85 * along - 0.35 * across);
    }
    to.dot(c);
    to.dot(b, Sketch::kInk, 1.2);
    // C on the side away from B or, where the rim is, on the other side.
    const bool at_rim = cam.eccentricity / cam.radius + 1.3 * letter > 1;
    if (cam.eccentricity > 0)
        to.label(c, "$C$", (at_rim ? 0.85 : -0.85) * along + (at_rim ? -0.35 : 0.2) * across);
    else
        to.label(c, "$B$ = $C$", {-0.85, 0.9});
    if (cam.speed == 0) return;
    const double way = cam.speed > 0 ? -1 : 1;
    to.add({.kind = Sketch::Kind::turn,
            .centre = b,
            .radius = kTurn * radius,
            .from = turning - 0.9 * way + 0.2,
            .to = turning + 0.5 * way + 0.2,
            .width = 0.8});
    to.label(b + kTurn * radius * sim::unit(turning + 0.1), "$ω$", -0.85 * sim::unit(turning));
}

}  // namespace beamcam::scenes
