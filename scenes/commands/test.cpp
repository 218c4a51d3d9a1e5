// `beamcam test`: the regression test of a file of baselines.
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>

#include "output/data/manifest.hpp"
#include "output/files/atomic_file.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/regression/regression.hpp"
#include "scenes/regression/report.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

enum class Annotations { automatic, github, none };
constexpr sim::Named<Annotations> kAnnotations[] = {
    {Annotations::automatic, "auto"}, {Annotations::github, "github"}, {Annotations::none, "none"}};

struct TestArguments {
    Common common;
    std::string baselines;
    RegressionOptions test;  // those that options set directly
    std::vector<std::string> tolerance;
    std::optional<std::string> report, junit;
    Annotations annotate = Annotations::automatic;
};

constexpr sim::Named<NewRenderer> kOnNewRenderer[] = {
    {NewRenderer::fail, "fail"}, {NewRenderer::warn, "warn"}, {NewRenderer::accept, "accept"}};

RegressionOptions options_of(const TestArguments& args) {
    if (!args.test.update.empty() && !args.test.only.empty())
        throw UsageError("--update and --only exclude each other; --update runs only the entries that it names");
    if (!args.test.update.empty() && args.test.add_digest)
        throw UsageError(
            "--update and --add-digest exclude each other: one replaces the expected pictures, the other adds to them");
    RegressionOptions options = args.test;
    options.tolerance = tolerance_argument(args.tolerance);
    if (args.report) options.report = *args.report;
    options.run = run_options(args.common, "");
    return options;
}

// Before any work: throws if a file is in the way of a report.
void require_replaceable(const TestArguments& args, output::Manifest& manifest) {
    if (args.report) manifest.require_replaceable(fs::path(*args.report) / "index.html");
    if (args.junit) manifest.require_replaceable(*args.junit);
}

void write_reports(const TestArguments& args, const RegressionResult& result, const PassRule& rule,
                   output::Manifest& manifest) {
    const std::string title = fs::path(args.baselines).filename().string();
    if (args.junit)
        output::write_file(manifest.target(*args.junit), to_junit(result, fs::path(title).stem().string(), rule));
    if (args.report) {
        write_page(*args.report, result, title, rule, manifest);
        inform(args.common, fmt::format("wrote {}", (fs::path(*args.report) / "index.html").string()));
    }
    manifest.save();
}

// Annotations, and a table in the file to which the steps of GitHub Actions append their summaries.
void report_to_github(const TestArguments& args, const RegressionResult& result, const PassRule& rule) {
    const char* actions = std::getenv("GITHUB_ACTIONS");
    if (args.annotate == Annotations::none) return;
    if (args.annotate == Annotations::automatic && !(actions && *actions)) return;
    output::print_message("{}", to_annotations(result, rule));
    const char* summary = std::getenv("GITHUB_STEP_SUMMARY");
    if (!summary || !*summary) return;
    std::ofstream file(summary, std::ios::app);
    file << to_markdown(result, fs::path(args.baselines).filename().string(), rule);
    if (!file.flush()) throw output::IoError(fmt::format("cannot write {}, the summary of the step", summary));
}

// The patterns of --update, with `all` and `failed` resolved.
std::vector<std::string> entries_to_update(const TestArguments& args, RegressionOptions options) {
    if (args.test.update == std::vector<std::string>{"all"}) return {"*"};
    if (args.test.update != std::vector<std::string>{"failed"}) return args.test.update;
    options.update.clear();
    options.report.reset();
    std::vector<std::string> failed;
    for (const EntryResult& entry : test_regression(args.baselines, options).entries)
        if (!options.rule.passes(entry)) failed.push_back(entry.name);
    return failed;
}

