#include "render/film/color_bars.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "render/plot/ticks.hpp"

namespace beamcam::render {

std::array<std::string, 3> trace_marks(const FilmContext& context) {
    const Prefix prefix = context.scales.force_unit;
    return {"0", quantity(context.scales.force / 4, prefix, "N"), quantity(context.scales.force, prefix, "N")};
}

void draw_color_bars(Canvas& canvas, const FilmContext& context) {
    if (!context.places.scales || !context.places.first(PanelKind::mechanism)) return;
    const double u = context.look.unit;
    const Palette& palette = context.look.palette;
    const Box& b = *context.places.scales;
    const TextStyle small{.size = context.look.letters.words, .color = palette.muted, .align = HAlign::centre};
    const std::string moment_title = context.look.translate("bending moment (√ scale)"),
                      trace_title = context.look.translate("contact force, trace (√ scale)");
    const double wide = std::round(std::max({250 * u, canvas.measure(moment_title, small).w,
                                             context.scales.force > 0 ? canvas.measure(trace_title, small).w : 0}));
    const auto bar = [&](double right, const std::string& title, const auto& color, std::array<std::string, 3> marks) {
        const Box strip{std::round(right - wide), std::round(b.y + 24 * u), wide, std::round(10 * u)};
        for (int i = 0; i < static_cast<int>(strip.w); ++i) {
            canvas.rectangle({strip.x + i, strip.y, 1, strip.h});
            canvas.fill(color((i + 0.5) / strip.w));
        }
        canvas.text({strip.x + strip.w / 2, strip.y - 8 * u}, title, small);
        for (std::size_t i = 0; i < 3; ++i) {
            TextStyle style = small;
            style.align = i == 0 ? HAlign::left : i == 1 ? HAlign::centre : HAlign::right;
            canvas.text({strip.x + 0.5 * double(i) * strip.w, strip.bottom() + 0.9 * context.look.letters.words},
                        marks[i], style);
        }
    };
    double right = b.right();
    if (context.scales.force > 0) {
        bar(
            right, trace_title, [&](double s) { return force_color(palette, s); }, trace_marks(context));
        right -= wide + 50 * u;
    }
    if (context.scales.moment > 0) {
        const std::string top = quantity(context.scales.moment, "N\u2009m");
        bar(right, moment_title, [&](double s) { return moment_color(palette, 2 * s - 1); },
            {"−" + top.substr(0, top.find("\u00A0")), "0", top});
    }
}

}  // namespace beamcam::render
