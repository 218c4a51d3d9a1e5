#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>

#include "output/data/manifest.hpp"
#include "output/files/atomic_file.hpp"
#include "scenes/commands/cli.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/regression/regression.hpp"
#include "scenes/regression/report.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

struct TestArguments {
    Common common;
    std::string baselines;
    std::vector<std::string> update, only, tolerance;
    std::optional<std::string> report, junit;
    std::string on_new_renderer = "fail", annotate = "auto";
    bool add_digest = false, strict = false;
};

const std::map<std::string, NewRenderer> kOnNewRenderer = {
    {"fail", NewRenderer::fail}, {"warn", NewRenderer::warn}, {"accept", NewRenderer::accept}};

RegressionOptions options_of(const TestArguments& args) {
    if (!args.update.empty() && !args.only.empty())
        throw UsageError("--update and --only exclude each other; --update runs nothing but what it names");
    if (!args.update.empty() && args.add_digest)
        throw UsageError(
            "--update and --add-digest exclude each other: one replaces what is expected, the other adds to it");
    RegressionOptions options;
    options.only = args.only;
    options.update = args.update;
    options.add_digest = args.add_digest;
    options.rule.strict = args.strict;
    options.rule.new_renderer = kOnNewRenderer.at(args.on_new_renderer);
    for (const std::string& text : args.tolerance) apply_tolerance(options.tolerance, text);
    if (args.report) options.report = *args.report;
    options.run = run_options(args.common, "");
    return options;
}

// Refused before any work if it stands in the way.
void need_room(const TestArguments& args, output::Manifest& manifest) {
    if (args.report) manifest.require_replaceable(fs::path(*args.report) / "index.html");
    if (args.junit) manifest.require_replaceable(*args.junit);
}

void write_own(output::Manifest& manifest, const fs::path& file, const std::string& text) {
    output::write_file(manifest.target(file), text);
}

void write_reports(const TestArguments& args, const RegressionResult& result, const PassRule& rule,
                   output::Manifest& manifest) {
    const std::string title = fs::path(args.baselines).filename().string();
    if (args.junit) write_own(manifest, *args.junit, to_junit(result, fs::path(title).stem().string(), rule));
    if (args.report) {
        write_page(*args.report, result, title, rule, manifest);
        say(args.common, fmt::format("wrote {}", (fs::path(*args.report) / "index.html").string()));
    }
    manifest.save();
}

// GitHub Actions names a file to which steps append their summaries.
void tell_github(const TestArguments& args, const RegressionResult& result, const PassRule& rule) {
    const char* actions = std::getenv("GITHUB_ACTIONS");
    if (args.annotate == "none" || (args.annotate == "auto" && !(actions && *actions))) return;
    output::print_message("{}", to_annotations(result, rule));
    const char* summary = std::getenv("GITHUB_STEP_SUMMARY");
    if (!summary || !*summary) return;
    std::ofstream file(summary, std::ios::app);
    file << to_markdown(result, fs::path(args.baselines).filename().string(), rule);
    if (!file.flush()) throw output::IoError(fmt::format("cannot write {}, the summary of the step", summary));
}

// Names in place of the words `all` and `failed`.
std::vector<std::string> to_update(const TestArguments& args, RegressionOptions options) {
    if (args.update == std::vector<std::string>{"all"}) return {"*"};
    if (args.update != std::vector<std::string>{"failed"}) return args.update;
    options.update.clear();
    options.report.reset();
    std::vector<std::string> failed;
    for (const EntryResult& entry : test_regression(args.baselines, options).entries)
        if (!options.rule.passes(entry)) failed.push_back(entry.name);
    return failed;
}

