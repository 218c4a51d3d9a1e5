// Outputs with numbers of the motion or of the sweep: "trajectory", "shapes", "impacts", "state", "summary", "sweep".
#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include "output/data/records.hpp"
#include "output/data/sweep_data.hpp"
#include "output/data/tables.hpp"
#include "output/files/atomic_file.hpp"
#include "output/files/standard_output.hpp"
#include "scenes/format/checks.hpp"
#include "scenes/format/value_formats.hpp"
#include "scenes/plan/planner.hpp"
#include "scenes/scene/files.hpp"
#include "scenes/scene/film_times.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {

// ---- "trajectory": a table of channels against time, as CSV or NPZ.

void TrajectoryOutput::visit(SceneVisitor& v) {
    visit_file(v, file, {".csv", ".npz"}, ".csv");
    v.value("channels", channels_format(channels),
            "Columns, in this order; the time is always the first. By default all channels.");
    visit_rows(v, rate, times);
    v.check([this](ObjectReader& r) {
        if (rate) limit_rows(r, *rate, 1);
    });
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
    constexpr int kPieces = 1000;    // of an adaptive table, each of which is halved where the motion needs it
    constexpr double kStray = 2e-3;  // of a channel's range: two pixels of a curve that is 1000 pixels high
    const bool adaptive = times.empty() && !rate;
    std::vector<double> instants =
        times.empty() ? rows(0, scene.end_time, rate.value_or(kPieces / scene.end_time)) : times;
    planner.simulate_until(*std::ranges::max_element(instants));

    DataFile data{output, file, kType, {}};
    data.content = adaptive ? "rows that follow the motion" : counted(instants.size(), "row");
    const std::size_t index = planner.add_table(std::move(instants), std::move(columns));
    sim::TableRequest& table = planner.request().tables[index];
    table.adaptive = adaptive;
    table.stray = kStray;
    if (times.empty()) table.rate = rate;
    data.table = index;
    data.write = [index](const DataSource& from) { return write_table(from, from.run.tables[index]); };
    planner.add(std::move(data));
}

// ---- "shapes": the deflection along the beam in time, as CSV or NPZ: t, x, v in rows.

void ShapesOutput::visit(SceneVisitor& v) {
    visit_file(v, file, {".csv", ".npz"}, "-shapes.csv");
    visit_rows(v, rate, times);
    v.integer("stations", stations, 2, 1001,
              "Number of points along the beam, equally spaced from the root to the tip.");
    v.check([this](ObjectReader& r) { limit_rows(r, rate, stations); });
}

void ShapesOutput::plan(Planner& planner, std::size_t output) const {
    const Scene& scene = planner.scene();
    std::vector<double> instants = times.empty() ? rows(0, scene.end_time, rate) : times;
    planner.simulate_until(*std::ranges::max_element(instants));
    std::vector<sim::PoseRequest>& poses = planner.request().poses;
    poses.push_back({.times = std::move(instants), .stations = stations});
    DataFile data{output, file, kType, {}};
    data.content = fmt::format("{} points at {} times", stations, poses.back().times.size());
    data.write = [index = poses.size() - 1](const DataSource& from) {
        output::ColumnTable table{{{"t"}, {"x"}, {"v"}}};
        for (const sim::Pose& pose : from.run.poses[index]) {
            const std::vector<double> v = deflection(pose);
            for (std::size_t k = 0; k < v.size(); ++k) {
                table.columns[0].values.push_back(pose.t);
                table.columns[1].values.push_back(from.problem.beam.length * static_cast<double>(k) /
                                                  static_cast<double>(v.size() - 1));
                table.columns[2].values.push_back(v[k]);
            }
        }
        output::write_table(*from.file, table);
        return counted(table.rows(), "row");
    };
    planner.add(std::move(data));
}

// ---- "impacts": all impacts and collisions, as JSON or CSV.

void ImpactsOutput::visit(SceneVisitor& v) { visit_file(v, file, {".json", ".csv"}, "-impacts.json"); }

void ImpactsOutput::plan(Planner& planner, std::size_t output) const {
    const auto write = [](const DataSource& from) {
        from.file ? output::write_impacts(*from.file, from.run) : output::print_json(output::impacts_json(from.run));
        return fmt::format("{} in {}", counted(from.run.impacts.size(), "impact"),
                           counted(from.run.collisions.size(), "collision"));
    };
    planner.simulate_until(planner.run_end());
    planner.add(DataFile{.output = output, .file = file, .type = kType, .write = write, .holds_events = true});
}

// ---- "state": a scene that continues the motion from an instant.

void StateOutput::visit(SceneVisitor& v) {
    visit_file(v, file, {".json"}, "-state.json");
    v.number("at", at, sim::dimension::kTime, kFromStart, "The instant; it is the time 0 of the scene in the file.");
}

void StateOutput::plan(Planner& planner, std::size_t output) const {
    Scene next;
    next.end_time = planner.scene().end_time > at ? planner.scene().end_time - at : planner.scene().end_time;
    std::vector<double>& states = planner.request().states;
    states.push_back(at);
    const auto write = [next, index = states.size() - 1, at = at](const DataSource& from) {
        Scene scene = next;
        scene.problem = from.run.states[index].value();
        const std::string json = to_json(scene);
        from.file ? output::write_file(*from.file, json) : output::print_json(json);
        return fmt::format("state at {:g} s", at);
    };
    planner.simulate_until(at);
    planner.add(DataFile{.output = output, .file = file, .type = kType, .write = write});
}

// ---- "summary": counts, extrema, energy balance and warnings of the run, and the work for all outputs.

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
        const std::string json = output::summary_json(from.problem, from.run, from.request.extrema, &from.work, all);
        from.file ? output::write_file(*from.file, json) : output::print_json(json);
        return from.run.reproducibility;
    };
    planner.simulate_until(planner.run_end());
    planner.request().zero_crossings = true;
    if (planner.request().extrema.empty())
        for (const sim::Channel& channel : all_channels(planner.scene().problem))
            if (channel.kind != sim::ChannelKind::t && channel.kind != sim::ChannelKind::q_dot)
                planner.request().extrema.push_back(channel);
    if (horizon) planner.require_horizon();
    planner.add(DataFile{.output = output, .file = file, .type = kType, .write = write, .reports_work = true});
}

// ---- "sweep": the samples of all points of the scene's sweep, as NetCDF-4, CSV or NPZ.

void SweepOutput::visit(SceneVisitor& v) {
    visit_file(v, file, {".nc", ".csv", ".npz"}, "-sweep.nc");
    v.check([](ObjectReader& r) {
        if (!r.context().scene.sweep && !r.diagnostics().any())
            r.reject_object("type", ": the scene has no key \"sweep\"; add it, or remove this output");
    });
}

void SweepOutput::plan(Planner& planner, std::size_t output) const {
    DataFile data{output, file, kType, {}};
    if (const Shard& shard = planner.shard(); !shard.whole()) {
        data.file = part_file(file, shard);
        data.part = shard.text();
    }
    data.write = [](const DataSource& from) {
        if (from.file) {
            output::write_sweep(*from.file, *from.sweep);
        } else {
            output::write_sweep_csv(std::cout, *from.sweep);
            output::flush_data();
        }
        return counted(from.sweep->rows_in_all(), "row");
    };
    planner.require_sweep(data.file);
    planner.add(std::move(data));
}

}  // namespace beamcam::scenes
