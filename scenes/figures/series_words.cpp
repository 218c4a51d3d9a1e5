#include "scenes/figures/series_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "render/plot/channel_label.hpp"
#include "scenes/figures/recipes.hpp"

namespace beamcam::scenes {
namespace {

std::string words_of(const sim::Channel& channel, Lang lang) {
    const render::ChannelLabel& label = render::label_of(channel.kind);
    std::string text = lang == Lang::en ? label.words : label.chinese;
    if (lang == Lang::en) text.front() = static_cast<char>(std::tolower(text.front()));
    return fmt::format("{} {}", text, render::print_symbol(channel));
}

}  // namespace

std::string series_subject(const SeriesKeys& keys, Lang lang) {
    const bool en = lang == Lang::en;
    std::vector<std::string> words;
    for (const SeriesPanel& panel : keys.panels)
        for (const auto* side : {&panel.channels, &panel.right})
            for (const sim::Channel& channel : *side) words.push_back(words_of(channel, lang));
    std::string all = fmt::format("{}", fmt::join(words, en ? ", " : "，"));
    if (en) all.front() = static_cast<char>(std::toupper(all.front()));
    if (keys.against == "phase") return all + (en ? " against the phase of the cam" : "随凸轮相位的变化");
    const auto against = sim::channel_named(keys.against);
    if (!against || against->kind == sim::ChannelKind::t) return all;
    return all + filled(en ? " against {}" : "随{}的变化", words_of(*against, lang));
}

std::string impacts_words(const sim::Problem& problem, const sim::Result& result, double end, Lang lang) {
    const auto count = std::ranges::count_if(
        result.impacts, [&](const sim::Impact& i) { return i.t_start <= end && strikes(problem, i); });
    if (lang == Lang::zh) return count == 0 ? "无冲击" : fmt::format("{} 次冲击", count);
    return count == 0 ? "no impact" : fmt::format("{} impact{}", count, count == 1 ? "" : "s");
}

std::string common_facts(const std::vector<SeriesMotion>& motions, Lang lang) {
    const SeriesMotion& first = motions.front();
    const bool alike = first.problem.cam && std::ranges::all_of(motions, [&](const SeriesMotion& each) {
                           sim::Problem other = each.problem;
                           if (other.cam) other.cam->speed = first.problem.cam->speed;
                           return Studies::key(other) == Studies::key(first.problem);
                       });
    if (motions.size() == 1 || alike) return facts(first.problem, lang, {.cam_speed = motions.size() > 1});
    return filled(lang == Lang::en ? "Of {}: " : "{}：", first.label) + facts(first.problem, lang);
}

}  // namespace beamcam::scenes
