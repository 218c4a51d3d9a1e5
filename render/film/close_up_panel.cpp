// The contact close-up, in the frame of its tangent (to the right) and normal (up): the undeformed faces of beam and
// cam, not exaggerated, in a plot of heights against widths. Their overlap is the penetration of the contact law.
#include <algorithm>
#include <cmath>

#include "render/film/chart_panel.hpp"
#include "render/film/close_up_readings.hpp"
#include "sim/cam/cam_shape.hpp"

namespace beamcam::render {
namespace {

constexpr double kBelow = 1.35, kAbove = 1.9;  // displayed heights, relative to the largest penetration

class CloseUpPanel final : public FilmPanel {
  public:
    CloseUpPanel(const FilmContext& context, const PanelSlot& slot)
        : context_(context),
          member_(std::min(slot.spec.member, context.members() - 1)),
          box_(slot.box),
          area_(plot_area(slot.box, context.look.unit, context.look.letters.words)),
          style_(chart_style(context)),
          plot_(axes_, style_, "close-up") {
        for (const sim::Impact& i : motion().impacts) depth_ = std::max(depth_, i.penetration_peak);
        for (std::size_t k = 0; k < motion().surveyed(); ++k)
            if (const auto& near = motion().surveyed(k).nearest) depth_ = std::max(depth_, -near->gap);
        if (!motion().problem.cam) return;
        const double radius = sim::cam_shape(motion().problem)->largest_radius();
        // An impulsive contact does not penetrate: its scale is a ten-thousandth of the radius.
        if (!(depth_ > 1e-9 * radius)) depth_ = 1e-4 * radius;
        // The rim of the cam reaches the lower edge at the sides.
        half_width_ = std::min(std::sqrt(2 * radius * 1.2 * depth_), 0.9 * radius);
        axes_.x = {.label = "$x$ / m", .from = -half_width_, .to = half_width_, .short_numbers = true};
        axes_.y = {.label = "$y$ / m", .from = -kBelow * depth_, .to = kAbove * depth_, .short_numbers = true};
        unit_ = prefix_for(kAbove * depth_);
        Image none(1, 1);
        plot_.place(Canvas(none, *context.fonts), area_);
    }

    double begins() const override { return begins_with_touch(context_); }

    void draw_background(Canvas& canvas) const override {
        const bool has_cam = motion().problem.cam.has_value();
        const TextStyle bold{.size = context_.look.letters.heading, .weight = Weight::semibold},
            plain{.size = context_.look.letters.heading, .weight = Weight::medium};
        const double room = area_.w - 16 * context_.look.unit -
                            canvas.measure(context_.look.translate("penetration") + kWidestGap, plain).w;
        const std::string whose = motion_suffix(context_, member_), name = has_cam ? " " + plot_.y().name() : "";
        const std::string whole = context_.look.translate("Contact close-up"),
                          brief = context_.look.translate("Contact");
        // The reading is beside the heading.
        draw_heading(
            canvas, context_, {area_.x, box_.y, area_.w, area_.h},
            first_that_fits(
                canvas, {whole + whose + name, brief + whose + name, brief + name, has_cam ? plot_.y().name() : brief},
                bold, room));
        canvas.rectangle(area_);
        canvas.fill_keeping_path(context_.look.palette.paper);  // of its own in a transparent picture
        canvas.fill(close_up_background(context_.look.palette));
        if (!has_cam) return;
        plot_.draw_y_axis(canvas);
        plot_.draw_x_axis(canvas);
    }

    void draw(Canvas& canvas, int frame, Style, BodyPicture&) const override {
        const sim::Pose& pose = context_.pose(member_, frame);
        if (!motion().problem.cam || !pose.nearest) return;
        const sim::Nearest& near = *pose.nearest;
        canvas.clip(area_, [&] {
            canvas.without_halo([&] {
                draw_cam(canvas, pose);
                if (!is_above(near)) draw_beam(canvas, pose);
            });
        });
        if (is_above(near)) point_to_beam(canvas);
        CloseUpReadings{context_, motion(), box_, area_, unit_}.draw(canvas, pose, at(0, near.gap).y);
    }

  private:
    const Motion& motion() const { return context_.motion(member_); }
    Vec2 at(double x, double y) const { return plot_.at(x, y); }
    // Of the disc that osculates the cam at the contact.
    static double cam_height(const sim::Pose& pose, double x) {
        const double r = pose.disc_radius;
        return std::sqrt(std::max(0.0, r * r - x * x)) - r;
    }

    // Fills the area between the line and this height [px].
    static void fill_to(Canvas& canvas, const std::vector<Vec2>& line, double y, Color color) {
        canvas.polyline(line);
        canvas.line_to({line.back().x, y});
        canvas.line_to({line.front().x, y});
        canvas.close();
        canvas.fill(color);
    }

    std::vector<Vec2> rim(const sim::Pose& pose) const {
        std::vector<Vec2> out;
        for (int i = 0; i <= 80; ++i) {
            const double x = half_width_ * (i / 40.0 - 1) * 1.02;
            out.push_back(at(x, cam_height(pose, x)));
        }
        return out;
    }

    void draw_cam(Canvas& canvas, const sim::Pose& pose) const {
        const Palette& p = context_.look.palette;
        const std::vector<Vec2> edge = rim(pose);
        fill_to(canvas, edge, area_.bottom() + 4, p.steel);
        canvas.polyline(edge);
        canvas.stroke({p.steel_edge, 2 * context_.look.unit});
    }

