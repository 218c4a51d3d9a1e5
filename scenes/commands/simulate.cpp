#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "scenes/commands/commands.hpp"
#include "scenes/format/source.hpp"
#include "scenes/format/suggest.hpp"
#include "scenes/outputs/run.hpp"
#include "scenes/plan/plan.hpp"
#include "scenes/scene/files.hpp"

namespace beamcam::scenes {
namespace {

struct SimulateArguments {
    Common common;
    std::string scene;
    std::optional<std::string> trajectory, shapes, impacts, summary, rate;
    std::vector<std::string> times, channels;
    bool horizon = false;
};

double positive_rate(const std::string& text, double rows_per_rate) {
    const double rate = quantity_argument("--rate", text, dimension::kFrequency);
    if (!(rate > 0)) throw UsageError("--rate must be positive");
    if (rate * rows_per_rate > 2e7) throw UsageError(fmt::format("--rate {}: more than 2e7 rows; lower it", text));
    return rate;
}

std::vector<double> instants_of(const SimulateArguments& args) {
    std::vector<double> times;
    for (const std::string& text : args.times) times.push_back(seconds_argument("--times", text));
    return times;
}

TrajectoryOutput trajectory_output(const SimulateArguments& args, const Scene& scene) {
    TrajectoryOutput table;
    table.file = args.trajectory.value_or("-");
    need_ending("--trajectory", table.file, {".csv", ".npz"});
    if (args.rate) table.rate = positive_rate(*args.rate, scene.end_time);
    table.times = instants_of(args);
    std::vector<std::string> known;
    const std::vector<sim::Channel> every = all_channels(scene.problem);
    for (const sim::Channel& channel : every) known.push_back(name(channel));
    for (const std::string& text : args.channels) {
        const auto found = std::find(known.begin(), known.end(), text);
        if (found == known.end())
            throw UsageError(fmt::format("--channels: {} is not a channel of this scene{}", in_quotes(text),
                                         suggestion_or_list(text, known)));
        const sim::Channel channel = every[static_cast<std::size_t>(found - known.begin())];
        if (std::find(table.channels.begin(), table.channels.end(), channel) != table.channels.end())
            throw UsageError(fmt::format("--channels: {} stands twice", text));
        table.channels.push_back(channel);
    }
    return table;
}

// With no file named, the table goes to standard output if its options were given, else the summary.
std::vector<Output> simulate_outputs(const SimulateArguments& args, const Scene& scene) {
    std::vector<Output> outputs;
    if (args.rate && !args.times.empty()) throw UsageError("--rate and --times exclude each other; keep one");
    const bool wants_table =
        args.trajectory || !args.channels.empty() || ((args.rate || !args.times.empty()) && !args.shapes);
    if (wants_table) outputs.push_back(trajectory_output(args, scene));
    if (args.shapes) {
        if (*args.shapes == "-") throw UsageError("--shapes -: name a file that ends in .csv or .npz");
        need_ending("--shapes", *args.shapes, {".csv", ".npz"});
        ShapesOutput shapes{*args.shapes};
        if (args.rate) shapes.rate = positive_rate(*args.rate, scene.end_time * shapes.stations);
        shapes.times = instants_of(args);
        outputs.push_back(shapes);
    }
    if (args.impacts) {
        need_ending("--impacts", *args.impacts, {".json", ".csv"});
        outputs.push_back(ImpactsOutput{*args.impacts});
    }
    if (args.summary || outputs.empty() || args.horizon) {
        const std::string file = args.summary.value_or("-");
        need_ending("--summary", file, {".json"});
        outputs.push_back(SummaryOutput{file, args.horizon});
    }
    const auto to_stdout =
        std::count_if(outputs.begin(), outputs.end(), [](const Output& o) { return file_of(o) == "-"; });
    if (to_stdout > 1) throw UsageError("more than one output would go to standard output; name files for the others");
    FileClaims claims;
    for (std::size_t i = 0; i < outputs.size(); ++i) claims.add(file_of(outputs[i]), i);
    for (const auto& clash : claims.clashes())
        throw UsageError(fmt::format("{} is named twice; give each output a file of its own", clash.later.file));
    return outputs;
}

int act(const SimulateArguments& args) {
    Scene scene = read_or_refuse(args.scene, args.common);
    scene.set_outputs(simulate_outputs(args, scene));
    const RunOptions options = run_options(args.common, "");
    run_or_plan({&scene, 1}, options, args.common);
    return 0;
}

}  // namespace

void add_simulate(Grammar& grammar) {
    auto args = std::make_shared<SimulateArguments>();
    Command& app = grammar.command("simulate", "Compute without pictures; with no option, print the summary");
    add_scene(app, args->scene, args->common);
    app.option("--trajectory", &args->trajectory, "FILE",
               "Table of channels, .csv or .npz; - is standard output (CSV)");
    app.option("--shapes", &args->shapes, "FILE", "Deflection along the beam in time, .csv or .npz");
    app.option("--rate", &args->rate, "HZ", "Rows or shapes a second (default: 1000)");
    app.option("--times", &args->times, "T,T,...", "Exactly these rows or shapes, in this order").separated_by(',');
    app.option("--channels", &args->channels, "CHANNEL,...", "Columns besides the time (default: all)")
        .separated_by(',');
    app.option("--impacts", &args->impacts, "FILE",
               "Impacts and collisions, .json or .csv; - is standard output (JSON)");
    app.option("--summary", &args->summary, "FILE", "Counts, extremes, energy balance, .json; - is standard output");
    app.flag("--horizon", args->horizon,
             "Report in the summary the intervals in which the motion is reproducible (further runs, tighter and by "
             "another method)");
    add_work(app, args->common);
    app.bind(args, act);
}

}  // namespace beamcam::scenes
