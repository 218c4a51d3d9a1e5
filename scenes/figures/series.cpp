#include "scenes/figures/series.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>

#include "render/plot/channel_label.hpp"
#include "scenes/figures/key_label.hpp"
#include "scenes/figures/measured.hpp"
#include "scenes/figures/reproducible.hpp"
#include "scenes/figures/series_curves.hpp"
#include "scenes/figures/series_rules.hpp"
#include "scenes/figures/series_spectrum.hpp"
#include "scenes/figures/series_words.hpp"

namespace beamcam::scenes {
namespace {

using render::figure::Axis;
using render::figure::Figure;
using render::figure::Legend;
using render::figure::Panel;
using render::figure::Series;
using sim::Channel;
using sim::ChannelKind;

constexpr int kRows = 2001;  // to begin with; more where a curve bends

std::string letter(std::size_t k) { return {static_cast<char>('a' + k)}; }

// Of measured data from the curves of a channel; its unit has a prefix of its own.
void finish_differences(Channel channel, const sim::Problem& problem, Panel& differences) {
    double most = 0;
    for (const Series& each : differences.series) most = std::max(most, largest(each.y));
    const Measure measure = measure_of(unit(channel, problem), most);
    for (Series& each : differences.series) each.y = scaled(std::move(each.y), measure.factor), each.label.clear();
    differences.y.label = axis_label("Δ" + render::print_symbol(channel), measure.unit);
    differences.name = name(channel) + " difference";
    differences.rules.push_back({.at = 0});
    differences.share = 0.6;
    differences.legend = Legend::none;
}

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
        if (!(high > low) || panel.y.scale == render::figure::Scale::logarithmic) continue;
        panel.y.from = panel.y.from.value_or(low - air), panel.y.to = panel.y.to.value_or(high + air);
    }
}

class SeriesFigure {
  public:
    SeriesFigure(const Scene& scene, SeriesKeys keys, SeriesWords words, Lang lang, Studies& studies)
        : keys_(std::move(keys)), words_(std::move(words)), lang_(lang), end_(keys_.to.value_or(scene.end_time)) {
        if (keys_.compare.empty()) motions_.push_back({"", scene.problem, 0});
        for (const Compared& each : keys_.compare) motions_.push_back({each.label, each.problem, 0});
        if (const auto channel = sim::channel_named(keys_.against); channel && channel->kind != ChannelKind::t)
            abscissa_ = *channel;
        if (is_phase()) abscissa_ = Channel{ChannelKind::cam_angle, 0};
        for (SeriesMotion& motion : motions_) {
            motion.study = studies.of(motion.problem, end_, words_.name);
            studies.horizon(motion.study);
            if (std::ranges::any_of(keys_.notes, [](const auto& n) { return n.at.kind == Instant::Kind::apex; }))
                studies.turning_points(motion.study);
        }
        // Data are of the scene's own motion; where that is not among those shown, they are held against the first.
        for (std::size_t k = motions_.size(); k-- > 0;)
            if (Studies::key(motions_[k].problem) == Studies::key(scene.problem)) measured_motion_ = k;
        std::vector<Channel> all;
        for (const SeriesPanel& panel : keys_.panels) {
            all.insert(all.end(), panel.channels.begin(), panel.channels.end());
            all.insert(all.end(), panel.right.begin(), panel.right.end());
        }
        if (abscissa_) all.push_back(*abscissa_);
        measured_ = measured(scene, all, keys_.from, end_, motions_[measured_motion_].study, studies);
        each_panel([&](const SeriesPanel& panel, const std::vector<std::size_t>& shown) {
            for (const auto* side : {&panel.channels, &panel.right})
                for (const Channel& channel : *side)
                    for (const std::size_t motion : shown) tables_.push_back(table_of(channel, motion, studies));
        });
    }

