#include "render/film/close_up_readings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/plot/ticks.hpp"

namespace beamcam::render {
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
    const double size = std::abs(near.gap);
    const bool zero = size < (unit.factor == 1e-6 ? 0.05 : 1e-3) * unit.factor;
    const bool deep = near.gap < 0 && !zero;
    const std::string amount = zero                               ? fmt::format("0\u00A0{}m", unit.symbol)
                               : unit.factor != 1e-6 || size >= 1 ? quantity(size, "m")
                               : size < 1e-3 ? fmt::format("{}\u00A0µm", fixed(size * 1e6, size < 1e-5 ? 1 : 0))
                                             : fmt::format("{}\u00A0mm", fixed(size * 1e3, size < 0.1 ? 1 : 0));
    // The place of the word does not depend on the number. Without room for both words there are symbols, or the colour
    // alone.
    const TextStyle style{.size = context.look.letters.heading,
                          .color = deep ? p.contact : p.motion,
                          .weight = Weight::medium,
                          .align = HAlign::right,
                          .tabular = true};
    const Vec2 right{plot.right(), box.y + 26 * u};
    const double widest = std::max(canvas.measure(amount, style).w, canvas.measure(kWidestGap, style).w) + 8 * u;
    const auto fits = [&](const std::string& name) {
        return canvas.measure("$y$ / µm" + name, style).w + 16 * u + widest <= plot.w;
    };
    canvas.text(right, amount, style);
    if (fits("$δ$"))
        canvas.text(right - Vec2{widest, 0},
                    fits(context.look.translate("penetration")) ? context.look.translate(deep ? "penetration" : "gap")
                    : deep                                      ? "$δ$"
                                                                : "$g$",
                    style);
    if (!std::holds_alternative<sim::StickSlipFriction>(motion.problem.contact.friction) || !(near.force > 0)) return;
    const double line = plot.y + 2 * u + 1.1 * context.look.letters.words;
    const bool on_beam = face > line;
    const TextStyle state{.size = context.look.letters.words,
                          .color = p.ink,
                          .align = HAlign::right,
                          .halo = on_beam ? mix(close_up_background(p), p.motion, 0.30) : close_up_background(p)};
    canvas.text({plot.right() - 10 * u, line},
                context.look.translate(sticks(motion.problem, near.force, near.friction) ? "sticks" : "slips"), state);
}

}  // namespace beamcam::render
