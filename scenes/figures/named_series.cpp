// Figures by name that are a series: the hub angle, the same for three speeds of the cam, the vibration of the tip.
#include <fmt/format.h>

#include "scenes/figures/series.hpp"

namespace beamcam::scenes {
namespace {

using sim::ChannelKind;

constexpr Words kAngleTitle{"Hub angle", "转角"};
constexpr Words kSpeedsTitle{"Hub angle for three speeds of the cam", "三种凸轮转速下的转角"};
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

std::optional<std::string> needs_vibration(const Scene& scene) {
    if (scene.problem.beam.model != sim::ModelKind::rigid) return std::nullopt;
    return "a rigid beam does not vibrate; choose another beam.model";
}

}  // namespace

const Recipe kSeries{"series", {"Any channels, of one motion or of several", "任意通道"}, no_refusal, prepare_keys};
const Recipe kAngle{"angle", kAngleTitle, no_refusal, prepare_angle};
const Recipe kSpeeds{"speeds", kSpeedsTitle, needs_cam, prepare_speeds};
const Recipe kTipVibration{"tip-vibration", kTipTitle, needs_vibration, prepare_tip};

}  // namespace beamcam::scenes
