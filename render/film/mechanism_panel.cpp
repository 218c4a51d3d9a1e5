#include "render/film/mechanism_panel.hpp"

#include <algorithm>
#include <cmath>

#include "render/film/mechanism_labels.hpp"
#include "render/film/mechanism_marks.hpp"
#include "render/mechanism/cam_outline.hpp"

namespace beamcam::render {
namespace {

Pen horizontal_pen(const MechanismView& at) {
    return {at.palette.faint, 1.5 * at.unit, {10 * at.unit, 8 * at.unit}, Cap::butt};
}

}  // namespace

// ---- prepared once for a film ----------------------------------------------------------------

MechanismPanel::MechanismPanel(const FilmContext& context, const PanelSlot& slot)
    : at_(context, slot), legend_(at_), cameras_(at_), tip_path_(at_), rings_(at_) {
    std::vector<Followed> followed;
    for (int k = 0; k < context.frames(); ++k) {
        const auto [pose, drawn, shape] = at_.drawn_frame(k);
        const Vec2 tip = at_.look.camera.to_world((shape.face.back() + shape.back.back()) * 0.5);
        followed.push_back(
            {tip, drawn.contact ? drawn.contact->on_disc : tip, at_.problem().cam ? pose.cam_centre : Vec2{}});
    }
    cameras_.follow(followed);
}

Trace MechanismPanel::trace_until(double t) const {
    const sim::Problem& problem = at_.problem();
    const double rim = problem.cam ? cam_circumference(problem) : 1, length = problem.beam.length;
    const auto places = [&](double metres) {
        return static_cast<std::size_t>(std::clamp(metres * at_.look.camera.scale, 1.0, 65536.0));
    };
    return render::trace_until(at_.context.samples[static_cast<std::size_t>(at_.member)], t, rim, places(rim), length,
                               places(length));
}

bool MechanismPanel::has_marks(int frame) const {
    const double now = at_.context.clock.at(frame);
    return std::ranges::any_of(at_.context.samples, [now](const std::vector<TraceSample>& contacts) {
        return !contacts.empty() && contacts.front().t <= now;
    });
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
        if (at_.problem().cam) disc.add(at_.problem().cam->centre, cam_reach(at_.problem()));
        if (!seen && !sees(hub) && !(at_.problem().cam && sees(disc))) ++count;
    }
    return count;
}

// ---- the background --------------------------------------------------------------------------

void MechanismPanel::draw_background(Canvas& canvas) const {
    if (cameras_.moves()) return;
    draw_still(canvas, at_);
    legend_.draw(canvas, at_);
}

void MechanismPanel::draw_still(Canvas& canvas, const MechanismView& at) const {
    if (at.context.setup->view.style == Style::solid) return;  // the camera may move: there is no fixed background
    const Vec2 o = at.px({0, 0});
    canvas.line({at.box.x, o.y}, {at.box.right(), o.y}, horizontal_pen(at));
    if (at.context.setup->view.style == Style::flat)
        canvas.without_halo([&] { draw_support(canvas, o, at.hub(), at.marks * at.zoom(), at.marks, at.palette); });
}

// ---- moving parts ----------------------------------------------------------------------------

// What a near camera cuts off fades out towards the edges of its view, the more the nearer it is.
static void fade_edges(Canvas& canvas, const MechanismView& at) {
    constexpr int kSteps = 24;
    const double step = std::round(at.fade() / kSteps);
    if (step < 1) return;
    const Box& b = at.box;
    for (int k = 0; k < kSteps; ++k) {
        const double inner = k * step;
        for (const Box& strip : {Box{b.x + inner, b.y, step, b.h}, Box{b.right() - inner - step, b.y, step, b.h},
                                 Box{b.x, b.y + inner, b.w, step}, Box{b.x, b.bottom() - inner - step, b.w, step}}) {
            canvas.erase(strip, 1 - (k + 0.5) / kSteps);
        }
    }
}

void MechanismPanel::draw(Canvas& canvas, int frame, Style style, BodyPicture& bodies) const {
    if (!cameras_.moves()) {
        if (has_marks(frame)) legend_.name_contacts(canvas);
        return draw_moving(canvas, at_, frame, style, bodies);
    }
    const double presence = cameras_.presence(frame);
    if (presence == 0) return;
    const MechanismView at = cameras_.view(frame);
    canvas.clip(at.box, [&] {
        canvas.layer(presence, [&] {
            draw_still(canvas, at);
            draw_moving(canvas, at, frame, style, bodies);
            fade_edges(canvas, at);
        });
    });
    legend_.draw(canvas, at);
    if (has_marks(frame)) legend_.name_contacts(canvas);
}

void MechanismPanel::draw_moving(Canvas& canvas, const MechanismView& at, int frame, Style style,
                                 BodyPicture& bodies) const {
    const auto [pose, drawn, shape] = at.drawn_frame(frame);
    const Trace trace = trace_until(pose.t);
    const std::optional<Projection> perspective = cameras_.perspective(at, frame);
    const MechanismScene s{canvas, frame, pose, drawn, shape, at, perspective ? &*perspective : nullptr};
    if (at.ghosts) draw_ghost_bodies(s);
    if (s.view) {
        const Vec2 o = at.px({0, 0});
        canvas.clip(at.box, [&] { canvas.line(s.on(o), s.on({at.box.right(), o.y}), horizontal_pen(at)); });
        legend_.scale_bar(canvas, at, s.view);
    }
    draw_undeflected(s);
    const std::optional<Vec2> theta = draw_arc_of_angle(s);
    tip_path_.draw_trail(s);
    canvas.without_halo([&] {
        if (!s.view || style == Style::solid) {  // else only the labels are needed
            style == Style::flat ? draw_flat(canvas, s.shape, at.unit, at.palette) : bodies.draw(s);
            if (s.shape.disc) draw_disc_marks(s, trace);
        }
        draw_beam_trace(s, trace);
    });
    if (theta) draw_letter_of_angle(s, *theta);
    if (at.ghosts) draw_ghost_outlines(s);
    if (at.member == 0) draw_measured_beams(s);
    draw_cam_speed(s);
    draw_hub_torque(s);
    rings_.draw(s);
    draw_force(s);
}

bool MechanismPanel::animates_while_paused(int frame) const { return cameras_.move_at(frame); }

PanelType mechanism_panel() {
    return {
        .kind = PanelKind::mechanism, .name = "mechanism", .smallest = {16, 16}, .make = make_panel<MechanismPanel>};
}

PanelType overview_panel() {
    return {.kind = PanelKind::overview, .name = "overview", .smallest = {16, 16}, .make = make_panel<MechanismPanel>};
}

}  // namespace beamcam::render
