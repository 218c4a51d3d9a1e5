#include "scenes/figures/sweep_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "render/draw/markup.hpp"
#include "scenes/figures/key_label.hpp"

namespace beamcam::scenes {

namespace figure = render::figure;
using sim::AttractorClass;

namespace {

std::string span_words(const sim::CamSpan& span, Lang lang) {
    if (span.time) return fmt::format("{:g} s", *span.time);
    return filled(lang == Lang::en ? "{:g} turns of the cam" : "凸轮 {:g} 转", span.turns);
}

std::string axes_words(const SweptPoints& points) {
    std::string text;
    for (const output::SweepAxis& axis : points.data.axes)
        text += filled(
            points.lang == Lang::en ? "{} = {:.6g} … {:.6g}{} in {} values; " : "{} = {:.6g} … {:.6g}{}，共 {} 值；",
            symbol_of(axis.name), *std::ranges::min_element(axis.values), *std::ranges::max_element(axis.values),
            axis.unit == "1" ? "" : " " + axis.unit, axis.values.size());
    return text;
}

std::string starts_words(const SweptPoints& points) {
    std::string text;
    for (std::uint64_t k = 0; k < std::min<std::uint64_t>(points.seeds(), 3); ++k) {
        if (k > 0 && points.seed(k) == points.seed(k - 1)) continue;
        text += (k > 0 ? points.lang == Lang::en ? ", " : "、" : "") + look_of(points.seed(k)).label.in(points.lang);
    }
    return points.seeds() > 3 ? fmt::format("{} ({})", text, points.seeds()) : text;
}

// How many points are of each class.
std::string class_words(const std::map<AttractorClass, std::uint64_t>& kinds, Lang lang) {
    const bool en = lang == Lang::en;
    std::string counts;
    for (const auto& [kind, count] : kinds)
        counts += filled(en ? "{}{} {}" : "{0}{2} {1}",
                         counts.empty() ? ""
                         : en           ? ", "
                                        : "，",
                         count, class_label(kind, lang));
    return counts + (en ? ". " : "。");
}

}  // namespace

std::string caption_words(const SweptPoints& points) {
    const bool en = points.lang == Lang::en;
    std::map<AttractorClass, std::uint64_t> kinds;
    int longest = 0;  // period
    for (std::uint64_t k = 0; k < points.data.points(); ++k) {
        if (!points.data.has(k)) continue;
        const output::StoredPoint p = points.data.read(k);
        ++kinds[kind_of(p)];
        longest = std::max(longest, p.period);
    }
    const sim::Sampling& s = points.scene.sweep->sampling;
    std::string text = axes_words(points);
    text += filled(en ? "samples: {}; transient {}, then {} kept; starts: {}. Points: "
                      : "样本：{}；舍去 {}，保留 {}；初值：{}。点数：",
                   text_of_sample(s), span_words(s.transient, points.lang), span_words(s.keep, points.lang),
                   starts_words(points));
    text += class_words(kinds, points.lang);
    if (kinds.contains(AttractorClass::chaotic))
        text += en ? "Where the motion is chaotic a point is a statistic of its start, transient and periods. "
                   : "混沌处的点是其初值、过渡与周期数的统计。";
    if (!s.keep.time && longest > s.keep.turns)
        text += filled(en ? "Of periods longer than the kept turns, up to {}, only a part is sampled. "
                          : "周期长于保留转数（最长 {} 转）时只取其一部分。",
                       longest);
    Varied varied;
    varied.cam_speed =
        std::ranges::find(points.data.axes, "cam.speed", &output::SweepAxis::name) != points.data.axes.end();
    return text + (en ? "But for what is swept: " : "除扫描参数外：") +
           facts(points.scene.problem, points.lang, varied);
}

std::string tolerance_words(const SweptPoints& points) {
    const bool en = points.lang == Lang::en;
    const sim::Problem& problem = points.scene.problem;
    const bool closed =
        problem.beam.model == sim::ModelKind::rigid && problem.contact.model == sim::ContactModel::restitution;
    return filled(en ? "Relative tolerance {}{}." : "相对容差 {}{}。", one_digit(problem.solver.rtol),
                  !closed ? ""
                  : en    ? ", or rounding where the rigid beam is followed in closed form"
                          : "，刚性梁以闭式求解时为舍入误差");
}

std::string words_of_point(const Swept& swept, std::uint64_t point, Lang lang) {
    const SweptPoints points(swept, lang);
    const output::StoredPoint p = points.data.read(point);
    const output::SweepAxis& axis = points.axis(0);
    std::string text = fmt::format("{} = {:.{}g}{}", render::to_plain(symbol_of(axis.name)),
                                   points.data.place(point)[0], kValueDigits, axis.unit == "1" ? "" : " " + axis.unit);
    text += lang == Lang::en ? ": " : "：";
    if (kind_of(p) != AttractorClass::periodic) return text + class_label(kind_of(p), lang);
    if (lang == Lang::zh) return text + fmt::format("周期 {} 圈，碰撞 {:g} 次", p.period, p.impacts_per_period);
    const auto plural = [](auto count) { return count == 1 ? "" : "s"; };
    return text + fmt::format("period {} turn{}, {:g} impact{}", p.period, plural(p.period), p.impacts_per_period,
                              plural(p.impacts_per_period));
}

}  // namespace beamcam::scenes
