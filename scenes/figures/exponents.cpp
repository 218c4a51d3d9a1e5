#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "render/base/error.hpp"
#include "render/plot/ticks.hpp"
#include "scenes/figures/caption.hpp"
#include "scenes/figures/command_figures.hpp"
#include "scenes/figures/figure_types.hpp"

namespace beamcam::scenes {

namespace {

using render::figure::Panel;

std::string value_text(const sim::Exponents& e, std::size_t i) {
    const std::string name = fmt::format("$λ$_{{{}}}", i + 1);
    if (!std::isfinite(e.lambda[i])) return name + " = −∞";
    if (!(e.error[i] > 0)) return fmt::format("{} = {} s^{{−1}}", name, number(e.lambda[i], 4));
    const int decimals = decimals_of(e.error[i]);
    return fmt::format("{} = {} ± {} s^{{−1}}", name, render::fixed(e.lambda[i], decimals),
                       render::fixed(e.error[i], decimals));
}

// Of the exponents from `first` to before `last`.
Panel panel_of(const sim::Exponents& e, std::size_t first, std::size_t last, Lang lang) {
    Panel panel{.x = {.label = phrase(lang, "averaged over $t$ / s"), .tight = true},
                .y = {.label = "$λ$ / s^{−1}"},
                .rules = {{.at = 0}},
                .name = "exponents"};
    // The first averages, over less than a tenth of the duration, are of the start.
    const auto begin = std::ranges::lower_bound(e.time, 0.1 * e.duration) - e.time.begin();
    for (std::size_t i = first; i < last; ++i) {
        if (!std::isfinite(e.lambda[i])) continue;
        const int look = static_cast<int>(i - first);
        panel.series.push_back({.label = value_text(e, i),
                                .x = {e.time.begin() + begin, e.time.end()},
                                .y = {e.history[i].begin() + begin, e.history[i].end()},
                                .look = look});
        if (!(e.error[i] > 0)) continue;
        const double low = e.lambda[i] - e.error[i], high = e.lambda[i] + e.error[i];
        panel.bands.push_back({.x = {e.time[static_cast<std::size_t>(begin)], e.time.back()},
                               .low = {low, low},
                               .high = {high, high},
                               .look = look});
    }
    return panel;
}

}  // namespace

render::figure::Figure exponents_figure(const sim::Exponents& e, const Subject& subject) {
    const Lang lang = subject.lang;
    const std::size_t count = e.lambda.size();  // none of a rigid beam on a driven hub
    // The largest one is apart, since the others may be far below it.
    std::vector<Panel> panels{panel_of(e, 0, std::min<std::size_t>(1, count), lang), panel_of(e, 1, count, lang)};
    std::erase_if(panels, [](const Panel& panel) { return panel.series.empty(); });
    if (panels.empty())
        throw render::PictureError(
            "exponents: all are −∞, because sustained contact removes every difference; there is nothing to draw");
    const double aspect = panels.size() > 1 ? 1.2 : 0.66;
    render::figure::Figure figure{
        .name = "exponents",
        .title = fmt::format("Convergence of the Lyapunov exponents over {} s with {} impacts", number(e.duration, 4),
                             e.impacts),
        .panels = lettered(std::move(panels)),
        .stack = true,
        .share_x = true,
        .aspect = aspect};
    add_caption(figure, std::vector{subject.problem}, subject.units);
    figure.accuracy = "The bands are $λ$ ± its error, the standard error of block averages.";
    return figure;
}

}  // namespace beamcam::scenes
