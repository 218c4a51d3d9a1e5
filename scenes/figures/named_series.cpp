// Figures by name that are a series: the hub angle, the same for three speeds of the cam, the vibration of the tip, the
// energy balance.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/figures/series.hpp"

namespace beamcam::scenes {
namespace {

using sim::ChannelKind;

constexpr Words kAngleTitle{"Hub angle", "转角"};
constexpr Words kSpeedsTitle{"Hub angle for three speeds of the cam", "三种凸轮转速下的转角"};
constexpr Words kEnergyTitle{"Energy balance", "能量账目"};
constexpr Words kTipTitle{"Transverse vibration of the free end", "自由端的横向振动"};

FigureMaker prepare_keys(const Scene& scene, const FigureOutput& how, Studies& studies) {
    SeriesKeys keys = how.series;
    if (keys.panels.empty()) keys.panels = {{.channels = {{ChannelKind::theta, 0}}}};
    return prepare_series(scene, keys, {}, how.lang, studies);
}

FigureMaker prepare_angle(const Scene& scene, const FigureOutput& how, Studies& studies) {
    return prepare_series(scene, {.panels = {{.channels = {{ChannelKind::theta, 0}}}}},
                          {"angle", kAngleTitle.in(how.lang), {}, 0.55}, how.lang, studies);
}

FigureMaker prepare_speeds(const Scene& scene, const FigureOutput& how, Studies& studies) {
    SeriesKeys keys{.panels = {{.channels = {{ChannelKind::theta, 0}}}}, .apart = true};
    for (const double speed : kPaperSpeeds) {
        keys.compare.push_back({fmt::format("$ω$ = {} rad s^{{−1}}", number(speed, 3)), scene.problem});
        keys.compare.back().problem.cam->speed = speed;
    }
    const Words caption{"Hub angle $θ$ for three speeds of the cam, clockwise", "三种凸轮转速（顺时针）下的转角 $θ$"};
    return prepare_series(scene, keys, {"speeds", kSpeedsTitle.in(how.lang), caption.in(how.lang), 1.25}, how.lang,
                          studies);
}

FigureMaker prepare_tip(const Scene& scene, const FigureOutput& how, Studies& studies) {
    const SeriesKeys keys{
        .panels = {{.channels = {{ChannelKind::tip_deflection, 0}}, .lines = {0}, .label = "$v$($L$, $t$)"}}};
    const Words with{"Transverse deflection of the free end from the tangent at the root",
                     "自由端相对根部切线的横向挠度"},
        without{"Transverse deflection of the free end from the tangent at the root, without a cam",
                "自由端相对根部切线的横向挠度（无凸轮）"};
    const Words& caption = scene.problem.cam ? with : without;
    return prepare_series(scene, keys, {"tip-vibration", kTipTitle.in(how.lang), caption.in(how.lang), 0.55, 0.75},
                          how.lang, studies);
}

// What the first panel shows, and the closure where there is a second.
std::string energy_caption(const render::figure::Figure& figure, Lang lang) {
    const bool en = lang == Lang::en, both = figure.panels.size() > 1;
    std::vector<std::string> names;
    for (const render::figure::Series& s : figure.panels.front().series) names.push_back(s.label);
    names.pop_back();  // the balance
    const Words closure{
        ". (b) Magnitude of the change of that balance, which the exact solution keeps at zero; what is below "
        "10^{−12} of the largest energy is rounding and lies on the lower edge",
        "。(b) 该平衡变化量的绝对值，精确解中恒为零；小于最大能量 10^{−12} 的部分属舍入误差，画在下边缘"};
    return filled(en ? "Energy: {}{}; the black line is their balance" : "能量：{}{}；黑线为其平衡", both ? "(a) " : "",
                  fmt::format("{}", fmt::join(names, en ? ", " : "、"))) +
           (both ? closure.in(lang) : "");
}

FigureMaker prepare_energy(const Scene& scene, const FigureOutput& how, Studies& studies) {
    using Kind = ChannelKind;
    const auto say = [&](const char* en, const char* zh) { return Words{en, zh}.in(how.lang); };
    const std::vector<Kind> stored{Kind::energy_kinetic, Kind::energy_potential, Kind::energy_elastic,
                                   Kind::energy_contact},
        lost{Kind::loss_structural, Kind::loss_contact, Kind::loss_friction}, work{Kind::work_cam, Kind::work_drive};
    std::vector<Kind> all = stored;
    all.insert(all.end(), lost.begin(), lost.end());
    const SeriesKeys keys{
        .panels = {{.channels = {{Kind::energy_kinetic, 0}}, .label = "$E$"},
                   {.channels = {{Kind::energy_residual, 0}}, .logarithmic = true, .label = "|$ΔE$|"}}};
    return prepare_series(
        scene, keys,
        {.name = "energy",
         .title = kEnergyTitle.in(how.lang),
         .caption = {},
         .aspect = 1.05,
         .weight = 0.75,
         .sums = {{say("kinetic", "动能"), {Kind::energy_kinetic}},
                  {say("potential", "重力势能"), {Kind::energy_potential}},
                  {say("bending and contact", "弯曲与接触能"), {Kind::energy_elastic, Kind::energy_contact}},
                  {say("lost", "损失"), lost},
                  {say("work done on it", "外功"), work},
                  {say("sum − work", "总和 − 外功"), all, work}},
         .horizon = false,
         .caption_of = energy_caption},
        how.lang, studies);
}

std::optional<std::string> needs_vibration(const Scene& scene) {
    if (scene.problem.beam.model != sim::ModelKind::rigid) return std::nullopt;
    return "a rigid beam does not vibrate; choose another beam.model";
}

}  // namespace

const Recipe kSeries{"series", {"Any channels, of one motion or of several", "任意通道"}, no_refusal, prepare_keys};
const Recipe kAngle{"angle", kAngleTitle, no_refusal, prepare_angle};
const Recipe kSpeeds{"speeds", kSpeedsTitle, needs_cam, prepare_speeds};
const Recipe kEnergy{"energy", kEnergyTitle, no_refusal, prepare_energy};
const Recipe kTipVibration{"tip-vibration", kTipTitle, needs_vibration, prepare_tip};

}  // namespace beamcam::scenes
