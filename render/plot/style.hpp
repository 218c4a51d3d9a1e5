// The style of plots: column widths of journals, sizes of type and lines, colours and dashes, the colour map.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "render/draw/color.hpp"
#include "render/draw/text_style.hpp"

namespace beamcam::render::figure {

// A column of a journal, or a slide.
struct Column {
    const char* name;
    double width;       // [mm]
    double letters;     // size of text [pt]
    double line;        // width of curves [pt]
    double height = 0;  // [mm]; 0: by the figure
    const char* whose = "";
};
const Column* column_named(std::string_view name);  // nullptr: none
std::vector<std::string> column_names();

inline constexpr Color kInk = rgb(0x000000), kMuted = rgb(0x555555), kWhite = rgb(0xFFFFFF);

// How plots are drawn: on a page, whose sizes follow from the column [pt], or in a film [px].
struct PlotStyle {
    const Palette* palette = nullptr;  // of a film; null: a page
    double unit = 1;                   // pt, or a design pixel

    double letters = 8;    // axis titles, legends, notes
    double numbers = 7.5;  // at the ticks
    double line = 1.0;     // curves
    double frame = 0.6;    // axes
    double tick = 3, minor_tick = 1.7;
    double gap = 3;       // between neighbours
    double marker = 2.0;  // radius
    TextStyle words() const { return {.size = letters, .color = kInk}; }
    TextStyle tick_numbers() const { return {.size = numbers, .color = palette ? palette->muted : kInk}; }
};
PlotStyle style_of(const Column& column);
PlotStyle scaled(PlotStyle style, double factor);
// `numbers`: size of the letters at axes [px].
PlotStyle film_style(const Palette& palette, double unit, double letters, double numbers);

// The k-th line of a plot: colours of Okabe & Ito (2008), with dashes and markers that distinguish lines in grey.
enum class Marker { circle, square, triangle, diamond, down, cross };
struct LineStyle {
    Color color;
    std::vector<double> dash;  // in widths of the line; empty: solid
    Marker marker = Marker::circle;
};
const LineStyle& look(int k);  // colours repeat after eight, with other dashes; all after 64

Color pale(Color color, double share = 0.62);  // towards white, opaque: print knows no transparency

// The colour on a dark slide of a colour on white paper: lightness is reversed, from the dark theme's paper to its ink,
// and the hue stays. Colours of lines keep their lightness, or get enough to contrast with the paper.
Color on_dark(Color color);

// Perceptually uniform, dark at 1: viridis (Smith & van der Walt 2015, CC0) from its bright end, without its palest
// colours, which are invisible on white. `share`: 0…1, clamped.
Color map_color(double share);
// Of a signed quantity: blue at −1, light grey at 0, red at 1, clamped.
Color signed_color(double share);

}  // namespace beamcam::render::figure
