#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

#include "render/base/error.hpp"
#include "render/plot/channel_label.hpp"
#include "scenes/figures/axis_labels.hpp"
#include "scenes/figures/figure_types.hpp"
#include "scenes/figures/series.hpp"
#include "scenes/figures/series_data.hpp"

namespace beamcam::scenes {
namespace {

using render::Axis;
using sim::Channel;

constexpr double kCurveWeight = 0.8;  // of the lines

// ---- values ---------------------------------------------------------------------------------------

bool has_values(const sim::Table& table) {  // in its last channel
    return std::ranges::any_of(table.values.back(), [](double v) { return std::isfinite(v); });
}

bool is_zero(const sim::Table& table) { return largest_magnitude(table.values.back()) == 0; }

// Whether curves over the same axes differ by less than a line is wide.
bool coincide(const Series& a, const Series& b) {
    constexpr double kWidth = 0.008;  // of a line in a column, in the range of the curve
    if (b.x.size() < 2 || !std::ranges::is_sorted(a.x) || !std::ranges::is_sorted(b.x)) return false;
    render::Extent range;
    range.add(a.y);
    std::size_t k = 0;
    for (std::size_t i = 0; i < a.x.size(); ++i) {
        while (k + 2 < b.x.size() && b.x[k + 1] < a.x[i]) ++k;
        const double wide = b.x[k + 1] - b.x[k], share = wide > 0 ? (a.x[i] - b.x[k]) / wide : 0;
        if (!(std::abs(a.y[i] - std::lerp(b.y[k], b.y[k + 1], share)) <= kWidth * (range.high - range.low)))
            return false;
    }
    return true;
}

class SeriesPanelMaker {
  public:
    SeriesPanelMaker(const SeriesPlan& plan, const PlannedPanel& planned, const MotionResults& results,
                     const std::vector<int>& looks)
        : plan_(plan),
          keys_(plan.keys.panels[planned.number]),
          planned_(planned),
          results_(results),
          looks_(looks),
          first_(plan.motions[planned.motions.front()]) {}

    std::vector<Panel> make() {
        if (!has_sums()) panel_.name = name(keys_.channels.front());
        if (keys_.logarithmic) panel_.y.scale = render::Scale::logarithmic;
        panel_.y.from = keys_.low, panel_.y.to = keys_.high;
        read();
        panel_.y.label =
            axis_label(keys_.label.empty() ? fmt::format("{}", fmt::join(symbols_, ", ")) : keys_.label, measure_.unit);
        panel_.y.keeps_unit = !keys_.unit.name.empty();
        for (std::size_t i = 0; i < planned_.curves.size(); ++i) planned_.curves[i].sum ? add_sum(i) : add_curve(i);
        if (panel_.series.size() == 1) panel_.series.front().solid = true;
        panel_.title = phrase(plan_.lang, sums_.size() == 1 && keys_.title.empty() ? sums_.front() : keys_.title);
        if (shows_some()) panel_.title = first_.label + (panel_.title.empty() ? "" : ": ") + panel_.title;
        if (shows_motion_with_data()) add_data();
        limit_axis();
        const auto labelled = [](const Series& curve) { return !curve.label.empty(); };
        panel_.legend = std::ranges::count_if(panel_.series, labelled) > 1;
        panel_.caption = caption();
        if (has_sums()) panel_.share = 1 + 0.2 * static_cast<double>(keys_.sums.size());
        for (auto& rule : series_rules(plan_, planned_, results_)) panel_.rules.push_back(std::move(rule));
        std::vector<Panel> out;
        if (is_rounding_ || panel_.series.empty()) return out;
        out.push_back(std::move(panel_));
        if (differences_.series.empty()) return out;
        finish_differences();
        out.push_back(std::move(differences_));
        return out;
    }

  private:
    bool has_sums() const { return !keys_.sums.empty(); }
    // The sums that are drawn or the channels, and the motion; of one panel for each motion that alone.
    std::string caption() const {
        if (shows_some() && plan_.keys.panels.size() == 1) return first_.label;
        SeriesPanel drawn = keys_;
        std::erase_if(drawn.sums, [&](const SeriesSum& sum) { return !std::ranges::count(sums_, sum.label); });
        return (is_closure() ? "largest " : "") + panel_subject(drawn) + (is_closure() ? " so far" : "") +
               (shows_some() ? ", " + first_.label : "");
    }
    bool shows_some() const { return planned_.motions.size() < plan_.motions.size(); }  // not all motions
    // A logarithmic axis shows the largest change of the energy balance so far.
    bool is_closure() const {
        return keys_.logarithmic && keys_.channels.front().kind == sim::ChannelKind::energy_residual;
    }

