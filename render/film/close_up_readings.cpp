#include "render/film/close_up_readings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

}  // namespace

bool sticks(const sim::Problem& problem, double force, double friction) {
    constexpr double kRounding = 1e-6;
    const auto* law = std::get_if<sim::StickSlipFriction>(&problem.contact.friction);
    if (!law || !(force > 0)) return false;
    const double limit = law->coefficient * force;
    return std::abs(std::abs(friction) - limit) > kRounding * limit;
}

void CloseUpReadings::draw(Canvas& canvas, const sim::Pose& pose, double face) const {
    const sim::Nearest& near = *pose.nearest;
    const Palette& p = context.look.palette;
    const double u = context.look.unit;
    const bool deep = near.gap < 0;
    const double size = std::abs(near.gap);
    const std::string amount = size < (unit.factor == 1e-6 ? 0.05 : 1e-3) * unit.factor ? quantity(0, unit, "m", 1)
                               : unit.factor != 1e-6 || size >= 1                       ? quantity(size, "m")
                               : size < 1e-3 ? fmt::format("{}\u00A0µm", fixed(size * 1e6, size < 1e-5 ? 1 : 0))
                                             : fmt::format("{}\u00A0mm", fixed(size * 1e3, size < 0.1 ? 1 : 0));
    draw_reading(
        canvas, {plot.right(), box.y + 26 * u}, context.look.translate(deep ? "penetration" : "gap"), amount,
        "00.0\u00A0mm",
        {.size = context.look.letters.heading, .color = deep ? p.contact : p.motion, .weight = Weight::medium});
    if (!std::holds_alternative<sim::StickSlipFriction>(motion.problem.contact.friction) || !(near.force > 0)) return;
    const double line = plot.y + 2 * u + 1.1 * context.look.letters.words;
    const bool on_beam = face > line;
    const TextStyle style{.size = context.look.letters.words,
                          .color = p.ink,
                          .align = HAlign::right,
                          .halo = on_beam ? mix(close_up_background(p), p.motion, 0.30) : close_up_background(p)};
    canvas.text({plot.right() - 10 * u, line},
                context.look.translate(sticks(motion.problem, near.force, near.friction) ? "sticks" : "slides"), style);
}

}  // namespace beamcam::render
