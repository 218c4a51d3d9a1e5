#include "render/film/mechanism_cameras.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/mechanism/cam_outline.hpp"

namespace beamcam::render {
namespace {

using std::numbers::pi;

double solid_distance(const Box& box) { return 2.4 * std::max(box.w, box.h); }  // a mild perspective

}  // namespace

MechanismCameras::MechanismCameras(const MechanismView& home) : home_(home) {
    if (home.context.setup->view.style == Style::solid) fit_solid_view();
}

void MechanismCameras::follow(const std::vector<Followed>& parts) {
    const FilmSetup& setup = *home_.context.setup;
    const Shot& first = setup.view.shot;
    if (first.zoom == 1 && first.follow == Anchor{} && setup.moves.empty()) return;
    shots_ = camera_frames(first, setup.moves, home_.look.camera, home_.box, parts, setup.fps);
}

bool MechanismCameras::move_at(int frame) const {
    const auto now = static_cast<std::size_t>(frame);
    return moves() && !(shots_[now] == shots_[now - 1]);
}

double MechanismCameras::presence(int frame) const {
    constexpr double kWhole = 1.25;  // zoom from which it is there
    if (!home_.whole || !moves()) return 1;
    return std::clamp((shots_[static_cast<std::size_t>(frame)].zoom - 1) / (kWhole - 1), 0.0, 1.0);
}

MechanismView MechanismCameras::view(int frame) const {
    return near() ? home_.with_camera(shots_[static_cast<std::size_t>(frame)]) : home_;
}

// Seen from far aside, bodies in perspective may need more room than from the front, or much less: the picture is
// reduced or enlarged, and moved.
void MechanismCameras::fit_solid_view() {
    const View& view = home_.context.setup->view;
    const Vec2 middle = home_.box.centre(), hinge = home_.px({0, 0});
    const double half = home_.wide / 2, hub = home_.hub(),
                 foot = floor_depth(home_.problem(), home_.look.camera, home_.unit);
    Bounds seen;  // from the centre of the panel, at zoom 1 [px]
    const auto add_all = [&](double yaw, double pitch) {
        const auto from = Projection::looking({}, solid_distance(home_.box), 1, yaw, pitch);
        const auto add = [&](Vec2 p, double z) { seen.add(from.to_pixels({p.x - middle.x, middle.y - p.y, z})); };
        for (const std::vector<Vec2>& strip : home_.context.extent.strips)
            for (const Vec2 p : strip) add(home_.px(p), half), add(home_.px(p), -half);
        for (int i = 0; home_.problem().cam && i < 32; ++i) {
            const Vec2 rim = home_.problem().cam->centre + sim::unit(2 * pi * i / 32) * cam_reach(home_.problem());
            for (const double side : {-1.0, 1.0}) add(home_.px(rim), side * kDiscDepth * home_.wide);
        }
        for (const double x : {-1.6 * hub, 1.6 * hub})
            for (const double z : {-kMountDepth * home_.wide, kHubDepth * home_.wide})
                add(hinge + Vec2{x, foot}, z), add(hinge + Vec2{x, -hub}, z);
    };
    add_all(view.shot.yaw, view.shot.pitch);
    for (const CameraMove& move : home_.context.setup->moves) add_all(move.shot.yaw, move.shot.pitch);
    const Box all = seen.box();
    const double w = home_.box.w / 2, h = home_.box.h / 2, zoom = solid_zoom_;
    constexpr double kMost = 0.96, kLeast = 0.8, kLargest = 1.5;  // parts of the panel; zoom
    const double fits = std::min(home_.box.w / all.w, home_.box.h / all.h);
    const bool leaves = zoom * std::max(-all.x, all.right()) > w || zoom * std::max(-all.y, all.bottom()) > h;
    if (!leaves && kLeast * fits <= zoom) return;
    solid_zoom_ = std::clamp(zoom, std::min(kLeast * fits, kLargest), std::max(kMost * fits, 1e-9));
    solid_shift_ = all.centre() * -solid_zoom_;
}

// A near camera is not shifted.
Projection MechanismCameras::looking(const MechanismView& at, double yaw, double pitch) const {
    const Vec2 shift = solid_shift_ * std::clamp(2 - at.zoom(), 0.0, 1.0);
    return Projection::looking(at.box.centre() + shift, solid_distance(at.box) * at.zoom(), solid_zoom_, yaw, pitch);
}

std::optional<Projection> MechanismCameras::perspective(const MechanismView& at, int frame) const {
    const View& view = at.context.setup->view;
    if (view.style != Style::solid) return std::nullopt;
    double yaw = view.shot.yaw, pitch = view.shot.pitch;
    if (near())
        yaw = shots_[static_cast<std::size_t>(frame)].yaw, pitch = shots_[static_cast<std::size_t>(frame)].pitch;
    return looking(at, yaw, pitch);
}

}  // namespace beamcam::render
