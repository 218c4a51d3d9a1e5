// Any channels against the time, the turns of the cam or another channel; of one motion or of several.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "render/plot/channel_label.hpp"
#include "render/plot/ticks.hpp"
#include "scenes/figures/key_label.hpp"
#include "scenes/figures/recipes.hpp"
#include "scenes/figures/reproducible.hpp"

namespace beamcam::scenes {
namespace {

using render::figure::Axis;
using render::figure::Figure;
using render::figure::Legend;
using render::figure::Panel;
using render::figure::Series;
using sim::Channel;
using sim::ChannelKind;

constexpr int kRows = 2001;             // to begin with; more where a curve bends
constexpr std::size_t kMostRules = 60;  // more lines than these hide the curves

// A quantity along an axis: its unit, with the prefix that suits its values.
struct Measure {
    double factor = 1;
    std::string unit;  // may be empty
};

Measure measure_of(const std::string& unit, double largest) {
    const bool prefixed = unit == "m" || unit == "N" || unit == "J" || unit == "s";
    const render::Prefix prefix = render::prefix_for(prefixed && largest > 0 && std::isfinite(largest) ? largest : 1);
    return {1 / prefix.factor, prefix.symbol + unit};
}

// Only differences of potential energy mean anything: its least value is the zero.
std::vector<double> above_zero(std::vector<double> values, Channel channel) {
    if (channel.kind != ChannelKind::energy_potential || values.empty()) return values;
    const double least = *std::ranges::min_element(values);
    for (double& v : values) v -= least;
    return values;
}

bool has_values(const sim::Table* table) {
    return std::ranges::any_of(table->values.back(), [](double v) { return std::isfinite(v); });
}

double largest(const std::vector<double>& values) {
    double out = 0;
    for (const double v : values)
        if (std::isfinite(v)) out = std::max(out, std::abs(v));
    return out;
}

struct Motion {
    std::string label;
    sim::Problem problem;
    std::size_t study = 0;
};

class SeriesFigure {
  public:
    SeriesFigure(const Scene& scene, const FigureOutput& how, Studies& studies)
        : keys_(how.series), lang_(how.lang), end_(keys_.to.value_or(scene.end_time)) {
        if (keys_.compare.empty()) motions_.push_back({"", scene.problem, 0});
        for (const Compared& each : keys_.compare) motions_.push_back({each.label, each.problem, 0});
        if (const auto channel = sim::channel_named(keys_.against); channel && channel->kind != ChannelKind::t)
            abscissa_ = *channel;
        for (Motion& motion : motions_) {
            motion.study = studies.of(motion.problem, end_, "series");
            studies.horizon(motion.study);
        }
        for (const SeriesPanel& panel : keys_.panels)
            for (const auto* side : {&panel.channels, &panel.right})
                for (const Channel& channel : *side)
                    for (const Motion& motion : motions_)
                        tables_.push_back(studies.curve(motion.study, {keys_.from, end_, kRows},
                                                        abscissa_.value_or(Channel{}), channel));
    }

    Figure operator()(const Results& results) const {
        Figure figure;
        figure.name = "series";
        std::size_t table = 0;
        std::vector<std::string> words;
        for (std::size_t k = 0; k < keys_.panels.size(); ++k) {
            figure.panels.push_back(panel(keys_.panels[k], results, table));
            if (keys_.panels.size() > 1) figure.panels.back().letter = std::string(1, static_cast<char>('a' + k));
            for (const auto* side : {&keys_.panels[k].channels, &keys_.panels[k].right})
                for (const Channel& channel : *side) words.push_back(words_of(channel));
        }
        share_abscissa(figure);
        figure.stack = figure.share_x = true;
        figure.aspect = 0.2 + 0.36 * static_cast<double>(keys_.panels.size());
        if (keys_.height) figure.height = *keys_.height * 1e3;
        figure.title = render::label_of(keys_.panels.front().channels.front().kind).words;
        write_caption(figure, words, results);
        return figure;
    }

  private:
    bool en() const { return lang_ == Lang::en; }

