// Stand-in until the pictures land.
#pragma once
#include <optional>
namespace beamcam::render {
enum class Style { lit, flat };
enum class Theme { light, dark, print };
struct View {
    Style style = Style::lit;
    Theme theme = Theme::light;
    std::optional<double> exaggeration;
};
}  // namespace beamcam::render
