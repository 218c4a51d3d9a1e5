#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "scenes/figures/series_data.hpp"

namespace beamcam::scenes {

using render::figure::Series;

std::vector<Lost> unreliable(const sim::Result& result, double end) {
    std::vector<Lost> out;
    for (const sim::Interval& lost : result.not_reproducible)
        if (lost.from < end) out.push_back({lost.from, std::min(lost.to.value_or(end), end)});
    return out;
}

std::array<Series, 2> split(const Series& whole, const std::vector<double>& times, const std::vector<Lost>& intervals) {
    std::array<Series, 2> parts{whole, whole};
    for (Series& part : parts) part.x.clear(), part.y.clear();
    std::optional<bool> before;
    for (std::size_t i = 0; i < whole.x.size(); ++i) {
        const bool unsure = std::ranges::any_of(intervals, [&](const Lost& v) { return v.holds(times[i]); });
        Series& part = parts[unsure ? 1 : 0];
        if (before && *before != unsure) {
            if (!part.x.empty()) part.x.push_back(whole.x[i - 1]), part.y.push_back(std::nan(""));
            part.x.push_back(whole.x[i - 1]), part.y.push_back(whole.y[i - 1]);
        }
        part.x.push_back(whole.x[i]), part.y.push_back(whole.y[i]);
        before = unsure;
    }
    return parts;
}

std::string horizon_text(const std::vector<std::pair<std::string, const sim::Result*>>& motions, double from,
                         double end, Lang lang) {
    std::vector<std::string> times;
    for (const auto& [name, result] : motions)
        for (Lost v : unreliable(*result, end)) {
            if (v.to <= from) continue;
            v.from = std::max(v.from, from);
            const std::string of = name.empty() ? "" : name + " ";
            times.push_back(v.to < end ? phrase(lang, "{}from {} s to {} s", "{}{} s 至 {} s", of, number(v.from, 3),
                                                number(v.to, 3))
                                       : phrase(lang, "{}from {} s on", "{}{} s 之后", of, number(v.from, 3)));
        }
    if (times.empty()) return {};
    return phrase(lang,
                  "Drawn lighter, {}, $θ$ is not reproducible to 10^{{−6}} rad: a run at a tighter tolerance "
                  "differs by more, because impacts multiply small differences. ",
                  "以浅色绘制的部分（{}）$θ$ 不能重现到 10^{{−6}} "
                  "rad：碰撞会放大微小差别，与更严容差的计算之差超过该值。",
                  fmt::format("{}", fmt::join(times, phrase(lang, ", ", "，"))));
}

}  // namespace beamcam::scenes
