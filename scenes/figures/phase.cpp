// The phase portrait of the hub: the motion, and its mean over a period of the first bending mode.
#include <algorithm>
#include <array>
#include <cmath>

#include "scenes/figures/recipes.hpp"
#include "sim/beam/modes.hpp"

namespace beamcam::scenes {
namespace {

// The run may be longer because of other figures.
std::ptrdiff_t impacts_until(const sim::Problem& problem, const sim::Result& result, double end) {
    return std::ranges::count_if(result.impacts,
                                 [&](const sim::Impact& i) { return i.t_start <= end && strikes(problem, i); });
}

// Of the first bending mode [s]; 0: the beam has none.
double first_period(const sim::Problem& problem) {
    const std::vector<sim::Mode> modes = sim::natural_modes(problem, std::nullopt);
    return modes.empty() || !(modes.front().omega > 0) ? 0 : 2 * M_PI / modes.front().omega;
}

// Enough rows for a mean over a period.
int rows_until(double end, double period) {
    constexpr double kOfAPeriod = 24, kFewest = 20'000, kMost = 400'000;
    return static_cast<int>(std::clamp(period > 0 ? kOfAPeriod * end / period : 0, kFewest, kMost)) + 1;
}

// 0: the rows are too far apart to average.
int rows_of(double period, const std::vector<double>& time) {
    return time.size() < 2 ? 0 : static_cast<int>(std::lround(period / (time[1] - time[0])));
}

// The mean of `rows` values around each value; of fewer at the ends.
std::vector<double> mean(const std::vector<double>& values, int rows) {
    std::vector<double> sums{0}, out;
    for (const double v : values) sums.push_back(sums.back() + v);
    const auto half = static_cast<std::size_t>(rows / 2), count = values.size();
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t reach = std::min({half, i, count - 1 - i});
        out.push_back((sums[i + reach + 1] - sums[i - reach]) / static_cast<double>(2 * reach + 1));
    }
    return out;
}

Panel empty_panel() {
    Panel panel;
    panel.legend = Legend::none;
    panel.x.label = "$θ$ / rad";
    panel.x.tight = false;
    panel.y.label = "$\\dot{θ}$ / (rad s^{−1})";
    panel.color_bar = render::figure::ColorBar{.label = "$t$ / s"};
    panel.rules.push_back({.at = 0});
    return panel;
}

Series portrait(const sim::Table& table) {
    Series s;
    s.x = column(table, ChannelKind::theta);
    s.y = column(table, ChannelKind::theta_dot);
    return s;
}

// Drawn in grey beneath the mean.
Series raw_portrait(const sim::Table& table) {
    Series raw = portrait(table);
    raw.color = render::rgb(0xD2D2D2);
    raw.weight = 0.35;
    raw.name = "with vibration";
    return raw;
}

std::string phase_caption(bool is_mean, bool has_impacts, Lang lang) {
    const bool en = lang == Lang::en;
    std::string text =
        is_mean ? (en ? "Phase portrait of the hub angle. Grey: the motion with the beam's vibration. Coloured by "
                        "time: its "
                        "mean over one period of the first bending mode. "
                      : "转角的相图：灰色为原始曲线（含梁的振动），彩色（表示时间）为一阶弯曲周期上的平均。")
                : (en ? "Phase portrait of the hub angle, coloured by time. " : "转角的相图，颜色表示时间。");
    if (has_impacts) text += en ? "Near-vertical segments are collisions. " : "近似竖直的线段为碰撞。";
    return text;
}

FigureMaker prepare_phase(const Scene& scene, const FigureOutput& how, Studies& studies) {
    const Lang lang = how.lang;
    const double end = scene.end_time;
    const double first = first_period(scene.problem);
    const std::size_t study = studies.of(scene.problem, end, "phase");
    const std::size_t table = studies.table(study, {0, end, rows_until(end, first)},
                                            {ChannelKind::t, ChannelKind::theta, ChannelKind::theta_dot});
    const std::size_t curve =
        studies.curve(study, {0, end, 2001}, {ChannelKind::theta, 0}, {ChannelKind::theta_dot, 0});
    return [=, problem = scene.problem](const Results& results) {
        const bool en = lang == Lang::en;
        const sim::Result& result = *results[study];
        Panel panel = empty_panel();
        Series s = portrait(result.tables[table]);
        s.value = column(result.tables[table], ChannelKind::t);
        const int period = rows_of(first, s.value);
        if (period > 1) {
            panel.series.push_back(raw_portrait(result.tables[curve]));
            s.name = "mean over a period";
            s.x = mean(s.x, period);
            s.y = mean(s.y, period);
        }
        if (!s.x.empty())
            panel.marks.push_back({.x = s.x.front(), .y = s.y.front(), .label = en ? "start" : "起点", .look = 6});
        panel.series.push_back(std::move(s));
        Figure figure;
        figure.panels.push_back(std::move(panel));
        figure.aspect = 0.75;
        figure.caption =
            phase_caption(period > 1, impacts_until(problem, result, end) > 0, lang) + facts(problem, lang);
        figure.accuracy = accuracy({{&problem, &result}}, lang);
        return figure;
    };
}

}  // namespace

const Recipe kPhase{"phase", {"Phase portrait", "相图"}, no_refusal, prepare_phase};

}  // namespace beamcam::scenes
