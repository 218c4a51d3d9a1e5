// `beamcam sweep`: many motions over one or two keys of a scene.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <tuple>

#include "output/files/numbers.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/figures/figure_types.hpp"
#include "scenes/figures/sweeps.hpp"
#include "scenes/format/checks.hpp"
#include "scenes/format/file_column.hpp"
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
    std::optional<std::string> diagram, figure, value, caption;
    std::string column = "elsevier";
    Lang lang = Lang::en;
    std::optional<std::string> shard;
};

// "601" and "601n" are a number of values; "0.02", "2.0" and "2 rad/s" are a step. "1" is a step, too: a range has more
// than one value.
bool is_count(const std::string& text) {
    const bool digits = !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
    return text.ends_with('n') || (digits && text != "0" && text != "1");
}

// FIRST, LAST, and COUNT or STEP.
void set_range(SweptKey& over, const std::string& option, const std::vector<std::string>& parts,
               const Dimension& dimension) {
    std::string third = parts[2];
    const bool counted = is_count(third) || over.logarithmic;
    require_units(option, counted ? std::vector{parts[0], parts[1]} : std::vector{parts[0], parts[1], third});
    over.from = signed_argument(option, parts[0], dimension);
    over.to = signed_argument(option, parts[1], dimension);
    if (third.ends_with('n')) third.pop_back();
    const double step = counted ? 0 : signed_argument(option, third, dimension);
    const double count = counted ? output::number_in<int>(third).value_or(0)
                                 : 1 + std::floor((*over.to - *over.from) / step * (1 + 1e-12) + 1e-9);
    constexpr double kMost = 1e8;
    if (count > kMost && std::isfinite(count))
        throw UsageError(fmt::format("{}: {:.4g} values are too many; a key has at most {:g}", option, count, kMost));
    const double fewest = counted || over.from == over.to ? 1 : 2;  // a step within the range leads to a second value
    if (!(count >= fewest && count <= kMost))
        throw UsageError(fmt::format("{}: {} is not a {} from {} to {}", option, parts[2],
                                     counted ? "number of values" : "step", parts[0], parts[1]));
    if (!counted) over.to = *over.from + (count - 1) * step;  // a whole number of steps away
    over.count = static_cast<int>(count);
}

// KEY=FIRST:LAST:COUNT, then :log; KEY=FIRST:LAST:STEP; KEY=v,v,…; KEY=@FILE:COLUMN. Diagrams take over the unit.
SweptKey over_argument(const std::string& text, const sim::Problem& problem, render::Units& units) {
    const std::string option = "--over " + text;
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
        throw UsageError(option + ": write KEY=FIRST:LAST:COUNT, for example cam.speed=40:60:601");
    SweptKey over;
    over.key = text.substr(0, equals);
    std::string value = text.substr(equals + 1);
    const auto key = sim::number_key(problem, over.key);
    const Dimension dimension = key ? key->dimension : dimension::kNone;  // unknown keys are rejected later
    if (value.starts_with('@')) {
        const auto column = file_column_in(value);
        if (!column) throw UsageError(option + ": write KEY=@FILE.csv:COLUMN");
        std::tie(over.file, over.column) = *column;
        if (const std::string wrong = read_column(over, "", problem); !wrong.empty())
            throw UsageError(fmt::format("{}: {}", option, wrong));
        return over;
    }
    adopt_unit(value.substr(0, value.find_first_of(":,")), dimension, units);
    const std::vector<std::string> parts = split(value, ':');
    if (parts.size() == 1) {
        const std::vector<std::string> values = split(value, ',');
        require_units(option, values);
        for (const std::string& each : values) over.values.push_back(signed_argument(option, each, dimension));
        return over;
    }
    if (parts.size() == 4 && (parts[3] == "log" || parts[3] == "linear")) over.logarithmic = parts[3] == "log";
    if (parts.size() != 3 && !(parts.size() == 4 && (over.logarithmic || parts[3] == "linear")))
        throw UsageError(
            option +
            ": write KEY=FIRST:LAST:COUNT, with :log for logarithmic spacing, or KEY=FIRST:LAST:STEP as in 40:52:0.02");
    set_range(over, option, parts, dimension);
    return over;
}

// A digit that may have been meant as the other of count and step is explained.
void explain_range(const Common& common, const std::string& text, const SweptKey& over) {
    const std::string third = text.substr(text.rfind(':') + 1);
    if (third.size() != 1 || third < "1" || third > "9" || !over.count) return;
    inform(common, fmt::format("note: --over {}: {} values; {}", text, *over.count,
                               third == "1" ? "1 is a step, because a range has more than one value"
                                            : "whole numbers from 2 are a number of values, and a step has a decimal "
                                              "point"));
}

// The scene with the options in its sweep.
Scene with_sweep_options(Scene scene, const SweepArguments& args) {
    Sweep sweep = scene.sweep.value_or(Sweep{});
    if (!args.over.empty()) sweep.over.clear();
    for (const std::string& text : args.over) {
        sweep.over.push_back(over_argument(text, scene.problem, scene.units));
        explain_range(args.common, text, sweep.over.back());
    }
    const auto require = [](const char* option, const std::string& text, const std::string& problem) {
        if (!problem.empty()) throw UsageError(fmt::format("{} {}: {}", option, text, problem));
    };
    if (args.sample) require("--sample", *args.sample, parse_sample(*args.sample, scene.problem, sweep.sampling));
    if (args.seed) require("--seed", *args.seed, parse_seeds(*args.seed, sweep.seeds));
    if (args.transient) sweep.sampling.transient = span_argument("--transient", *args.transient);
    if (args.keep) sweep.sampling.keep = span_argument("--keep", *args.keep);
    if (args.exponents) sweep.sampling.exponents = true;
    for (const SweepProblem& problem : problems_of(sweep, scene.problem))
        throw UsageError(fmt::format("{}: {}", problem.key.starts_with("over") ? "--over" : problem.key, problem.text));
    scene.sweep = std::move(sweep);
    return scene;
}