    Figure operator()(const Results& results) const {
        Figure figure;
        figure.name = words_.name;
        std::size_t table = 0;
        each_panel([&](const SeriesPanel& keys, const std::vector<std::size_t>& shown) {
            Panel differences;
            figure.panels.push_back(panel(keys, shown, results, table, differences));
            if (!differences.series.empty()) figure.panels.push_back(std::move(differences));
        });
        if (figure.panels.size() > 1)
            for (std::size_t k = 0; k < figure.panels.size(); ++k) figure.panels[k].letter = letter(k);
        share_abscissa(figure);
        if (keys_.apart) share_ordinates(figure);
        figure.stack = figure.share_x = true;
        figure.aspect = words_.aspect > 0 ? words_.aspect : 0.2 + 0.36 * static_cast<double>(figure.panels.size());
        const render::ChannelLabel& first = render::label_of(keys_.panels.front().channels.front().kind);
        figure.title = !words_.title.empty() ? words_.title : en() ? first.words : first.chinese;
        write_caption(figure, results);
        return figure;
    }

  private:
    bool en() const { return lang_ == Lang::en; }

    // Panels in their order, each with the motions that it shows.
    template <class Visit>
    void each_panel(Visit&& visit) const {
        std::vector<std::size_t> all(motions_.size());
        std::iota(all.begin(), all.end(), std::size_t{0});
        const std::size_t groups = keys_.apart ? all.size() : 1;
        for (std::size_t k = 0; k < groups; ++k)
            for (const SeriesPanel& panel : keys_.panels) visit(panel, keys_.apart ? std::vector<std::size_t>{k} : all);
    }

    // Where curves are lighter; a spectrum is of all of a stretch.
    std::vector<Lost> lost(const sim::Result& result) const {
        return keys_.against == "frequency" ? std::vector<Lost>{} : unreliable(result, end_);
    }
    bool is_phase() const { return keys_.against == "phase"; }
    bool over_time() const { return keys_.against == "t" || keys_.against == "turns"; }

    std::size_t table_of(Channel channel, std::size_t motion, Studies& studies) const {
        const SeriesMotion& of = motions_[motion];
        if (keys_.against != "frequency")
            return studies.curve(of.study, {keys_.from, end_, kRows}, abscissa_.value_or(Channel{}), channel);
        std::vector<sim::TableRequest>& tables = studies.request(of.study).tables;
        tables.push_back({spectrum_instants(of.problem, keys_.from, end_), {Channel{}, channel}});
        return tables.size() - 1;
    }
    // Of a motion, or its amplitudes by frequency.
    sim::Table curve(const Results& results, std::size_t motion, std::size_t table) const {
        const sim::Table& rows = results[motions_[motion].study]->tables[tables_[table]];
        return keys_.against == "frequency" ? spectrum_table(rows, keys_.x_high) : rows;
    }

    // Of each point of a curve, in SI units or turns.
    std::vector<double> abscissa(const sim::Table& table, const sim::Problem& problem) const {
        if (abscissa_) return table.values[1];
        return scaled(table.values[0], per_second(problem));
    }
    double per_second(const sim::Problem& problem) const {
        if (keys_.against != "turns") return 1;
        return problem.cam ? std::abs(problem.cam->speed) / (2 * std::numbers::pi) : 0;
    }

    // Of the same panel of every motion: all have one unit. `table`: the first of one of them.
    double most_of_all(const std::vector<Channel>& channels, std::size_t table, const Results& results) const {
        const std::size_t each = tables_.size() / motions_.size();
        double most = 0;
        for (std::size_t motion = 0; motion < motions_.size(); ++motion)
            for (std::size_t k = 0; k < channels.size(); ++k) {
                const sim::Table rows = curve(results, motion, motion * each + table % each + k);
                most = std::max(most, largest(above_zero(rows.values.back(), channels[k])));
            }
        return most;
    }

