// `beamcam stress`: the stress campaign. Every case must finish or be rejected with a clear message; otherwise the exit
// code is 1.
#include "sim/studies/stress.hpp"

#include <atomic>

#include "output/data/manifest.hpp"
#include "output/data/stress_report.hpp"
#include "output/files/atomic_file.hpp"
#include "output/files/interrupt.hpp"
#include "output/image/png.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/figures/command_figures.hpp"
#include "scenes/figures/figure_files.hpp"
#include "scenes/motions/fan_out.hpp"
#include "scenes/motions/progress.hpp"

namespace beamcam::scenes {
namespace {

struct StressArguments {
    Common common;
    bool quick = false, full = false;
    std::vector<std::string> files;
};

std::vector<sim::StressResult> run_cases(const sim::Campaign& campaign, const Common& common) {
    const auto count = static_cast<long>(campaign.cases.size());
    std::vector<sim::StressResult> results(campaign.cases.size());
    std::atomic<long> done = 0;
    Progress progress(run_options(common, "").progress);
    progress.begin("stress", static_cast<double>(count), "cases");
    Gate gate;
    fan_out(
        count, thread_count(common.threads),
        [&]() -> Worker {
            return [&](long i) {
                if (output::interrupted()) throw sim::Interrupted();
                const auto k = static_cast<std::size_t>(i);
                results[k] = sim::run_case(campaign.cases[k]);
                progress.reach(static_cast<double>(++done));
            };
        },
        gate);
    return results;
}

// At the size of a double page.
render::Image drawn_map(const sim::Campaign& campaign, const std::vector<sim::StressResult>& results) {
    FigureOutput how;
    how.column = "elsevier-double";
    how.width = 0.3;
    how.dpi = 150;
    return figure_image(survival_map(campaign, results), how);
}

void write(const output::Target& file, const sim::Campaign& campaign, const std::vector<sim::StressResult>& results) {
    const std::string ending = file.path.extension().string();
    if (ending == ".png")
        output::write_png(file, drawn_map(campaign, results));
    else
        output::write_file(
            file, ending == ".csv" ? output::stress_csv(campaign, results) : output::stress_json(campaign, results));
}

void act(const StressArguments& args) {
    if (args.quick && args.full) throw UsageError("--quick and --full exclude each other; keep one");
    output::Manifest manifest(args.common.force);
    for (const std::string& file : args.files) {
        if (file == "-") throw UsageError("-o -: the table is always printed on standard output; name a file");
        require_ending("-o", file, {".csv", ".json", ".png"});
        manifest.require_replaceable(file);
    }
    const sim::Campaign campaign = sim::stress_campaign(args.full);
    const std::vector<sim::StressResult> results = run_cases(campaign, args.common);
    print_text(output::stress_text(campaign, results));
    for (const std::string& file : args.files) write(manifest.target(file), campaign, results);
    manifest.save();
    const bool failed = std::any_of(results.begin(), results.end(),
                                    [](const sim::StressResult& r) { return r.outcome == sim::Outcome::failed; });
    if (failed)
        throw std::logic_error("the stress campaign found cases that neither finish nor are rejected with a message");
}

}  // namespace

void add_stress(Grammar& grammar) {
    const auto [app, args] = grammar.command<StressArguments>(
        "stress", "Test the solver with thousands of extreme problems; each must finish or be rejected with a message",
        act);
    app.examples = {"stress --quick -o cases.csv -o map.png"};
    app.flag("--quick", args.quick, "Run one case in eleven and the short single cases (default)");
    app.flag("--full", args.full, "Run every case; takes minutes to an hour");
    app.option("-o,--output", &args.files, "FILE", "Write the cases, too: .csv, .json, or a map as .png (repeatable)");
    add_quiet(app, args.common);
    add_jobs(app, args.common, "Largest number of cases at a time");
    add_progress(app, args.common);
    add_force(app, args.common);
}

}  // namespace beamcam::scenes
