#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "render/plot/channel_label.hpp"
#include "scenes/figures/figure_types.hpp"
#include "scenes/figures/series.hpp"
#include "scenes/figures/series_data.hpp"
#include "scenes/motions/identity.hpp"

namespace beamcam::scenes {
namespace {

std::string channel_text(const sim::Channel& channel, Lang lang) {
    const sim::ChannelLabel& label = sim::row(channel.kind).label;
    std::string text = phrase(lang, label.words, label.chinese);
    if (lang == Lang::en) text.front() = static_cast<char>(std::tolower(text.front()));
    return fmt::format("{} {}", text, render::print_symbol(channel));
}

// "12 impacts", "no impact" until `end` [s].
std::string impacts_text(const sim::Problem& problem, const sim::Result& result, double end, Lang lang) {
    const std::size_t count = strikes(problem, result.impacts, 0, end).size();
    if (count == 0) return phrase(lang, "no impact", "无冲击");
    return phrase(lang, count == 1 ? "{} impact" : "{} impacts", "{} 次冲击", count);
}

// The facts of all motions where they differ by the cam's speed alone, else those of the first.
std::string common_facts(const std::vector<SeriesMotion>& motions, const render::Units& units, Lang lang) {
    const SeriesMotion& first = motions.front();
    const bool alike =
        motions.size() == 1 || (first.problem.cam && std::ranges::all_of(motions, [&](const SeriesMotion& each) {
                                    sim::Problem other = each.problem;
                                    if (other.cam) other.cam->speed = first.problem.cam->speed;
                                    return motion_key(other) == motion_key(first.problem);
                                }));
    if (!alike) return phrase(lang, "Of {}: ", "{}：", first.label) + facts({first.problem, units, lang});
    Varied varied;
    for (const SeriesMotion& motion : motions) varied.others.push_back(motion.problem);
    return facts({first.problem, units, lang}, varied);
}

// The first panel, "(c)", of a motion with separate panels. A panel of differences follows those of the motion with
// data.
std::string first_panel(const SeriesPlan& plan, std::size_t motion, const Figure& figure) {
    const std::size_t differences = figure.panels.size() - plan.panels.size(),
                      first = motion * plan.keys.panels.size() + (motion > plan.measured_motion ? differences : 0);
    return fmt::format("({})", panel_letter(first));
}

// The name of a motion among several.
std::string motion_name(const SeriesPlan& plan, std::size_t motion, const Figure& figure) {
    return plan.keys.apart ? first_panel(plan, motion, figure) : plan.motions[motion].label;
}

// ": (a) ω = 0, no impact; (b) …"; empty: the only motion has no name.
std::string motions_text(const SeriesPlan& plan, const Figure& figure, const Results& results) {
    std::vector<std::string> labels;
    for (std::size_t k = 0; k < plan.motions.size(); ++k) {
        const SeriesMotion& motion = plan.motions[k];
        if (plan.keys.apart)
            labels.push_back(phrase(plan.lang, "{} {}, {}", "{} {}，{}", first_panel(plan, k, figure), motion.label,
                                    impacts_text(motion.problem, *results[motion.study], plan.end, plan.lang)));
        else if (!motion.label.empty())
            labels.push_back(motion.label);
    }
    return labels.empty() ? "" : phrase(plan.lang, ": {}", "：{}", fmt::join(labels, phrase(plan.lang, "; ", "；")));
}

std::string dashed_lines_text(const SeriesPlan& plan, const Figure& figure, const Results& results) {
    if (!plan.keys.impacts || figure.panels.front().rules.empty()) return "";
    const SeriesMotion& first = plan.motions.front();  // whose impacts are marked in panels of several motions
    const bool collisions = marks_collisions(*results[first.study], plan.keys.from, plan.end);
    const std::string of =
        plan.keys.apart || plan.motions.size() == 1 ? "" : phrase(plan.lang, " of {}", "（{}）", first.label);
    return phrase(plan.lang, "Dashed lines: starts of {}{}. ", "虚线：{}{}开始。",
                  collisions ? phrase(plan.lang, "collisions", "碰撞") : phrase(plan.lang, "impacts", "冲击"), of);
}

// Names data that hold channels of the panels but not the quantity of the x axis.
std::string undrawn_text(const SeriesPlan& plan) {
    std::string text;
    for (const Measured& each : plan.measured)
        if (!plan.abscissa.of(each.data, plan.motion_with_data().problem))
            text += phrase(plan.lang, "Data “{}” do not hold {} and are not drawn. ", "{}：不含 {}，未绘出。",
                           each.data.label, render::print_symbol(*plan.abscissa.channel()));
    return text;
}

// Where the curves are reproducible, and how the data compare with them.
std::string trust_text(const SeriesPlan& plan, const Figure& figure, const Results& results) {
    const double from = plan.keys.from;
    if (!plan.horizon) return undrawn_text(plan);
    if (plan.abscissa.is_frequency())
        return spectrum_text(plan.motions.front().problem, from, plan.end, plan.lang) +
               measured_spectrum_text(plan.measured, plan.lang);
    std::vector<std::pair<std::string, const sim::Result*>> runs;
    for (std::size_t k = 0; k < plan.motions.size(); ++k)
        runs.emplace_back(motion_name(plan, k, figure), results[plan.motions[k].study]);
    const SeriesMotion& motion = plan.motion_with_data();
    return horizon_text(runs, from, plan.end, plan.lang) + undrawn_text(plan) +
           agreement_text(plan.measured, *results[motion.study], {motion.problem, plan.units, plan.lang});
}

std::string omitted_text(const Figure& figure, Lang lang) {
    const auto omits = [](const Panel& panel) {
        return std::ranges::any_of(panel.series, [&](const Series& curve) {
            const render::Scale scale = curve.right && panel.right ? panel.right->scale : panel.y.scale;
            return scale == render::Scale::logarithmic &&
                   std::ranges::any_of(curve.y, [](double value) { return value <= 0; });
        });
    };
    if (std::ranges::none_of(figure.panels, omits)) return {};
    return phrase(lang, "Logarithmic axes omit values that are not positive. ", "对数轴略去非正值。");
}

}  // namespace

std::string series_subject(const SeriesKeys& keys, Lang lang) {
    std::vector<std::string> words;
    for (const SeriesPanel& panel : keys.panels) {
        for (const SeriesSum& sum : panel.sums) words.push_back(sum.label);
        for (const auto* side : {&panel.channels, &panel.right}) {
            if (side == &panel.channels && !panel.sums.empty()) continue;
            for (const sim::Channel& channel : *side) words.push_back(channel_text(channel, lang));
        }
    }
    std::string all = listed(words, lang);
    if (lang == Lang::en) all.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(all.front())));
    if (keys.against == "phase") return all + phrase(lang, " against the phase of the cam", "随凸轮相位的变化");
    const auto against = sim::channel_named(keys.against);
    if (!against || against->kind == sim::ChannelKind::t) return all;
    return all + phrase(lang, " against {}", "随{}的变化", channel_text(*against, lang));
}

std::string series_caption(const SeriesPlan& plan, const std::string& subject, const Figure& figure,
                           const Results& results) {
    return fmt::format("{}{}{}", subject, motions_text(plan, figure, results), phrase(plan.lang, ". ", "。")) +
           omitted_text(figure, plan.lang) + dashed_lines_text(plan, figure, results) +
           trust_text(plan, figure, results) + common_facts(plan.motions, plan.units, plan.lang);
}

}  // namespace beamcam::scenes
