#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <optional>

#include "output/data/manifest.hpp"
#include "output/files/atomic_file.hpp"
#include "scenes/commands/cli.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/regression/regression.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

struct TestArguments {
    Common common;
    std::string baselines;
    std::vector<std::string> update, only, tolerance;
    std::optional<std::string> report, junit;
    std::string on_new_renderer = "fail";
    bool add_digest = false, strict = false;
};

const char* name(NewRenderer policy) {
    switch (policy) {
        case NewRenderer::fail:
            return "fail";
        case NewRenderer::warn:
            return "warn";
        case NewRenderer::accept:
            return "accept";
    }
    return "?";
}

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
    for (const NewRenderer policy : {NewRenderer::fail, NewRenderer::warn, NewRenderer::accept})
        if (args.on_new_renderer == name(policy)) options.rule.new_renderer = policy;
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
        output::ensure_directory(*args.report);
        const fs::path page = fs::path(*args.report) / "index.html";
        write_own(manifest, page, to_html(result, title));
        say(args.common, fmt::format("wrote {}", page.string()));
    }
    manifest.save();
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
    const RegressionOptions options = options_of(args);
    output::Manifest manifest(args.common.force);
    need_room(args, manifest);
    const RegressionResult result = test_regression(args.baselines, options);
    write_reports(args, result, options.rule, manifest);
    tell(args, result, options.rule);
    bool fine = !result.changed || (options.update.empty() && !args.add_digest);  // for somebody to look
    for (const EntryResult& entry : result.entries)
        if (entry.exit_code != 0 && entry.exit_code != kDiffers) return entry.exit_code;
    for (const EntryResult& entry : result.entries) fine = fine && options.rule.passes(entry.verdict());
    return fine ? kDone : kDiffers;
}

}  // namespace

void add_test(Grammar& grammar) {
    auto args = std::make_shared<TestArguments>();
    Command& app = grammar.command(
        "test", "Render and simulate again what a file of baselines lists; ends with 7 when something differs");
    app.positional("BASELINES", &args->baselines, "The baselines, a JSON file; - is standard input").required();
    app.option("--only", &args->only, "NAME...", "Test these entries only").several();
    app.option("--update", &args->update, "NAME...",
               "Replace what these entries expect by what they are now (ends with 7, for somebody to look)")
        .several();
    app.flag("--add-digest", args->add_digest,
             "Accept the digests of this machine beside the others, where pictures are equivalent, or where nothing is "
             "accepted yet of its libraries and fonts (ends with 7)");
    app.option("--on-new-renderer", &args->on_new_renderer, "WHAT",
               "Pictures of libraries or fonts of which nothing is accepted yet: fail, warn (they pass when they look "
               "alike), accept (their digests, from now on) (default: fail)")
        .one_of({name(NewRenderer::fail), name(NewRenderer::warn), name(NewRenderer::accept)});
    app.flag("--strict", args->strict, "What is only equivalent fails too");
    app.option("--tolerance", &args->tolerance, "KEY=X,...",
               "Over those of the file: channel=2, share=1e-4, motion=2e-5, impacts=1e-4 (repeatable)")
        .separated_by(',');
    app.option("--report", &args->report, "DIR", "Folder for a page with actual and difference pictures");
    app.option("--junit", &args->junit, "FILE", "Report for continuous integration, .xml");
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