    void limit_axis() {
        Axis& axis = panel_.y;
        for (auto* limit : {&axis.from, &axis.to})
            if (*limit) **limit *= measure_.factor;
        for (const double at : keys_.lines) panel_.rules.push_back({.at = at * measure_.factor});
        if (is_closure())
            begin_at_rounding();
        else if (keys_.logarithmic && !plan_.abscissa.is_frequency() && !axis.from)
            leave_out_tails();
    }

    // A force that ends passes through all decades to zero: the axis begins at most six below the largest value.
    void leave_out_tails() {
        constexpr double kDecades = 1e-6;
        double most = 0, least = std::numeric_limits<double>::infinity();
        for (const sim::Table& rows : rows_)
            for (const double v : rows.values.back())
                if (v > 0) most = std::max(most, v), least = std::min(least, v);
        if (least < kDecades * most) panel_.y.from = kDecades * most * measure_.factor;
    }

    // Reads the rows of the curves. Separate panels of several motions have one unit.
    void read() {
        double most = 0;
        for (const SeriesCurve& curve : planned_.curves) {
            rows_.push_back(rows_of(curve));
            most = std::max(most, largest_magnitude(rows_.back().values.back()));
        }
        if (shows_some()) most = std::max(most, largest_of_all());
        const Channel& first = keys_.channels.front();
        if (!(most > 0) && std::ranges::none_of(rows_, has_values))
            throw render::PictureError(
                fmt::format("series: {} has no value from {:g} s to {:g} s", name(first), plan_.keys.from, plan_.end));
        const std::string si = unit(first, plan_.motions.front().problem);
        measure_ = !keys_.unit.name.empty() ? measure_in(keys_.unit)
                   : plan_.has_sums()       ? Measure{1, si}
                                            : measure_of(si, most, plan_.units);
        if (has_sums() && si == "J") return void(symbols_ = {"$E$"});
        for (const Channel& channel : keys_.channels)
            symbols_.push_back(fmt::format(fmt::runtime(plan_.abscissa.is_frequency() ? "|{}|"
                                                        : is_closure()                ? "max |{}|"
                                                                                      : "{}"),
                                           render::print_symbol(channel)));
    }
    sim::Table rows_of(const SeriesCurve& curve) const {
        sim::Table rows = plan_.rows(curve, results_);
        double most = is_closure() ? rounding(curve) : 0;  // so far
        for (double& v : rows.values.back())
            if (is_closure()) v = most = std::max(std::abs(v), most);
        return rows;
    }
    // Below it the change of the energy balance is rounding, which differs between machines.
    double rounding(const SeriesCurve& curve) const {
        return 1e-12 * results_[plan_.motions[curve.motion].request]->energy_scale;
    }
    double largest_of_all() const {
        double most = 0;
        for (const PlannedPanel& panel : plan_.panels)
            if (panel.number == planned_.number)
                for (const SeriesCurve& curve : panel.curves)
                    most = std::max(most, largest_magnitude(rows_of(curve).values.back()));
        return most;
    }

    // Starts the axis at the rounding. A panel that would show rounding alone is omitted if there are others.
    void begin_at_rounding() {
        double floor = 0, most = 0;
        for (std::size_t i = 0; i < planned_.curves.size(); ++i)
            floor = std::max(floor, rounding(planned_.curves[i])),
            most = std::max(most, largest_magnitude(rows_[i].values.back()));
        if (!panel_.y.from && floor > 0) panel_.y.from = floor * measure_.factor;
        is_rounding_ = plan_.keys.panels.size() > 1 && !(floor > 0 && most > 10 * floor);
    }

    // The look in the colour that the quantity has in films, else the next one; vermilion belongs to the contact.
    int look_of(sim::ChannelKind kind) {
        using enum sim::ChannelKind;
        constexpr int kVermilion = 1;
        static const std::map<sim::ChannelKind, int> kOfFilms{
            {energy_kinetic, 0},  {energy_potential, 5},       {energy_elastic, 3},
            {loss_structural, 7}, {contact_force, kVermilion}, {energy_contact, kVermilion}};
        if (const auto of_film = kOfFilms.find(kind); of_film != kOfFilms.end()) return of_film->second;
        while (curves_ == kVermilion || std::ranges::count(panel_.series, curves_, &Series::look) > 0) ++curves_;
        return curves_++;
    }

