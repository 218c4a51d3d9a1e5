#include "render/film/close_up_readings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/plot/ticks.hpp"

namespace beamcam::render {
namespace {

// Draws a word and a number that ends at `right`; the place of the word does not depend on the number.
void draw_reading(Canvas& canvas, Vec2 right, const std::string& word, const std::string& number, const char* widest,
                  TextStyle style) {
    style.align = HAlign::right;
    canvas.text(right, number, style);
    const double room = std::max(canvas.measure(number, style).w, canvas.measure(widest, style).w);
    canvas.text(right - Vec2{room + 0.4 * style.size, 0}, word, style);
}

// "collision 2 · impact 3 of 5", from the first touch of a collision until shortly after its last.
std::string collision_counter(const Motion& motion, double t) {
    const std::vector<sim::Impact>& all = motion.impacts;
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
    const double over = end + sim::collision_gap(motion.problem);
    if (t > over) return {};
    std::string collision = fmt::format("collision {}", last.collision);
    if (of == 1) return collision;
    // The collision may go on after the end of the motion.
    return fmt::format("{} · impact {}", collision, number) + (over <= motion.end ? fmt::format(" of {}", of) : "");
}

}  // namespace

bool sticks(const sim::Problem& problem, double force, double friction) {
    constexpr double kRounding = 1e-6;
    const auto* law = std::get_if<sim::StickSlipFriction>(&problem.contact.friction);
    if (!law || !(force > 0)) return false;
    const double limit = law->coefficient * force;
    return std::abs(std::abs(friction) - limit) > kRounding * limit;
}

// " · sticks" or " · slides"; empty without contact or stick–slip friction.
static std::string friction_word(const sim::Problem& problem, const sim::Nearest& contact) {
    if (!std::holds_alternative<sim::StickSlipFriction>(problem.contact.friction) || !(contact.force > 0)) return {};
    return sticks(problem, contact.force, contact.friction) ? " · sticks" : " · slides";
}

void CloseUpReadings::draw(Canvas& canvas, const sim::Pose& pose, double face) const {
    const sim::Nearest& near = *pose.nearest;
    const Palette& p = context.look.palette;
    const double u = context.look.unit;
    const bool deep = near.gap < 0;
    const double size = std::abs(near.gap);
    const std::string amount = size < 1e-3 * unit.factor          ? quantity(0, unit, "m", 1)
                               : unit.factor != 1e-6 || size >= 1 ? quantity(size, "m")
                               : size < 1e-3 ? fmt::format("{}\u00A0µm", fixed(size * 1e6, size < 1e-5 ? 1 : 0))
                                             : fmt::format("{}\u00A0mm", fixed(size * 1e3, size < 0.1 ? 1 : 0));
    draw_reading(
        canvas, {plot.right(), box.y + 26 * u}, context.look.translate(deep ? "penetration" : "gap"), amount,
        "00.0\u00A0mm",
        {.size = context.look.letters.heading, .color = deep ? p.contact : p.motion, .weight = Weight::medium});
    draw_count(canvas, pose, face);
}

void CloseUpReadings::draw_count(Canvas& canvas, const sim::Pose& pose, double face) const {
    const Palette& p = context.look.palette;
    const double u = context.look.unit;
    const std::string count =
        context.look.translate(collision_counter(motion, pose.t) + friction_word(motion.problem, *pose.nearest));
    const double line = plot.y + 2 * u + 1.1 * context.look.letters.words;
    const bool on_beam = face > line;
    const TextStyle style{.size = context.look.letters.words,
                          .color = p.ink,
                          .align = HAlign::right,
                          .halo = on_beam ? mix(close_up_background(p), p.motion, 0.30) : close_up_background(p)};
    const double room =
        plot.w - canvas.measure(context.look.translate("beam"), {.size = context.look.letters.words}).w - 64 * u;
    if (canvas.measure(count, style).w < room) canvas.text({plot.right() - 10 * u, line}, count, style);
}

}  // namespace beamcam::render
