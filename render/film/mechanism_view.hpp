// Where and how large a mechanism is drawn in a film, and one frame of it as it is being drawn.
#pragma once

#include <optional>
#include <vector>

#include "render/film/mechanism_labels.hpp"
#include "render/film/panel.hpp"
#include "render/gl/solid.hpp"
#include "render/mechanism/mechanism.hpp"

namespace beamcam::render {

struct MechanismView {
    MechanismView(const FilmContext& context, const PanelSlot& slot);

    const FilmContext& context;
    const Palette& palette;
    Box box;
    int member;
    bool ghosts;  // the other motions are drawn here as outlines
    double unit,
        marks = 1;  // [px] of a design pixel: of lines and words; of what is drawn on the mechanism (mark_unit)
    bool small;
    bool labelled() const { return !small && context.setup->view.show.labels; }
    MechanismLook look;
    double wide;  // of the beam across the plane of motion, in the solid view [px]

    // The same with the camera elsewhere: what is drawn grows with the zoom, lines and letters do not.
    MechanismView with_camera(const CameraFrame& frame_camera) const;
    double zoom() const { return look.unit / unit; }
    bool shows(Vec2 px) const {
        return !moved || (px.x > box.x && px.x < box.right() && px.y > box.y && px.y < box.bottom());
    }
    double hub() const { return hub_radius(problem(), look.camera, look.unit); }
    const MechanismLabels* labels = nullptr;  // null: not yet placed
    bool moved = false;                       // the camera does not show all

    const Motion& motion() const { return context.motion(member); }
    const sim::Problem& problem() const { return motion().problem; }
    Vec2 px(Vec2 world) const { return look.camera.to_pixels(world); }
    // Where a point of the plane of motion [px of the flat view] is seen; null: as it is.
    Vec2 seen(Vec2 flat, const Perspective* view) const;
    DrawnBeam drawn(int whose, const sim::Pose& pose) const;
    DrawnBeam beam_of(int whose, int frame) const { return drawn(whose, context.pose(whose, frame)); }
    // Where a label is written. A moving camera keeps it as near to its base, or to this one [m], as the camera that
    // shows all does, and within the view; in perspective, the end of it that is nearest to its base keeps its place.
    Box label_box(const LabelPlace& label, const Perspective* view, std::optional<Vec2> base = {}) const;

  private:
    void place_camera();
};

// One frame as it is being drawn.
struct MechanismScene {
    Canvas& canvas;
    int frame;
    const sim::Pose& pose;
    const DrawnBeam& beam;
    const MechanismShape& shape;
    const MechanismView& at;
    const Perspective* view;               // of the solid view; null: as it is
    std::optional<ForceArrow> arrow = {};  // the arrow of force that it shows
    std::vector<Box>* labels = nullptr;    // where each label was drawn is added here

    Vec2 on(Vec2 flat) const { return at.seen(flat, view); }
    Vec2 px(Vec2 world) const { return on(at.px(world)); }
    void arc(Vec2 flat_centre, double radius, double from, double to) const;
};

}  // namespace beamcam::render
