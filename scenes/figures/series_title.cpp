// The title of a series.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cctype>

#include "render/plot/channel_label.hpp"
#include "scenes/figures/series.hpp"

namespace beamcam::scenes {
namespace {

std::string channel_text(const sim::Channel& channel) {
    std::string text = sim::row(channel.kind).label.words;
    text.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(text.front())));
    return fmt::format("{} {}", text, render::print_symbol(channel));
}

}  // namespace

std::string panel_subject(const SeriesPanel& panel) {
    std::vector<std::string> words;
    for (const SeriesSum& sum : panel.sums) words.push_back(sum.label);
    if (panel.sums.empty())
        for (const sim::Channel& channel : panel.channels) words.push_back(channel_text(channel));
    return fmt::format("{}", fmt::join(words, ", "));
}

std::string series_title(const SeriesKeys& keys) {
    std::string all = keys.panels.size() == 1 && !keys.residuals ? panel_subject(keys.panels.front()) : "motion";
    all.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(all.front())));
    if (keys.against == "phase") return all + " against the phase of the cam";
    const auto against = sim::channel_named(keys.against);
    if (!against || against->kind == sim::ChannelKind::t) return all;
    return fmt::format("{} against {}", all, channel_text(*against));
}

}  // namespace beamcam::scenes