    // Curves with short peaks, which gaps of dashes would hide, are solid.
    static bool has_short_peaks(sim::ChannelKind kind) {
        using enum sim::ChannelKind;
        return kind == contact_force || kind == energy_elastic || kind == energy_contact;
    }

    // A sum that is zero throughout is omitted, unless it is the only one.
    void add_sum(std::size_t i) {
        const SeriesSum& sum = *planned_.curves[i].sum;
        const std::vector<double>& values = rows_[i].values.back();
        if (keys_.sums.size() > 1 && is_zero(rows_[i])) return;
        sums_.push_back(sum.label);
        constexpr int kBlack = 6;
        const bool total = !sum.minus.empty();
        Series curve{.label = phrase(plan_.lang, sum.label),
                     .x = plan_.abscissa.of(rows_[i], plan_.motions[planned_.curves[i].motion].problem),
                     .y = scaled(values, measure_.factor),
                     .look = total ? kBlack : look_of(sum.plus.front().kind),
                     .solid = total || has_short_peaks(sum.plus.front().kind),
                     .weight = total ? 1 : kCurveWeight};
        curve.t = rows_[i].values[0];
        plan_.abscissa.fold(curve);
        panel_.series.push_back(std::move(curve));
    }

    // Paler where θ is not reproducible.
    void add_curve(std::size_t i) {
        const SeriesMotion& motion = plan_.motions[planned_.curves[i].motion];
        const std::size_t shown = planned_.motions.size(), channel = i / shown;
        const sim::Table& rows = rows_[i];
        if (shown > 1 && is_zero(rows) && !std::ranges::all_of(rows_, is_zero)) return;
        const bool one_channel = keys_.channels.size() == 1;
        const std::string label = phrase(plan_.lang, motion.label);
        const std::string alone = one_channel && has_data() ? phrase(plan_.lang, "simulation") : symbols_[channel];
        // Motions that coincide have one look.
        const int looks = 1 + std::ranges::max(looks_);
        Series whole{.label = shown == 1    ? alone
                              : one_channel ? label
                                            : fmt::format("{}, {}", label, symbols_[channel]),
                     .x = plan_.abscissa.of(rows, motion.problem),
                     .y = scaled(rows.values.back(), measure_.factor),
                     .name = shown == 1 ? symbols_[channel] : "",
                     .look = shown == 1 ? look_of(keys_.channels[channel].kind)
                                        : static_cast<int>(channel) * looks + looks_[planned_.curves[i].motion],
                     .solid = has_short_peaks(keys_.channels[channel].kind),
                     .weight = kCurveWeight};
        if (shown > 1) curves_ = std::max(curves_, whole.look + 1);
        std::vector<Series> parts = by_reliability(whole, rows.values[0], plan_.unreliable(*results_[motion.request]));
        if (parts.size() > 1) parts.front().label.clear();
        for (Series& part : parts) {
            plan_.abscissa.fold(part);
            panel_.series.push_back(std::move(part));
        }
    }

    // ---- measured data ----------------------------------------------------------------------------

    bool shows_motion_with_data() const {
        return std::ranges::find(planned_.motions, plan_.measured_motion) != planned_.motions.end();
    }
    bool has_data() const {
        return shows_motion_with_data() && std::ranges::any_of(plan_.measured, [&](const Measured& each) {
                   return each.data.find(keys_.channels.front()) != nullptr;
               });
    }
    void add_data() {
        for (const Channel& channel : keys_.channels)
            for (const Measured& each : plan_.measured) {
                if (!each.data.find(channel)) continue;
                if (plan_.abscissa.is_frequency())
                    add_spectrum(each.data, channel);
                else
                    add_points(each, channel);
            }
    }

    void add_spectrum(const Measurement& data, Channel channel) {
        if (panel_.series.empty()) return;
        const auto lines = measured_spectrum(data, channel, panel_.series.back().x.back());
        if (!lines) return;
        Series& s = panel_.series.emplace_back(
            measured_series(data, lines->values[0], scaled(lines->values[1], measure_.factor), curves_++));
        s.line = true, s.every_point = false;
    }

