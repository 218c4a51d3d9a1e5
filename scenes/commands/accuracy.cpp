// `beamcam accuracy`: the error budget of a scene.
#include "sim/studies/accuracy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "output/data/records.hpp"
#include "scenes/commands/result_files.hpp"
#include "scenes/figures/command_figures.hpp"
#include "scenes/format/suggest.hpp"
#include "scenes/format/value_formats.hpp"
#include "scenes/motions/progress.hpp"
#include "sim/studies/peak_budget.hpp"

namespace beamcam::scenes {
namespace {

constexpr double kPeakRuns = 10;  // time limit of each variant of --of, in longest runs: there are few

struct AccuracyArguments {
    Common common;
    std::string scene;
    ResultFiles files;
    std::optional<std::string> until, target, longest, of;
    sim::AccuracyRequest request;
};

std::string seconds_text(double seconds) {
    if (seconds <= 0) return "-";
    if (seconds < 1) return fmt::format("{:.3g} ms", 1e3 * seconds);
    return fmt::format("{:.3g} s", seconds);
}

std::string row_text(const std::string& head, const sim::AccuracyRow& row, bool is_reference = false) {
    if (!row.error) return fmt::format("  {:24} {}\n", head, row.note);
    return fmt::format(
        "  {:24} {:>9}  {:>8.4g} s  {:>10}  {:>9}  {:>9}  {:>7}  {}\n", head,
        is_reference ? "reference" : fmt::format("{:.1e}", *row.error), row.trusted_until,
        seconds_text(row.time.median),
        row.time.repeats > 1 ? fmt::format("±{:.0f} %", 50 * (row.time.high - row.time.low) / row.time.median) : "once",
        row.steps, row.impacts, row.touch_error ? fmt::format("{:.1e} s", *row.touch_error) : "other impacts");
}

std::string heading(const std::string& title, double target) {
    return fmt::format("\n{}\n  {:24} {:>9}  {:>10}  {:>10}  {:>9}  {:>9}  {:>7}  {}\n", title, "", "error/rad",
                       fmt::format("to {:.0e}", target), "run time", "spread", "steps", "impacts", "touch shift");
}

std::string accuracy_text(const sim::Accuracy& a) {
    const char* angle = a.of_tip ? "tip deflection over length" : "theta";
    std::string text = a.until >= a.end_time ? fmt::format("{} over the whole {:.4g} s\n", angle, a.end_time)
                                             : fmt::format(
                                                   "{} over the first {:.4g} s of {:.4g} s: after that the motion is "
                                                   "not reproducible with these settings\n",
                                                   angle, a.until, a.end_time);
    text += fmt::format("error of the reference ({}, rtol 1e-13): about {:.0e} rad\n", sim::name(a.reference_method),
                        a.reference_error);
    text += heading("time integration: against the reference", a.target);
    for (const auto& row : a.work) text += row_text(fmt::format("{} {:.0e}", name(row.method), row.rtol), row);
    if (!a.modes.empty()) {
        text += heading(fmt::format("number of modes: against {}", a.most_modes), a.target);
        for (const auto& row : a.modes)
            text += row_text(fmt::format("{} {}", row.modes, row.modes == 1 ? "mode" : "modes"), row,
                             row.modes == a.most_modes);
    }
    if (!a.models.empty()) {
        text += heading(fmt::format("beam model: against {}, first {:.4g} s", name(a.best_model), a.models_until),
                        a.target);
        for (const auto& row : a.models) text += row_text(name(row.model), row, row.model == a.best_model);
    }
    if (!a.contact.empty()) {
        text += heading("contact: effect of changes of the law", a.target);
        for (const auto& row : a.contact) text += row_text(row.change, row);
    }
    return text + (a.recommendation
                       ? fmt::format("\n{}\n", a.recommendation->text)
                       : fmt::format("\nno settings that were tried give {} to {:g} rad\n", angle, a.target));
}

sim::AccuracyRequest request_of(const AccuracyArguments& args, const Scene& scene) {
    sim::AccuracyRequest request = args.request;
    request.end_time = args.until ? positive_argument("--until", *args.until, dimension::kTime) : scene.end_time;
    if (args.target) request.target = positive_argument("--target", *args.target, dimension::kAngle);
    if (args.longest) request.longest_run = positive_argument("--longest", *args.longest, dimension::kTime);
    return request;
}

std::string peak_text(const sim::PeakBudget& budget, const std::string& unit) {
    std::string text = fmt::format("{} to {:.4g} s: largest {:.5g} {} at {:.6g} s\n", name(budget.channel),
                                   budget.end_time, budget.peak, unit, budget.t);
    for (const sim::PeakRow& row : budget.rows)
        text += row.peak ? fmt::format("  {:24} {:>12.5g} {}  {:>+8.2g} %  at {:.6g} s\n", row.change, *row.peak, unit,
                                       100 * relative_change(budget, row), row.t)
                         : fmt::format("  {:24} {}\n", row.change, row.note);
    return text + "\n" + budget.recommendation + "\n";
}

// How sure the largest value of one channel is.
int assess_peak(const AccuracyArguments& args, const Scene& scene, const sim::AccuracyRequest& request) {
    const std::vector<std::string> known = channel_names(all_channels(scene.problem));
    if (std::ranges::find(known, *args.of) == known.end())
        throw UsageError(
            fmt::format("--of {}: it is not a channel of this scene{}", *args.of, suggestion_or_list(*args.of, known)));
    const sim::Channel channel = *sim::channel_named(*args.of);
    if (traits(channel.kind).needs_cam && !scene.problem.cam)
        throw UsageError(fmt::format("--of {}: it has no values without a cam", *args.of));
    output::FileList file_list(args.common.force);
    require_writable("-o", args.files.names, {".json"}, file_list);
    Progress progress(progress_style(args.common));
    progress.begin("accuracy", 100, "%");
    const sim::PeakBudget found =
        sim::peak_budget(scene.problem, channel, request.end_time, kPeakRuns * request.longest_run,
                         [&](double share) { return progress.reach(100 * share); });
    progress.end();
    const std::string unit = sim::unit(channel, scene.problem);
    return write_result({[&] { return output::peak_json(found, unit); }, [&] { return peak_text(found, unit); }, {}},
                        args.files, scene, args.common, file_list);
}

int act(const AccuracyArguments& args) {
    const Scene scene = load_scene(args.scene, args.common);
    const sim::AccuracyRequest request = request_of(args, scene);
    if (args.of) return assess_peak(args, scene, request);
    output::FileList file_list(args.common.force);
    require_writable("-o", args.files.names, {".json", ".png", ".svg", ".pdf"}, file_list);
    Progress progress(progress_style(args.common));
    progress.begin("accuracy", 100, "%");
    const sim::Accuracy found =
        sim::assess(scene.problem, request, [&](double share) { return progress.reach(100 * share); });
    progress.end();
    return write_result({[&] { return output::accuracy_json(found); }, [&] { return accuracy_text(found); },
                         [&] { return accuracy_figure(found, subject_of(scene, args.files.lang)); }},
                        args.files, scene, args.common, file_list);
}

}  // namespace

void add_accuracy(Program& program) {
    const auto [app, args] = add_command<AccuracyArguments>(
        program, "accuracy", "Compute the error budget of a scene, and error against run time", act);
    add_examples(app, {"accuracy fall.json --until 0.3 --repeats 1 --target 1e-5 -o budget.pdf",
                       "accuracy fall.json --of contact_force"});
    add_scene(app, args.scene, args.common);
    add_result_options(app, args.files, args.common,
                       "Write the result, too: .json, or the diagram as .png, .svg or .pdf (repeatable)");
    add_option(app, "--until", args.until, "T", "Assess the motion up to this time (default: the end of the scene)");
    add_option(
        app, "--target", args.target, "ANGLE",
        "Error for which settings are recommended: of theta; of a driven hub, of the tip deflection over the length "
        "(default: 1e-4 rad)");
    add_option(app, "--of", args.of, "CHANNEL",
               "Assess the largest value of this channel instead, such as contact_force or stress_max: its change with "
               "modes, model, tolerance and contact");
    within(add_option(app, "--repeats", args.request.repeats, "N", "Timings of each row (default: 5)"), 1, 1000);
    add_option(app, "--longest", args.longest, "T", "Leave out runs that take longer than this (default: 2 s)");
}

}  // namespace beamcam::scenes
