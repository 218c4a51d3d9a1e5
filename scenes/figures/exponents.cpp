#include "scenes/figures/exponents.hpp"

#include <cmath>

#include "render/base/error.hpp"

namespace beamcam::scenes {

render::figure::Figure exponents_figure(const sim::Exponents& e, const sim::Problem& problem, Lang lang) {
    using render::figure::Figure, render::figure::Panel, render::figure::Series;
    const bool en = lang == Lang::en;
    Panel panel;
    panel.name = "exponents";
    panel.x = {.label = en ? "averaged over $t$ / s" : "平均时间 $t$ / s", .tight = true};
    panel.y = {.label = en ? "$λ$ / s^{−1}" : "$λ$ / s^{−1}"};
    panel.rules.push_back({.at = 0});
    std::string values;
    for (std::size_t i = 0; i < e.lambda.size(); ++i) {
        const std::string name = filled("$λ$_{{{}}}", i + 1);
        if (!std::isfinite(e.lambda[i])) {
            values += filled("{}{} = −∞", i > 0 ? ", " : "", name);
            continue;
        }
        Series curve;
        curve.label = name;
        curve.look = static_cast<int>(i);
        for (std::size_t k = 0; k < e.time.size(); ++k) {
            curve.x.push_back(e.time[k]);
            curve.y.push_back(e.history[i][k]);
        }
        panel.series.push_back(std::move(curve));
        values +=
            filled("{}{} = {} ± {} s^{{−1}}", i > 0 ? ", " : "", name, number(e.lambda[i], 4), number(e.error[i], 1));
    }
    if (panel.series.empty())
        throw render::PictureError("exponents: all are −∞, because the contact lasts; there is nothing to draw");
    Figure figure;
    figure.name = "exponents";
    figure.title = en ? "Lyapunov exponents" : "Lyapunov 指数";
    figure.panels.push_back(std::move(panel));
    figure.caption =
        filled(en ? "Convergence of the Lyapunov exponents after a transient of {} s, over {} s with {} "
                    "impacts ({} near grazing): {}. {}"
                  : "经 {} s 暂态后，{} s 内（{} 次碰撞，其中 {} 次近擦边）Lyapunov 指数的收敛：{}。{}",
               number(e.transient, 4), number(e.duration, 4), e.impacts, e.near_grazing, values, facts(problem, lang));
    figure.accuracy = en ? "Errors are standard errors of block averages." : "误差为分块平均的标准误差。";
    return figure;
}

}  // namespace beamcam::scenes
