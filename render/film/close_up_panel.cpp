// The contact close-up, in the frame of its tangent (to the right) and normal (up): the undeformed faces of beam and
// cam, not exaggerated, heights in micrometres against widths in millimetres. Their overlap is the penetration of the
// contact law.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/film/panel.hpp"
#include "render/plot/ticks.hpp"

namespace beamcam::render {
namespace {

constexpr const char* kWidest = "00.0\u00A0mN";  // of the readings of forces
constexpr double kBelow = 1.35, kAbove = 1.9;    // displayed heights, relative to the largest penetration

class CloseUpPanel final : public FilmPanel {
  public:
    CloseUpPanel(const FilmContext& context, const PanelSlot& slot)
        : context_(context), member_(std::min(slot.spec.member, context.members() - 1)), box_(slot.box) {
        const double u = context.unit;
        const double left = 70 * u + 2.4 * (context.tick - 17 * u);  // as in plot_area
        plot_ = {std::round(box_.x + left), std::round(box_.y + 46 * u), std::round(box_.w - left - 8 * u),
                 std::round(box_.h - 46 * u - 40 * u)};
        for (const sim::Impact& i : motion().impacts) depth_ = std::max(depth_, i.penetration_peak);
        for (int k = 0; k < context.frames(); ++k)
            if (const auto near = context.pose(member_, k).nearest) depth_ = std::max(depth_, -near->gap);
        if (!motion().problem.cam) return;
        const double radius = motion().problem.cam->radius;
        // An impulsive contact does not penetrate: its scale is a ten-thousandth of the radius.
        if (!(depth_ > 1e-9 * radius)) depth_ = 1e-4 * radius;
        // The rim of the cam reaches the lower edge at the sides.
        half_width_ = std::min(std::sqrt(2 * radius * 1.2 * depth_), 0.9 * radius);
        shown_ = {-kBelow * depth_, kAbove * depth_};
        if (shown_.high < 2e-6 || shown_.high > 5e-3) unit_ = prefix_for(shown_.high);
    }

    void draw_background(Canvas& canvas) const override {
        const double u = context_.unit;
        const Palette& p = *context_.palette;
        const TextStyle bold{.size = context_.heading(), .weight = Weight::semibold},
            plain{.size = context_.heading(), .weight = Weight::medium};
        const double room = plot_.w - canvas.measure(context_.translate("penetration 000\u00A0µm"), plain).w - 16 * u;
        const std::string whose = motion_suffix(context_, member_);
        const std::string whole = context_.translate("Contact close-up"), brief = context_.translate("Contact");
        // The reading is beside the heading.
        draw_heading(canvas, context_, {plot_.x, box_.y, plot_.w, plot_.h},
                     first_that_fits(canvas, {whole + whose, brief + whose, brief, ""}, bold, room));
        canvas.rectangle(plot_);
        canvas.fill(p.tint(p.grid, 0.35));
        if (!motion().problem.cam) return;
        // At least two marks, since one does not show a scale.
        Ticks marks;
        for (int most = std::clamp(static_cast<int>(plot_.h / (45 * u)), 2, 5); marks.values.size() < 2; ++most)
            marks = ticks(shown_.low / unit_.factor, shown_.high / unit_.factor, most);
        const TextStyle label{.size = context_.tick, .color = p.muted, .align = HAlign::right};
        for (double v : marks.values) {
            const double y = std::round(at(0, v * unit_.factor).y) + 0.5;
            canvas.line({plot_.x - 6 * u, y}, {plot_.x, y}, {p.muted, std::max(1.0, u), {}, Cap::butt});
            canvas.text({plot_.x - 12 * u, y + 6.0 / 17 * context_.tick}, fixed(v, marks.decimals), label);
        }
        const double stretch = (plot_.h / (shown_.high - shown_.low)) / (plot_.w / (2 * half_width_));
        const std::string how =
            context_.translate(fmt::format("heights in {}m, ×{:.2g} against widths", unit_.symbol, stretch));
        TextStyle note{.size = 16.0 / 17 * context_.tick, .color = p.muted};
        const double bar = round_down_125(0.5 * half_width_), w = bar / (2 * half_width_) * plot_.w;
        const double y = plot_.bottom() + 12 * u, x1 = plot_.right();
        canvas.move_to({x1 - w, y - 4 * u});
        canvas.line_to({x1 - w, y});
        canvas.line_to({x1, y});
        canvas.line_to({x1, y - 4 * u});
        canvas.stroke({p.muted, 1.6 * u, {}, Cap::butt});
        const std::string length = quantity(bar, "m");
        canvas.text({x1, y + 3 * u + context_.tick}, length,
                    {.size = 16.0 / 17 * context_.tick, .color = p.muted, .align = HAlign::right});
        const double left = plot_.w - std::max(w, canvas.measure(length, note).w) - 20 * u;
        const std::string brief_how = context_.translate(fmt::format("heights in {}m", unit_.symbol));
        canvas.text({plot_.x, y - 3 * u + context_.tick},
                    first_that_fits(canvas, {how, brief_how, fmt::format("{}m", unit_.symbol), ""}, note, left), note);
    }

