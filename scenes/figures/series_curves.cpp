#include "scenes/figures/series_curves.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "render/plot/ticks.hpp"

namespace beamcam::scenes {

using render::figure::Series;
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

void fold_turns(Series& curve) {
    const Series whole = std::exchange(curve, {});
    curve = whole;
    curve.x.clear(), curve.y.clear();
    const auto add = [&](double x, double y) { curve.x.push_back(x), curve.y.push_back(y); };
    const auto turns = [&](std::size_t i) { return whole.x[i] / (2 * std::numbers::pi); };
    for (std::size_t i = 0; i < whole.x.size(); ++i) {
        const double now = turns(i), before = i > 0 ? turns(i - 1) : now;
        if (whole.line && std::floor(now) != std::floor(before)) {
            const double edge =
                std::max(std::floor(now), std::floor(before));  // between them: rows are closer than turns
            const double y = whole.y[i - 1] + (whole.y[i] - whole.y[i - 1]) * (edge - before) / (now - before);
            const bool forward = now > before;
            add(forward, y), add(std::nan(""), std::nan("")), add(!forward, y);
        }
        add(now - std::floor(now), whole.y[i]);
    }
}

}  // namespace beamcam::scenes
