// The bifurcation diagram: samples over one parameter, the largest exponent where it is known, and a strip with the
// class of each motion.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scenes/figures/swept_points.hpp"

namespace beamcam::scenes {

// `order`: in which the clouds hold the points. `added` is told of each dot.
using Added = std::function<void(std::size_t panel, std::size_t cloud, std::uint64_t point)>;
std::vector<std::uint64_t> as_numbered(const SweptPoints& points);
// `value`: a column of the samples; empty: the usual one. Throws PictureError for one that they have not.
render::figure::Figure bifurcation(const SweptPoints& points, const std::string& value,
                                   const std::vector<std::uint64_t>& order, const Added& added);

// The cell of each point in the strip of classes; none beyond its lanes.
std::vector<std::optional<std::size_t>> strip_cells(const SweptPoints& points);

}  // namespace beamcam::scenes