    std::string words_of(const Channel& channel) const {
        const render::ChannelLabel& label = render::label_of(channel.kind);
        std::string text = en() ? label.words : label.chinese;
        if (en()) text.front() = static_cast<char>(std::tolower(text.front()));
        return fmt::format("{} {}", text, render::print_symbol(channel));
    }

    // Of each point of a curve, in SI units or turns.
    std::vector<double> abscissa(const sim::Table& table, const sim::Problem& problem) const {
        if (abscissa_) return table.values[1];
        std::vector<double> x = table.values[0];
        const double speed = problem.cam ? std::abs(problem.cam->speed) : 0;
        if (keys_.against == "turns")
            for (double& v : x) v *= speed / (2 * std::numbers::pi);
        return x;
    }

    // One side of a panel. `look` counts the curves of both.
    void add_side(const std::vector<Channel>& channels, bool right, Axis& axis, int& look, std::size_t& table,
                  const Results& results, Panel& out) const {
        double most = 0;
        std::vector<const sim::Table*> all;
        for (std::size_t i = 0; i < channels.size() * motions_.size(); ++i) {
            const Motion& motion = motions_[i % motions_.size()];
            all.push_back(&results[motion.study]->tables[tables_[table++]]);
            most = std::max(most, largest(above_zero(all.back()->values.back(), channels[i / motions_.size()])));
        }
        if (!(most > 0) && std::ranges::none_of(all, has_values))
            throw render::PictureError(
                fmt::format("series: {} has no value from {:g} s to {:g} s", name(channels.front()), keys_.from, end_));
        const Measure measure = measure_of(unit(channels.front(), motions_.front().problem), most);
        std::vector<std::string> symbols;
        for (const Channel& channel : channels) symbols.push_back(render::print_symbol(channel));
        axis.label = axis_label(fmt::format("{}", fmt::join(symbols, ", ")), measure.unit);
        for (std::size_t i = 0; i < all.size(); ++i) {
            const Motion& motion = motions_[i % motions_.size()];
            const std::string& symbol = symbols[i / motions_.size()];
            Series whole;
            whole.x = abscissa(*all[i], motion.problem);
            whole.y = scaled(above_zero(all[i]->values.back(), channels[i / motions_.size()]), measure.factor);
            whole.right = right;
            whole.look = look++;
            whole.weight = 0.9;
            const bool is_one_symbol = channels.size() == 1 && !out.right;
            whole.label = motions_.size() == 1 ? symbol
                          : is_one_symbol      ? motion.label
                                               : fmt::format("{}, {}", motion.label, symbol);
            auto [sure, unsure] = split(whole, all[i]->values[0], unreliable(*results[motion.study], end_));
            unsure.faded = true;
            if (!sure.x.empty()) unsure.label.clear();
            if (!unsure.x.empty()) out.series.push_back(std::move(unsure));
            if (!sure.x.empty()) out.series.push_back(std::move(sure));
        }
        if (!right) {
            axis.scale = out.y.scale;
            for (auto* limit : {&axis.from, &axis.to})
                if (*limit) **limit *= measure.factor;
        }
    }

    Panel panel(const SeriesPanel& keys, const Results& results, std::size_t& table) const {
        Panel out;
        out.title = keys.title;
        out.name = name(keys.channels.front());
        if (keys.logarithmic) out.y.scale = render::figure::Scale::logarithmic;
        out.y.from = keys.low, out.y.to = keys.high;
        int look = 0;
        if (!keys.right.empty()) out.right.emplace();
        add_side(keys.channels, false, out.y, look, table, results, out);
        if (out.right) add_side(keys.right, true, *out.right, look, table, results, out);
        out.legend = look > 1 ? Legend::direct : Legend::none;
        if (keys_.impacts && !abscissa_) add_impacts(results, out);
        return out;
    }

    // Of impacts or, where they are too many to be told apart, of collisions.
    template <class Touch>
    std::vector<double> begins(const std::vector<Touch>& touches) const {
        std::vector<double> out;
        for (const Touch& touch : touches)
            if (touch.t_start >= keys_.from && touch.t_start <= end_) out.push_back(touch.t_start);
        return out;
    }
    bool marks_collisions(const sim::Result& result) const { return begins(result.impacts).size() > kMostRules; }

