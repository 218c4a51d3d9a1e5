#include "render/film/tip_path.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "render/draw/smooth_path.hpp"

namespace beamcam::render {
namespace {

constexpr double kTrailSeconds = 1.2;  // length of the trail in time of the film, freezes not counted
constexpr double kArcStep = 6;         // step of the drawn curve [design px]
constexpr double kFarTurn =
    0.5;  // rotation of the hub between positions above which the error of a spline exceeds half a pixel [rad]

// A point of the path in the view of the scene's camera.
Vec2 seen_in(const MechanismScene& s, const MechanismView& home, Vec2 p) {
    return s.on(s.at.moved ? s.at.px(home.look.camera.to_world(p)) : p);
}

}  // namespace

TipPath::Knot knot_of(const MechanismView& home, const sim::Pose& pose) {
    const DrawnBeam b = home.drawn(home.member, pose);
    const std::size_t tip = b.line.size() - 1;
    return {pose.t, home.px((b.face(tip) + b.back(tip)) * 0.5), pose.theta};
}

void TipPath::Knots::add(const Knot& knot) {
    times.push_back(knot.t), points.push_back(knot.at), angles.push_back(knot.angle);
}

// The curve between positions k and k + 1.
std::vector<Vec2> TipPath::curve_between(const MechanismView& home, const Knots& knots, std::size_t k) {
    const double turn = knots.angles[k + 1] - knots.angles[k], step = kArcStep * home.unit;
    if (std::abs(turn) < kFarTurn) return smooth_piece(knots.points, k, step);
    return turning_piece(home.px({0, 0}), knots.points[k], knots.points[k + 1], turn, step);
}

void TipPath::add_frame(const Knot& knot) {
    frames_.push_back(knots_.points.size());
    knots_.add(knot);
}

void TipPath::add_between_frames(const Knot& knot) { knots_.add(knot); }

// Whether the state at the end of the film, which the survey contains, is the one at its first frame.
bool TipPath::closes(const MechanismView& home) const {
    constexpr double kSamePlace = 1, kSameSpeed = 1e-3;  // [px], share of the largest speed
    const Motion& motion = home.motion();
    if (motion.survey.size() < 2 || frames_.size() < 3) return false;
    std::size_t latest = 0;  // not the last: samples of collisions come after it
    for (std::size_t k = 0; k < motion.surveyed(); ++k)
        if (motion.survey[k].t > motion.survey[latest].t) latest = k;
    const sim::Pose first = motion.pose(0), end = motion.surveyed(latest);
    const double step = motion.time(frames_.size() - 1) - motion.time(frames_.size() - 2);
    const bool is_next = std::abs(end.t - motion.time(frames_.size() - 1) - step) < 0.5 * step;
    if (!is_next || first.t < 0.999 * (end.t - first.t) ||
        !(norm(knot_of(home, end).at - knots_.points.front()) < kSamePlace))
        return false;
    double fastest = 0;
    for (std::size_t k = 0; k < motion.surveyed(); ++k)
        fastest = std::max(fastest, std::abs(motion.surveyed(k).theta_dot));
    return std::abs(end.theta_dot - first.theta_dot) <= kSameSpeed * fastest;
}

// Whether a knot between this frame and the next one is farther than a pixel from the curve through the frames alone.
bool TipPath::needs_between(const MechanismView& home, const Knots& of_frames, std::size_t frame) const {
    constexpr double kStray = 1;  // [px]
    const std::vector<Vec2> curve = curve_between(home, of_frames, frame);
    const auto distance = [&](Vec2 p, std::size_t i) {  // from a piece of the curve
        const Vec2 a = curve[i], way = curve[i + 1] - a;
        const double share = dot(way, way) > 0 ? std::clamp(dot(p - a, way) / dot(way, way), 0.0, 1.0) : 0;
        return norm(p - (a + way * share));
    };
    for (std::size_t k = frames_[frame] + 1; k < frames_[frame + 1]; ++k) {
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i + 1 < curve.size(); ++i) least = std::min(least, distance(knots_.points[k], i));
        if (least > kStray) return true;
    }
    return false;
}

void TipPath::complete(const MechanismView& home) {
    if (frames_.empty()) return;
    Knots of_frames, needed;
    const auto add = [&](Knots& to, std::size_t k) { to.add({knots_.times[k], knots_.points[k], knots_.angles[k]}); };
    for (const std::size_t k : frames_) add(of_frames, k);
    std::vector<std::size_t> frames;
    for (std::size_t f = 0; f < frames_.size(); ++f) {
        frames.push_back(needed.points.size());
        add(needed, frames_[f]);
        if (f + 1 == frames_.size() || !needs_between(home, of_frames, f)) continue;
        for (std::size_t k = frames_[f] + 1; k < frames_[f + 1]; ++k) add(needed, k);
    }
    knots_ = std::move(needed), frames_ = std::move(frames);
    if (!closes(home)) return;
    const std::vector<Vec2>& all = knots_.points;
    const std::array around{all[all.size() - 2], all.back(), all[0], all[1]};
    seam_ = smooth_piece(around, 1, kArcStep * home.unit);
}

std::vector<Vec2> TipPath::piece(const MechanismView& home, std::size_t frame) const {
    std::vector<Vec2> out;
    for (std::size_t k = frames_[frame]; k < frames_[frame + 1]; ++k) {
        const std::vector<Vec2> next = curve_between(home, knots_, k);
        out.insert(out.end(), next.begin() + (out.empty() ? 0 : 1), next.end());
    }
    return out;
}

void TipPath::draw_trail(const MechanismScene& s, const MechanismView& home) const {
    struct Piece {
        std::vector<Vec2> line;
        double opacity;
    };
    std::vector<Piece> pieces;
    const auto now = static_cast<std::size_t>(s.frame), last = frames_.size() - 1;
    const std::vector<int>& moves = home.context.moved;  // a freeze does not shorten the trail
    // False beyond the end of the trail. `moved`: frames in which time moved since its beginning at frame k.
    const auto add = [&](std::size_t k, int moved) {
        const double age = moved / (kTrailSeconds * home.context.setup->fps);
        if (age > 1) return false;
        if (k < last && moves[k + 1] == moves[k]) return true;
        pieces.push_back({k < last ? piece(home, k) : seam_, 1 - age});
        for (Vec2& p : pieces.back().line) p = seen_in(s, home, p);
        return true;
    };
    bool more = true;
    for (std::size_t k = now; more && k-- > 0;) more = add(k, moves[now] - moves[k]);
    for (std::size_t k = last + 1; more && !seam_.empty() && k-- > now + 1;)
        more = add(k, moves[now] + 1 + moves[last] - moves[k]);
    for (const Piece& each : pieces) {
        s.canvas.polyline(each.line);
        s.canvas.stroke({home.palette.motion.faded(0.55 * each.opacity), 2 * home.unit, {}, Cap::butt});
    }
}

}  // namespace beamcam::render