void check_value(const SweepArguments& args, std::string_view diagram, const Scene& scene) {
    const std::string problem = problem_with_value(diagram, args.value.value_or(""), scene);
    if (!problem.empty()) throw UsageError(fmt::format("--value {}: {}", *args.value, problem));
}

// The files of the sweep as outputs of its scene.
std::vector<Output> outputs_of(const SweepArguments& args, const Scene& scene) {
    std::vector<Output> outputs;
    if (!args.file.empty() || !args.diagram) outputs.emplace_back(SweepOutput{args.file.empty() ? "-" : args.file});
    if (!args.diagram) return outputs;
    FigureOutput diagram;
    diagram.file = *args.diagram;
    diagram.figure = args.figure.value_or(usual_diagram(scene));
    if (const auto why = figure_type(diagram.figure)->refusal(scene))
        throw UsageError(fmt::format("--figure {}: {}", diagram.figure, *why));
    check_value(args, diagram.figure, scene);
    diagram.value = args.value.value_or("");
    diagram.column = args.column;
    diagram.lang = args.lang;
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
    if (args.figure) throw UsageError("--figure belongs to --diagram");
    if (args.value) throw UsageError("--value belongs to --diagram");
}

void act(const SweepArguments& args) {
    check_parts(args);
    reject_unused_options(args);
    if (!args.file.empty()) require_ending_or_stdout("-o", args.file, {".csv", ".npz", ".nc"});
    if (args.diagram) require_ending("--diagram", *args.diagram, kFigureEndings);
    if (args.caption) require_ending("--caption", *args.caption, kCaptionEndings);
    Scene scene = with_sweep_options(load_scene(args.scene, args.common), args);
    scene.set_outputs(outputs_of(args, scene));
    RunOptions options = run_options(args.common, "");
    if (args.shard) options.shard = shard_of(*args.shard, std::getenv);
    run_or_plan({&scene, 1}, options, args.common);
}

}  // namespace

void add_sweep(Grammar& grammar) {
    const auto [app, args] = grammar.command<SweepArguments>(
        "sweep", "Simulate many motions over one or two keys: samples, classes, diagrams", act);
    app.examples = {
        "sweep pressed.json --over cam.speed=40:60:601 -o sweep.csv --diagram bifurcation.pdf",
        "sweep pressed.json --over cam.speed=40:60:21 --sample peaks --value rebound_peak --diagram peaks.pdf",
        "sweep pressed.json --over cam.speed=40:60:601 -o sweep.csv --shard 2/8"};
    app.footer = "`beamcam init --from pressed` writes the scene of the examples.";
    add_scene(app, args.scene, args.common);
    app.option(
        "--over", &args.over, "KEY=VALUES",
        "The key to vary and its values: KEY=FIRST:LAST:COUNT (both ends included; add :log for logarithmic spacing), "
        "KEY=FIRST:LAST:STEP, KEY=v,v,... or KEY=@FILE.csv:COLUMN. A third number of digits only, 2 or more, is a "
        "COUNT; "
        "0.02, 2.0 and 1 are a STEP. A unit belongs to each number: 300rpm:600rpm:7. Twice for a grid");
    app.option(
        "--sample", &args.sample, "WHAT",
        "When to take samples: impacts, apexes, peaks (one of all: largest force, stress, gap …), section:cam_angle=A, "
        "section:CHANNEL=VALUE[:falling] (default: "
        "impacts)");
    app.option("--transient", &args.transient, "N",
               "Turns of the cam, or a time, before the first sample (default: 200)");
    app.option("--keep", &args.keep, "N", "Turns of the cam, or a time, in which samples are taken (default: 50)");
    app.option("--seed", &args.seed, "WHICH",
               "Initial states: same, carry-up, carry-down, carry-up,carry-down or random:N (default: same)");
    app.flag("--exponents", args.exponents,
             "Compute the largest Lyapunov exponent of each motion, too, which may show that it is chaotic");
    app.option("-o,--output", &args.file, "FILE",
               "Table of samples: .csv, .npz or .nc (NetCDF-4); without any file, CSV on standard output");
    app.option("--diagram", &args.diagram, "FILE", "Figure of the sweep: .pdf, .svg or .png");
    app.option("--figure", &args.figure, "NAME", "Kind of --diagram (default: depends on the swept keys)")
        .one_of(diagram_names());
    app.option(
        "--value,--ordinate", &args.value, "WHAT",
        "Quantity that --diagram shows. bifurcation, peaks: a column of the samples (default: v_n_before, "
        "theta, force_peak); map, basins: class (default), exponent, impacts_per_period, or the mean of a column");
    add_column(app, args.column);
    add_lang(app, args.lang);
    app.option("--caption", &args.caption, "FILE", "Write the caption of the figure, too: .txt or .md");
    app.option("--shard", &args.shard, "I/N",
               "Compute part I of N into a separate file: 2/3 writes NAME.2of3.points; `beamcam collect` joins the "
               "parts. auto: the part of this array task of Slurm");
    add_work(app, args.common);
}

}  // namespace beamcam::scenes
