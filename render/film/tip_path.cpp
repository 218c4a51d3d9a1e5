#include "render/film/tip_path.hpp"

#include <algorithm>
#include <cmath>

#include "render/draw/smooth_path.hpp"

namespace beamcam::render {
namespace {

constexpr double kTrailSeconds = 1.2;  // length of the trail in time of the film, freezes not counted
constexpr double kArcStep = 6;         // step of the drawn curve [design px]
constexpr double kFarTurn =
    0.5;  // rotation of the hub between positions above which the error of a spline exceeds half a pixel [rad]

// The curve between positions k and k + 1.
std::vector<Vec2> curve_between(const MechanismView& home, std::span<const Vec2> tips, std::span<const double> angles,
                                std::size_t k) {
    const double turn = angles[k + 1] - angles[k], step = kArcStep * home.unit;
    if (std::abs(turn) < kFarTurn) return smooth_piece(tips, k, step);
    return turning_piece(home.px({0, 0}), tips[k], tips[k + 1], turn, step);
}

// A point of the path in the view of the scene's camera.
Vec2 seen_in(const MechanismScene& s, const MechanismView& home, Vec2 p) {
    return s.on(s.at.moved ? s.at.px(home.look.camera.to_world(p)) : p);
}

}  // namespace

void TipPath::add_frame(Vec2 tip, double angle, bool moved) {
    tips_.push_back(tip);
    angles_.push_back(angle);
    moved_.push_back((moved_.empty() ? 0 : moved_.back()) + (moved ? 1 : 0));
}

std::vector<Vec2> TipPath::piece(const MechanismView& home, std::size_t frame) const {
    return curve_between(home, tips_, angles_, frame);
}

void TipPath::find_whole(const MechanismView& home) {
    struct Tip {
        double t;
        Vec2 at;
        double angle;  // of the hub [rad]
    };
    std::vector<Tip> tips;
    const double now = home.context.at(home.member, home.context.frames() - 1);
    for (std::size_t k = 0; k < tips_.size(); ++k)
        tips.push_back({home.context.at(home.member, static_cast<int>(k)), tips_[k], angles_[k]});
    for (std::size_t k = 0; home.motion().survey && k < home.motion().surveyed(); ++k) {
        if (home.motion().survey->time(k) > now) continue;
        const sim::Pose pose = home.motion().surveyed(k);
        const DrawnBeam b = home.drawn(home.member, pose);
        tips.push_back({home.motion().survey->time(k),
                        home.px((b.face(b.line.size() - 1) + b.back(b.line.size() - 1)) * 0.5), pose.theta});
    }
    std::ranges::stable_sort(tips, {}, &Tip::t);
    tips.erase(std::unique(tips.begin(), tips.end(), [](const Tip& a, const Tip& b) { return a.t == b.t; }),
               tips.end());
    std::vector<Vec2> all, inside;
    std::vector<double> times, angles;
    for (const Tip& tip : tips) all.push_back(tip.at), angles.push_back(tip.angle);
    for (std::size_t k = 0; k < all.size(); ++k) {
        std::vector<Vec2> piece{all[k]};
        if (k > 0) piece = curve_between(home, all, angles, k - 1), piece.erase(piece.begin());
        for (Vec2 p : piece) {
            times.push_back(tips[k].t);
            inside.push_back(p - Vec2{home.box.x, home.box.y});
        }
    }
    whole_ = thinned(times, inside, 0.5);
}

void TipPath::draw_trail(const MechanismScene& s, const MechanismView& home) const {
    struct Piece {
        std::vector<Vec2> line;
        double opacity;
    };
    std::vector<Piece> pieces;
    const auto now = static_cast<std::size_t>(s.frame);
    for (std::size_t k = now; k-- > 0;) {
        const double age = (moved_[now] - moved_[k]) / (kTrailSeconds * home.context.setup->fps);
        if (age > 1) break;
        if (moved_[k + 1] == moved_[k]) continue;
        pieces.push_back({piece(home, k), 1 - age});
        for (Vec2& p : pieces.back().line) p = seen_in(s, home, p);
    }
    const auto stroke = [&](Color color, double strength, double width) {
        for (const Piece& each : pieces) {
            s.canvas.polyline(each.line);
            s.canvas.stroke({color.faded(strength * each.opacity), width, {}, Cap::butt});
        }
    };
    const double width = 2 * home.unit;
    if (s.canvas.casing) stroke(s.canvas.casing->color, 1, width + s.canvas.casing->width);
    stroke(home.palette.motion, 0.55, width);
}

void TipPath::draw_whole(const MechanismScene& s, const MechanismView& home) const {
    const auto end = std::ranges::upper_bound(whole_.times, s.pose.t) - whole_.times.begin();
    std::vector<Vec2> line;
    for (std::ptrdiff_t i = 0; i < end; ++i)
        line.push_back(seen_in(s, home, whole_.points[static_cast<std::size_t>(i)] + Vec2{home.box.x, home.box.y}));
    const Pen pen{s.at.palette.motion_faint, 1.6 * s.at.unit};
    if (const std::optional<Casing>& under = s.canvas.casing)
        s.canvas.curve(line, {under->color, pen.width + under->width});
    s.canvas.curve(line, pen);
}

}  // namespace beamcam::render