    void draw(Canvas& canvas, int frame, Style, State*) const override {
        const sim::Pose& pose = context_.pose(member_, frame);
        if (!motion().problem.cam || !pose.nearest) return;
        const sim::Nearest& near = *pose.nearest;
        canvas.clip(plot_, [&] {
            draw_cam(canvas);
            draw_beam(canvas, pose);
        });
        draw_state(canvas, pose, near);
    }

  private:
    const Motion& motion() const { return context_.motion(member_); }
    Vec2 at(double x, double y) const {
        return {plot_.x + plot_.w * (x + half_width_) / (2 * half_width_),
                plot_.bottom() - plot_.h * (y - shown_.low) / (shown_.high - shown_.low)};
    }
    double cam_height(double x) const {
        const double r = motion().problem.cam->radius;
        return std::sqrt(r * r - x * x) - r;
    }

    std::vector<Vec2> rim() const {
        std::vector<Vec2> out;
        for (int i = 0; i <= 80; ++i) {
            const double x = half_width_ * (i / 40.0 - 1) * 1.02;
            out.push_back(at(x, cam_height(x)));
        }
        return out;
    }

    void draw_cam(Canvas& canvas) const {
        const Palette& p = *context_.palette;
        const std::vector<Vec2> edge = rim();
        canvas.polyline(edge);
        canvas.line_to({edge.back().x, plot_.bottom() + 4});
        canvas.line_to({edge.front().x, plot_.bottom() + 4});
        canvas.close();
        canvas.fill(p.steel);
        canvas.polyline(edge);
        canvas.stroke({p.steel_edge, 2 * context_.unit});
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

    void draw_beam(Canvas& canvas, const sim::Pose& pose) const {
        const Palette& p = *context_.palette;
        const double u = context_.unit;
        if (pose.nearest->gap > shown_.high) {  // above the plot: an arrow points to it
            const double x = plot_.x + 20 * u;
            canvas.arrow({x, plot_.y + 40 * u}, {x, plot_.y + 10 * u}, {p.motion, 2.4 * u}, {14 * u});
            canvas.text({x + 14 * u, plot_.y + 31 * u}, context_.translate("beam"),
                        {.size = context_.tick, .color = p.motion, .weight = Weight::medium});
            return;
        }
        const std::vector<Vec2> heights = face(pose);
        std::vector<Vec2> edge;
        for (Vec2 h : heights) edge.push_back(at(h.x, h.y));
        canvas.polyline(edge);
        canvas.line_to({edge.back().x, plot_.y - 4});
        canvas.line_to({edge.front().x, plot_.y - 4});
        canvas.close();
        canvas.fill(p.motion.faded(0.30));
        // The overlap.
        std::vector<Vec2> over, under;
        for (Vec2 h : heights)
            if (h.y < cam_height(h.x)) over.push_back(at(h.x, cam_height(h.x))), under.push_back(at(h.x, h.y));
        if (over.size() > 1) {
            over.insert(over.end(), under.rbegin(), under.rend());
            canvas.polyline(over);
            canvas.close();
            canvas.fill(p.tint(p.contact, 0.55));
            canvas.polyline(rim());  // visible through the beam
            canvas.stroke({p.steel_edge, 2 * u});
        }
        canvas.polyline(edge);
        canvas.stroke({p.motion, 2.4 * u});
        const TextStyle name{.size = context_.tick, .color = p.motion, .weight = Weight::medium};
        const double top = std::max(edge.front().y, plot_.y + 30 * u);
        if (top - plot_.y > 24 * u)
            canvas.text({plot_.x + 12 * u, std::min(plot_.y + 24 * u, top - 6 * u)}, context_.translate("beam"), name);
        if (at(0, std::min(0.0, pose.nearest->gap)).y < plot_.bottom() - 32 * u)  // below the overlap
            canvas.text({plot_.x + plot_.w / 2 - 14 * u, plot_.bottom() - 12 * u}, context_.translate("cam"),
                        {.size = context_.tick, .color = mix(p.steel_edge, p.steel, 0.25), .weight = Weight::medium});
        forces(canvas, *pose.nearest);
    }

    void forces(Canvas& canvas, const sim::Nearest& near) const {
        if (!near.touching || !(near.force > 0) || !(context_.force_scale > 0)) return;
        const Palette& p = *context_.palette;
        const double u = context_.unit, longest = 0.55 * plot_.h;
        const Vec2 foot = at(0, near.gap / 2);
        // Both forces have the same scale; those too short for an arrow are shown only as numbers.
        const auto arrow = [&](double force, Vec2 way) {
            const double length = longest * std::min(1.0, force / context_.force_scale);
            if (length > 5 * u)
                canvas.arrow(foot, foot + way * length, {p.contact, 4 * u}, {std::min(16 * u, 0.7 * length)});
        };
        canvas.circle(foot, 3.5 * u);
        canvas.fill(p.contact);
        arrow(near.force, {0, -1});
        arrow(std::abs(near.friction), {near.friction > 0 ? 1.0 : -1.0, 0});
    }

    void draw_state(Canvas& canvas, const sim::Pose& pose, const sim::Nearest& near) const {
        const Palette& p = *context_.palette;
        const double u = context_.unit;
        const bool deep = near.gap < 0;
        const double size = std::abs(near.gap);
        const std::string amount = size < 1e-3 * unit_.factor          ? quantity(0, unit_, "m", 1)
                                   : unit_.factor != 1e-6 || size >= 1 ? quantity(size, "m")
                                   : size < 1e-3 ? fmt::format("{}\u00A0µm", fixed(size * 1e6, size < 1e-5 ? 1 : 0))
                                                 : fmt::format("{}\u00A0mm", fixed(size * 1e3, size < 0.1 ? 1 : 0));
        draw_reading(canvas, {plot_.right(), box_.y + 26 * u}, context_.translate(deep ? "penetration" : "gap"), amount,
                     "00.0\u00A0mm",
                     {.size = context_.heading(), .color = deep ? p.contact : p.motion, .weight = Weight::medium});
        draw_corner(canvas, pose, near);
    }

    // Up to three lines in the upper right corner, on a plate that hides the line of the beam's face.
    void draw_corner(Canvas& canvas, const sim::Pose& pose, const sim::Nearest& near) const {
        const Palette& p = *context_.palette;
        const double u = context_.unit;
        const std::string count = collision_counter(pose.t);
        const double room = plot_.w - canvas.measure(context_.translate("beam"), {.size = context_.tick}).w - 40 * u;
        TextStyle style{.size = context_.tick, .color = p.ink, .align = HAlign::right}, strong = style;
        strong.weight = Weight::medium;
        const double counted = count.empty() ? 0 : canvas.measure(count, style).w;
        const double read =
            canvas.measure(context_.translate("friction "), strong).w + canvas.measure(kWidest, strong).w;
        const bool has_force = near.touching && near.force > 0 && plot_.h >= 120 * u && read <= room;
        const bool has_count = counted > 0 && counted < room, has_friction = has_force && near.friction != 0;
        if (!has_count && !has_force) return;
        const auto line = [&](int k) { return plot_.y + 2 * u + (1.1 + 1.3 * k) * context_.tick; };
        const double right = plot_.right() - 10 * u,
                     wide = std::max(has_count ? counted : 0, has_force ? read : 0) + 8 * u,
                     bottom = line(has_friction ? 2
                                   : has_force  ? 1
                                                : 0) +
                              0.4 * context_.tick;
        const Color background = p.tint(p.grid, 0.35);
        const bool over_beam = at(0, near.gap).y > (plot_.y + bottom) / 2;
        canvas.rectangle(
            {right - wide, plot_.y + 3 * u, plot_.right() - 3 * u - right + wide, bottom - plot_.y - 3 * u});
        canvas.fill(over_beam ? mix(background, p.motion, 0.30) : background);
        if (has_count) canvas.text({right, line(0)}, count, style);
        if (has_force)
            draw_reading(canvas, {right, line(1)}, context_.translate("force"), reading(near.force, "N"), kWidest,
                         strong);
        if (has_friction)
            draw_reading(canvas, {right, line(2)}, context_.translate("friction"),
                         reading(std::abs(near.friction), "N"), kWidest, strong);
    }

    // Draws a word and a number that ends at `right`; the place of the word does not depend on the number.
    static void draw_reading(Canvas& canvas, Vec2 right, const std::string& word, const std::string& number,
                             const char* widest, TextStyle style) {
        style.align = HAlign::right;
        canvas.text(right, number, style);
        const double room = std::max(canvas.measure(number, style).w, canvas.measure(widest, style).w);
        canvas.text(right - Vec2{room + 0.4 * style.size, 0}, word, style);
    }

    // "collision 2 · impact 3 of 5", from the first touch of a collision until shortly after its last.
    std::string collision_counter(double t) const {
        const std::vector<sim::Impact>& all = motion().impacts;
        const auto after = std::ranges::upper_bound(all, t, {}, &sim::Impact::t_start);
        if (after == all.begin()) return {};
        const sim::Impact& last = *(after - 1);
        int of = 0, number = 0;
        double end = t;  // of the last impact
        for (const sim::Impact& i : all) {
            if (i.collision != last.collision) continue;
            ++of;
            if (i.t_start <= last.t_start) ++number;
            end = i.t_end.value_or(std::numeric_limits<double>::infinity());
        }
        const double over = end + sim::collision_gap(motion().problem);
        if (t > over) return {};
        const std::string counted = fmt::format("collision {} · impact {}", last.collision + 1, number);
        // The collision may go on after the end of the motion.
        return context_.translate(over <= motion().end ? fmt::format("{} of {}", counted, of) : counted);
    }

    const FilmContext& context_;
    int member_;
    Box box_, plot_;
    double depth_ = 0, half_width_ = 1;  // [m]
    Range shown_;                        // heights [m]
    Prefix unit_{"µ", 1e-6};             // unit of heights: µm unless they are much larger or smaller
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