void tell(const TestArguments& args, const RegressionResult& result, const PassRule& rule) {
    if (args.common.json)
        print_json(to_json(result));
    else
        print_text(to_text(result, rule, args.common.quiet));
    std::map<Verdict, std::size_t> counts;
    for (const EntryResult& entry : result.entries) ++counts[entry.verdict()];
    const std::size_t of_new_renderer = counts[Verdict::new_renderer];
    say(args.common,
        fmt::format("{} entries: {} identical, {} equivalent, {}{} different, {} missing; {} simulations, {} pictures, "
                    "{:.2f} s",
                    result.entries.size(), counts[Verdict::identical], counts[Verdict::equivalent],
                    of_new_renderer > 0 ? fmt::format("{} of a new renderer, ", of_new_renderer) : "",
                    counts[Verdict::different], counts[Verdict::missing], result.simulations, result.pictures,
                    result.seconds));
    if (result.changed)
        say(args.common, fmt::format("{} was changed: look at what it accepts now, and keep it only if it is right",
                                     args.baselines));
}

int act(const TestArguments& args) {
    RegressionOptions options = options_of(args);
    output::Manifest manifest(args.common.force);
    need_room(args, manifest);
    options.update = to_update(args, options);
    if (options.update.empty() && !args.update.empty()) {
        say(args.common, "no entry fails; nothing is updated");
        return kDone;
    }
    const RegressionResult result = test_regression(args.baselines, options);
    write_reports(args, result, options.rule, manifest);
    tell(args, result, options.rule);
    tell_github(args, result, options.rule);
    bool fine = !result.changed || (options.update.empty() && !args.add_digest);  // for somebody to look
    for (const EntryResult& entry : result.entries)
        if (entry.exit_code != 0 && entry.exit_code != kDiffers) return entry.exit_code;
    for (const EntryResult& entry : result.entries) fine = fine && options.rule.passes(entry);
    return fine ? kDone : kDiffers;
}

}  // namespace

void add_test(Grammar& grammar) {
    auto args = std::make_shared<TestArguments>();
    Command& app = grammar.command(
        "test", "Render and simulate again what a file of baselines lists; ends with 7 when something differs");
    app.positional("BASELINES", &args->baselines, "The baselines, a JSON file; - is standard input").required();
    app.option("--only,--filter", &args->only, "NAME...", "Test these entries only; patterns such as 'fall-*' too")
        .several();
    app.option("--update", &args->update, "NAME...",
               "Replace what these entries expect by what they are now (ends with 7, for somebody to look); patterns "
               "too, and the words all and failed")
        .several();
    app.flag("--add-digest", args->add_digest,
             "Accept the digests of this machine beside the others, where pictures are equivalent, or where nothing is "
             "accepted yet of its libraries and fonts (ends with 7)");
    app.option("--on-new-renderer", &args->on_new_renderer, "WHAT",
               "Pictures of libraries or fonts of which nothing is accepted yet: fail, warn (they pass when they look "
               "alike), accept (their digests, from now on) (default: fail)")
        .one_of({"fail", "warn", "accept"});
    app.flag("--strict", args->strict, "What is only equivalent fails too");
    app.option("--tolerance", &args->tolerance, "KEY=X,...",
               "Over those of the file: channel=2, share=1e-4, ssim=0.97, motion=2e-5, impacts=1e-4 (repeatable)")
        .separated_by(',');
    app.option("--report", &args->report, "DIR", "Folder for a page with actual and difference pictures");
    app.option("--junit", &args->junit, "FILE", "Report for continuous integration, .xml");
    app.option("--annotate", &args->annotate, "SERVICE",
               "Tell failures as annotations, and a table as the step's summary: auto, github or none (default: auto, "
               "where GITHUB_ACTIONS is set)")
        .one_of({"auto", "github", "none"});
    app.option("-j,--jobs", &args->common.threads, "N", "Threads that draw, at most (default: one for each core)")
        .range(1, 1024);
    app.option("--progress", &args->common.progress, "STYLE",
               "Progress on standard error: auto, bar, plain, json or none");
    app.flag("--json", args->common.json, "As JSON");
    app.flag("--force", args->common.force, "Replace reports and references that beamcam did not make");
    add_quiet(app, args->common);
    app.bind(args, act);
}

}  // namespace beamcam::scenes
