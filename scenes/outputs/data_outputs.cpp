// Outputs with numbers of the motion or of the sweep: "trajectory", "impacts", "state", "summary", "sweep".
#include "scenes/outputs/data_outputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

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
    v.number(
        sim::written_if(times.empty(), "rate"), rate, sim::dimension::kFrequency, sim::kPositive,
        "Rows at the times k/rate, and at the end. \"adaptive\": as many rows as the curves of the channels, drawn "
        "from the start to the end, need to be within about 0.2 % of the drawing's size, so that peaks are complete; "
        "on the flank of a collision that is short in this drawing, values between two rows may err by more. Two "
        "rows at one time are the sides of a jump. Without \"channels\" those of single modes and the separation do "
        "not count.",
        "adaptive");
    v.numbers("times", times, sim::dimension::kTime, kFromStart, {1}, "Rows at exactly these times, in this order.");
    v.exclusive("rate", "times");
    v.check([this](ObjectReader& r) {
        if (!times.empty()) check_end(r, "times", std::ranges::max(times));
        constexpr double kMostRows = 20'000'000;  // 160 MB for each channel
        const double count = rate.value_or(0) * r.context().scene.end_time;
        if (count > kMostRows)
            r.reject_value(r.place("rate"), "rate",
                           " gives {:.3g} rows, but a table has at most {:.3g}; reduce the rate", count, kMostRows);
    });
}

namespace {

std::string write_table(const DataSource& from, const sim::Table& table) {
    from.file ? output::write_table(*from.file, table) : output::write_csv(output::print_data, table);
    return counted(table.rows(), "row");
}

}  // namespace

void plan(Planner& planner, const TrajectoryOutput& table, const ResolvedOutput& resolved) {
    const Scene& scene = planner.scene();
    std::vector<sim::Channel> columns = table.channels.empty() ? all_channels(scene.problem) : table.channels;
    const sim::Channel t{sim::ChannelKind::t, 0};
    if (std::ranges::find(columns, t) == columns.end()) columns.insert(columns.begin(), t);
    constexpr int kPieces = 1000;    // of an adaptive table, each of which is halved where a curve needs it
    constexpr double kStray = 2e-3;  // of a channel's range: two pixels of a curve that is 1000 pixels high
    const bool adaptive = table.times.empty() && !table.rate;
    std::vector<double> instants =
        table.times.empty() ? rows(0, scene.end_time, table.rate.value_or(kPieces / scene.end_time)) : table.times;
    sim::Request& request = planner.run_until(*std::ranges::max_element(instants));
    DataFile data{resolved.index, table.file};
    data.content = adaptive ? "rows that follow the motion" : counted(instants.size(), "row");
    data.tables = {planner.add_table(std::move(instants), std::move(columns))};
    request.tables.back().adaptive = adaptive;
    request.tables.back().stray = kStray;
    if (table.times.empty()) request.tables.back().rate = table.rate;
    planner.add(std::move(data));
}

static std::string write(const TrajectoryOutput&, const DataFile& data, const DataSource& from) {
    return write_table(from, from.run.tables[data.tables.front()]);
}

// ---- "impacts": all impacts and collisions, as JSON or CSV.

void ImpactsOutput::visit(SceneVisitor& v) { visit_file(v, file, {".json", ".csv"}, "-impacts.json"); }

void plan(Planner& planner, const ImpactsOutput& impacts, const ResolvedOutput& resolved) {
    planner.run_until(run_end(planner.scene()));
    planner.add(DataFile{resolved.index, impacts.file});
}

static std::string write(const ImpactsOutput&, const DataFile&, const DataSource& from) {
    from.file ? output::write_impacts(*from.file, from.run) : output::print_json(output::impacts_json(from.run));
    return fmt::format("{} in {}", counted(from.run.impacts.size(), "impact"),
                       counted(from.run.collisions.size(), "collision"));
}

// ---- "state": a scene that continues the motion from an instant.

void StateOutput::visit(SceneVisitor& v) {
    visit_file(v, file, {".json"}, "-state.json");
    v.number("at", at, sim::dimension::kTime, kFromStart, "The instant; it is the time 0 of the scene in the file.");
    v.check([this](ObjectReader& r) { check_end(r, "at", at); });
}

void plan(Planner& planner, const StateOutput& state, const ResolvedOutput& resolved) {
    std::vector<double>& states = planner.run_until(state.at).states;
    DataFile data{resolved.index, state.file};
    data.index = states.size();
    states.push_back(state.at);
    planner.add(std::move(data));
}

