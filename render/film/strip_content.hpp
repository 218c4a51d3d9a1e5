// The content of strips and of the energy panel: names, units and colours of channels, and their curves.
#pragma once

#include <optional>
#include <vector>

#include "render/film/panel.hpp"
#include "render/plot/chart.hpp"

namespace beamcam::render {

// Colour of an energy, the same in strips and in the energy panel; none for other channels.
std::optional<Color> energy_color(const Palette& palette, sim::ChannelKind kind);
// A chart with time axis and marks of impacts, without curves. `member` < 0: impacts of all motions.
ChartContent blank_content(const FilmContext& context, const PanelSpec& spec, int member);
// A chart with the curves of a strip's channels for all motions.
ChartContent strip_content(const FilmContext& context, const PanelSpec& spec);
// The value of a channel at a frame; NaN: undefined.
double reading(const FilmContext& context, int member, int frame, sim::Channel channel);

// Readings of the curves of measured data, which follow those of the motions.
std::vector<double> readings_of_data(const FilmContext& context, const PanelSpec& spec, double t);

}  // namespace beamcam::render
