#include <cmath>

#include "render/base/error.hpp"
#include "scenes/figures/caption.hpp"
#include "scenes/figures/command_figures.hpp"

namespace beamcam::scenes {

render::figure::Figure exponents_figure(const sim::Exponents& e, const sim::Problem& problem, Lang lang) {
    render::figure::Panel panel{
        .x = {.label = phrase(lang, "averaged over $t$ / s", "平均时间 $t$ / s"), .tight = true},
        .y = {.label = "$λ$ / s^{−1}"},
        .rules = {{.at = 0}},
        .name = "exponents"};
    std::string values;
    for (std::size_t i = 0; i < e.lambda.size(); ++i) {
        const std::string name = fmt::format("$λ$_{{{}}}", i + 1), separator = i > 0 ? ", " : "";
        if (!std::isfinite(e.lambda[i])) {
            values += separator + name + " = −∞";
            continue;
        }
        panel.series.push_back({.label = name, .x = e.time, .y = e.history[i], .look = static_cast<int>(i)});
        values +=
            fmt::format("{}{} = {} ± {} s^{{−1}}", separator, name, number(e.lambda[i], 4), number(e.error[i], 1));
    }
    if (panel.series.empty())
        throw render::PictureError("exponents: all are −∞, because the contact lasts; there is nothing to draw");
    return {.name = "exponents",
            .title = phrase(lang, "Lyapunov exponents", "Lyapunov 指数"),
            .panels = {std::move(panel)},
            .caption = phrase(lang,
                              "Convergence of the Lyapunov exponents after a transient of {} s, over {} s with {} "
                              "impacts ({} near grazing): {}. {}",
                              "经 {} s 暂态后，{} s 内（{} 次碰撞，其中 {} 次近擦边）Lyapunov 指数的收敛：{}。{}",
                              number(e.transient, 4), number(e.duration, 4), e.impacts, e.near_grazing, values,
                              facts(problem, lang)),
            .accuracy = phrase(lang, "Errors are standard errors of block averages.", "误差为分块平均的标准误差。")};
}

}  // namespace beamcam::scenes