    // Draws data beneath the computed curves, if they hold the quantity of the x axis.
    void add_points(const Measured& measured, Channel channel) {
        const Measurement& data = measured.data;
        const auto along = plan_.abscissa.of(data, plan_.motion_with_data().problem);
        if (!along) return;
        Series points = measured_series(data, *along, scaled(*data.find(channel), measure_.factor), curves_++);
        points.t = data.times;
        plan_.abscissa.fold(points);
        if (plan_.keys.residuals) add_difference(measured, channel, points);
        panel_.series.insert(panel_.series.begin(), std::move(points));
    }

    void add_difference(const Measured& measured, Channel channel, const Series& points) {
        const sim::Result& result = *results_[plan_.motion_with_data().request];
        const std::vector<double>& computed = column(result.tables[measured.table], channel.kind);
        std::vector<double> difference = *measured.data.find(channel);
        for (std::size_t i = 0; i < difference.size(); ++i) difference[i] -= computed[i];
        const Series whole = measured_series(measured.data, points.x, std::move(difference), points.look);
        std::ranges::move(by_reliability(whole, measured.data.times, plan_.unreliable(result)),
                          std::back_inserter(differences_.series));
    }

    // Their unit has its own prefix.
    void finish_differences() {
        const Channel& channel = keys_.channels.front();
        double most = 0;
        for (const Series& each : differences_.series) most = std::max(most, largest_magnitude(each.y));
        const Measure measure = measure_of(unit(channel, plan_.motions.front().problem), most, plan_.units);
        const std::string symbol = "Δ" + render::print_symbol(channel);
        differences_.caption = symbol + ":";
        for (Series& each : differences_.series) {
            each.y = scaled(std::move(each.y), measure.factor);
            if (!each.label.empty()) differences_.caption += fmt::format(" {} − simulation", each.label);
            each.name = fmt::format("{}, {}", symbol, std::exchange(each.label, {}));
        }
        differences_.y.label = axis_label(symbol, measure.unit);
        differences_.name = name(channel) + " difference";
        differences_.rules.push_back({.at = 0});
        differences_.share = 0.6;
        differences_.legend = false;
    }

    const SeriesPlan& plan_;
    const SeriesPanel& keys_;
    const PlannedPanel& planned_;
    const MotionResults& results_;
    const std::vector<int>& looks_;  // of the motions
    const SeriesMotion& first_;      // of those shown

    std::vector<sim::Table> rows_;      // of the curves
    std::vector<std::string> symbols_;  // of the channels
    Measure measure_;

    Panel panel_, differences_;
    std::vector<std::string> sums_;  // the labels of those drawn
    bool is_rounding_ = false;       // it would show rounding alone
    int curves_ = 0;                 // looks so far, of data, too
};

}  // namespace

std::vector<int> looks_of_motions(const SeriesPlan& plan, const MotionResults& results) {
    const auto curve_of = [&](const SeriesCurve& curve) {
        const sim::Table rows = plan.rows(curve, results);
        return Series{.x = plan.abscissa.of(rows, plan.motions[curve.motion].problem), .y = rows.values.back()};
    };
    const auto differ = [&](std::size_t a, std::size_t b, const PlannedPanel& panel) {
        const std::size_t shown = panel.motions.size();
        for (std::size_t i = 0; shown > 1 && i < panel.curves.size(); i += shown)
            if (!coincide(curve_of(panel.curves[i + a]), curve_of(panel.curves[i + b]))) return true;
        return false;
    };
    std::vector<int> looks;
    for (std::size_t k = 0; k < plan.motions.size(); ++k) {
        int look = looks.empty() ? 0 : 1 + std::ranges::max(looks);
        for (std::size_t other = 0; other < k; ++other)
            if (std::ranges::none_of(plan.panels, [&](const auto& panel) { return differ(other, k, panel); })) {
                look = looks[other];
                break;
            }
        looks.push_back(look);
    }
    return looks;
}

std::vector<Panel> series_panels(const SeriesPlan& plan, const PlannedPanel& planned, const MotionResults& results,
                                 const std::vector<int>& looks) {
    return SeriesPanelMaker(plan, planned, results, looks).make();
}

}  // namespace beamcam::scenes
