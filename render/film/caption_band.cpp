#include "render/film/caption_band.hpp"

#include <algorithm>
#include <vector>

#include "render/plot/user_text.hpp"

namespace beamcam::render {

void draw_caption_band(Canvas& canvas, const FilmContext& context, const Box& band, int frame) {
    constexpr std::size_t kLines = 2;
    constexpr double kLine = 29, kBetween = 8, kPadding = 16;  // [design px]
    const double u = context.unit;
    std::vector<const Callout*> shown;
    for (const Callout& each : context.setup->callouts)
        if (each.shown(frame)) shown.push_back(&each);
    const auto count = static_cast<double>(shown.size());
    const double wide = (band.w - kBetween * u * (count - 1)) / std::max(count, 1.0);
    double left = band.x;
    for (const Callout* each : shown) {
        TextStyle style{.size = 22 * u,
                        .color = context.palette->ink.faded(each->opacity(frame)),
                        .weight = Weight::medium,
                        .max_width = wide - 2 * kPadding * u};
        const std::vector<std::string> lines = wrapped_lines(canvas, each->text, style, kLines);
        double text_width = 0, high = 0;
        for (const std::string& line : lines) {
            const Box ink = canvas.measure(line, style);
            text_width = std::max(text_width, ink.w), high = std::max(high, ink.h);
        }
        const double step = std::max(kLine * u, lines.size() == 1 ? 0.0 : std::min(high, band.h / 2)),
                     rest = step * (static_cast<double>(lines.size()) - 1), tall = std::max(kLine * u, high);
        const double plate_height = std::min(band.h, rest + tall + kPadding * u);
        const Box plate{left, band.y + (band.h - plate_height) / 2, std::min(text_width + 2 * kPadding * u, wide),
                        plate_height};
        canvas.rounded(plate, 8 * u);
        canvas.stroke({style.color, 1.6 * u});
        double y = plate.centre().y - rest / 2 + 0.36 * style.size;
        for (const std::string& line : lines) canvas.text({left + kPadding * u, y}, line, style), y += step;
        left = plate.right() + kBetween * u;
    }
}

}  // namespace beamcam::render
