// The phase portrait of the hub: the motion, and its mean over a period of the first bending mode.
#include <algorithm>
#include <cmath>
#include <utility>

#include "scenes/figures/axis_labels.hpp"
#include "scenes/figures/figure_types.hpp"

namespace beamcam::scenes {
namespace {

// Of the first bending mode [s]; 0: the beam has none.
double first_period(const sim::Problem& problem) {
    const std::vector<double> frequencies = frequencies_of(problem);
    return frequencies.empty() ? 0 : 1 / frequencies.front();
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

// The mean of 2·half + 1 values around each value that has so many.
std::vector<double> mean(const std::vector<double>& values, std::size_t half) {
    std::vector<double> sums{0}, out;
    for (const double v : values) sums.push_back(sums.back() + v);
    for (std::size_t i = half; i + half < values.size(); ++i)
        out.push_back((sums[i + half + 1] - sums[i - half]) / static_cast<double>(2 * half + 1));
    return out;
}

// The curve without its vibration; it begins and ends half a period within the motion.
void average(Series& s, std::size_t half) {
    s.x = mean(s.x, half), s.y = mean(s.y, half);
    s.value = {s.value.begin() + static_cast<std::ptrdiff_t>(half), s.value.end() - static_cast<std::ptrdiff_t>(half)};
}

Series portrait(const sim::Table& table, const Measure& angle, const Measure& speed) {
    return {.x = scaled(column(table, ChannelKind::theta), angle.factor),
            .y = scaled(column(table, ChannelKind::theta_dot), speed.factor)};
}

std::string phase_caption(bool is_mean, bool has_impacts, Lang lang) {
    std::string text =
        is_mean ? phrase(lang,
                         "Phase portrait of the hub angle. Grey: the motion with the beam's vibration. Coloured by "
                         "time: its "
                         "mean over one period of the first bending mode. ",
                         "转角的相图：灰色为原始曲线（含梁的振动），彩色（表示时间）为一阶弯曲周期上的平均。")
                : phrase(lang, "Phase portrait of the hub angle, coloured by time. ", "转角的相图，颜色表示时间。");
    if (has_impacts) text += phrase(lang, "Near-vertical segments are collisions. ", "近似竖直的线段为碰撞。");
    return text;
}

FigureDrawing prepare_phase(const Scene& scene, const FigureOutput&, Studies& studies) {
    const double first = first_period(scene.problem);
    const std::size_t study = studies.of(scene.problem, scene.end_time);
    const std::size_t table = studies.table(study, {0, scene.end_time, rows_until(scene.end_time, first)},
                                            {ChannelKind::t, ChannelKind::theta, ChannelKind::theta_dot});
    const std::size_t curve =
        studies.curve(study, {0, scene.end_time, 2001}, {ChannelKind::theta, 0}, {ChannelKind::theta_dot, 0});
    return figure_of_motion(study, [=](const Subject& subject, const sim::Result& result) -> Figure {
        const auto& [problem, units, lang, end] = subject;
        const Measure angle = measure_in(units, "rad"), speed = measure_in(units, "rad/s");
        Panel panel{.x = {.label = axis_label("$θ$", angle.unit)},
                    .y = {.label = axis_label("$\\dot{θ}$", speed.unit)},
                    .rules = {{.at = 0}},
                    .color_bar = render::figure::ColorBar{.label = "$t$ / s", .from = 0, .to = end},
                    .legend = Legend::none};
        const int period = rows_of(first, column(result.tables[table], ChannelKind::t));
        const bool averaged = period > 1 && std::cmp_less(2 * period, result.tables[table].rows());
        // Equally spaced rows for the mean; otherwise rows that are closer where the curve bends.
        const sim::Table& rows = result.tables[averaged ? table : curve];
        Series s = portrait(rows, angle, speed);
        s.value = column(rows, ChannelKind::t);
        if (!s.x.empty())
            panel.marks.push_back(
                {.x = s.x.front(), .y = s.y.front(), .label = phrase(lang, "start", "起点"), .look = 6});
        if (averaged) {
            Series& raw =
                panel.series.emplace_back(portrait(result.tables[curve], angle, speed));  // in grey beneath the mean
            raw.color = render::rgb(0xD2D2D2), raw.weight = 0.35, raw.name = "with vibration";
            s.name = "mean over a period";
            average(s, static_cast<std::size_t>(period / 2));
        }
        panel.series.push_back(std::move(s));
        const bool has_impacts = !strikes(problem, result.impacts, 0, end).empty();  // the run may be longer
        return {.panels = {std::move(panel)}, .aspect = 0.75, .caption = phase_caption(averaged, has_impacts, lang)};
    });
}

}  // namespace

extern const FigureType kPhase{"phase", {"Phase portrait", "相图"}, no_refusal, prepare_phase};

}  // namespace beamcam::scenes