    // One side of a panel: its channels, their curves of all motions in turn, and how they are written.
    struct Side {
        const std::vector<Channel>& channels;
        const std::vector<std::size_t>& shown;
        bool right, alone;  // alone: the panel has one channel
        std::vector<sim::Table> curves = {};
        Measure measure = {};
        std::vector<std::string> symbols = {};  // of the channels
    };
    Side side(const SeriesPanel& keys, const std::vector<std::size_t>& shown, bool right, std::size_t& table,
              const Results& results) const {
        Side out{right ? keys.right : keys.channels, shown, right, keys.channels.size() == 1 && keys.right.empty()};
        const std::vector<Channel>& channels = out.channels;
        double most = keys_.apart ? most_of_all(channels, table, results) : 0;
        for (std::size_t i = 0; i < channels.size() * shown.size(); ++i) {
            sim::Table& rows = out.curves.emplace_back(curve(results, shown[i % shown.size()], table++));
            rows.values.back() = above_zero(rows.values.back(), channels[i / shown.size()]);
            most = std::max(most, largest(rows.values.back()));
        }
        if (!(most > 0) && std::ranges::none_of(out.curves, has_values))
            throw render::PictureError(
                fmt::format("series: {} has no value from {:g} s to {:g} s", name(channels.front()), keys_.from, end_));
        out.measure = measure_of(unit(channels.front(), motions_.front().problem), most);
        for (const Channel& channel : channels)
            out.symbols.push_back(filled(keys_.against == "frequency" ? "|{}|" : "{}", render::print_symbol(channel)));
        return out;
    }

    // The curve `i` of a side, paler where θ is not reproducible.
    void add_curve(const Side& side, std::size_t i, int look, const Results& results, Panel& out) const {
        const SeriesMotion& motion = motions_[side.shown[i % side.shown.size()]];
        const std::string& symbol = side.symbols[i / side.shown.size()];
        const sim::Table& rows = side.curves[i];
        Series whole;
        whole.x = abscissa(rows, motion.problem);
        whole.y = scaled(rows.values.back(), side.measure.factor);
        whole.right = side.right;
        whole.look = look;
        whole.weight = words_.weight;
        whole.label = side.shown.size() == 1 ? symbol
                      : side.alone           ? motion.label
                                             : fmt::format("{}, {}", motion.label, symbol);
        auto [sure, unsure] = split(whole, rows.values[0], lost(*results[motion.study]));
        unsure.faded = true;
        if (!sure.x.empty()) unsure.label.clear();
        if (is_phase()) fold_turns(sure), fold_turns(unsure);
        if (!unsure.x.empty()) out.series.push_back(std::move(unsure));
        if (!sure.x.empty()) out.series.push_back(std::move(sure));
    }

    // `look` counts the curves of both sides, `table` the tables of all panels.
    void add_side(const SeriesPanel& keys, const std::vector<std::size_t>& shown, bool right, int& look,
                  std::size_t& table, const Results& results, Panel& out, Panel& differences) const {
        const Side curves = side(keys, shown, right, table, results);
        Axis& axis = right ? *out.right : out.y;
        const bool own_label = !right && !keys.label.empty();
        axis.label = axis_label(own_label ? keys.label : fmt::format("{}", fmt::join(curves.symbols, ", ")),
                                curves.measure.unit);
        for (std::size_t i = 0; i < curves.curves.size(); ++i) add_curve(curves, i, look++, results, out);
        const bool with_data = std::ranges::find(shown, measured_motion_) != shown.end();
        for (std::size_t k = 0; k < curves.channels.size() && with_data; ++k)
            for (const Measured& each : measured_) {
                if (keys_.against == "frequency") {
                    add_measured_spectrum(each.data, curves, k, look, out);
                    continue;
                }
                const Series* points = add_measured(each.data, curves, k, look, out);
                if (points && keys_.residuals && !right)
                    add_difference(each, curves.channels[k], *points, results, differences);
            }
        if (right) return;
        for (auto* limit : {&axis.from, &axis.to})
            if (*limit) **limit *= curves.measure.factor;
        for (const double at : keys.lines) out.rules.push_back({.at = at * curves.measure.factor});
    }

    void add_measured_spectrum(const Measurement& data, const Side& side, std::size_t k, int& look, Panel& out) const {
        if (!data.find(side.channels[k]) || out.series.empty()) return;
        const auto lines = measured_spectrum(data, side.channels[k], out.series.back().x.back());
        if (!lines) return;
        Series& s = out.series.emplace_back(
            measured_series(data, lines->values[0], scaled(lines->values[1], side.measure.factor), look++));
        s.line = true, s.every_point = false, s.right = side.right;
    }

