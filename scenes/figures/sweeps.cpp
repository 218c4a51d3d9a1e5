#include "scenes/figures/sweeps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "render/base/error.hpp"
#include "render/plot/channel_label.hpp"
#include "scenes/figures/axis_labels.hpp"
#include "scenes/figures/figure_types.hpp"
#include "scenes/figures/swept_points.hpp"
#include "sim/problem/number_keys.hpp"

namespace beamcam::scenes {
namespace {

namespace figure = render::figure;
using render::rgb;
using sim::AttractorClass;

// ---- captions -------------------------------------------------------------------------------------

std::string span_text(const sim::CamSpan& span, Lang lang) {
    if (span.time) return fmt::format("{:g} s", *span.time);
    return phrase(lang, "{:g} turns of the cam", "凸轮 {:g} 转", span.turns);
}

// "θ₀ = 0.1 … 0.4 rad"
std::string range_text(const std::string& key, double low, double high, const std::string& unit) {
    const std::string last = with_unit(number(high, 6), unit), name = symbol_of(key);
    return low == high ? fmt::format("{} = {}", name, last) : fmt::format("{} = {} … {}", name, number(low, 6), last);
}

std::string axes_text(const SweptPoints& points) {
    std::string text;
    for (std::size_t i = 0; i < points.axes().size(); ++i) {
        const output::SweepAxis& axis = points.axis(i);
        const auto [low, high] = std::ranges::minmax(axis.values);
        text += range_text(axis.name, low, high, axis.unit);
        if (low != high)
            text += phrase(points.lang, " in {} values{}", "，共 {} 值{}", axis.values.size(),
                           points.scale(i) == render::Scale::linear
                               ? ""
                               : phrase(points.lang, " of a logarithmic scale", "（对数分布）"));
        text += phrase(points.lang, "; ", "；");
    }
    return text;
}

std::string sample_text(const SweptPoints& points) {
    const sim::Sampling& s = points.scene.sweep->sampling;
    const bool crossing = s.kind == sim::SampleKind::crossings;
    if (!crossing && s.kind != sim::SampleKind::section)
        return s.kind == sim::SampleKind::impacts ? phrase(points.lang, "at impacts", "碰撞时刻")
                                                  : phrase(points.lang, "at apexes", "极点时刻");
    const Measure in = measure_in(points.scene.units, crossing ? sim::unit(s.channel, points.scene.problem) : "rad");
    const std::string level = with_unit(number(in.factor * s.level, 6), in.unit);
    if (!crossing) return phrase(points.lang, "where the cam's angle is {}", "凸轮转角为 {} 处", level);
    return phrase(points.lang, s.rising ? "where {} rises through {}" : "where {} falls through {}",
                  s.rising ? "{} 升过 {} 处" : "{} 降过 {} 处", render::print_symbol(s.channel), level);
}

bool has_random_starts(const SweptPoints& points) {
    return std::ranges::count(points.scene.sweep->seeds.kinds, SeedKind::random) > 0;
}

// ": θ₀ = 0.1 … 0.4 rad, …"
std::string random_text(const SweptPoints& points) {
    std::vector<std::string> ranges;
    for (const RandomKey& each : random_keys(*points.scene.sweep, points.scene.problem)) {
        const Measure in =
            measure_in(points.scene.units, si_unit(sim::number_key(points.scene.problem, each.key)->dimension));
        ranges.push_back(range_text(each.key, in.factor * each.from, in.factor * each.to, in.unit));
    }
    return phrase(points.lang, " with {}", "：{}", listed(ranges, points.lang));
}

// The scene's problem at the ends of all ranges.
std::vector<sim::Problem> problems_at_ends(const SweptPoints& points) {
    std::vector<sim::Problem> out;
    const auto add = [&](const std::string& key, double value) {
        set_number(out.emplace_back(points.scene.problem), key, value);
    };
    for (const output::SweepAxis& axis : points.data.axes)
        for (const double value : {std::ranges::min(axis.values), std::ranges::max(axis.values)}) add(axis.name, value);
    if (has_random_starts(points))
        for (const RandomKey& each : random_keys(*points.scene.sweep, points.scene.problem))
            add(each.key, each.from), add(each.key, each.to);
    return out;
}

std::string starts_text(const SweptPoints& points) {
    std::string text;
    for (std::uint64_t k = 0; k < std::min<std::uint64_t>(points.seeds(), 3); ++k) {
        if (k > 0 && points.seed(k) == points.seed(k - 1)) continue;
        text += (k > 0 ? phrase(points.lang, ", ", "、") : "") + look_of(points.seed(k)).label.in(points.lang);
    }
    if (points.seeds() > 3) text += fmt::format(" ({})", points.seeds());
    return has_random_starts(points) ? text + random_text(points) : text;
}

// How many points are of each class.
std::string class_counts(const std::map<AttractorClass, std::uint64_t>& kinds, Lang lang) {
    std::vector<std::string> counts;
    for (const auto& [kind, count] : kinds)
        counts.push_back(phrase(lang, "{} {}", "{1} {0}", count, class_label(kind, lang)));
    return phrase(lang, "{}. ", "{}。", listed(counts, lang));
}

std::string sweep_caption(const SweptPoints& points) {
    std::map<AttractorClass, std::uint64_t> kinds;
    int longest = 0;  // period
    for (std::uint64_t k = 0; k < points.data.points(); ++k) {
        if (!points.data.has(k)) continue;
        const output::StoredPoint p = points.data.read(k);
        ++kinds[kind_of(p)];
        longest = std::max(longest, p.period);
    }
    const sim::Sampling& s = points.scene.sweep->sampling;
    std::string text = axes_text(points);
    text += phrase(points.lang, "samples {}; transient {}, then {} kept; starts: {}. Points: ",
                   "样本：{}；舍去 {}，保留 {}；初值：{}。点数：", sample_text(points),
                   span_text(s.transient, points.lang), span_text(s.keep, points.lang), starts_text(points));
    text += class_counts(kinds, points.lang);
    if (kinds.contains(AttractorClass::chaotic))
        text +=
            phrase(points.lang, "Samples of chaotic motions depend on their start, transient and number of periods. ",
                   "混沌处的点是其初值、过渡与周期数的统计。");
    if (!s.keep.time && longest > s.keep.turns)
        text += phrase(points.lang, "Of periods longer than the kept turns, up to {}, only a part is sampled. ",
                       "周期长于保留转数（最长 {} 转）时只取其一部分。", longest);
    return text + phrase(points.lang, "Other parameters: ", "其他参数：") +
           facts(subject_of(points.scene, points.lang), {.others = problems_at_ends(points)});
}

std::string tolerance_text(const SweptPoints& points) {
    const sim::Problem& problem = points.scene.problem;
    const bool closed =
        problem.beam.model == sim::ModelKind::rigid && problem.contact.model == sim::ContactModel::restitution;
    return phrase(points.lang, "Relative tolerance {}{}.", "相对容差 {}{}。", one_digit(problem.solver.rtol),
                  !closed ? ""
                          : phrase(points.lang, ", or rounding where the rigid beam is followed in closed form",
                                   "，刚性梁以闭式求解时为舍入误差"));
}

// ---- all samples in one plane ---------------------------------------------------------------------

constexpr std::uint32_t kValueColors[] = {0x000000, 0xD55E00, 0x0072B2, 0x009E73, 0xCC79A7, 0xE69F00};

bool has_many_values(const SweptPoints& points) {
    return points.data.axes.size() == 1 && points.axis(0).values.size() > std::size(kValueColors);
}

// A cloud for each value of one key, in the colours of a map if they are many; of two keys one cloud.
std::vector<figure::Cloud> clouds_of_values(const SweptPoints& points) {
    const output::SweepAxis& axis = points.axis(0);
    if (points.data.axes.size() > 1) return {{"", {}, {}, rgb(0x000000)}};
    std::vector<figure::Cloud> clouds;
    if (has_many_values(points)) {
        const auto [least, most] = std::ranges::minmax(axis.values);
        for (const double value : axis.values)
            clouds.push_back({.color = figure::map_color((value - least) / (most - least))});
        return clouds;
    }
    for (std::size_t i = 0; i < axis.values.size(); ++i)
        clouds.push_back({value_label(symbol_of(axis.name), axis.values[i], axis.unit), {}, {}, rgb(kValueColors[i])});
    if (clouds.size() == 1) clouds[0].label.clear();
    return clouds;
}

// A Poincaré section, or a map of each impact to the next. `x`, `y`: columns of the samples; `next`: y is that of the
// sample after.
figure::Figure sample_plane(const SweptPoints& points, const std::string& x, const std::string& y, bool next) {
    const std::size_t cx = points.column(x), cy = points.column(y), width = points.data.columns.size();
    std::vector<figure::Cloud> clouds = clouds_of_values(points);
    for (std::uint64_t k = 0; k < points.data.points(); ++k) {
        if (!points.data.has(k)) continue;
        const output::StoredPoint p = points.data.read(k);
        if (!has_section(kind_of(p))) continue;
        figure::Cloud& cloud = clouds[clouds.size() > 1 ? k / points.seeds() : 0];
        const std::size_t later = next ? width : 0;
        for (std::size_t i = 0; i + later < p.samples.size(); i += width)
            cloud.add(drawn(points, cx, p.samples[i + cx]), drawn(points, cy, p.samples[i + later + cy]));
    }
    if (all_empty(clouds))
        throw render::PictureError(
            "no point has a section to show: all rest, follow the cam, have left it or have not settled");
    const auto axis = [&](std::size_t c, const char* en, const char* zh) -> render::Axis {
        return {.label = column_label(points, c) + (next ? phrase(points.lang, en, zh) : "")};
    };
    figure::Panel panel{.x = axis(cx, ", impact $k$", "，第 $k$ 次冲击"),
                        .y = axis(cy, ", impact $k$ + 1", "，第 $k$ + 1 次冲击"),
                        .clouds = std::move(clouds),
                        .legend = figure::Legend::box,
                        .name = y};
    if (has_many_values(points)) {
        const auto [least, most] = std::ranges::minmax(points.axis(0).values);
        panel.color_bar = figure::ColorBar{.label = label_of(points.axis(0)), .from = least, .to = most};
    }
    return {.panels = {std::move(panel)}, .aspect = 0.9};
}

// ---- the figures by name --------------------------------------------------------------------------

std::optional<std::string> needs_sweep(const Scene& scene) {
    if (scene.sweep) return std::nullopt;
    return "the scene has no \"sweep\"; give it one, or use beamcam sweep --over KEY=VALUES --diagram FILE";
}
std::optional<std::string> needs_one_key(const Scene& scene) {
    if (auto why = needs_sweep(scene)) return why;
    if (scene.sweep->over.size() == 1) return std::nullopt;
    return "the sweep varies two keys; \"map\" shows it";
}
std::optional<std::string> needs_two_keys(const Scene& scene) {
    if (auto why = needs_sweep(scene)) return why;
    if (scene.sweep->over.size() == 2) return std::nullopt;
    return "the sweep varies one key; a map needs two: \"over\" has to name another, or --over a second time";
}
std::optional<std::string> needs_two_starts(const Scene& scene) {
    if (auto why = needs_two_keys(scene)) return why;
    if (std::ranges::all_of(scene.sweep->over, [](const SweptKey& o) { return o.key.starts_with("initial."); }))
        return std::nullopt;
    return "basins are over two initial values; \"map\" shows other keys";
}
std::optional<std::string> needs_impacts(const Scene& scene) {
    if (auto why = needs_sweep(scene)) return why;
    if (scene.sweep->sampling.kind == sim::SampleKind::impacts) return std::nullopt;
    return "its samples are no impacts; set sweep.sample to \"impacts\"";
}

figure::Figure draw_poincare(const SweptPoints& points, const FigureOutput&) {
    return points.of_impacts() ? sample_plane(points, "cam_phase", "v_n_before", false)
                               : sample_plane(points, "theta", "theta_dot", false);
}
figure::Figure draw_impact_map(const SweptPoints& points, const FigureOutput&) {
    return sample_plane(points, "cam_phase", "cam_phase", true);
}

}  // namespace

extern const FigureType kBifurcation{.name = "bifurcation",
                                     .title = {"Bifurcation diagram", "分岔图"},
                                     .refusal = needs_one_key,
                                     .draw = bifurcation,
                                     .keys = {"value"}};
extern const FigureType kBasins{.name = "basins",
                                .title = {"Basins of attraction", "吸引域"},
                                .refusal = needs_two_starts,
                                .draw = key_map,
                                .keys = {"value"}};
extern const FigureType kMap{.name = "map",
                             .title = {"Map of two keys", "双参数图"},
                             .refusal = needs_two_keys,
                             .draw = key_map,
                             .keys = {"value"}};
extern const FigureType kPoincare{
    .name = "poincare", .title = {"Poincaré section", "Poincaré 截面"}, .refusal = needs_sweep, .draw = draw_poincare};
extern const FigureType kImpactMap{
    .name = "impact-map", .title = {"Map of impacts", "碰撞映射"}, .refusal = needs_impacts, .draw = draw_impact_map};

FigureDrawing swept_figure(const FigureType& type, const FigureOutput& how) {
    return [&type, how](const Subject&, const Results& results) {
        if (!results.swept) throw std::logic_error("a figure of a sweep without its points");
        const SweptPoints points(*results.swept, how.lang);
        figure::Figure out = type.draw(points, how);
        out.title = phrase(how.lang, "{} over {}", "{}：{}", type.title.in(how.lang), points.axis(0).name);
        out.caption = sweep_caption(points) + (out.caption.empty() ? "" : " ") + out.caption;
        out.accuracy = tolerance_text(points);
        return out;
    };
}

std::string usual_diagram(const Scene& scene) {
    for (const FigureType& type : figure_types())
        if (type.of_sweep() && !type.refusal(scene)) return type.name;
    return kPoincare.name;
}

std::vector<std::string> diagram_values(std::string_view diagram, const Scene& scene) {
    std::vector<std::string> known;
    if (diagram != kBifurcation.name) known.assign(std::begin(kMapValues), std::end(kMapValues));
    for (const sim::SampleColumnInfo& column : sim::sample_columns())
        if (scene.sweep->sampling.kind == sim::SampleKind::impacts || !column.of_impacts)
            known.emplace_back(column.name);
    return known;
}

std::vector<std::string> diagram_names() {
    std::vector<std::string> names;
    for (const FigureType& type : figure_types())
        if (type.of_sweep()) names.emplace_back(type.name);
    return names;
}

}  // namespace beamcam::scenes
