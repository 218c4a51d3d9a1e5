// The figure "series" draws any channels against the time, the turns of the cam or another channel, of one motion or of
// several; the figures "angle", "speeds", "tip-vibration" and "energy" are series with given keys.
#include "scenes/figures/series.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>

#include "render/plot/channel_label.hpp"
#include "scenes/figures/figure_types.hpp"

namespace beamcam::scenes {
namespace {

// How a figure by name presents its series.
struct SeriesPreset {
    Translated caption = {};      // its first sentence; empty: by the channels
    double aspect = 0;            // 0: by the panels
    double weight = 0.9;          // of the lines
    bool horizon = true;          // curves are paler where θ is not reproducible
    bool names_energies = false;  // in the caption
};

// Gives the panels of several motions one scale, so that they compare.
void share_ordinates(Figure& figure) {
    std::map<std::string, render::Extent> ranges;  // by what the panels show
    for (const Panel& panel : figure.panels)
        for (const Series& curve : panel.series)
            if (!curve.right) ranges[panel.name].add(curve.y);
    for (Panel& panel : figure.panels) {
        const auto& [any, low, high] = ranges[panel.name];
        const double air = 0.05 * (high - low);
        if (!(high > low) || panel.y.scale == render::Scale::logarithmic) continue;
        panel.y.from = panel.y.from.value_or(low - air), panel.y.to = panel.y.to.value_or(high + air);
    }
}

// Names the curves of the first panel; explains the second, if there is one.
std::string energy_caption(const Figure& figure, Lang lang) {
    const bool both = figure.panels.size() > 1;
    std::vector<std::string> names;
    for (const Series& s : figure.panels.front().series) names.push_back(s.label);
    names.pop_back();  // the sum
    return phrase(
        lang, "Energy: {}{}; the black line is the sum of the energies stored and lost less the external work{}",
        "能量：{}{}；黑线为储能与损失之和减去外功{}", both ? "(a) " : "", fmt::join(names, phrase(lang, ", ", "、")),
        !both ? ""
              : phrase(lang,
                       ". (b) Magnitude of the change of that sum, which is zero for the exact solution; "
                       "values below 10^{−12} of the largest energy are rounding errors and are drawn at the "
                       "lower edge",
                       "。(b) 该平衡变化量的绝对值，精确解中恒为零；小于最大能量 10^{−12} "
                       "的部分属舍入误差，画在下边缘"));
}

Figure series_figure(const SeriesPlan& plan, const SeriesPreset& preset, const Results& results) {
    std::vector<Panel> panels;
    for (const PlannedPanel& planned : plan.panels)
        std::ranges::move(series_panels(plan, planned, results, preset.weight), std::back_inserter(panels));
    Figure figure{.panels = lettered(std::move(panels)), .stack = true, .share_x = true};
    plan.abscissa.share(figure, plan.motions.front().problem, plan.units);
    if (plan.keys.apart) share_ordinates(figure);
    const bool all_shown = figure.panels.size() >= plan.panels.size();
    figure.aspect =
        preset.aspect > 0 && all_shown ? preset.aspect : 0.2 + 0.36 * static_cast<double>(figure.panels.size());
    std::string subject = preset.names_energies ? energy_caption(figure, plan.lang) : preset.caption.in(plan.lang);
    if (subject.empty()) {
        const sim::ChannelLabel& first = sim::row(plan.keys.panels.front().channels.front().kind).label;
        figure.title = phrase(plan.lang, first.words, first.chinese);
        subject = series_subject(plan.keys, plan.lang);
    }
    figure.caption = series_caption(plan, subject, figure, results);
    Runs runs;
    for (const SeriesMotion& motion : plan.motions) runs.emplace_back(&motion.problem, results[motion.study]);
    figure.accuracy = accuracy(runs, plan.lang);
    return figure;
}

// Points are taken where the limits of a time axis show them.
void keep_within_limits(SeriesPlan& plan) {
    const SeriesKeys& keys = plan.keys;
    if (keys.against != "t") return;
    const double from = std::max(keys.from, keys.x_low.value_or(keys.from)),
                 end = std::min(plan.end, keys.x_high.value_or(plan.end));
    if (from < end) plan.keys.from = from, plan.end = end;
}

// `keys` has panels.
FigureDrawing prepare_series(const Scene& scene, const SeriesKeys& keys, const SeriesPreset& preset, Lang lang,
                             Studies& studies) {
    SeriesPlan plan{keys, lang, keys.to.value_or(scene.end_time), SeriesAbscissa(keys, lang), scene.units};
    keep_within_limits(plan);
    plan.horizon = preset.horizon;
    complete(plan, scene, studies);
    return [plan, preset](const Subject&, const Results& results) { return series_figure(plan, preset, results); };
}

// ---- the named ones -------------------------------------------------------------------------------

const SeriesKeys kHubAngle{.panels = {{.channels = {{ChannelKind::theta, 0}}}}};

FigureDrawing prepare_keys(const Scene& scene, const FigureOutput& how, Studies& studies) {
    SeriesKeys keys = how.series;
    if (keys.panels.empty()) keys.panels = kHubAngle.panels;
    return prepare_series(scene, keys, {}, how.lang, studies);
}

FigureDrawing prepare_angle(const Scene& scene, const FigureOutput& how, Studies& studies) {
    return prepare_series(scene, kHubAngle, {.aspect = 0.55}, how.lang, studies);
}

FigureDrawing prepare_speeds(const Scene& scene, const FigureOutput& how, Studies& studies) {
    SeriesKeys keys = kHubAngle;
    keys.apart = true;
    for (const double speed : kPaperSpeeds) {
        keys.compare.push_back({"$ω$ = " + angular_speed_text(speed, scene.units.speed), scene.problem});
        keys.compare.back().problem.cam->speed = speed;
    }
    return prepare_series(
        scene, keys,
        {.caption = {"Hub angle $θ$ for three speeds of the cam, clockwise", "三种凸轮转速（顺时针）下的转角 $θ$"},
         .aspect = 1.25},
        how.lang, studies);
}

FigureDrawing prepare_tip(const Scene& scene, const FigureOutput& how, Studies& studies) {
    const SeriesKeys keys{
        .panels = {{.channels = {{ChannelKind::tip_deflection, 0}}, .lines = {0}, .label = "$v$($L$, $t$)"}}};
    const Translated with{"Transverse deflection of the free end from the tangent at the root",
                          "自由端相对根部切线的横向挠度"},
        without{"Transverse deflection of the free end from the tangent at the root, without a cam",
                "自由端相对根部切线的横向挠度（无凸轮）"};
    return prepare_series(scene, keys, {.caption = scene.problem.cam ? with : without, .aspect = 0.55, .weight = 0.75},
                          how.lang, studies);
}

// Only the energies that the scene can have.
std::vector<SeriesSum> energies_of(const sim::Problem& p, Lang lang) {
    using Kind = ChannelKind;
    const bool bends = p.beam.model != sim::ModelKind::rigid,
               compressed = p.cam && p.contact.model == sim::ContactModel::compliant;
    const std::vector<sim::Channel> lost{{Kind::loss_structural}, {Kind::loss_contact}, {Kind::loss_friction}},
        work{{Kind::work_cam}, {Kind::work_drive}};
    std::vector<SeriesSum> sums;
    const auto add = [&](Translated label, std::vector<sim::Channel> plus) {
        sums.push_back({label.in(lang), std::move(plus)});
    };
    add({"kinetic", "动能"}, {{Kind::energy_kinetic}});
    if (p.gravity != 0) add({"potential", "重力势能"}, {{Kind::energy_potential}});
    if (bends || compressed)
        add(!compressed ? Translated{"bending", "弯曲能"}
            : bends     ? Translated{"bending and contact", "弯曲与接触能"}
                        : Translated{"contact", "接触能"},
            {{Kind::energy_elastic}, {Kind::energy_contact}});
    add({"lost", "损失"}, lost);
    add({"external work", "外功"}, work);
    std::vector<sim::Channel> all{
        {Kind::energy_kinetic}, {Kind::energy_potential}, {Kind::energy_elastic}, {Kind::energy_contact}};
    all.insert(all.end(), lost.begin(), lost.end());
    sums.push_back({Translated{"sum − work", "总和 − 外功"}.in(lang), all, work});
    return sums;
}

FigureDrawing prepare_energy(const Scene& scene, const FigureOutput& how, Studies& studies) {
    const SeriesKeys keys{
        .panels = {{.channels = {{ChannelKind::energy_kinetic, 0}},
                    .sums = energies_of(scene.problem, how.lang),
                    .label = "$E$"},
                   {.channels = {{ChannelKind::energy_residual, 0}}, .logarithmic = true, .label = "|$ΔE$|"}}};
    return prepare_series(scene, keys, {.aspect = 1.05, .weight = 0.75, .horizon = false, .names_energies = true},
                          how.lang, studies);
}

}  // namespace

extern const FigureType kSeries{.name = "series",
                                .title = {"Any channels, of one motion or of several", "任意通道"},
                                .refusal = no_refusal,
                                .maker = prepare_keys,
                                .keys = {"channels", "panels", "x", "x_low", "x_high", "from", "to", "impacts", "notes",
                                         "compare", "comparison", "residuals"}};
extern const FigureType kAngle{"angle", {"Hub angle", "转角"}, no_refusal, prepare_angle};
extern const FigureType kSpeeds{
    "speeds", {"Hub angle for three speeds of the cam", "三种凸轮转速下的转角"}, needs_cam, prepare_speeds};
extern const FigureType kEnergy{"energy", {"Energy balance", "能量账目"}, no_refusal, prepare_energy};
extern const FigureType kTipVibration{
    "tip-vibration", {"Transverse vibration of the free end", "自由端的横向振动"}, needs_bending, prepare_tip};

}  // namespace beamcam::scenes
