#include "render/film/moment_bar.hpp"

#include <array>
#include <cmath>
#include <string>

#include "render/plot/ticks.hpp"

namespace beamcam::render {

void draw_moment_bar(Canvas& canvas, const FilmContext& context) {
    if (!context.places.scale || !context.places.first(PanelKind::mechanism) || !(context.scales.moment > 0)) return;
    const double u = context.look.unit;
    const Box& b = *context.places.scale;
    const TextStyle small{
        .size = context.look.letters.words, .color = context.look.palette.muted, .align = HAlign::centre};
    const std::string title = context.look.translate("bending moment (√ scale)");
    const std::string top = quantity(context.scales.moment, "N\u2009m");
    const double wide = std::round(
        std::max({250 * u, canvas.measure(title, small).w, 2 * canvas.measure(top, small).w + 3 * small.size}));
    const Box strip{std::round(b.right() - wide), std::round(b.y + 24 * u), wide, std::round(10 * u)};
    for (int i = 0; i < static_cast<int>(strip.w); ++i) {
        canvas.rectangle({strip.x + i, strip.y, 1, strip.h});
        canvas.fill(moment_color(context.look.palette, 2 * (i + 0.5) / strip.w - 1));
    }
    canvas.text({strip.x + strip.w / 2, strip.y - 8 * u}, title, small);
    const std::array marks{"−" + top.substr(0, top.find("\u00A0")), std::string("0"), top};
    const std::array aligned{HAlign::left, HAlign::centre, HAlign::right};
    for (std::size_t i = 0; i < marks.size(); ++i) {
        TextStyle style = small;
        style.align = aligned[i];
        canvas.text({strip.x + 0.5 * double(i) * strip.w, strip.bottom() + 0.9 * small.size}, marks[i], style);
    }
}

}  // namespace beamcam::render
