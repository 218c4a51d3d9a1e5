// `beamcam simulate`: tables, impacts and the summary of a motion, without pictures.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "scenes/commands/key_options.hpp"
#include "scenes/format/keys.hpp"
#include "scenes/outputs/run.hpp"
#include "scenes/scene/files.hpp"

namespace beamcam::scenes {
namespace {

struct SimulateArguments {
    Common common;
    std::string scene;
    std::optional<std::string> trajectory, impacts, summary, state;
    KeyOptions rows{"trajectory"}, channels{"trajectory"}, state_at{"state"};
    bool horizon = false;
};

TrajectoryOutput trajectory_output(const SimulateArguments& args, const Scene& scene) {
    const std::string file = args.trajectory.value_or("-");
    require_ending_or_stdout("--trajectory", file, {".csv", ".npz"});
    auto table = std::get<TrajectoryOutput>(read_output(object_node({{"type", TrajectoryOutput::kType}}),
                                                        {&args.rows, &args.channels}, scene, args.scene, args.common));
    table.file = file;
    return table;
}

StateOutput state_output(const SimulateArguments& args, const Scene& scene) {
    const std::string file = args.state.value_or("-");
    if (!args.state_at.any())
        throw UsageError(
            fmt::format("-o {0}: it is the file of --state-at; {1} {0}", file,
                        ending_of(file) == ".json" ? "a summary is --summary" : "a table is --trajectory"));
    require_ending_or_stdout("-o", file, {".json"});
    auto state = std::get<StateOutput>(
        read_output(object_node({{"type", StateOutput::kType}}), {&args.state_at}, scene, args.scene, args.common));
    state.file = file;
    return state;
}

SummaryOutput summary_output(const SimulateArguments& args, const Scene& scene) {
    const std::string file = args.summary.value_or("-");
    require_ending_or_stdout("--summary", file, {".json"});
    auto summary = std::get<SummaryOutput>(
        read_output(object_node({{"type", SummaryOutput::kType}}), {&args.channels}, scene, args.scene, args.common));
    summary.file = file;
    summary.horizon = args.horizon;
    return summary;
}

// Without a file name the table goes to standard output if its options were given, else the summary.
std::vector<Output> simulate_outputs(const SimulateArguments& args, const Scene& scene) {
    std::vector<Output> outputs;
    const bool has_rows = args.rows.any(), has_summary = args.summary || args.horizon;
    if (args.trajectory || has_rows || (args.channels.any() && !has_summary))
        outputs.push_back(trajectory_output(args, scene));
    if (args.impacts) {
        require_ending_or_stdout("--impacts", *args.impacts, {".json", ".csv"});
        outputs.push_back(ImpactsOutput{*args.impacts});
    }
    if (args.state || args.state_at.any()) outputs.push_back(state_output(args, scene));
    if (has_summary || outputs.empty()) outputs.push_back(summary_output(args, scene));
    return outputs;
}

void require_one_on_stdout(const std::vector<Output>& outputs) {
    const auto to_stdout = std::ranges::count_if(outputs, [](const Output& o) { return is_stdout(file_of(o)); });
    if (to_stdout > 1) throw UsageError("more than one output would go to standard output; name files for the others");
}

void act(const SimulateArguments& args) {
    Scene scene = load_scene(args.scene, args.common);
    std::vector<Output> outputs = simulate_outputs(args, scene);
    require_one_on_stdout(outputs);
    scene.set_outputs(std::move(outputs));
    run_or_plan({&scene, 1}, run_options(args.common, ""), args.common);
}

}  // namespace

void add_simulate(Program& program) {
    const auto [app, args] = add_command<SimulateArguments>(
        program, "simulate", "Compute a motion without pictures; without options, print the summary", act);
    add_examples(app, {"simulate fall.json --trajectory fall.csv --channels theta,contact_force --rate 500",
                       "simulate fall.json --impacts impacts.json --summary -",
                       "simulate fall.json --state-at 0.45 -o later.json"});
    add_scene(app, args.scene, args.common);
    add_option(app, "--trajectory", args.trajectory, "FILE",
               "Table of channels against time, .csv or .npz; - is standard output (CSV)");
    args.rows.add(app, "--rate", "rate", "HZ", "Of --trajectory (default: adaptive).");
    args.rows.add_list(app, "--times", "times", "T,T,...", "In place of --rate.");
    args.channels.add_list(app, "--channels", "channels", "CHANNEL,...",
                           "Of --trajectory, and of --summary those with extrema.");
    add_option(app, "--impacts", args.impacts, "FILE",
               "Impacts and collisions, .json or .csv; - is standard output (JSON)");
    args.state_at.add(app, "--state-at", "at", "T", "Write a scene that continues the motion.");
    add_option(app, "-o,--output", args.state, "FILE", "File of --state-at, .json (default: standard output)");
    add_option(app, "--summary", args.summary, "FILE",
               "Counts, extreme values and energy balance, .json; - is standard output");
    app.add_flag(
        "--horizon", args.horizon,
        "Add to the summary the intervals in which the motion is reproducible; this takes a second run, with a "
        "tighter tolerance and with another method");
    add_work(app, args.common);
}

}  // namespace beamcam::scenes
