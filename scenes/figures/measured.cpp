#include <algorithm>

#include "render/plot/channel_label.hpp"
#include "scenes/figures/series_data.hpp"

namespace beamcam::scenes {

std::vector<Measured> measured(const Scene& scene, const std::vector<sim::Channel>& channels, double from, double to,
                               std::size_t study, Studies& studies) {
    std::vector<Measured> out;
    for (const Measurement& each : scene.data) {
        Measurement data = each.of(channels).within(from, to);
        if (data.columns.empty() || data.times.empty()) continue;
        const std::size_t table = studies.add_table(study, data.request());
        out.push_back({std::move(data), table});
    }
    return out;
}

render::figure::Series measured_series(const Measurement& data, std::vector<double> x, std::vector<double> y,
                                       int look) {
    const bool line = data.is_line(x.size());
    return {.label = data.label,
            .x = std::move(x),
            .y = std::move(y),
            .look = look,
            .line = line,
            .every_point = !line,
            .weight = 0.7};
}

std::string agreement_text(const std::vector<Measured>& all, const sim::Result& result, const sim::Problem& problem,
                           Lang lang) {
    std::string text;
    for (const Measured& each : all)
        for (const output::Agreement& a : agreements(each.data, result.tables[each.table], result)) {
            const std::string symbol = render::print_symbol(a.channel), unit = sim::unit(a.channel, problem);
            if (a.whole.rows == 0 && !a.beyond)
                text += phrase(lang, "Data “{}”: at no instant {} has both a measured and a computed value. ",
                               "{}：没有任何时刻同时具有 {} 的测量值与计算值。", each.data.label, symbol);
            if (a.whole.rows > 0)
                text += phrase(lang,
                               "Data “{}”: at {} instants {} differs by {} {} (root mean square), at most by {} {} at "
                               "{} s. ",
                               "{}，{} 个时刻：{} 的均方根差为 {} {}，最大差 {} {}（{} s）。", each.data.label,
                               a.whole.rows, symbol, number(a.whole.rms, 2), unit, number(a.whole.largest, 2), unit,
                               number(a.whole.t_largest, 4));
            if (!a.beyond) continue;
            const auto& [rows, m, c] = *a.beyond;
            text += phrase(lang,
                           "Data “{}”: at {} instants $θ$ is not reproducible, so that only statistics compare: "
                           "mean {} {} and standard deviation {} {}, computed {} {} and {} {}. ",
                           "{}，{} 个时刻 $θ$ 不可重现，仅比较统计量：均值 {} {}、标准差 {} {}，计算值为 {} {}、{} "
                           "{}。",
                           each.data.label, rows, number(m.mean, 3), unit, number(m.deviation, 3), unit,
                           number(c.mean, 3), unit, number(c.deviation, 3), unit);
        }
    return text;
}

}  // namespace beamcam::scenes
