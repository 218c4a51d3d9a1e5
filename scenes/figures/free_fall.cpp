// Falling without a cam: the hub angle of the flexible and the rigid beam.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "scenes/figures/recipes.hpp"
#include "sim/studies/paper.hpp"

namespace beamcam::scenes {
namespace {

constexpr int kFallPoints = 2001;  // points: a column of print has fewer dots
constexpr double kAround = 12e-6;  // half of the enlarged interval about the rigid crossing [s]

// The time that the inset enlarges: only the hinged rod released at rest has a closed form for it.
std::optional<double> closed_form(const sim::Problem& p) {
    const bool plain = std::holds_alternative<sim::FreeDrive>(p.hub.drive) && p.hub.radius == 0 && p.hub.inertia == 0 &&
                       p.initial.angular_velocity == 0 && p.initial.shape == sim::InitialShape::straight &&
                       p.initial.angle > 0 && p.initial.angle < 1.57 && p.gravity > 0;
    if (!plain) return std::nullopt;
    return sim::rod_fall_time(p.beam.length, p.gravity, p.initial.angle, 1);
}

struct Fall {
    std::size_t study = 0, table = 0;
    std::optional<std::size_t> close;
};

Series curve(const sim::Table& t, std::string label, int look) {
    Series s;
    s.label = std::move(label);
    s.look = look;
    s.x = column(t, ChannelKind::t);
    s.y = column(t, ChannelKind::theta);
    return s;
}

void mark_zero(Panel& panel, const sim::Result& result, int look, bool hollow) {
    if (!result.theta_zero.empty())
        panel.marks.push_back({.x = result.theta_zero.front().t, .y = 0, .look = look, .hollow = hollow});
}

std::optional<double> zero_of(const sim::Result& result) {
    if (result.theta_zero.empty()) return std::nullopt;
    return result.theta_zero.front().t;
}

// Microseconds about the closed form, microradians about zero, if both beams cross there.
std::optional<render::figure::Inset> close_up(const Fall& flexible, const Fall& stiff, double exact,
                                              const Results& results) {
    Panel panel;
    panel.x.label = filled("($t$ − {} s) / µs", grouped(exact, 6));
    panel.y.label = "$θ$ / µrad";
    panel.legend = Legend::none;
    panel.rules.push_back({.at = 0});
    double slope = 0;
    for (const auto& [fall, look] : {std::pair{&flexible, 0}, std::pair{&stiff, 1}}) {
        const sim::Result& result = *results[fall->study];
        const std::optional<double> zero = zero_of(result);
        if (!zero || std::abs(*zero - exact) > 0.8 * kAround) return std::nullopt;
        Series s = curve(result.tables[*fall->close], "", look);
        for (double& t : s.x) t = (t - exact) * 1e6;
        s.y = scaled(s.y, 1e6);
        s.solid = look == 0;
        panel.series.push_back(std::move(s));
        panel.marks.push_back({.x = (*zero - exact) * 1e6, .y = 0, .look = look});
        slope = std::abs(result.theta_zero.front().theta_dot);
    }
    return render::figure::Inset{
        .panel = {std::move(panel)},
        .width = 0.36,
        .height = 0.34,
        .source = render::figure::Inset::Source{exact - kAround, exact + kAround, -slope * kAround, slope * kAround}};
}

// The beams of the figure: the scene's own, the rigid one, and in the paper's fall the rod that takes its 0.262 s.
struct Beams {
    sim::Problem own, stiff, doubled;
    Fall falls[3];
    std::optional<std::size_t> fewer;  // the study of one mode fewer
    bool flexible = false, paper = false;
};

std::string fall_caption(const Beams& beams, const Results& results, double end, Lang lang) {
    const bool en = lang == Lang::en;
    const auto zero = [&](int k) { return zero_of(*results[beams.falls[k].study]); };
    const std::optional<double> fewer = beams.fewer ? zero_of(*results[*beams.fewer]) : std::nullopt;
    std::string text = beams.flexible ? (en ? "Hub angle without the cam, of the flexible and of the rigid beam. "
                                            : "无凸轮时柔性梁与刚性梁的转角。")
                                      : (en ? "Hub angle without the cam. " : "无凸轮时的转角。");
    std::vector<std::string> times;
    const auto add = [&](int k, const sim::Problem& problem, Translated whose) {
        if (!zero(k)) return;
        const Estimate at = estimate(problem, *zero(k), k == 0 ? fewer : std::nullopt);
        times.push_back(filled(en ? "{} s ({})" : "{} s（{}）", supported(at), whose.in(lang)));
    };
    if (beams.flexible) add(0, beams.own, {"flexible", "柔性"});
    add(1, beams.stiff, {"rigid", "刚性"});
    if (times.empty()) {
        text += filled(en ? "$θ$ does not reach 0 before {} s. " : "{} s 之前 $θ$ 未达到 0。", number(end, 4));
    } else {
        text += filled(en ? "$θ$ = 0 is reached at {}. " : "到达 $θ$ = 0 的时刻：{}。",
                       fmt::format("{}", fmt::join(times, en ? ", " : "，")));
        if (beams.flexible && zero(0) && zero(1)) {
            const Estimate own = estimate(beams.own, *zero(0), fewer);
            text += filled(en ? "Flexibility changes the time by {} s. " : "柔性使该时刻改变 {} s。",
                           supported({*zero(0) - *zero(1), own.error}));
        }
        text += digits_stated(beams.own, lang);
    }
    if (beams.paper)
        text += filled(en ? "The paper prints 0.37 s for the flexible beam and 0.262 s for the rigid rod. The third "
                            "curve, the rigid rod with a factor 2 between torque and inertia (torque doubled or "
                            "inertia halved), takes {} s, 1/√2 of the rod's time. "
                          : "原文给出柔性梁 0.37 s、刚性杆 0.262 s。第三条曲线为力矩与惯量之比差 2 "
                            "倍（力矩加倍或惯量减半）的刚性杆，历时 {} s，即刚性杆的 1/√2。",
                       supported(estimate(beams.doubled, *zero(2), std::nullopt)));
    return text;
}

// Until `end`; also in close-up about the time `closely` [s].
Fall ask_for_fall(Studies& studies, const sim::Problem& problem, double end, std::optional<double> closely) {
    Fall fall;
    fall.study = studies.of(problem, end, "free-fall");
    studies.zero_crossings(fall.study);
    fall.table = studies.table(fall.study, {0, end, kFallPoints}, {ChannelKind::t, ChannelKind::theta});
    if (closely)
        fall.close = studies.table(fall.study, {*closely - kAround, *closely + kAround, 241},
                                   {ChannelKind::t, ChannelKind::theta});
    return fall;
}

// The beams of the scene and their studies. `closely`: when the rigid beam is level, if the inset shows it.
Beams beams_of(const Scene& scene, std::optional<double>& closely, Studies& studies) {
    const double end = scene.end_time;
    Beams beams;
    beams.own = without_cam(scene.problem);
    beams.doubled = beams.stiff = rigid(beams.own);
    beams.doubled.gravity *= 2;
    beams.flexible = beams.own.beam.model != sim::ModelKind::rigid;
    const std::optional<double> exact = closed_form(beams.own);
    beams.paper = exact && is_of_the_paper(scene.problem) && *exact < end;
    if (beams.flexible && exact && *exact + kAround < end) closely = exact;
    beams.falls[0] = ask_for_fall(studies, beams.own, end, closely);
    beams.falls[1] = ask_for_fall(studies, beams.stiff, end, closely);
    if (beams.paper) beams.falls[2] = ask_for_fall(studies, beams.doubled, end, {});
    beams.fewer = study_with_one_mode_fewer(beams.own, end, "free-fall", studies);
    if (beams.fewer) studies.zero_crossings(*beams.fewer);
    return beams;
}

// The beams that are shown, with their labels.
std::vector<std::tuple<int, const sim::Problem*, Translated>> shown_beams(const Beams& beams) {
    std::vector<std::tuple<int, const sim::Problem*, Translated>> out;
    if (beams.flexible) out.emplace_back(0, &beams.own, Translated{"flexible", "柔性"});
    out.emplace_back(1, &beams.stiff, Translated{"rigid", "刚性"});
    if (beams.paper) out.emplace_back(2, &beams.doubled, Translated{"rigid, factor 2", "刚性，2 倍"});
    return out;
}

Panel fall_panel(const Beams& beams, std::optional<double> closely, const Results& results, Lang lang) {
    Panel panel;
    panel.x.label = "$t$ / s";
    panel.y.label = "$θ$ / rad";
    panel.legend = Legend::box;
    panel.rules.push_back({.at = 0});
    for (const auto& [k, problem, label] : shown_beams(beams)) {
        const Fall& fall = beams.falls[k];
        panel.series.push_back(curve(results[fall.study]->tables[fall.table], label.in(lang), k));
        panel.series.back().solid = panel.series.size() == 1;
    }
    if (beams.paper) mark_zero(panel, *results[beams.falls[2].study], 2, false);
    auto inset = closely ? close_up(beams.falls[0], beams.falls[1], *closely, results) : std::nullopt;
    if (inset) {
        // Room above the curves for the legend and the inset.
        double low = 0, high = 0;
        for (const Series& s : panel.series)
            for (const double v : s.y) low = std::min(low, v), high = std::max(high, v);
        panel.y.to = 1.75 * high - std::min(0.0, 0.1 * low) + 0.01;
        panel.insets.push_back(std::move(*inset));
    } else {
        if (beams.flexible) mark_zero(panel, *results[beams.falls[0].study], 0, false);
        mark_zero(panel, *results[beams.falls[1].study], 1, beams.flexible);
    }
    return panel;
}

FigureMaker prepare_fall(const Scene& scene, const FigureOutput& how, Studies& studies) {
    std::optional<double> closely;
    const Beams beams = beams_of(scene, closely, studies);
    return [=, lang = how.lang, end = scene.end_time](const Results& results) {
        Figure figure;
        figure.panels.push_back(fall_panel(beams, closely, results, lang));
        figure.aspect = 0.74;
        std::vector<std::pair<const sim::Problem*, const sim::Result*>> runs;
        for (const auto& [k, problem, label] : shown_beams(beams))
            runs.emplace_back(problem, results[beams.falls[k].study]);
        figure.caption = fall_caption(beams, results, end, lang) + beam_facts(beams.own, lang);
        figure.accuracy = accuracy(runs, lang);
        return figure;
    };
}

}  // namespace

const Recipe kFreeFall{"free-fall", {"Hub angle without the cam", "无凸轮时的转角"}, needs_fall, prepare_fall};

}  // namespace beamcam::scenes
