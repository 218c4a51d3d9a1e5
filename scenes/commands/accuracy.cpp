#include "sim/studies/accuracy.hpp"

#include <fmt/format.h>

#include <optional>

#include "output/data/manifest.hpp"
#include "output/data/records.hpp"
#include "output/files/atomic_file.hpp"
#include "output/files/interrupt.hpp"
#include "render/plot/style.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/figures/accuracy.hpp"
#include "scenes/figures/figure_files.hpp"
#include "scenes/motions/progress.hpp"

namespace beamcam::scenes {
namespace {

struct AccuracyArguments {
    Common common;
    std::string scene;
    std::vector<std::string> files;
    std::optional<std::string> until, target;
    std::string column = "elsevier", lang = "en";
    int repeats = 5;
    double longest = 2;
};

std::string seconds_text(double seconds) {
    if (seconds <= 0) return "-";
    if (seconds < 1) return fmt::format("{:.3g} ms", 1e3 * seconds);
    return fmt::format("{:.3g} s", seconds);
}

std::string row_text(const std::string& head, const sim::AccuracyRow& row, bool truth = false) {
    if (!row.error) return fmt::format("  {:24} {}\n", head, row.note);
    return fmt::format(
        "  {:24} {:>9}  {:>8.4g} s  {:>10}  {:>9}  {:>9}  {:>7}  {}\n", head,
        truth ? "(truth)" : fmt::format("{:.1e}", *row.error), row.trusted_until, seconds_text(row.time.median),
        row.time.repeats > 1 ? fmt::format("±{:.0f} %", 50 * (row.time.high - row.time.low) / row.time.median) : "once",
        row.steps, row.impacts, row.touch_error ? fmt::format("{:.1e} s", *row.touch_error) : "other impacts");
}

std::string heading(const std::string& what, double target) {
    return fmt::format("\n{}\n  {:24} {:>9}  {:>10}  {:>10}  {:>9}  {:>9}  {:>7}  {}\n", what, "", "error/rad",
                       fmt::format("to {:.0e}", target), "run time", "spread", "steps", "impacts", "touch shift");
}

std::string report(const sim::Accuracy& a) {
    const char* angle = a.of_tip ? "tip deflection over length" : "theta";
    std::string text =
        fmt::format("{} of the first {:.4g} s of {:.4g} s: beyond that it is not reproducible at these settings\n",
                    angle, a.until, a.end_time);
    if (a.until >= a.end_time) text = fmt::format("{} of the whole {:.4g} s\n", angle, a.end_time);
    text += fmt::format("the reference (rk8, rtol 1e-13) is good to about {:.0e} rad\n", a.reference_error);
    text += heading("time integration: against the reference", a.target);
    for (const auto& row : a.work) text += row_text(fmt::format("{} {:.0e}", name(row.method), row.rtol), row);
    if (!a.modes.empty()) {
        text += heading(fmt::format("number of modes: against {}", a.most_modes), a.target);
        for (const auto& row : a.modes)
            text += row_text(fmt::format("{} {}", row.modes, row.modes == 1 ? "mode" : "modes"), row,
                             row.modes == a.most_modes);
    }
    if (!a.models.empty()) {
        text += heading(
            fmt::format("model of the beam: against {}, first {:.4g} s", name(a.best_model), a.models_until), a.target);
        for (const auto& row : a.models) text += row_text(name(row.model), row, row.model == a.best_model);
    }
    if (!a.contact.empty()) {
        text += heading("contact: what a change of the law moves", a.target);
        for (const auto& row : a.contact) text += row_text(row.change, row);
    }
    text += a.recommendation ? fmt::format("\n{}\n", a.recommendation->text)
                             : fmt::format("\nno settings tried give {} to {:g} rad\n", angle, a.target);
    return text;
}

bool is_picture(const std::string& file) { return file != "-" && !file.ends_with(".json"); }

// The diagram carries the scene, but no output makes it again: its times are of this machine and hour.
std::string diagram(const sim::Accuracy& found, Scene scene, const AccuracyArguments& args, const std::string& file) {
    FigureOutput how;
    how.file = file;
    how.figure = "accuracy";
    how.column = args.column;
    how.lang = args.lang == "zh" ? Lang::zh : Lang::en;
    scene.outputs.clear();
    return figure_files(accuracy_figure(found, scene.problem, how.lang), how, to_json(scene)).front().second;
}

int act(const AccuracyArguments& args) {
    const Scene scene = read_or_refuse(args.scene, args.common);
    sim::AccuracyRequest request;
    request.end_time = args.until ? seconds_argument("--until", *args.until) : scene.end_time;
    if (!(request.end_time > 0)) throw UsageError("--until must be positive");
    if (args.target) {
        request.target = quantity_argument("--target", *args.target, dimension::kAngle);
        if (!(request.target > 0)) throw UsageError("--target must be positive");
    }
    request.repeats = args.repeats;
    request.longest_run = args.longest;
    output::Manifest manifest(args.common.force);
    for (const std::string& file : args.files) {
        need_ending("-o", file, {".json", ".png", ".svg", ".pdf"});
        if (file != "-") manifest.require_replaceable(file);
    }
    const RunOptions options = run_options(args.common, "");
    Progress progress(options.progress);
    progress.begin("accuracy", 100, "%");
    const sim::Accuracy found = sim::assess(scene.problem, request, [&](const std::string&, double share) {
        progress.reach(100 * share);
        return !output::interrupted();
    });
    progress.end();
    bool data_printed = false;
    for (const std::string& file : args.files) {
        const std::string text = is_picture(file) ? diagram(found, scene, args, file) : output::accuracy_json(found);
        if (file == "-") {
            print_data(text);
            data_printed = true;
            continue;
        }
        output::write_file(manifest.target(file), text);
        say(args.common, "wrote " + file);
    }
    manifest.save();
    if (!data_printed) print_text(report(found));
    return 0;
}

}  // namespace

void add_accuracy(Grammar& grammar) {
    auto args = std::make_shared<AccuracyArguments>();
    Command& app = grammar.command("accuracy", "Error budget of a scene, and run time against error of every method");
    add_scene(app, args->scene, args->common);
    app.option("-o,--output", &args->files, "FILE", "Also as .json, or the diagram as .png, .svg or .pdf (repeatable)");
    app.option("--until", &args->until, "T", "Look at the motion up to here (default: the end of the scene)");
    app.option("--target", &args->target, "RAD",
               "Error that the recommendation is for, in rad: of theta; of a driven hub, of the tip's deflection over "
               "the length (default: 1e-4)");
    app.option("--repeats", &args->repeats, "N", "Timings of each row (default: 5)").range(1, 1000);
    app.option("--longest", &args->longest, "S", "Leave out runs that take longer than this many seconds (default: 2)")
        .positive();
    app.option("--column", &args->column, "COLUMN", "Width and letters of a journal's column, for the diagram")
        .one_of(render::figure::column_names());
    app.option("--lang", &args->lang, "LANG", "Language of the diagram: en or zh").one_of({"en", "zh"});
    app.option("--progress", &args->common.progress, "STYLE",
               "Progress on standard error: auto, bar, plain, json or none");
    app.flag("--force", args->common.force, "Replace files that beamcam did not make");
    app.bind(args, act);
}

}  // namespace beamcam::scenes
