#include "scenes/figures/series.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>

#include "render/plot/channel_label.hpp"
#include "scenes/figures/series_panels.hpp"
#include "scenes/figures/series_plan.hpp"
#include "scenes/figures/series_words.hpp"

namespace beamcam::scenes {
namespace {

using render::figure::Figure;
using render::figure::Panel;
using render::figure::Series;

// Panels of several motions have one scale, so that heights compare.
void share_ordinates(Figure& figure) {
    const double infinity = std::numeric_limits<double>::infinity();
    std::map<std::string, std::pair<double, double>> ranges;  // by what the panels show
    for (const Panel& panel : figure.panels) {
        auto& [low, high] = ranges.try_emplace(panel.name, infinity, -infinity).first->second;
        for (const Series& curve : panel.series)
            for (const double y : curve.y)
                if (std::isfinite(y) && !curve.right) low = std::min(low, y), high = std::max(high, y);
    }
    for (Panel& panel : figure.panels) {
        const auto& [low, high] = ranges[panel.name];
        const double air = 0.05 * (high - low);
        if (!(high > low) || panel.y.scale == render::Scale::logarithmic) continue;
        panel.y.from = panel.y.from.value_or(low - air), panel.y.to = panel.y.to.value_or(high + air);
    }
}

std::string usual_title(const SeriesPlan& plan) {
    const render::ChannelLabel& first = render::label_of(plan.keys.panels.front().channels.front().kind);
    return plan.lang == Lang::en ? first.words : first.chinese;
}

Figure series_figure(const SeriesPlan& plan, const SeriesWords& words, const Results& results) {
    Figure figure;
    figure.name = words.name;
    for (const PlannedPanel& planned : plan.panels)
        std::ranges::move(series_panels(plan, planned, results, words.weight), std::back_inserter(figure.panels));
    if (figure.panels.size() > 1)
        for (std::size_t k = 0; k < figure.panels.size(); ++k) figure.panels[k].letter = panel_letter(k);
    plan.abscissa.share(figure, plan.motions.front().problem);
    if (plan.keys.apart) share_ordinates(figure);
    figure.stack = figure.share_x = true;
    figure.aspect = words.aspect > 0 ? words.aspect : 0.2 + 0.36 * static_cast<double>(figure.panels.size());
    figure.title = words.title.empty() ? usual_title(plan) : words.title;
    const std::string subject = words.caption_of        ? words.caption_of(figure, plan.lang)
                                : words.caption.empty() ? series_subject(plan.keys, plan.lang)
                                                        : words.caption;
    figure.caption = series_caption(plan, subject, figure, results);
    std::vector<std::pair<const sim::Problem*, const sim::Result*>> runs;
    for (const SeriesMotion& motion : plan.motions) runs.emplace_back(&motion.problem, results[motion.study]);
    figure.accuracy = accuracy(runs, plan.lang);
    return figure;
}

}  // namespace

FigureMaker prepare_series(const Scene& scene, const SeriesKeys& keys, const SeriesWords& words, Lang lang,
                           Studies& studies) {
    SeriesPlan plan{keys, lang, keys.to.value_or(scene.end_time), SeriesAbscissa(keys, lang)};
    plan.sums = words.sums, plan.horizon = words.horizon;
    complete(plan, scene, words.name, studies);
    return [plan, words](const Results& results) { return series_figure(plan, words, results); };
}

}  // namespace beamcam::scenes