static std::string write(const StateOutput& state, const DataFile& data, const DataSource& from) {
    Scene next;
    next.title = from.scene.title;
    next.units = from.scene.units;
    next.end_time = from.scene.end_time > state.at ? from.scene.end_time - state.at : from.scene.end_time;
    next.problem = from.run.states[data.index].value();
    const std::string json = to_json(next);
    from.file ? output::write_file(*from.file, json) : output::print_json(json);
    return fmt::format("state at {:g} s", state.at);
}

// ---- "summary": counts, extrema, energy balance and warnings of the run.

void SummaryOutput::visit(SceneVisitor& v) {
    visit_file(v, file, {".json"}, "-summary.json");
    v.value("channels", channels_format(channels),
            "Channels whose extrema are listed. By default theta, tip_deflection, contact_force, gap.");
    v.boolean("horizon", horizon,
              "Adds the intervals in which the motion is reproducible; needs a second run with tighter tolerances and "
              "another method.");
}

static std::vector<sim::Channel> extrema_channels(const SummaryOutput& summary) {
    using Kind = sim::ChannelKind;
    if (summary.channels.empty()) return {{Kind::theta}, {Kind::tip_deflection}, {Kind::contact_force}, {Kind::gap}};
    return summary.channels;
}

void plan(Planner& planner, const SummaryOutput& summary, const ResolvedOutput& resolved) {
    const Scene& scene = planner.scene();
    const double end = run_end(scene);
    sim::Request& request = planner.run_until(end);
    DataFile data{resolved.index, summary.file};
    for (const Measurement& each : scene.data) {
        sim::TableRequest table = each.within(0, end).request();
        data.tables.push_back(planner.add_table(std::move(table.times), std::move(table.channels)));
    }
    request.zero_crossings = true;
    request.horizon = request.horizon || summary.horizon || !scene.data.empty();
    for (const sim::Channel& channel : extrema_channels(summary))
        if (std::ranges::find(request.extrema, channel) == request.extrema.end()) request.extrema.push_back(channel);
    planner.add(std::move(data));
}

static std::string write(const SummaryOutput& summary, const DataFile& data, const DataSource& from) {
    const Scene& scene = from.scene;
    std::vector<output::ChannelExtremum> extrema;
    for (const sim::Channel& channel : extrema_channels(summary)) {
        const auto at = std::ranges::find(from.request.extrema, channel) - from.request.extrema.begin();
        extrema.push_back({channel, from.run.extrema.at(static_cast<std::size_t>(at))});
    }
    std::vector<output::Agreement> all;
    for (std::size_t i = 0; i < scene.data.size(); ++i)
        for (output::Agreement& each :
             agreements(scene.data[i].within(0, run_end(scene)), from.run.tables[data.tables[i]], from.run))
            all.push_back(std::move(each));
    const std::string json = output::summary_json(from.scene.problem, from.run, extrema, all);
    from.file ? output::write_file(*from.file, json) : output::print_json(json);
    return from.run.reproducibility;
}

// ---- "sweep": the samples of all points of the scene's sweep, as NetCDF-4, CSV or NPZ.

void SweepOutput::visit(SceneVisitor& v) {
    visit_file(v, file, {".nc", ".csv", ".npz"}, "-sweep.nc");
    v.check([](ObjectReader& r) {
        if (!r.context().scene.sweep && !r.diagnostics().any())
            r.reject_object("type", ": the scene has no key \"sweep\"; add it, or remove this output");
    });
}

void plan(Planner& planner, const SweepOutput& sweep, const ResolvedOutput& resolved) {
    planner.require_sweep(file_of(sweep), sweep.shard);
    planner.add(DataFile{resolved.index, file_of(sweep)});
}

static std::string write(const SweepOutput&, const DataFile&, const DataSource& from) {
    from.file ? output::write_sweep(*from.file, *from.sweep) : output::write_sweep_csv(output::print_data, *from.sweep);
    return counted(from.sweep->rows_in_all(), "row");
}

// ---- all types -----------------------------------------------------------------------------------

std::string write_data(const DataFile& data, const DataSource& from) {
    return std::visit(
        [&](const auto& each) -> std::string {
            if constexpr (requires { write(each, data, from); })
                return write(each, data, from);
            else
                throw std::logic_error("an output without numbers");
        },
        from.scene.outputs[data.output]);
}

}  // namespace beamcam::scenes
