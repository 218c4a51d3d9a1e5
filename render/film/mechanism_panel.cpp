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
    ThreadState(const FilmContext& context, int member, double scale) : trace(trace_of(context, member, scale)) {}
    static Trace trace_of(const FilmContext& context, int member, double scale) {
        const sim::Problem& problem = context.motion(member).problem;
        const double rim = 2 * pi * (problem.cam ? problem.cam->radius : 1), length = problem.beam.length;
        const auto places = [&](double metres) {
            return static_cast<std::size_t>(std::clamp(metres * scale, 1.0, 65536.0));
        };
        return {context.samples[static_cast<std::size_t>(member)], rim, places(rim), length, places(length)};
    }
    Trace trace;
    LitMechanism lit;
    Offscreen seen;  // view of a moving camera
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
    return std::make_unique<ThreadState>(at_.context, at_.member, at_.look.camera.scale);
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

void MechanismPanel::draw(Canvas& canvas, int frame, Style style, State* state) const {
    auto& threads = *static_cast<ThreadState*>(state);
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
    if (!s.view) {
        draw_angle_arc(s);
        draw_base_line(s);
        draw_cam_speed(s);
    }
    tip_path_.draw_trail(s, at_);  // over the halos of letters, which would interrupt it
    canvas.uncased([&] { draw_bodies(s, style, threads); });
    draw_force_leader(s);  // over the beam, so that it reaches its arrow
    if (s.view) {          // in the plane of the front of the beam: the mount must not hide them
        draw_angle_arc(s);
        draw_cam_speed(s);
    }
    if (!s.view) canvas.uncased([&] { draw_beam_trace(s, threads.trace); });
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
            return threads.lit.draw_solid(s, rim_colors(s.at, threads.trace));
        case Style::lit:
            threads.lit.draw(s.canvas, s.shape, s.at, s.at.moved ? s.at.box : lit_box_);
            break;
        case Style::flat:
            draw_flat(s.canvas, s.shape, s.at.unit, s.at.palette);
            break;
    }
    if (s.shape.disc) draw_disc_marks(s, threads.trace);
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
