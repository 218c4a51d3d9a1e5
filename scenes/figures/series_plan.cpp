#include <algorithm>
#include <cmath>
#include <numeric>

#include "scenes/figures/series.hpp"
#include "scenes/figures/series_data.hpp"
#include "scenes/motions/identity.hpp"
#include "scenes/scene/time_map.hpp"

namespace beamcam::scenes {
namespace {

constexpr int kRows = 2001;  // to begin with; more where a curve bends

std::vector<SeriesMotion> motions_of(const Scene& scene, const SeriesKeys& keys) {
    if (keys.compare.empty()) return {{"", scene.problem, 0}};
    std::vector<SeriesMotion> motions;
    for (const Compared& each : keys.compare) motions.push_back({each.label, each.problem, 0});
    return motions;
}

// Data belong to the scene's own motion; if it is not shown, they are compared with the first.
std::size_t motion_measured(const Scene& scene, const std::vector<SeriesMotion>& motions) {
    const std::string own = motion_key(scene.problem);
    for (std::size_t k = 0; k < motions.size(); ++k)
        if (motion_key(motions[k].problem) == own) return k;
    return 0;
}

std::vector<sim::Channel> channels_of(const SeriesPlan& plan) {
    std::vector<sim::Channel> all;
    for (const SeriesPanel& panel : plan.keys.panels)
        all.insert(all.end(), panel.channels.begin(), panel.channels.end());
    if (plan.abscissa.channel()) all.push_back(*plan.abscissa.channel());
    return all;
}

// Requests a table with the rows that `channel` needs, at least `rows`, and the channels `also` at the same rows.
std::size_t table_of(const SeriesPlan& plan, sim::Channel channel, const std::vector<sim::Channel>& also, int rows,
                     const SeriesMotion& motion, MotionRequests& requests) {
    if (!plan.abscissa.is_frequency())
        return requests.curve(motion.request, {plan.keys.from, plan.end, rows},
                              plan.abscissa.channel().value_or(sim::Channel{}), channel, also,
                              plan.abscissa.drawn(motion.problem));
    sim::TableRequest table{spectrum_instants(motion.problem, plan.keys.from, plan.end), {sim::Channel{}, channel}};
    table.channels.insert(table.channels.end(), also.begin(), also.end());
    return requests.add_table(motion.request, std::move(table));
}

// One table for all sums of a panel, with the rows that the first of their channels needs.
void add_sums(const SeriesPlan& plan, const std::vector<SeriesSum>& sums, std::size_t motion, MotionRequests& requests,
              std::vector<SeriesCurve>& curves) {
    constexpr int kSumRows = 8001;  // to begin with: energies vary as fast as the beam vibrates
    std::vector<sim::Channel> all;
    for (const SeriesSum& sum : sums)
        for (const auto* channels : {&sum.plus, &sum.minus})
            for (const sim::Channel& channel : *channels)
                if (std::ranges::find(all, channel) == all.end()) all.push_back(channel);
    const sim::Channel first = all.front();
    all.erase(all.begin());
    const std::size_t table = table_of(plan, first, all, kSumRows, plan.motions[motion], requests);
    for (const SeriesSum& sum : sums) curves.push_back({first, motion, table, sum});
}

PlannedPanel planned(const SeriesPlan& plan, std::size_t number, std::vector<std::size_t> motions,
                     MotionRequests& requests) {
    PlannedPanel out{number, std::move(motions), {}};
    const SeriesPanel& keys = plan.keys.panels[number];
    if (keys.sums.empty())
        for (const sim::Channel& channel : keys.channels)
            for (const std::size_t motion : out.motions)
                out.curves.push_back(
                    {channel, motion, table_of(plan, channel, {}, kRows, plan.motions[motion], requests)});
    for (const std::size_t motion : out.motions)
        if (!keys.sums.empty()) add_sums(plan, keys.sums, motion, requests, out.curves);
    return out;
}

// The sum stands after the first `kept` columns, the abscissae of the rows.
sim::Table summed(const sim::Table& rows, const SeriesSum& sum, std::ptrdiff_t kept) {
    sim::Table out{{rows.channels.begin(), rows.channels.begin() + kept + 1},
                   {rows.values.begin(), rows.values.begin() + kept}};
    out.values.emplace_back(rows.rows(), 0);
    const auto add = [&](const std::vector<sim::Channel>& channels, double sign) {
        for (const sim::Channel& channel : channels) {
            const auto at = std::ranges::find(rows.channels, channel) - rows.channels.begin();
            const std::vector<double>& values = rows.values.at(static_cast<std::size_t>(at));
            for (std::size_t i = 0; i < values.size(); ++i)
                if (std::isfinite(values[i])) out.values.back()[i] += sign * values[i];
        }
    };
    add(sum.plus, 1), add(sum.minus, -1);
    return out;
}

}  // namespace

sim::Table SeriesPlan::rows(const SeriesCurve& curve, const MotionResults& results) const {
    const sim::Table& table = results[motions[curve.motion].request]->tables[curve.table];
    const sim::Table rows = curve.sum ? summed(table, *curve.sum, abscissa.channel() ? 2 : 1) : table;
    return abscissa.is_frequency() ? spectrum_table(rows, keys.x_high) : rows;
}

std::vector<UnreliableInterval> SeriesPlan::unreliable(const sim::Result& result) const {
    return abscissa.is_frequency() ? std::vector<UnreliableInterval>{} : unreliable_intervals(result, end);
}

void complete(SeriesPlan& plan, const Scene& scene, MotionRequests& requests) {
    const SeriesKeys& keys = plan.keys;
    plan.motions = motions_of(scene, keys);
    for (SeriesMotion& motion : plan.motions) {
        motion.request = requests.motion(motion.problem, plan.end);
        if (keys.horizon && !plan.abscissa.is_frequency()) requests.horizon(motion.request);
        for (const SeriesNote& note : keys.notes)
            record_event(note.at, scene.end_time, requests.request(motion.request));
    }
    plan.measured_motion = motion_measured(scene, plan.motions);
    plan.measured = measured(scene, channels_of(plan), keys.from, plan.end, plan.motion_with_data().request, requests);
    std::vector<std::size_t> all(plan.motions.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    for (std::size_t group = 0; group < (keys.apart ? all.size() : 1); ++group)
        for (std::size_t number = 0; number < keys.panels.size(); ++number)
            plan.panels.push_back(planned(plan, number, keys.apart ? std::vector<std::size_t>{group} : all, requests));
}

}  // namespace beamcam::scenes
