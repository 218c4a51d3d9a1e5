#include "scenes/scene/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "output/data/tables.hpp"
#include "output/json/source.hpp"
#include "scenes/scene/exit_code.hpp"

namespace beamcam::scenes {

using sim::SampleKind;

constexpr double kRandomAngle = 0.3, kRandomRate = 1;  // [rad], [rad/s]

std::vector<RandomKey> random_keys(const Sweep& sweep, const sim::Problem& problem) {
    if (!sweep.seeds.keys.empty()) return sweep.seeds.keys;
    const double angle = problem.initial.angle;
    return {{"initial.angle", angle, angle + kRandomAngle}, {"initial.angular_velocity", -kRandomRate, kRandomRate}};
}

std::vector<SeedKind> starts_of(const SweepSeeds& seeds) {
    std::vector<SeedKind> all;
    for (const SeedKind kind : seeds.kinds)
        all.insert(all.end(), kind == SeedKind::random ? static_cast<std::size_t>(seeds.random) : 1, kind);
    return all;
}

std::string text_of_sample(const sim::Sampling& sampling) {
    switch (sampling.kind) {
        case SampleKind::impacts:
            return "impacts";
        case SampleKind::apexes:
            return "apexes";
        case SampleKind::section:
            return fmt::format("section:cam_angle={}", sampling.level);
        case SampleKind::crossings:
            break;
    }
    return fmt::format("section:{}={}:{}", name(sampling.channel), sampling.level,
                       sampling.rising ? "rising" : "falling");
}

static void resolve_table(SweptKey& over) {
    if (over.file.empty()) return;
    const output::ColumnTable table = output::read_table(over.file, output::Texts::kept);  // in other columns
    const auto column = std::ranges::find(table.columns, over.column, &output::TableColumn::name);
    if (column == table.columns.end())
        throw SceneError(fmt::format("sweep.over: {} has no column \"{}\"", over.file, over.column));
    for (std::size_t i = 0; i < column->texts.size(); ++i)
        if (!column->texts[i].empty())
            throw SceneError(fmt::format("sweep.over: {}, column {}, row {}: {} is not a number", over.file,
                                         over.column, i + 1, in_quotes(column->texts[i])));
    over.values = column->values;
    std::erase_if(over.values, [](double value) { return std::isnan(value); });
    if (over.values.empty())
        throw SceneError(fmt::format("sweep.over: column {} of {} is empty", over.column, over.file));
    over.file.clear();
    over.column.clear();
}

void resolve_tables(Sweep& sweep) { std::ranges::for_each(sweep.over, resolve_table); }

}  // namespace beamcam::scenes
