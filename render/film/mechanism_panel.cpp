#include "render/film/mechanism_panel.hpp"

#include <algorithm>
#include <numbers>

#include "render/film/offscreen.hpp"

namespace beamcam::render {
namespace {

using sim::Pose;

using std::numbers::pi;

}  // namespace

// ---- prepared once for a film ----------------------------------------------------------------

struct MechanismPanel::ThreadState final : FilmPanel::State {
    ThreadState(const FilmContext& context, int member, double scale, const Box& box)
        : path(kept_path(context.setup->view.tip_path, box)),
          path_casing(kept_path(context.setup->view.tip_path && context.setup->view.transparent, box)),
          trace(trace_of(context, member, scale)) {}
    static Trace trace_of(const FilmContext& context, int member, double scale) {
        const sim::Problem& problem = context.motion(member).problem;
        const double rim = 2 * pi * (problem.cam ? problem.cam->radius : 1), length = problem.beam.length;
        const auto places = [&](double metres) {
            return static_cast<std::size_t>(std::clamp(metres * scale, 1.0, 65536.0));
        };
        return {context.samples[static_cast<std::size_t>(member)], rim, places(rim), length, places(length)};
    }
    static AccumulatedLayer kept_path(bool needed, const Box& box) {
        return needed ? AccumulatedLayer(static_cast<int>(box.w), static_cast<int>(box.h)) : AccumulatedLayer(1, 1);
    }
    AccumulatedLayer path, path_casing;
    Trace trace;
    LitMechanism lit;
    Offscreen seen, exposed;  // view of a moving camera; one of several exposures
};

MechanismPanel::MechanismPanel(const FilmContext& context, const PanelSlot& slot)
    : at_(context, slot), legend_(at_), cameras_(at_) {
    at_.labels = &labels_;
    rings_.find(at_);
    const double cell = std::max(1.5, 2 * at_.unit);
    SweptRegion swept(at_, OccupancyGrid(at_.box, cell), cameras_.projections()), in_contact = swept;
    add_survey(swept);
    in_contact.add_fixed(), swept.add_fixed();
    std::vector<Followed> followed;
    const LabelNeeds needs = add_frames(swept, in_contact, followed);
    cameras_.follow(followed);
    labels_ = place_labels(at_, cameras_, needs, swept, in_contact);
    if (at_.member == 0) place_captions();
    legend_.place(std::move(swept.room));
}

std::unique_ptr<FilmPanel::State> MechanismPanel::make_state() const {
    return std::make_unique<ThreadState>(at_.context, at_.member, at_.look.camera.scale, at_.box);
}

// For the solid view this is an estimate: it is evaluated as if seen from the front.
int MechanismPanel::empty_frames() const {
    int count = 0;
    for (int k = 0; cameras_.near() && k < at_.context.frames(); ++k) {
        const Camera camera = cameras_.view(k).look.camera;
        const auto sees = [&](const Bounds& part) {  // a part of the mechanism [m]
            const Vec2 corner = camera.to_pixels({part.x0, part.y1});
            return at_.box.overlaps(
                {corner.x, corner.y, (part.x1 - part.x0) * camera.scale, (part.y1 - part.y0) * camera.scale});
        };
        const DrawnBeam drawn = beam(k);
        bool seen = false;
        for (std::size_t i = 1; i < drawn.line.size() && !seen; ++i) {
            Bounds piece;
            for (const Vec2 p : {drawn.face(i - 1), drawn.back(i - 1), drawn.face(i), drawn.back(i)}) piece.add(p);
            seen = sees(piece);
        }
        Bounds hub, disc;
        hub.add({0, 0}, hub_radius(at_.problem(), at_.look.camera, at_.unit) / at_.look.camera.scale);
        if (at_.problem().cam) disc.add(at_.context.pose(at_.member, k).disc_centre, at_.problem().cam->radius);
        if (!seen && !sees(hub) && !(at_.problem().cam && sees(disc))) ++count;
    }
    return count;
}

// ---- the background --------------------------------------------------------------------------

void MechanismPanel::draw_background(Canvas& canvas) const {
    if (cameras_.near()) return;
    draw_still(canvas, at_);
    legend_.draw(canvas, at_);
}

void MechanismPanel::draw_still(Canvas& canvas, const MechanismView& at) const {
    if (at.context.setup->view.style == Style::solid) return;  // the camera may move: there is no fixed background
    const Vec2 o = at.px({0, 0});
    canvas.line({at.box.x, o.y}, {at.box.right(), o.y},
                {at.palette.faint, 1.5 * at.unit, {10 * at.unit, 8 * at.unit}, Cap::butt});
    draw_support(canvas, o, at.hub(), at.marks * at.zoom(), at.marks, at.palette);
}

// ---- moving parts ----------------------------------------------------------------------------

bool MechanismPanel::accumulates_path() const {
    return at_.context.setup->view.tip_path && at_.context.setup->view.style != Style::solid && !cameras_.near();
}

void MechanismPanel::draw_accumulated_path(Canvas& canvas, int frame, ThreadState& threads) const {
    const double t = at_.context.at(frame);
    const Pen pen{at_.palette.motion_faint, 1.6 * at_.unit};
    const auto draw = [&](AccumulatedLayer& layer, const Pen& with) {
        layer.extend_to(t, tip_path_.whole(), canvas.fonts(), with);
        layer.draw(canvas, {at_.box.x, at_.box.y});
    };
    if (canvas.casing) draw(threads.path_casing, {canvas.casing->color, pen.width + canvas.casing->width});
    draw(threads.path, pen);
}

void MechanismPanel::draw(Canvas& canvas, int frame, Style style, State* state) const {
    auto& threads = *static_cast<ThreadState*>(state);
    if (accumulates_path()) draw_accumulated_path(canvas, frame, threads);
    if (!cameras_.near()) return draw_moving(canvas, at_, frame, style, threads);
    const MechanismView at = cameras_.view(frame);
    threads.seen.put(canvas, at.box, [&](Canvas& inside) {
        draw_still(inside, at);
        draw_moving(inside, at, frame, style, threads);
        legend_.draw(inside, at);
    });
}

void MechanismPanel::draw_moving(Canvas& canvas, const MechanismView& at, int frame, Style style, ThreadState& threads,
                                 std::vector<Box>* labels) const {
    const auto [pose, drawn, shape] = at.drawn_frame(frame);
    threads.trace.advance_to(pose.t);
    const std::optional<Perspective> perspective = cameras_.perspective(at, frame);
    const Perspective* view = perspective ? &*perspective : nullptr;
    const std::optional<ForceArrow> arrow = force_arrow_of(pose, drawn, rings_.peak(frame, drawn));
    const MechanismScene s{canvas, frame, pose, drawn, shape, at, view, arrow, labels};
    if (at.ghosts) draw_ghost_bodies(s);
    const bool several = at.motion().exposures > 1, one = !several || view_strobes();
    const auto bodies = [&] {
        canvas.uncased([&] {
            if (several) draw_exposures(s, style, threads);
            if (one) draw_bodies(s, style, threads);
        });
    };
    if (!s.view) {
        draw_angle_arc(s);
        draw_base_line(s);
        draw_cam_speed(s);
    }
    draw_tip_path(s);  // over the halos of letters, which would interrupt it
    bodies();
    draw_force_leader(s);  // over the beam, so that it reaches its arrow
    if (s.view) {          // in the plane of the front of the beam: the mount must not hide them
        draw_angle_arc(s);
        draw_cam_speed(s);
    }
    if (!s.view && one) canvas.uncased([&] { draw_beam_trace(s, threads.trace); });
    if (at.ghosts) draw_ghost_outlines(s);
    if (at.member == 0) draw_measured_beams(s);
    rings_.draw(s);
    draw_disc_letters(s);  // over the rings, which would make them hard to read
    if (at.member == 0) draw_caption_leaders(s);
    draw_force(s);  // its label has a halo that interrupts these lines
    if (at.member == 0) draw_captions(s);
}

void MechanismPanel::draw_bodies(const MechanismScene& s, Style style, ThreadState& threads) const {
    if (s.view && style != Style::solid) return;  // only the labels are needed
    switch (style) {
        case Style::solid:
            return threads.lit.draw_solid(s, rim_colors(s.at, threads.trace, s.pose.t));
        case Style::lit:
            threads.lit.draw(s.canvas, s.shape, s.at, s.at.moved || s.at.motion().exposures > 1 ? s.at.box : lit_box_);
            break;
        case Style::flat:
            draw_flat(s.canvas, s.shape, s.at.unit, s.at.palette);
            break;
    }
    if (s.shape.disc) draw_disc_marks(s, threads.trace);
}

// Motion blur draws the mean of all exposures; the strobe draws them one by one, older ones fainter.
void MechanismPanel::draw_exposures(const MechanismScene& s, Style style, ThreadState& threads) const {
    const std::size_t count = s.at.motion().exposures;
    const auto draw_one = [&](Canvas& canvas, const Pose& pose) {
        DrawnPose one = s.at.drawn_pose(s.at.member, pose);
        if (view_strobes()) one.shape.disc.reset();
        draw_bodies({canvas, s.frame, one.pose, one.beam, one.shape, s.at, s.view}, style, threads);
    };
    const auto pose_of = [&](std::size_t which) {
        return s.at.motion().pose(static_cast<std::size_t>(s.frame), which);
    };
    if (!view_strobes())
        return threads.exposed.put_mean(s.canvas, s.at.box, count,
                                        [&](Canvas& canvas, std::size_t which) { draw_one(canvas, pose_of(which)); });
    for (std::size_t k = 1; k < count; ++k) {
        const Pose pose = pose_of(k);
        if (pose.t >= s.pose.t) continue;  // before the first flash
        const double age = static_cast<double>(count - k) / static_cast<double>(count);
        threads.exposed.put(
            s.canvas, s.at.box, [&](Canvas& canvas) { draw_one(canvas, pose); }, 0.5 - 0.38 * age);
    }
}

// The whole path of the tip, unless its layer is drawn already, or its last part.
void MechanismPanel::draw_tip_path(const MechanismScene& s) const {
    if (accumulates_path()) return;
    if (at_.context.setup->view.tip_path)
        tip_path_.draw_whole(s, at_);
    else
        tip_path_.draw_trail(s, at_);
}

// The camera and fading labels change while time is frozen.
bool MechanismPanel::animates_while_paused(int frame) const {
    if (cameras_.move_at(frame)) return true;
    for (const auto* label : {&labels_.angle, &labels_.speed, &labels_.force})
        if (*label && ((*label)->opacity_at(frame) != (*label)->opacity_at(frame - 1) ||
                       !((*label)->offset_at(frame) == (*label)->offset_at(frame - 1))))
            return true;
    return false;
}

std::vector<Box> MechanismPanel::labels(Canvas& canvas, int frame) const {
    std::vector<Box> out;
    auto state = make_state();
    draw_moving(canvas, cameras_.view(frame), frame, Style::flat, static_cast<ThreadState&>(*state), &out);
    return out;
}

PanelType mechanism_panel() {
    return {
        .kind = PanelKind::mechanism, .name = "mechanism", .smallest = {16, 16}, .make = make_panel<MechanismPanel>};
}

}  // namespace beamcam::render
