// The contact trace: around the disc, in the frame of the disc, a spoke for each place, whose length and colour show
// the largest force so far; below, the same along the beam.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/film/panel.hpp"

namespace beamcam::render {
namespace {

using std::numbers::pi;
constexpr std::size_t kSpokes = 720, kPlaces = 400;

struct Spokes final : FilmPanel::State {
    Spokes(const FilmContext& context, int member)
        : trace(context.samples[static_cast<std::size_t>(member)],
                2 * pi * (context.motion(member).problem.cam ? context.motion(member).problem.cam->radius : 1), kSpokes,
                context.motion(member).problem.beam.length, kPlaces) {}
    Trace trace;
};

class TracesPanel final : public FilmPanel {
  public:
    TracesPanel(const FilmContext& context, const PanelSlot& slot)
        : context_(context), member_(std::min(slot.spec.member, context.members() - 1)), box_(slot.box) {
        const double u = context.unit;
        const Box room{box_.x, box_.y + 40 * u, box_.w, box_.h - 40 * u - 74 * u};
        radius_ = 0.5 * std::min(room.w, room.h) / 1.42;
        centre_ = room.centre();
        axes_ = plot_area(box_, u, context.tick);
        beam_ = {axes_.x, box_.bottom() - 34 * u, axes_.w, 8 * u};
    }
    std::unique_ptr<State> make_state() const override { return std::make_unique<Spokes>(context_, member_); }

    void draw_background(Canvas& canvas) const override {
        const double u = context_.unit;
        const Palette& p = *context_.palette;
        const TextStyle heading{.size = context_.heading(), .weight = Weight::semibold};
        const std::string suffix = motion_suffix(context_, member_);
        draw_heading(canvas, context_, {axes_.x, box_.y, axes_.w, axes_.h},
                     first_that_fits(canvas,
                                     {context_.translate("Contact trace on disc and beam") + suffix,
                                      context_.translate("Contact trace") + suffix},
                                     heading, axes_.w));
        canvas.circle(centre_, radius_);
        canvas.fill_keeping_path(p.tint(p.steel, 0.5));
        canvas.stroke({p.steel_edge, 1.6 * u});
        // The mark of the disc, where arc positions start.
        canvas.circle(centre_ + Vec2{radius_ - 14 * u, 0}, 4 * u);
        canvas.fill(p.steel_edge);
        canvas.rounded(beam_, 3 * u);
        canvas.fill(p.tint(p.motion, 0.35));
        const TextStyle end{.size = 16.0 / 17 * context_.tick, .color = p.muted};
        canvas.text({beam_.x, beam_.bottom() + 3 * u + context_.tick}, context_.translate("root"), end);
        canvas.text({beam_.right(), beam_.bottom() + 3 * u + context_.tick}, context_.translate("tip"),
                    {.size = 16.0 / 17 * context_.tick, .color = p.muted, .align = HAlign::right});
    }

    void draw(Canvas& canvas, int frame, Style, State* state) const override {
        const double u = context_.unit;
        const Palette& p = *context_.palette;
        const sim::Pose& pose = context_.pose(member_, frame);
        Trace& trace = static_cast<Spokes*>(state)->trace;
        trace.advance_to(pose.t);
        const auto share = [&](float force) { return std::sqrt(std::min(1.0, double(force) / context_.force_scale)); };
        const double width = std::max(1.2, 2 * pi * radius_ / kSpokes * 1.3);
        stroke_places(canvas, context_, trace.rim(), width, [&](std::size_t i) {
            const Vec2 way = down(2 * pi * (static_cast<double>(i) + 0.5) / kSpokes);
            canvas.move_to(centre_ + way * radius_);
            canvas.line_to(centre_ + way * (radius_ * (1 + 0.06 + 0.32 * share(trace.rim()[i]))));
        });
        stroke_places(canvas, context_, trace.beam(), std::max(1.2, beam_.w / kPlaces * 1.3), [&](std::size_t i) {
            const double x = beam_.x + beam_.w * (static_cast<double>(i) + 0.5) / kPlaces;
            canvas.move_to({x, beam_.y});
            canvas.line_to({x, beam_.y - 4 * u - 22 * u * share(trace.beam()[i])});
        });
        if (!pose.nearest || !context_.motion(member_).problem.cam) return;
        const Vec2 now = down(pose.nearest->s / context_.motion(member_).problem.cam->radius);
        const Color color = pose.nearest->touching ? p.contact : p.muted;
        canvas.circle(centre_ + now * (radius_ - 6 * u), 4.5 * u);
        canvas.fill(color);
        canvas.circle(
            {beam_.x + beam_.w * pose.nearest->x / context_.motion(member_).problem.beam.length, beam_.y + beam_.h / 2},
            4.5 * u);
        canvas.fill(color);
    }

  private:
    const FilmContext& context_;
    int member_;
    Box box_, axes_, beam_;  // `axes_`: as wide as those of charts in the same column
    Vec2 centre_;
    double radius_ = 1;
};

}  // namespace

PanelType traces_panel() {
    return {.kind = PanelKind::traces,
            .name = "traces",
            .smallest = {240, 170},
            .make = make_panel<TracesPanel>,
            .needs_cam = true};
}

}  // namespace beamcam::render
