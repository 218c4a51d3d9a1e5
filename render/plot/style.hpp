// How figures look: widths of the journals' columns, sizes of type and lines, the lines' colours and dashes, the
// colour map.
#pragma once

#include <span>
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
    double height = 0;  // [mm]; 0: what suits the figure
    const char* whose = "";
};
std::span<const Column> columns();
const Column* column_named(std::string_view name);  // nullptr: none
std::vector<std::string> column_names();

inline constexpr Color kInk = rgb(0x000000), kMuted = rgb(0x555555), kWhite = rgb(0xFFFFFF);

// Sizes that follow from the column [pt].
struct PrintStyle {
    double letters = 8;    // axis titles, legends, notes
    double numbers = 7.5;  // at the ticks
    double line = 1.0;     // curves
    double frame = 0.6;    // axes
    double tick = 3, minor_tick = 1.7;
    double gap = 3;       // between neighbours
    double marker = 2.0;  // radius
    TextStyle words() const { return {.size = letters, .color = kInk}; }
    TextStyle tick_numbers() const { return {.size = numbers, .color = kInk}; }
};
PrintStyle style_of(const Column& column);

// The k-th line of a plot: colour of Okabe & Ito (2008), told apart in grey by dash and marker as well.
enum class Marker { circle, square, triangle, diamond, down, cross };
struct LineStyle {
    Color color;
    std::vector<double> dash;  // in widths of the line; empty: solid
    Marker marker = Marker::circle;
};
const LineStyle& look(int k);  // colours repeat after eight, with other dashes; all after 64

Color pale(Color color, double share = 0.62);  // towards white, opaque: print knows no transparency

// What a colour of white paper becomes on a dark slide: lightness is reversed, from the dark theme's paper to its ink,
// and the hue stays. Colours of lines keep their lightness, or get as much as it takes to stand out.
Color on_dark(Color color);

// Perceptually uniform, dark at 1: viridis (Smith & van der Walt 2015, CC0) from its bright end, the palest left out,
// which white paper would swallow. 0…1; beyond: the end's colour.
Color map_color(double share);

}  // namespace beamcam::render::figure
