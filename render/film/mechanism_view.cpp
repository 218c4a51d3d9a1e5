#include "render/film/mechanism_view.hpp"

#include <algorithm>
#include <utility>

#include "render/film/mechanism_labels.hpp"

namespace beamcam::render {
MechanismView::MechanismView(const FilmContext& all, const PanelSlot& slot)
    : context(all),
      palette(all.look.palette),
      box(slot.box),
      member(std::min(slot.spec.member, all.members() - 1)),
      ghosts(all.members() > 1 && all.setup->comparison == Comparison::ghosts),
      unit(all.look.unit),
      small(is_small(slot.box, all.look.unit)),
      whole(slot.spec.kind == PanelKind::overview) {
    // Several mechanisms have the same scale, so that they can be compared.
    look.unit = unit;
    look.factor = all.scales.exaggeration;
    look.moment_scale = all.scales.moment;
    const bool measured = member == 0 && std::ranges::any_of(all.setup->data, [](const FilmData& data) {
                              return data.find({sim::ChannelKind::theta, 0}) != nullptr;
                          });
    names = (all.members() > 1 || measured) && has_names(box, unit);
    place_camera();
    wide = std::clamp(0.06 * problem().beam.length * look.camera.scale, 18 * unit, 80 * unit);
    over_floor = px({0, context.extent.beams.y0}).y < px({0, 0}).y + floor_depth(problem(), look.camera, unit);
    arc_radius = render::arc_radius(*this);
}

// The camera shows the beam of every frame, the circle that the disc sweeps, and the support.
void MechanismView::place_camera() {
    // A beam thinner than a line is drawn with the width of a line, which it gains on the side away from the cam.
    const auto as_deep_as = [&](const ViewExtent& extent) {
        const double label = !names ? 0 : (box.h > 200 * unit ? 38 : 28) * unit;
        look.camera = extent.camera({box.x, box.y + label, box.w, box.h - label - line_below()}, unit);
        look.depth = std::max(beam_depth(problem().beam), 10 * unit / look.camera.scale);
    };
    as_deep_as(context.extent);
    if (look.depth > beam_depth(problem().beam)) as_deep_as(view_extent_of(context, look.depth));
    marks = unit;  // the same for all mechanisms
    for (const sim::Problem* p : context.extent.problems) marks = std::min(marks, mark_unit(*p, look.camera, unit));
}

MechanismView MechanismView::with_camera(const CameraFrame& frame_camera) const {
    MechanismView out = *this;
    out.look.camera = frame_camera.camera;
    out.look.unit = unit * frame_camera.zoom;
    out.wide = wide * frame_camera.zoom;
    out.moved = true;
    out.box.h -= 1.6 * line_below();
    return out;
}

Vec2 MechanismView::seen(Vec2 flat, const Projection* view, double depth) const {
    if (!view) return flat;
    const Vec2 middle = box.centre();
    return view->to_pixels({flat.x - middle.x, middle.y - flat.y, depth * wide});
}

DrawnBeam MechanismView::drawn(int whose, const sim::Pose& pose) const {
    const sim::Problem& its = context.motion(whose).problem;
    const double factor = its.beam.model == sim::ModelKind::rigid ? 1 : look.factor;
    return drawn_beam(its, pose, factor, look.depth, context.section_reference(whose));
}

DrawnPose MechanismView::drawn_pose(int whose, sim::Pose pose) const {
    DrawnBeam beam = drawn(whose, pose);
    MechanismShape shape = mechanism_shape(context.motion(whose).problem, pose, beam, look, palette);
    return {std::move(pose), std::move(beam), std::move(shape)};
}

void MechanismScene::arc(Vec2 centre, double radius, double from, double to, double depth) const {
    if (!view) return canvas.arc(centre, radius, from, to);
    constexpr int kPieces = 48;
    std::vector<Vec2> points;
    for (int i = 0; i <= kPieces; ++i)
        points.push_back(on(centre + down(from + (to - from) * i / kPieces) * radius, depth));
    canvas.polyline(points);
}

}  // namespace beamcam::render