void print_verdicts(const TestArguments& args, const RegressionResult& result) {
    print_result(args.common, to_json(result), to_text(result));
    std::map<Verdict, std::size_t> counts;
    for (const EntryResult& entry : result.entries) ++counts[entry.verdict()];
    const std::size_t new_renderer = counts[Verdict::new_renderer], not_run = counts[Verdict::not_run];
    inform(
        args.common,
        fmt::format("{}: {} identical, {} equivalent, {}{} different, {} missing{}; {}, {}, {:.2f} s",
                    counted(result.entries.size(), "entry"), counts[Verdict::identical], counts[Verdict::equivalent],
                    new_renderer > 0 ? fmt::format("{} new-renderer, ", new_renderer) : "", counts[Verdict::different],
                    counts[Verdict::missing], not_run > 0 ? fmt::format(", {} not-run", not_run) : "",
                    counted(result.simulations, "simulation"), counted(result.pictures, "picture"), result.seconds));
    if (result.changed)
        inform(args.common,
               fmt::format("{} was changed: check the pictures and motions that it accepts now before you keep it",
                           args.baselines));
}

int act(const TestArguments& args) {
    if (args.junit) require_ending("--junit", *args.junit, {".xml"});
    RegressionOptions options = options_of(args);
    output::Manifest manifest(args.common.force);
    require_replaceable(args, manifest);
    options.update = entries_to_update(args, options);
    if (options.update.empty() && !args.test.update.empty()) {
        inform(args.common, "no entry fails; nothing is updated");
        return kDone;
    }
    const RegressionResult result = test_regression(args.baselines, options);
    write_reports(args, result, options.rule, manifest);
    print_verdicts(args, result);
    report_to_github(args, result, options.rule);
    bool fine = !result.changed || (options.update.empty() && !args.test.add_digest);  // a change must be checked
    for (const EntryResult& entry : result.entries)
        if (entry.could_not_run()) return entry.exit_code;
    for (const EntryResult& entry : result.entries) fine = fine && options.rule.passes(entry);
    return fine ? kDone : kDiffers;
}

}  // namespace

void add_test(Grammar& grammar) {
    const auto [app, args] = grammar.command<TestArguments>("test",
                                                            "Run a regression test of pictures and motions; exit code "
                                                            "7 if any entry differs, 3, 5 or 6 if any could not run",
                                                            act);
    app.examples = {"test baselines.json --report report", "test baselines.json --update 'fall-*'"};
    app.positional("BASELINES", &args.baselines, "The file of baselines, JSON; - is standard input").required();
    app.option("--only,--filter", &args.test.only, "NAME...",
               "Test only these entries; patterns such as 'fall-*' are allowed")
        .several();
    app.option("--update", &args.test.update, "NAME...",
               "Replace the references of these entries by the present pictures and motions (exit code 7 if that "
               "changes any); patterns, all and failed are allowed")
        .several();
    app.flag("--add-digest", args.test.add_digest,
             "Accept the pictures of this machine in addition to the others, where they are equivalent, or where no "
             "picture of its libraries and fonts is accepted yet (exit code 7)");
    app.choice("--on-new-renderer", args.test.rule.new_renderer, kOnNewRenderer, "WHAT",
               "Verdict on pictures of libraries or fonts of which no picture is accepted yet: fail; warn: similar "
               "pictures pass; accept: they pass and are accepted (default: fail)");
    app.flag("--strict", args.test.rule.strict, "Fail entries that are only equivalent");
    app.option("--tolerance", &args.tolerance, "KEY=X,...",
               "Tolerances that replace those of the file: channel=2, share=1e-4, ssim=0.97, motion=2e-5, impacts=1e-4 "
               "(repeatable)")
        .separated_by(',');
    app.option("--report", &args.report, "DIR",
               "Directory for an HTML page with actual, expected and difference pictures");
    app.option("--junit", &args.junit, "FILE", "Write a JUnit report, .xml");
    app.choice("--annotate", args.annotate, kAnnotations, "SERVICE",
               "Print failures as annotations, and add a table to the summary of the step (default: auto: if "
               "GITHUB_ACTIONS is set)");
    add_jobs(app, args.common, "Largest number of threads that draw");
    add_progress(app, args.common);
    add_json(app, args.common);
    add_force(app, args.common);
    add_quiet(app, args.common);
}

}  // namespace beamcam::scenes
