// `beamcam test`: the regression test of a file of baselines.
#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <optional>

#include "output/data/file_list.hpp"
#include "output/files/atomic_file.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/regression/regression.hpp"
#include "scenes/regression/report.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

struct TestArguments {
    Common common;
    std::string baselines;
    RegressionOptions test;  // those that options set directly
    std::optional<std::string> report, junit;
};

RegressionOptions options_of(const TestArguments& args) {
    if (!args.test.update.empty() && !args.test.only.empty())
        throw UsageError("--update and --filter exclude each other; --update runs only the entries that it names");
    RegressionOptions options = args.test;
    if (options.update == std::vector<std::string>{"all"}) options.update = {"*"};
    if (args.report) options.report = *args.report;
    options.run = run_options(args.common, "");
    return options;
}

// Before any work: throws if a file is in the way of a report.
void require_replaceable(const TestArguments& args, output::FileList& file_list) {
    if (args.report) {
        output::ensure_directory(*args.report);
        file_list.require_replaceable(fs::path(*args.report) / "index.html");
    }
    if (args.junit) file_list.require_replaceable(*args.junit);
}

void write_reports(const TestArguments& args, const RegressionResult& result, const PassRule& rule,
                   output::FileList& file_list) {
    const std::string title = fs::path(args.baselines).filename().string();
    if (args.junit)
        output::write_file(file_list.target(*args.junit), to_junit(result, fs::path(title).stem().string(), rule));
    if (args.report) {
        write_page(*args.report, result, title, rule, file_list);
        inform(args.common, fmt::format("wrote {}", (fs::path(*args.report) / "index.html").string()));
    }
}

void print_verdicts(const TestArguments& args, const RegressionResult& result) {
    print_result(args.common, to_json(result), to_text(result));
    std::map<Verdict, std::size_t> counts;
    for (const EntryResult& entry : result.entries) ++counts[entry.verdict()];
    const std::size_t not_run = counts[Verdict::not_run];
    inform(args.common,
           fmt::format("{}: {} identical, {} equivalent, {} different, {} missing{}; {}, {}, {:.2f} s",
                       counted(result.entries.size(), "entry"), counts[Verdict::identical], counts[Verdict::equivalent],
                       counts[Verdict::different], counts[Verdict::missing],
                       not_run > 0 ? fmt::format(", {} not-run", not_run) : "",
                       counted(result.simulations, "simulation"), counted(result.pictures, "picture"), result.seconds));
    if (result.is_updated())
        inform(args.common, "references were changed: check them, for example with git diff, before you keep them");
}

int act(const TestArguments& args) {
    if (args.junit) require_ending("--junit", *args.junit, {".xml"});
    const RegressionOptions options = options_of(args);
    output::FileList file_list(args.common.force);
    require_replaceable(args, file_list);
    const RegressionResult result = test_regression(args.baselines, options);
    write_reports(args, result, options.rule, file_list);
    print_verdicts(args, result);
    bool fine = !result.is_updated();  // a change must be checked
    for (const EntryResult& entry : result.entries)
        if (entry.could_not_run()) return entry.exit_code;
    for (const EntryResult& entry : result.entries) fine = fine && options.rule.passes(entry);
    return fine ? kDone : kDiffers;
}

}  // namespace

void add_test(Program& program) {
    const auto [app, args] = add_command<TestArguments>(program, "test",
                                                        "Run a regression test of pictures and motions; exit code "
                                                        "7 if any entry differs, 3, 5 or 6 if any could not run",
                                                        act);
    add_examples(app, {"test baselines.json --report report", "test baselines.json --update 'fall-*'"});
    app.add_option("BASELINES", args.baselines, "The file of baselines, JSON; - is standard input")->required();
    app.add_option("--filter,--only", args.test.only, "Test only these entries; patterns such as 'fall-*' are allowed")
        ->type_name("NAME...");
    app.add_option("--update", args.test.update,
                   "Replace the references of these entries by the present pictures and motions (exit code 7 if that "
                   "changes any); patterns and all are allowed (without NAME: all)")
        ->type_name("NAME...")
        ->expected(0, CLI::detail::expected_max_vector_size)
        ->default_str("all");
    app.add_flag("--strict", args.test.rule.strict, "Fail entries that are only equivalent");
    add_option(app, "--report", args.report, "DIR",
               "Directory for an HTML page with actual, expected and difference pictures");
    add_option(app, "--junit", args.junit, "FILE", "Write a JUnit report, .xml");
    add_jobs(app, args.common, "Largest number of threads that draw");
    add_progress(app, args.common);
    add_json(app, args.common);
    add_force(app, args.common);
    add_quiet(app, args.common);
}

}  // namespace beamcam::scenes