    // The touching face near the contact, from the true centre line: heights above the tangent at the contact.
    std::vector<Vec2> face(const sim::Pose& pose) const {
        const sim::Nearest& near = *pose.nearest;
        const Vec2 n = near.normal, t{n.y, -n.x};
        const double offset = sim::contact_offset(motion().problem);
        const std::vector<Vec2>& line = pose.centreline;
        const double spacing = motion().problem.beam.length / static_cast<double>(line.size() - 1);
        // Curvature of the centre line at the contact, by three stations.
        const double station = std::clamp(near.x / spacing, 1.0, static_cast<double>(line.size() - 2));
        const auto i = static_cast<std::size_t>(std::lround(station));
        const Vec2 bend = (line[i + 1] - line[i] * 2 + line[i - 1]) * (1 / (spacing * spacing));
        const double curvature = dot(bend, n);
        std::vector<Vec2> out;
        // The face ends at the end of the beam.
        const double forward = dot(line[i + 1] - line[i - 1], t) >= 0 ? 1 : -1;
        const double before = near.x, after = motion().problem.beam.length - near.x;
        const double left = std::min(half_width_ * 1.02, forward > 0 ? before : after),
                     right = std::min(half_width_ * 1.02, forward > 0 ? after : before);
        for (int k = 0; k <= 60; ++k) {
            const double x = -left + (left + right) * k / 60.0;
            const double reach = 1 + offset * curvature;  // curvature of a curve parallel to the centre line
            out.push_back({x, near.gap + 0.5 * curvature * x * x / reach});
        }
        return out;
    }

    bool is_above(const sim::Nearest& near) const { return near.gap > kAbove * depth_; }  // the beam, the plot
    void point_to_beam(Canvas& canvas) const {
        const double u = context_.look.unit, x = area_.x + 20 * u;
        const Color color = context_.look.palette.motion;
        canvas.arrow({x, area_.y + 40 * u}, {x, area_.y + 10 * u}, {color, 2.4 * u}, {14 * u});
        canvas.text({x + 14 * u, area_.y + 31 * u}, context_.look.translate("beam"),
                    {.size = context_.look.letters.words, .color = color, .weight = Weight::medium});
    }

    void draw_beam(Canvas& canvas, const sim::Pose& pose) const {
        const Palette& p = context_.look.palette;
        const double u = context_.look.unit;
        const std::vector<Vec2> heights = face(pose);
        std::vector<Vec2> edge;
        for (Vec2 h : heights) edge.push_back(at(h.x, h.y));
        fill_to(canvas, edge, area_.y - 4, p.motion.faded(0.30));
        // The overlap.
        std::vector<Vec2> over, under;
        for (Vec2 h : heights)
            if (h.y < cam_height(pose, h.x))
                over.push_back(at(h.x, cam_height(pose, h.x))), under.push_back(at(h.x, h.y));
        if (over.size() > 1) {
            over.insert(over.end(), under.rbegin(), under.rend());
            canvas.polyline(over);
            canvas.close();
            canvas.fill(mix(p.paper, p.contact, 0.55));
            canvas.polyline(rim(pose));  // visible through the beam
            canvas.stroke({p.steel_edge, 2 * u});
        }
        canvas.polyline(edge);
        canvas.stroke({p.motion, 2.4 * u});
        const TextStyle name{.size = context_.look.letters.words, .color = p.motion, .weight = Weight::medium};
        const double top = std::max(edge.front().y, area_.y + 30 * u);
        if (top - area_.y > 24 * u)
            canvas.text({area_.x + 12 * u, std::min(area_.y + 24 * u, top - 6 * u)}, context_.look.translate("beam"),
                        name);
        if (at(0, std::min(0.0, pose.nearest->gap)).y < area_.bottom() - 32 * u)  // below the overlap
            canvas.text({area_.x + area_.w / 2 - 14 * u, area_.bottom() - 12 * u}, context_.look.translate("cam"),
                        {.size = context_.look.letters.words,
                         .color = mix(p.steel_edge, p.steel, 0.25),
                         .weight = Weight::medium});
        forces(canvas, *pose.nearest);
    }

    void forces(Canvas& canvas, const sim::Nearest& near) const {
        if (!near.touching || !(near.force > 0)) return;
        const Palette& p = context_.look.palette;
        const double u = context_.look.unit, longest = 0.55 * area_.h;
        const Vec2 foot = at(0, near.gap / 2);
        // Both forces have the same scale; a short arrow is a small one.
        const auto arrow = [&](double force, Vec2 way) {
            const double length = longest * std::min(1.0, force / context_.scales.largest_force),
                         size = std::min(u, length / 32);
            canvas.arrow(foot, foot + way * length, {p.contact, 4 * size}, {16 * size});
        };
        arrow(near.force, {0, -1});
        arrow(std::abs(near.friction), {near.friction > 0 ? 1.0 : -1.0, 0});
    }

    const FilmContext& context_;
    int member_;
    Box box_, area_;
    figure::PlotStyle style_;
    figure::Panel axes_;
    figure::Plot plot_;
    double depth_ = 0, half_width_ = 1;  // [m]
    Prefix unit_{"µ", 1e-6};             // of heights
};

}  // namespace

PanelType close_up_panel() {
    return {.kind = PanelKind::close_up,
            .name = "close-up",
            .smallest = {240, 170},
            .make = make_panel<CloseUpPanel>,
            .needs_cam = true};
}

}  // namespace beamcam::render
