// The text of a point beside a GrowingDiagram.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "render/draw/markup.hpp"
#include "render/plot/ticks.hpp"
#include "scenes/figures/axis_labels.hpp"
#include "scenes/figures/caption.hpp"
#include "scenes/figures/sweeps.hpp"
#include "scenes/figures/swept_points.hpp"

namespace beamcam::scenes {

using sim::AttractorClass;

std::optional<int> decimals_of(std::vector<double> values) {
    constexpr int kMost = 6;
    constexpr double kLargest = 1e5, kRounding = 0.02;  // of the least distance
    if (largest_magnitude(values) >= kLargest) return {};
    std::ranges::sort(values);
    double least = values.size() < 2 || values.front() == values.back() ? 1 : kLargest;
    for (std::size_t i = 1; i < values.size(); ++i)
        if (values[i] > values[i - 1]) least = std::min(least, values[i] - values[i - 1]);
    const auto rounded = [&](int decimals) {
        return std::ranges::all_of(values, [&](double v) {
            const double unit = render::ten_to(-decimals);
            return std::abs(v - std::round(v / unit) * unit) <= kRounding * least;
        });
    };
    for (int decimals = 0; decimals <= kMost; ++decimals)
        if (rounded(decimals)) return decimals;
    return {};
}

ValueDigits value_digits(const Swept& swept, std::vector<double> shown, Lang lang) {
    constexpr int kMost = 6;
    const SweptPoints points(swept, lang);
    const double factor = points.factor(0);
    for (double& each : shown) each *= factor;
    ValueDigits out;
    if (points.scale(0) == render::Scale::linear) out.decimals = decimals_of(shown);
    const std::size_t different = std::set(shown.begin(), shown.end()).size();
    const auto texts = [&] {
        std::set<std::string> all;
        for (const double each : shown) all.insert(number(each, out.significant));
        return all.size();
    };
    while (out.significant < kMost && texts() < different) ++out.significant;
    return out;
}

std::string point_text(const Swept& swept, std::uint64_t point, const ValueDigits& digits, Lang lang) {
    const SweptPoints points(swept, lang);
    const output::StoredPoint p = points.data.read(point);
    const output::SweepAxis& axis = points.axis(0);
    const double value = points.value(point);
    const std::string written =
        digits.decimals ? render::fixed(value, *digits.decimals) : render::to_plain(number(value, digits.significant));
    const std::string symbol = symbol_of(axis.name);  // markup of a bare name is no formula
    std::string text = fmt::format("{} = {}{}", symbol.starts_with('$') ? symbol : axis.name, written,
                                   axis.unit == "1" ? "" : (axis.unit == "°" ? "" : "\u00A0") + axis.unit);
    text += ": ";
    if (kind_of(p) != AttractorClass::periodic) return text + class_label(kind_of(p), lang);
    const auto plural = [](auto count) { return count == 1 ? "" : "s"; };
    return text + phrase(lang, "period {0} turn{1}, {2:g} impact{3}", p.period, plural(p.period), p.impacts_per_period,
                         plural(p.impacts_per_period));
}

}  // namespace beamcam::scenes
