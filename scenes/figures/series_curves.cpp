#include "scenes/figures/series_curves.hpp"

#include <algorithm>
#include <cmath>

#include "render/plot/ticks.hpp"

namespace beamcam::scenes {

using sim::Channel;
using sim::ChannelKind;

Measure measure_of(const std::string& unit, double largest) {
    const bool prefixed = unit == "m" || unit == "N" || unit == "J" || unit == "s";
    const render::Prefix prefix = render::prefix_for(prefixed && largest > 0 && std::isfinite(largest) ? largest : 1);
    return {1 / prefix.factor, prefix.symbol + unit};
}

std::vector<double> above_zero(std::vector<double> values, Channel channel) {
    if (channel.kind != ChannelKind::energy_potential || values.empty()) return values;
    const double least = *std::ranges::min_element(values);
    for (double& v : values) v -= least;
    return values;
}

bool has_values(const sim::Table& table) {
    return std::ranges::any_of(table.values.back(), [](double v) { return std::isfinite(v); });
}

double largest(const std::vector<double>& values) {
    double out = 0;
    for (const double v : values)
        if (std::isfinite(v)) out = std::max(out, std::abs(v));
    return out;
}

}  // namespace beamcam::scenes
