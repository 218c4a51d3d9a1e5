#include "render/film/tip_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace beamcam::render {
namespace {

constexpr double kTrailSeconds = 1.2;  // length of the trail in time of the film, freezes not counted
constexpr double kArcStep = 6;         // step of the drawn curve [design px]

// Adds the way from one place to another, which turns about the centre by `turn` up to the difference of the places
// [rad]; its distance from the centre changes linearly with the angle.
void add_arc(std::vector<Vec2>& to, Vec2 centre, Vec2 from, Vec2 until, double turn, double step) {
    constexpr double kMostSteps = 4096;  // several turns in a large picture; more turns look like a ring
    const Vec2 first = from - centre, last = until - centre;
    const double start = std::atan2(-first.y, first.x), end = std::atan2(-last.y, last.x);
    const double angle = turn + std::remainder(end - start - turn, 2 * std::numbers::pi);
    const double length = std::abs(angle) * std::max(norm(first), norm(last));
    const int steps = std::max(1, static_cast<int>(std::min(std::ceil(length / step), kMostSteps)));
    for (int k = 1; k < steps; ++k) {
        const double part = double(k) / steps, at = start + part * angle;
        to.push_back(centre + Vec2{std::cos(at), -std::sin(at)} * (norm(first) + part * (norm(last) - norm(first))));
    }
    to.push_back(until);
}

}  // namespace

TipPath::TipPath(const MechanismView& home) : home_(home) {
    const std::vector<sim::Pose>& between = home.motion().path;
    auto next = between.begin();
    for (int k = 0; k < home.context.frames(); ++k) {
        const double t = home.context.clock.at(k);
        for (; next != between.end() && next->t < t; ++next)
            if (k > 0 && next->t > home.context.clock.at(k - 1)) add(*next);
        frames_.push_back(places_.size());
        add(home.context.pose(home.member, k));
    }
}

void TipPath::add(const sim::Pose& pose) {
    const DrawnBeam beam = home_.drawn(home_.member, pose);
    const std::size_t tip = beam.line.size() - 1;
    places_.push_back(home_.px((beam.face(tip) + beam.back(tip)) * 0.5));
    angles_.push_back(pose.theta);
}

std::vector<Vec2> TipPath::piece(std::size_t frame) const {
    std::vector<Vec2> out{places_[frames_[frame]]};
    for (std::size_t k = frames_[frame]; k < frames_[frame + 1]; ++k)
        add_arc(out, home_.px({0, 0}), places_[k], places_[k + 1], angles_[k + 1] - angles_[k], kArcStep * home_.unit);
    return out;
}

// A freeze does not shorten the trail.
void TipPath::draw_trail(const MechanismScene& s) const {
    const std::vector<int>& moved = home_.context.clock.moved;
    const auto now = static_cast<std::size_t>(s.frame);
    for (std::size_t k = now; k-- > 0;) {
        const double age = (moved[now] - moved[k]) / (kTrailSeconds * home_.context.setup->fps);
        if (age > 1) return;
        if (moved[k + 1] == moved[k]) continue;
        std::vector<Vec2> line = piece(k);
        for (Vec2& p : line) p = s.on(s.at.moved ? s.at.px(home_.look.camera.to_world(p)) : p);
        s.canvas.polyline(line);
        s.canvas.stroke({home_.palette.motion.faded(0.55 * (1 - age)), 2 * home_.unit, {}, Cap::butt});
    }
}

}  // namespace beamcam::render