    // What the rows of data are drawn against; nothing where they do not hold it. The cam's law gives its angle.
    std::optional<std::vector<double>> measured_abscissa(const Measurement& data) const {
        const sim::Problem& problem = motions_[measured_motion_].problem;
        if (!abscissa_) return scaled(data.times, per_second(problem));
        if (const std::vector<double>* held = data.find(*abscissa_)) return *held;
        if (abscissa_->kind != ChannelKind::cam_angle || !problem.cam) return std::nullopt;
        std::vector<double> angles;
        for (const double t : data.times) angles.push_back(problem.cam->phase - problem.cam->speed * t);
        return angles;
    }

    // Beneath the computed curves. Nothing where the data do not hold it.
    const Series* add_measured(const Measurement& data, const Side& side, std::size_t k, int& look, Panel& out) const {
        const std::vector<double>* values = data.find(side.channels[k]);
        const auto along = measured_abscissa(data);
        if (!values || !along) return nullptr;
        Series& points = *out.series.insert(
            out.series.begin(),
            measured_series(data, *along, scaled(above_zero(*values, side.channels[k]), side.measure.factor), look++));
        points.right = side.right;
        if (is_phase()) fold_turns(points);
        return &points;
    }

    void add_difference(const Measured& each, Channel channel, const Series& points, const Results& results,
                        Panel& differences) const {
        const sim::Result& result = *results[motions_[measured_motion_].study];
        const std::vector<double>& computed = column(result.tables[each.table], channel.kind);
        std::vector<double> difference = *each.data.find(channel);
        for (std::size_t i = 0; i < difference.size(); ++i) difference[i] -= computed[i];
        Series whole = measured_series(each.data, points.x, std::move(difference), points.look);
        auto [sure, unsure] = split(whole, each.data.times, lost(result));
        unsure.faded = true;
        for (Series* part : {&unsure, &sure})
            if (!part->x.empty()) differences.series.push_back(std::move(*part));
    }

    Panel panel(const SeriesPanel& keys, const std::vector<std::size_t>& shown, const Results& results,
                std::size_t& table, Panel& differences) const {
        Panel out;
        out.title = keys.title;
        if (keys_.apart) out.title = motions_[shown.front()].label + (out.title.empty() ? "" : ": ") + out.title;
        out.name = name(keys.channels.front());
        if (keys.logarithmic) out.y.scale = render::figure::Scale::logarithmic;
        out.y.from = keys.low, out.y.to = keys.high;
        int look = 0;
        if (!keys.right.empty()) out.right.emplace();
        add_side(keys, shown, false, look, table, results, out, differences);
        if (out.right) add_side(keys, shown, true, look, table, results, out, differences);
        finish_differences(keys.channels.front(), motions_.front().problem, differences);
        out.legend = look > 1 ? Legend::direct : Legend::none;
        if (!over_time()) return out;
        const SeriesMotion& first = motions_[shown.front()];
        const sim::Result& result = *results[first.study];
        if (keys_.impacts)
            add_rules(impact_rules(result, keys_.from, end_), first, out);
        else if (shown.size() == 1)
            add_rules(horizon_rules(result, keys_.from, end_), first, out);
        const bool with_words = &keys == &keys_.panels.front();
        add_rules(note_rules(keys_.notes, result, keys_.from, end_, with_words), first, out);
        return out;
    }
    void add_rules(const Rules& rules, const SeriesMotion& motion, Panel& out) const {
        for (const render::figure::Rule& rule : rules) {
            out.rules.push_back(rule);
            out.rules.back().at *= per_second(motion.problem);
        }
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
        const double air = abscissa_ && !is_phase() ? 0.03 * (high - low) : 0;
        const Channel channel = abscissa_.value_or(Channel{});
        // Seconds, as in print, unless a stretch is short.
        constexpr double kShort = 0.05;  // [s]
        if (!abscissa_ && high - low >= kShort) most = 1;
        if (is_phase()) low = 0, high = 1;
        if (keys_.x_low) low = *keys_.x_low + air;
        if (keys_.x_high) high = *keys_.x_high - air;
        Measure measure = measure_of(unit(channel, motions_.front().problem), most);
        std::string symbol = render::print_symbol(channel);
        if (keys_.against == "frequency") measure = {1, "Hz"}, symbol = "$f$";
        if (is_phase()) measure = {1, "(2π)"}, symbol = en() ? "phase of the cam" : "凸轮相位";
        if (keys_.against == "turns") measure = {1, ""}, symbol = en() ? "turns of the cam" : "凸轮转数";
        for (Panel& each : figure.panels) {
            each.x.label = axis_label(symbol, measure.unit);
            if (high > low) each.x.from = (low - air) * measure.factor, each.x.to = (high + air) * measure.factor;
            for (Series& curve : each.series) curve.x = scaled(std::move(curve.x), measure.factor);
            for (auto& rule : each.rules)
                if (rule.vertical) rule.at *= measure.factor;
        }
    }

