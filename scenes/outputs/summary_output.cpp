// Output "summary": counts, extrema, energy balance and warnings of the run, and the work for all outputs.
#include "output/data/records.hpp"
#include "output/files/atomic_file.hpp"
#include "output/files/standard_output.hpp"
#include "scenes/format/checks.hpp"
#include "scenes/format/value_formats.hpp"
#include "scenes/plan/planner.hpp"

namespace beamcam::scenes {

void SummaryOutput::visit(SceneVisitor& v) {
    visit_file(v, file, {".json"}, "-summary.json");
    v.boolean("horizon", horizon,
              "Adds the intervals in which the motion is reproducible; needs further runs with tighter tolerances and "
              "another method.");
}

void SummaryOutput::plan(Planner& planner, std::size_t output) const {
    std::vector<std::pair<Measurement, std::size_t>> data;  // with their tables
    for (const Measurement& each : planner.scene().data) {
        data.emplace_back(each.within(0, planner.run_end()), 0);
        sim::TableRequest table = data.back().first.request();
        data.back().second = planner.add_table(std::move(table.times), std::move(table.channels));
        planner.require_horizon();
    }
    const auto write = [data](const DataSource& from) {
        std::vector<output::Agreement> all;
        for (const auto& [measurement, table] : data)
            for (output::Agreement& each : agreements(measurement, from.run.tables[table], from.run))
                all.push_back(std::move(each));
        const std::vector<sim::Channel>& extrema = from.request.extrema;
        if (from.file)
            output::write_file(*from.file, output::summary_json(from.problem, from.run, extrema, &from.work, all));
        else
            output::print_json(output::summary_json(from.problem, from.run, extrema, &from.work, all));
        return from.run.reproducibility;
    };
    planner.simulate_until(planner.run_end(), file);
    planner.request().zero_crossings = true;
    if (planner.request().extrema.empty())
        for (const sim::Channel& channel : all_channels(planner.scene().problem))
            if (channel.kind != sim::ChannelKind::t) planner.request().extrema.push_back(channel);
    if (horizon) planner.require_horizon();
    planner.add(DataFile{.output = output, .file = file, .stage = "summary", .write = write, .reports_work = true});
}

}  // namespace beamcam::scenes
