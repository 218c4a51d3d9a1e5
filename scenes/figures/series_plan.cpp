#include "scenes/figures/series_plan.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "scenes/figures/series_spectrum.hpp"

namespace beamcam::scenes {
namespace {

constexpr int kRows = 2001;  // to begin with; more where a curve bends

std::vector<SeriesMotion> motions_of(const Scene& scene, const SeriesKeys& keys) {
    if (keys.compare.empty()) return {{"", scene.problem, 0}};
    std::vector<SeriesMotion> motions;
    for (const Compared& each : keys.compare) motions.push_back({each.label, each.problem, 0});
    return motions;
}

// Data are of the scene's own motion; where that is not among those shown, they are held against the first.
std::size_t motion_measured(const Scene& scene, const std::vector<SeriesMotion>& motions) {
    const std::string own = Studies::key(scene.problem);
    for (std::size_t k = 0; k < motions.size(); ++k)
        if (Studies::key(motions[k].problem) == own) return k;
    return 0;
}

std::vector<sim::Channel> channels_of(const SeriesPlan& plan) {
    std::vector<sim::Channel> all;
    for (const SeriesPanel& panel : plan.keys.panels) {
        all.insert(all.end(), panel.channels.begin(), panel.channels.end());
        all.insert(all.end(), panel.right.begin(), panel.right.end());
    }
    if (plan.abscissa.channel()) all.push_back(*plan.abscissa.channel());
    return all;
}

std::size_t table_of(const SeriesPlan& plan, sim::Channel channel, const SeriesMotion& motion, Studies& studies) {
    if (!plan.abscissa.is_frequency())
        return studies.curve(motion.study, {plan.keys.from, plan.end, kRows},
                             plan.abscissa.channel().value_or(sim::Channel{}), channel);
    std::vector<sim::TableRequest>& tables = studies.request(motion.study).tables;
    tables.push_back({spectrum_instants(motion.problem, plan.keys.from, plan.end), {sim::Channel{}, channel}});
    return tables.size() - 1;
}

// One table for all sums, with the rows that the first of their channels needs.
void add_sums(const SeriesPlan& plan, std::size_t motion, Studies& studies, std::vector<SeriesCurve>& curves) {
    constexpr int kSumRows = 8001;  // to begin with: energies swing with whatever the beam does
    std::vector<sim::ChannelKind> all;
    for (const SeriesSum& sum : plan.sums)
        for (const auto* kinds : {&sum.plus, &sum.minus})
            for (const sim::ChannelKind kind : *kinds)
                if (std::ranges::find(all, kind) == all.end()) all.push_back(kind);
    const sim::Channel first{all.front(), 0};
    all.erase(all.begin());
    const std::size_t table =
        studies.curve(plan.motions[motion].study, {plan.keys.from, plan.end, kSumRows}, {}, first, all);
    for (std::size_t k = 0; k < plan.sums.size(); ++k) curves.push_back({first, motion, table, k});
}

PlannedPanel planned(const SeriesPlan& plan, std::size_t number, std::vector<std::size_t> motions, Studies& studies) {
    PlannedPanel out{number, std::move(motions), {}, {}};
    const SeriesPanel& keys = plan.keys.panels[number];
    const auto add = [&](const std::vector<sim::Channel>& channels, std::vector<SeriesCurve>& curves) {
        for (const sim::Channel& channel : channels)
            for (const std::size_t motion : out.motions)
                curves.push_back({channel, motion, table_of(plan, channel, plan.motions[motion], studies)});
    };
    if (number == 0 && !plan.sums.empty())
        for (const std::size_t motion : out.motions) add_sums(plan, motion, studies, out.left);
    else
        add(keys.channels, out.left);
    add(keys.right, out.right);
    return out;
}

sim::Table summed(const sim::Table& rows, const SeriesSum& sum) {
    sim::Table out{{rows.channels[0], rows.channels[1]}, {rows.values[0], std::vector<double>(rows.rows(), 0)}};
    const auto add = [&](const std::vector<sim::ChannelKind>& kinds, double sign) {
        for (const sim::ChannelKind kind : kinds) {
            const std::vector<double>& values = column(rows, kind);
            for (std::size_t i = 0; i < values.size(); ++i)
                if (std::isfinite(values[i])) out.values[1][i] += sign * values[i];
        }
    };
    add(sum.plus, 1), add(sum.minus, -1);
    return out;
}

}  // namespace

sim::Table SeriesPlan::rows(const SeriesCurve& curve, const Results& results) const {
    const sim::Table& rows = results[motions[curve.motion].study]->tables[curve.table];
    if (curve.sum) return summed(rows, sums[*curve.sum]);
    return abscissa.is_frequency() ? spectrum_table(rows, keys.x_high) : rows;
}

std::vector<Lost> SeriesPlan::lost(const sim::Result& result) const {
    return abscissa.is_frequency() || !horizon ? std::vector<Lost>{} : unreliable(result, end);
}

void complete(SeriesPlan& plan, const Scene& scene, const char* name, Studies& studies) {
    const SeriesKeys& keys = plan.keys;
    plan.motions = motions_of(scene, keys);
    for (SeriesMotion& motion : plan.motions) {
        motion.study = studies.of(motion.problem, plan.end, name);
        if (plan.horizon) studies.horizon(motion.study);
        if (std::ranges::any_of(keys.notes, [](const auto& n) { return n.at.kind == Instant::Kind::apex; }))
            studies.turning_points(motion.study);
    }
    plan.measured_motion = motion_measured(scene, plan.motions);
    plan.measured = measured(scene, channels_of(plan), keys.from, plan.end, plan.motion_with_data().study, studies);
    std::vector<std::size_t> all(plan.motions.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    for (std::size_t group = 0; group < (keys.apart ? all.size() : 1); ++group)
        for (std::size_t number = 0; number < keys.panels.size(); ++number)
            plan.panels.push_back(planned(plan, number, keys.apart ? std::vector{group} : all, studies));
}

}  // namespace beamcam::scenes
