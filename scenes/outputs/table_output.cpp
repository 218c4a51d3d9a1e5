// Output "trajectory": a table of channels against time, as CSV or NPZ.
#include <algorithm>
#include <iostream>

#include "output/data/tables.hpp"
#include "output/files/standard_output.hpp"
#include "scenes/format/checks.hpp"
#include "scenes/format/value_formats.hpp"
#include "scenes/plan/planner.hpp"
#include "scenes/scene/film_times.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {

void TrajectoryOutput::visit(SceneVisitor& v) {
    visit_file(v, file, {".csv", ".npz"}, ".csv");
    v.value("channels", channels_format(channels),
            "Columns, in this order; the time is always the first. By default all channels.");
    visit_rows(v, rate, times);
    v.check([this](ObjectReader& r) { limit_rows(r, rate, 1); });
}

namespace {

std::string write_table(const DataSource& from, const sim::Table& table) {
    if (from.file) {
        output::write_table(*from.file, table);
    } else {
        output::write_csv(std::cout, table);
        output::flush_data();
    }
    return counted(table.rows(), "row");
}

}  // namespace

void TrajectoryOutput::plan(Planner& planner, std::size_t output) const {
    const Scene& scene = planner.scene();
    std::vector<sim::Channel> columns = channels.empty() ? all_channels(scene.problem) : channels;
    const sim::Channel t{sim::ChannelKind::t, 0};
    if (std::ranges::find(columns, t) == columns.end()) columns.insert(columns.begin(), t);
    std::vector<double> instants = times.empty() ? rows(0, scene.end_time, rate) : times;
    planner.simulate_until(*std::ranges::max_element(instants), file);

    DataFile data{output, file, "table", {}};
    data.content = counted(instants.size(), "row") + " of " + counted(columns.size(), "channel");
    data.numbers = instants.size() * columns.size();
    data.details = object_node({{"rows", instants.size()}, {"channels", channel_names(columns)}});
    const std::size_t index = planner.add_table(std::move(instants), std::move(columns));
    data.table = index;
    data.write = [index](const DataSource& from) { return write_table(from, from.run.tables[index]); };
    planner.add(std::move(data));
}

}  // namespace beamcam::scenes
