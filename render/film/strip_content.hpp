// What strips and the energy panel show: names, units and colours of channels, and their curves as a chart's content.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/film/panel.hpp"
#include "render/plot/chart.hpp"

namespace beamcam::render {

// Energies have one colour in strips and in the ledger; nothing for other channels.
std::optional<Color> energy_color(const Palette& palette, sim::ChannelKind kind);
// Only differences of potential energy mean anything: its least value is the zero.
double zero_of(const sim::Table& table, sim::Channel channel);
// Time axis and impacts without curves. `member` < 0: of all motions.
ChartContent blank_content(const FilmContext& context, const PanelSpec& spec, int member);
// The curves of a strip's channels for every motion.
ChartContent strip_content(const FilmContext& context, const PanelSpec& spec);
// The channel at a frame; NaN: it has no value there.
double reading(const FilmContext& context, int member, int frame, sim::Channel channel);

// Of the data's curves, which follow those of the motions.
std::vector<double> readings_of_data(const FilmContext& context, const PanelSpec& spec, double t);

}  // namespace beamcam::render
