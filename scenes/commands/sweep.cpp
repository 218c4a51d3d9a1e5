// `beamcam sweep`: many motions over one or two keys of a scene.
#include <fmt/format.h>

#include <cstdlib>

#include "scenes/commands/key_options.hpp"
#include "scenes/figures/sweeps.hpp"
#include "scenes/format/checks.hpp"
#include "scenes/format/overrides.hpp"
#include "scenes/format/sweep_keys.hpp"
#include "scenes/scene/files.hpp"
#include "scenes/sweep/parts.hpp"
#include "sim/problem/number_keys.hpp"

namespace beamcam::scenes {
namespace {

struct SweepArguments {
    Common common;
    std::string scene, file;
    std::vector<std::string> over;
    std::optional<std::string> sample, transient, keep, seed;
    bool exponents = false;
    std::optional<std::string> diagram, caption, shard;
    KeyOptions keys{"figure"};  // of the diagram
};

// The entry of "over" that the option stands for: KEY=FIRST:LAST:COUNT, then :log; KEY=v,v,…; KEY=@FILE:COLUMN.
Node over_node(const std::string& text) {
    const std::string option = "--over " + text;
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
        throw UsageError(option + ": write KEY=FIRST:LAST:COUNT, for example cam.speed=40:60:601");
    const std::string value = text.substr(equals + 1);
    Node over = object_node({{"key", text.substr(0, equals)}});
    if (value.starts_with('@')) {
        add(over, "values", value);
        return over;
    }
    const std::vector<std::string> parts = split(value, ':');
    if (parts.size() == 1) {
        const std::vector<std::string> values = split(value, ',');
        require_units(option, values);
        add(over, "values", array_node(values, value_node));
        return over;
    }
    const bool logarithmic = parts.size() == 4 && parts[3] == "log";
    if (parts.size() != 3 && !logarithmic)
        throw UsageError(option + ": write KEY=FIRST:LAST:COUNT, with :log for logarithmic spacing");
    require_units(option, {parts[0], parts[1]});
    add(over, "from", value_node(parts[0])), add(over, "to", value_node(parts[1]));
    add(over, "count", value_node(parts[2]));
    if (logarithmic) add(over, "spacing", "log");
    return over;
}

// Diagrams take over the unit of the first value.
void adopt_unit_of(const std::string& over, Scene& scene) {
    const std::size_t equals = over.find('=');
    const auto key = sim::number_key(scene.problem, over.substr(0, equals));
    const std::string value = over.substr(equals + 1);
    if (key) adopt_unit(value.substr(0, value.find_first_of(":,")), key->dimension, scene.units);
}

// The scene with the options in its sweep.
Scene with_sweep_options(Scene scene, const SweepArguments& args) {
    if (args.over.empty() && !scene.sweep)
        throw UsageError("--over: no key varies; write for example cam.speed=40:52:601");
    if (args.transient || args.keep) scene.sweep = scene.sweep.value_or(Sweep{});
    if (args.transient) scene.sweep->sampling.transient = span_argument("--transient", *args.transient);
    if (args.keep) scene.sweep->sampling.keep = span_argument("--keep", *args.keep);
    Node keys = sweep_tree(scene);
    const auto set = [&keys](const char* key, Node value) {
        remove(keys, key);
        add(keys, key, std::move(value));
    };
    if (!args.over.empty()) set("over", array_node(args.over, over_node));
    if (args.sample) set("sample", *args.sample);
    if (args.seed) set("seed", *args.seed);
    if (args.exponents) set("exponents", true);
    for (const std::string& over : args.over) adopt_unit_of(over, scene);
    const std::string problem = read_sweep(keys, scene);
    for (std::size_t i = 0; i < args.over.size(); ++i)
        if (const std::string path = fmt::format("sweep.over.{}.", i); problem.starts_with(path))
            throw UsageError(fmt::format("--over {}: {}", args.over[i], problem.substr(path.size())));
    if (!problem.empty()) throw UsageError(problem);
    return scene;
}

// The files of the sweep as outputs of its scene.
std::vector<Output> outputs_of(const SweepArguments& args, const Scene& scene) {
    std::vector<Output> outputs;
    if (!args.file.empty() || !args.diagram)
        outputs.emplace_back(SweepOutput{args.file.empty() ? "-" : args.file,
                                         args.shard ? shard_of(*args.shard, std::getenv) : Shard()});
    if (!args.diagram) return outputs;
    auto diagram = std::get<FigureOutput>(
        read_output(object_node({{"type", FigureOutput::kType}, {"figure", usual_diagram(scene)}}), {&args.keys}, scene,
                    args.scene, args.common));
    diagram.file = *args.diagram;
    diagram.caption_file = args.caption.value_or("");
    outputs.emplace_back(std::move(diagram));
    return outputs;
}

// `collect` makes the files of a whole sweep from its parts.
void check_parts(const SweepArguments& args) {
    if (!args.shard) return;
    if (args.file.empty() || is_stdout(args.file))
        throw UsageError("--shard: name the table of the whole sweep with -o; a part of r.csv is r.2of3.points");
    if (args.diagram) throw UsageError("--diagram: a part has no diagram; collect the parts first");
}

void reject_unused_options(const SweepArguments& args) {
    if (args.diagram) return;
    if (args.caption) throw UsageError("--caption belongs to --diagram");
    for (const auto& [option, key] : args.keys.given())
        throw UsageError(fmt::format("{} belongs to --diagram", option));
}

void act(const SweepArguments& args) {
    check_parts(args);
    reject_unused_options(args);
    if (!args.file.empty()) require_ending_or_stdout("-o", args.file, {".csv", ".npz", ".nc"});
    if (args.diagram) require_ending("--diagram", *args.diagram, kFigureEndings);
    if (args.caption) require_ending("--caption", *args.caption, kCaptionEndings);
    Scene scene = with_sweep_options(load_scene(args.scene, args.common), args);
    scene.set_outputs(outputs_of(args, scene));
    run_or_plan({&scene, 1}, run_options(args.common, ""), args.common);
}

}  // namespace

void add_sweep(Program& program) {
    const auto [app, args] = add_command<SweepArguments>(
        program, "sweep", "Simulate many motions over one or two keys: samples, classes, diagrams", act);
    add_examples(
        app, {"sweep pressed.json --over cam.speed=40:60:601 -o sweep.csv --diagram bifurcation.pdf",
              "sweep pressed.json --over cam.speed=40:60:21 --sample peaks --value rebound_peak --diagram peaks.pdf",
              "sweep pressed.json --over cam.speed=40:60:601 -o sweep.csv --shard 2/8"});
    add_note(app, "`beamcam init --from pressed` writes the scene of the examples.");
    add_scene(app, args.scene, args.common);
    add_option(
        app, "--over", args.over, "KEY=VALUES",
        "The key to vary and its values: KEY=FIRST:LAST:COUNT (both ends included; add :log for logarithmic spacing), "
        "KEY=v,v,... or KEY=@FILE.csv:COLUMN. A unit belongs to each number: 300rpm:600rpm:7. Twice for a grid");
    add_option(
        app, "--sample", args.sample, "WHAT",
        "When to take samples: impacts, apexes, peaks (one of all: largest force, stress, gap …), section:cam_angle=A, "
        "section:CHANNEL=VALUE[:falling] (default: "
        "impacts)");
    add_option(app, "--transient", args.transient, "N",
               "Turns of the cam, or a time, before the first sample (default: 200)");
    add_option(app, "--keep", args.keep, "N", "Turns of the cam, or a time, in which samples are taken (default: 50)");
    add_option(app, "--seed", args.seed, "WHICH",
               "Initial states: same, carry-up, carry-down, carry-up,carry-down or random:N (default: same)");
    app.add_flag("--exponents", args.exponents,
                 "Compute the largest Lyapunov exponent of each motion, too, which may show that it is chaotic");
    add_option(app, "-o,--output", args.file, "FILE",
               "Table of samples: .csv, .npz or .nc (NetCDF-4); without any file, CSV on standard output");
    add_option(app, "--diagram", args.diagram, "FILE", "Figure of the sweep: .pdf, .svg or .png");
    one_of(args.keys.add(app, "--figure", "figure", "NAME")
               ->description("Kind of --diagram (default: depends on the swept keys)"),
           diagram_names());
    args.keys.add(app, "--value", "value", "WHAT", "Of --diagram.");
    args.keys.add(app, "--column", "column", "COLUMN", "Of --diagram.");
    args.keys.add(app, "--lang", "lang", "LANG", "Of --diagram.");
    add_option(app, "--caption", args.caption, "FILE", "Write the caption of the figure, too: .txt or .md");
    add_option(app, "--shard", args.shard, "I/N",
               "Compute part I of N into a separate file: 2/3 writes NAME.2of3.points; `beamcam collect` joins the "
               "parts. auto: the part of this array task of Slurm");
    add_work(app, args.common);
}

}  // namespace beamcam::scenes
