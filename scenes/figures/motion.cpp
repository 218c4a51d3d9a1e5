// Motion through repeated impacts: the hub angle in time, for the paper's three speeds, and the phase portrait.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scenes/figures/recipes.hpp"
#include "sim/modes.hpp"

namespace beamcam::scenes {
namespace {

using render::figure::Figure;
using render::figure::Legend;
using render::figure::Panel;
using render::figure::Series;
using sim::ChannelKind;

constexpr int kCurve = 8001;
constexpr std::array kSpeeds3{0.0, 1.0, 5.0};  // ω of the paper's figure 6 [rad/s]

// The part of a curve up to `until`, and the rest, which joins it.
std::array<Series, 2> split(const Series& whole, double until) {
    std::array<Series, 2> parts{whole, whole};
    for (Series& part : parts) part.x.clear(), part.y.clear();
    for (std::size_t i = 0; i < whole.x.size(); ++i) {
        const bool sure = whole.x[i] <= until;
        parts[sure ? 0 : 1].x.push_back(whole.x[i]);
        parts[sure ? 0 : 1].y.push_back(whole.y[i]);
    }
    if (!parts[0].x.empty() && !parts[1].x.empty()) {
        parts[1].x.insert(parts[1].x.begin(), parts[0].x.back());
        parts[1].y.insert(parts[1].y.begin(), parts[0].y.back());
    }
    return parts;
}

Panel angle_panel(const sim::Result& result, std::size_t table, double end) {
    Panel panel;
    panel.x.label = "$t$ / s";
    panel.y.label = "$θ$ / rad";
    panel.legend = Legend::none;
    Series whole;
    whole.x = column(result.tables[table], ChannelKind::t);
    whole.y = column(result.tables[table], ChannelKind::theta);
    whole.weight = 0.9;
    const double until = result.reproducible_until.value_or(end);
    auto [sure, unsure] = split(whole, until);
    unsure.faded = true;
    if (!unsure.x.empty()) panel.series.push_back(std::move(unsure));
    if (!sure.x.empty()) panel.series.push_back(std::move(sure));
    if (until < end) panel.rules.push_back({.at = until, .vertical = true});
    return panel;
}

std::string horizon_words(const std::vector<const sim::Result*>& results, double end, Lang lang) {
    const bool en = lang == Lang::en;
    std::string times;
    for (const sim::Result* r : results) {
        if (!times.empty()) times += en ? ", " : "、";
        const double until = r->reproducible_until.value_or(end);
        times += until < end ? grouped(until, 3) + " s" : (en ? "the end" : "结束");
    }
    return filled(
        en ? "The motion is chaotic: from the vertical line on (until {}), drawn lighter, $θ$ is not "
             "reproducible to 10^{{−6}} rad, by comparison with a run at a tighter tolerance; there the "
             "curve is one of many possible ones. "
           : "运动是混沌的：竖线之后（可重现至 {}）以浅色绘制，与更严容差的计算相比，$θ$ 不能重现到 10^{{−6}} rad，"
             "该部分只是多种可能曲线之一。",
        times);
}

FigureMaker prepare_angle(const Scene& scene, Lang lang, Studies& studies) {
    const double end = scene.end_time;
    const std::size_t study = studies.of(scene.problem, end, "angle");
    const std::size_t table = studies.table(study, {0, end, kCurve}, {ChannelKind::t, ChannelKind::theta});
    studies.horizon(study);
    return [=, problem = scene.problem](const Results& results) {
        const bool en = lang == Lang::en;
        Figure figure;
        figure.name = "angle";
        figure.title = en ? "Hub angle" : "转角";
        figure.panels.push_back(angle_panel(*results[study], table, end));
        figure.aspect = 0.55;
        figure.caption = en ? "Hub angle $θ$. " : "转角 $θ$。";
        if (results[study]->reproducible_until.value_or(end) < end)
            figure.caption += horizon_words({results[study]}, end, lang);
        figure.caption += stated(problem, lang);
        figure.accuracy = accuracy({{&problem, results[study]}}, lang);
        return figure;
    };
}

FigureMaker prepare_speeds(const Scene& scene, Lang lang, Studies& studies) {
    const double end = scene.end_time;
    std::vector<sim::Problem> problems;
    std::vector<std::size_t> where, tables;
    for (const double speed : kSpeeds3) {
        sim::Problem p = scene.problem;
        p.cam->speed = speed;
        where.push_back(studies.of(p, end, "speeds"));
        tables.push_back(studies.table(where.back(), {0, end, kCurve}, {ChannelKind::t, ChannelKind::theta}));
        studies.horizon(where.back());
        problems.push_back(std::move(p));
    }
    return [=](const Results& results) {
        const bool en = lang == Lang::en;
        Figure figure;
        figure.name = "speeds";
        figure.title =
            en ? "Hub angle through repeated impacts for three speeds of the cam" : "三种凸轮转速下反复碰撞时的转角";
        std::vector<const sim::Result*> all;
        std::vector<std::pair<const sim::Problem*, const sim::Result*>> runs;
        double low = 1e300, high = -1e300;
        for (std::size_t k = 0; k < where.size(); ++k) {
            const sim::Result& result = *results[where[k]];
            Panel panel = angle_panel(result, tables[k], end);
            panel.letter = std::string(1, static_cast<char>('a' + k));
            panel.title = fmt::format("$ω$ = {} rad s^{{−1}}", number(kSpeeds3[k], 3));
            for (const Series& s : panel.series)
                for (const double v : s.y) low = std::min(low, v), high = std::max(high, v);
            figure.panels.push_back(std::move(panel));
            all.push_back(&result);
            runs.emplace_back(&problems[k], &result);
        }
        // One scale for all three, so that heights compare.
        const double air = 0.05 * (high - low);
        if (high > low)
            for (Panel& panel : figure.panels) panel.y.from = low - air, panel.y.to = high + air;
        figure.stack = true;
        figure.share_x = true;
        figure.aspect = 1.25;
        figure.caption = en ? "Hub angle $θ$ through repeated impacts: (a) $ω$ = 0, (b) 1, (c) 5 rad s^{−1}. "
                            : "反复碰撞过程中的转角 $θ$：(a) $ω$ = 0，(b) 1，(c) 5 rad s^{−1}。";
        figure.caption += horizon_words(all, end, lang) + stated(problems[1], lang) +
                          (en ? " ($ω$ of panel (b).)" : "（$ω$ 为图 (b) 的值。）");
        figure.accuracy = accuracy(runs, lang);
        return figure;
    };
}

// Rows in a period of the first bending mode; 0: the beam has none, or the rows are too far apart to average.
int rows_of_first_period(const sim::Problem& problem, const std::vector<double>& time) {
    const std::vector<sim::Mode> modes = sim::natural_modes(problem, std::nullopt);
    if (modes.empty() || !(modes.front().omega > 0) || time.size() < 2) return 0;
    return static_cast<int>(std::lround(2 * M_PI / modes.front().omega / (time[1] - time[0])));
}

// Over `rows` values around each, fewer at the ends.
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

FigureMaker prepare_phase(const Scene& scene, Lang lang, Studies& studies) {
    const double end = scene.end_time;
    const std::size_t study = studies.of(scene.problem, end, "phase");
    const std::size_t table =
        studies.table(study, {0, end, 20001}, {ChannelKind::t, ChannelKind::theta, ChannelKind::theta_dot});
    return [=, problem = scene.problem](const Results& results) {
        const bool en = lang == Lang::en;
        const sim::Result& result = *results[study];
        Figure figure;
        figure.name = "phase";
        figure.title = en ? "Phase portrait" : "相图";
        Panel panel;
        panel.legend = Legend::none;
        panel.x.label = "$θ$ / rad";
        panel.x.tight = false;
        panel.y.label = "$\\dot{θ}$ / (rad s^{−1})";
        panel.color_bar = render::figure::ColorBar{.label = "$t$ / s"};
        const std::vector<double>& time = column(result.tables[table], ChannelKind::t);
        Series s;
        s.x = column(result.tables[table], ChannelKind::theta);
        s.y = column(result.tables[table], ChannelKind::theta_dot);
        s.value = time;
        const int period = rows_of_first_period(problem, time);
        if (period > 1) {
            Series raw = s;
            raw.value.clear();
            raw.color = render::rgb(0xD2D2D2);
            raw.weight = 0.35;
            panel.series.push_back(std::move(raw));
            s.x = mean(s.x, period);
            s.y = mean(s.y, period);
        }
        if (!s.x.empty())
            panel.marks.push_back({.x = s.x.front(), .y = s.y.front(), .label = en ? "start" : "起点", .look = 6});
        panel.series.push_back(std::move(s));
        panel.rules.push_back({.at = 0});
        figure.panels.push_back(std::move(panel));
        figure.aspect = 0.75;
        figure.caption =
            en ? "Phase portrait of the hub angle: in grey as it is, with the beam's vibration; coloured by time, the "
                 "mean over one period of the first bending mode. Near-vertical stretches are collisions. "
               : "转角的相图：灰色为原始曲线（含梁的振动），彩色（表示时间）为一阶弯曲周期上的平均。近似竖直的线段为碰"
                 "撞。";
        figure.caption += stated(problem, lang);
        figure.accuracy = accuracy({{&problem, &result}}, lang);
        return figure;
    };
}

}  // namespace

const Recipe kAngle{"angle", {"Hub angle", "转角"}, no_refusal, prepare_angle};
const Recipe kSpeeds{
    "speeds",
    {"Hub angle through repeated impacts for three speeds of the cam", "三种凸轮转速下反复碰撞时的转角"},
    needs_cam,
    prepare_speeds};
const Recipe kPhase{"phase", {"Phase portrait", "相图"}, no_refusal, prepare_phase};

}  // namespace beamcam::scenes
