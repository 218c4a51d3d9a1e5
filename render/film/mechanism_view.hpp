// Position and scale of a mechanism in a film, and the state of drawing one frame of it.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "render/film/panel.hpp"
#include "render/gl/bodies.hpp"
#include "render/mechanism/mechanism.hpp"

namespace beamcam::render {

// A motion at a pose, as it is drawn.
struct DrawnPose {
    sim::Pose pose;
    DrawnBeam beam;
    MechanismShape shape;
};

struct MechanismView {
    MechanismView(const FilmContext& context, const PanelSlot& slot);

    const FilmContext& context;
    const Palette& palette;
    Box box;
    int member;
    bool ghosts;       // the other motions are drawn in this panel as outlines
    double unit;       // size of a design pixel of lines and letters [px]
    double marks = 1;  // the same for marks on the mechanism (mark_unit) [px]
    bool small;
    bool whole;  // the camera does not move: it shows everything
    // Of the line below the mechanism, with scale bar and the name of the marks [px].
    double line_below() const { return labelled() ? context.look.letters.words : 0; }
    bool labelled() const { return !small && context.setup->view.labelled(); }
    MechanismLook look;
    double wide;  // width of the beam across the plane of motion, in the solid view [px]

    // The same view with another camera: shapes grow with the zoom; lines and letters do not.
    MechanismView with_camera(const CameraFrame& frame_camera) const;
    double zoom() const { return look.unit / unit; }
    double fade() const { return 60 * unit * std::clamp(zoom() - 1, 0.0, 1.0); }  // width of the edges of a near view
    bool shows(Vec2 px) const {
        return !moved || (px.x > box.x && px.x < box.right() && px.y > box.y && px.y < box.bottom());
    }
    double hub() const { return hub_radius(problem(), look.camera, look.unit); }
    bool moved = false;                // the camera is not the one that shows everything
    bool names = false;                // a row above the mechanism names motions
    bool over_floor = true;            // the beam stays above the floor
    std::optional<double> arc_radius;  // of θ, before the camera that shows everything [px]

    const Motion& motion() const { return context.motion(member); }
    const sim::Problem& problem() const { return motion().problem; }
    Vec2 px(Vec2 world) const { return look.camera.to_pixels(world); }
    // Projects a point [px of the flat view] at this depth before the plane of motion, relative to the width of the
    // beam, whose front is at 0.5; unchanged if `view` is null.
    Vec2 seen(Vec2 flat, const Projection* view, double depth = 0.5) const;
    DrawnBeam drawn(int whose, const sim::Pose& pose) const;
    DrawnPose drawn_pose(int whose, sim::Pose pose) const;
    DrawnPose drawn_frame(int frame) const { return drawn_pose(member, context.pose(member, frame)); }
    DrawnBeam beam_of(int whose, int frame) const { return drawn(whose, context.pose(whose, frame)); }

  private:
    void place_camera();
};

// State of drawing one frame.
struct MechanismScene {
    Canvas& canvas;
    int frame;
    const sim::Pose& pose;
    const DrawnBeam& beam;
    const MechanismShape& shape;
    const MechanismView& at;
    const Projection* view;  // of the solid view; null: flat or lit

    Vec2 on(Vec2 flat, double depth = 0.5) const { return at.seen(flat, view, depth); }
    Vec2 on_disc(Vec2 flat) const { return on(flat, kDiscDepth); }
    Vec2 px(Vec2 world) const { return on(at.px(world)); }
    void arc(Vec2 flat_centre, double radius, double from, double to, double depth = 0.5) const;
};

}  // namespace beamcam::render