    void add_impacts(const Results& results, Panel& out) const {
        const Motion& first = motions_.front();
        const sim::Result& result = *results[first.study];
        sim::Table table;
        table.values = {marks_collisions(result) ? begins(result.collisions) : begins(result.impacts)};
        if (table.rows() > kMostRules) return;
        for (const double at : abscissa(table, first.problem)) out.rules.push_back({.at = at, .vertical = true});
    }

    // All panels have one axis along x.
    void share_abscissa(Figure& figure) const {
        double most = 0, low = std::numeric_limits<double>::infinity(), high = -low;
        for (const Panel& each : figure.panels)
            for (const Series& curve : each.series)
                for (const double x : curve.x)
                    if (std::isfinite(x))
                        most = std::max(most, std::abs(x)), low = std::min(low, x), high = std::max(high, x);
        // A logarithmic panel leaves out what is not positive; its axis stays that of the others.
        const double air = abscissa_ ? 0.03 * (high - low) : 0;
        const Channel channel = abscissa_.value_or(Channel{});
        Measure measure = measure_of(unit(channel, motions_.front().problem), most);
        std::string symbol = render::print_symbol(channel);
        if (keys_.against == "turns") measure = {1, ""}, symbol = en() ? "turns of the cam" : "凸轮转数";
        for (Panel& each : figure.panels) {
            each.x.label = axis_label(symbol, measure.unit);
            if (high > low) each.x.from = (low - air) * measure.factor, each.x.to = (high + air) * measure.factor;
            for (Series& curve : each.series) curve.x = scaled(std::move(curve.x), measure.factor);
            for (auto& rule : each.rules) rule.at *= measure.factor;
        }
    }

    void write_caption(Figure& figure, const std::vector<std::string>& words, const Results& results) const {
        std::string all = fmt::format("{}", fmt::join(words, en() ? ", " : "，"));
        if (en()) all.front() = static_cast<char>(std::toupper(all.front()));
        const std::string over = abscissa_ ? filled(en() ? " against {}" : "随{}的变化", words_of(*abscissa_)) : "";
        std::vector<std::string> labels;
        std::vector<const sim::Result*> runs;
        std::vector<std::pair<const sim::Problem*, const sim::Result*>> pairs;
        for (const Motion& motion : motions_) {
            if (!motion.label.empty()) labels.push_back(motion.label);
            runs.push_back(results[motion.study]);
            pairs.emplace_back(&motion.problem, runs.back());
        }
        const std::string of =
            labels.empty() ? "" : filled(en() ? ": {}" : "：{}", fmt::join(labels, en() ? "; " : "；"));
        figure.caption = fmt::format("{}{}{}{}", all, over, of, en() ? ". " : "。");
        if (!figure.panels.front().rules.empty())
            figure.caption += marks_collisions(*runs.front())
                                  ? (en() ? "Dashed lines: series of impacts begin. " : "虚线：冲击序列开始。")
                                  : (en() ? "Dashed lines: impacts begin. " : "虚线：冲击开始。");
        figure.caption += runs.size() == 1 ? horizon_words(runs, end_, lang_) : "";
        if (!labels.empty()) figure.caption += filled(en() ? "Of {}: " : "{}：", labels.front());
        figure.caption += facts(motions_.front().problem, lang_);
        figure.accuracy = accuracy(pairs, lang_);
    }

    SeriesKeys keys_;
    Lang lang_;
    double end_;  // [s]
    std::vector<Motion> motions_;
    std::optional<Channel> abscissa_;  // absent: time or turns
    std::vector<std::size_t> tables_;  // of each panel, side, channel and motion, in this order
};

FigureMaker prepare_series(const Scene& scene, const FigureOutput& how, Studies& studies) {
    FigureOutput wanted = how;
    if (wanted.series.panels.empty()) wanted.series.panels = {{.channels = {{ChannelKind::theta, 0}}}};
    return SeriesFigure(scene, wanted, studies);
}

}  // namespace

const Recipe kSeries{"series", {"Any channels, of one motion or of several", "任意通道"}, no_refusal, prepare_series};

}  // namespace beamcam::scenes
