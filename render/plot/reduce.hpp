// Curves reduced to what a device can show, so that a million points draw and weigh as little as a few thousand.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "render/draw/geometry.hpp"

namespace beamcam::render {

// Points in units of the sheet; NaN breaks the line and stays. `grain`: the smallest distance that shows.
// Where x increases: the first, least, greatest and last of each column of width `grain`. Elsewhere: points closer than
// `grain` to the last kept one are left out, extremes of the excursion kept.
std::vector<Vec2> reduce(std::span<const Vec2> points, double grain);
// The columns alone, of this width. x must not decrease.
std::vector<Vec2> column_extremes(std::span<const Vec2> points, double width);

// A stretch of neighbouring columns in each of which the curve goes up and down more than once: to the eye a band.
struct Envelope {
    std::size_t first = 0, last = 0;       // indices of the stretch
    std::vector<std::size_t> least, most;  // of each column
};
// None unless x increases all along. Breaks that are narrower than a column do not end a stretch.
std::vector<Envelope> envelopes(std::span<const Vec2> points, double column);

// Its outline: along the crests, back along the troughs.
std::vector<Vec2> outline(const Envelope& envelope, std::span<const Vec2> points);
// What is left of the curve between the stretches, with a break for each; its extremes within them instead when
// `keep_extremes`.
std::vector<std::size_t> without(const std::vector<Envelope>& envelopes, std::size_t count, bool keep_extremes);
inline constexpr std::size_t kBreak = static_cast<std::size_t>(-1);  // among the indices of `without`

}  // namespace beamcam::render