    // Data that hold what the panels show, but not what it is drawn against.
    std::string undrawn_words() const {
        std::string text;
        for (const Measured& each : measured_)
            if (!measured_abscissa(each.data))
                text += filled(en() ? "Data “{}” do not hold {} and are not drawn. " : "{}：不含 {}，未绘出。",
                               each.data.label, render::print_symbol(*abscissa_));
        return text;
    }

    void write_caption(Figure& figure, const Results& results) const {
        std::vector<std::string> labels;
        std::vector<std::pair<std::string, const sim::Result*>> runs;
        std::vector<std::pair<const sim::Problem*, const sim::Result*>> pairs;
        // Panels of differences belong to the motion with data.
        const std::size_t differences = keys_.apart ? figure.panels.size() - motions_.size() * keys_.panels.size() : 0;
        for (std::size_t k = 0; k < motions_.size(); ++k) {
            const SeriesMotion& motion = motions_[k];
            const sim::Result& result = *results[motion.study];
            const std::size_t first = k * keys_.panels.size() + (k > measured_motion_ ? differences : 0);
            const std::string panel = fmt::format("({})", letter(first));
            if (keys_.apart)
                labels.push_back(filled(en() ? "{} {}, {}" : "{} {}，{}", panel, motion.label,
                                        impacts_words(motion.problem, result, end_, lang_)));
            else if (!motion.label.empty())
                labels.push_back(motion.label);
            runs.emplace_back(keys_.apart ? panel : motion.label, &result);
            pairs.emplace_back(&motion.problem, &result);
        }
        const std::string of =
            labels.empty() ? "" : filled(en() ? ": {}" : "：{}", fmt::join(labels, en() ? "; " : "；"));
        figure.caption = fmt::format("{}{}{}", words_.caption.empty() ? series_subject(keys_, lang_) : words_.caption,
                                     of, en() ? ". " : "。");
        if (keys_.impacts && !figure.panels.front().rules.empty())
            figure.caption += marks_collisions(*runs.front().second, keys_.from, end_)
                                  ? (en() ? "Dashed lines: series of impacts begin. " : "虚线：冲击序列开始。")
                                  : (en() ? "Dashed lines: impacts begin. " : "虚线：冲击开始。");
        if (keys_.against == "frequency")
            figure.caption += spectrum_words(motions_.front().problem, keys_.from, end_, lang_);
        else
            figure.caption += horizon_words(runs, keys_.from, end_, lang_);
        const SeriesMotion& motion = motions_[measured_motion_];
        figure.caption +=
            keys_.against == "frequency"
                ? measured_spectrum_words(measured_, lang_)
                : undrawn_words() + agreement_words(measured_, *results[motion.study], motion.problem, lang_);
        figure.caption += common_facts(motions_, lang_);
        figure.accuracy = accuracy(pairs, lang_);
    }

    SeriesKeys keys_;
    SeriesWords words_;
    Lang lang_;
    double end_;  // [s]
    std::vector<SeriesMotion> motions_;
    std::vector<Measured> measured_;
    std::size_t measured_motion_ = 0;
    std::optional<Channel> abscissa_;  // absent: time or turns
    std::vector<std::size_t> tables_;  // of each panel, side, channel and motion, in this order
};

}  // namespace

FigureMaker prepare_series(const Scene& scene, const SeriesKeys& keys, const SeriesWords& words, Lang lang,
                           Studies& studies) {
    return SeriesFigure(scene, keys, words, lang, studies);
}

}  // namespace beamcam::scenes
