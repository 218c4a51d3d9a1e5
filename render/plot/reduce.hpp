// Curves reduced to the resolution of a device, so that a million points cost as little as a few thousand.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "render/draw/geometry.hpp"

namespace beamcam::render {

// Whether x never decreases, breaks apart.
bool increasing(std::span<const Vec2> points);
inline bool broken(Vec2 p) { return !(std::isfinite(p.x) && std::isfinite(p.y)); }

// Points on the page; NaN breaks the line and is kept. `grain`: the smallest visible distance. Pieces with increasing x
// keep the first, least, greatest and last point of each column of width `grain`; other pieces omit points nearer than
// `grain` to the last kept one.
std::vector<Vec2> reduce(std::span<const Vec2> points, double grain);
// By columns of this width alone; x must not decrease.
std::vector<Vec2> column_extremes(std::span<const Vec2> points, double width);

// An interval of neighbouring columns in each of which the curve goes up and down more than once: it looks like a band.
struct Envelope {
    std::size_t first = 0, last = 0;       // indices of its points
    std::vector<std::size_t> least, most;  // of each column
};
// Empty unless x increases throughout. Breaks narrower than a column do not end an envelope.
std::vector<Envelope> envelopes(std::span<const Vec2> points, double column);

// Its outline: along the crests, back along the troughs.
std::vector<Vec2> outline(const Envelope& envelope, std::span<const Vec2> points);
// The curve between the envelopes, with a break for each envelope.
std::vector<Vec2> without(const std::vector<Envelope>& envelopes, std::span<const Vec2> points);

}  // namespace beamcam::render
