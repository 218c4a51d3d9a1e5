// `beamcam stress`: the stress campaign. Every case must finish or be rejected with a clear message; otherwise the exit
// code is 1.
#include "sim/studies/stress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <map>

#include "output/data/file_list.hpp"
#include "output/files/atomic_file.hpp"
#include "output/image/png.hpp"
#include "output/json/tree.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/figures/command_figures.hpp"
#include "scenes/motions/fan_out.hpp"
#include "scenes/motions/progress.hpp"
#include "scenes/scene/files.hpp"

namespace beamcam::scenes {
namespace {

struct StressArguments {
    Common common;
    bool quick = false, full = false;
    std::vector<std::string> files;
};

std::vector<sim::StressResult> run_cases(const sim::Campaign& campaign, const Common& common) {
    const std::size_t count = campaign.cases.size();
    std::vector<sim::StressResult> results(count);
    std::atomic<long> done = 0;
    Progress progress(progress_style(common));
    progress.begin("stress", static_cast<double>(count), "cases");
    fan_out(count, common.threads, [&](std::size_t k) {
        results[k] = sim::run_case(campaign.cases[k]);
        progress.reach(static_cast<double>(++done));
    });
    return results;
}

// ---- the results as text, CSV and JSON ----------------------------------------------------------

struct Tally {
    std::array<long, 5> outcomes{};
    double closure = 0, steps_per_second = 0;
    void count(const sim::StressResult& r) {
        ++outcomes[static_cast<std::size_t>(r.outcome)];
        if (r.outcome == sim::Outcome::closed) closure = std::max(closure, r.closure);
        if (r.outcome == sim::Outcome::closed || r.outcome == sim::Outcome::open)
            steps_per_second = std::max(steps_per_second, r.steps_per_second);
    }
    std::string line(const std::string& title) const {
        long all = 0;
        for (long n : outcomes) all += n;
        return fmt::format("{:<30} {:>6} {:>7} {:>6} {:>8} {:>8} {:>7} {:>8.2g} {:>10.2g}\n", title, all, outcomes[0],
                           outcomes[1], outcomes[2], outcomes[3], outcomes[4], closure, steps_per_second);
    }
};

std::string place(const sim::Campaign& campaign, const sim::StressCase& one) {
    const sim::CaseGrid& grid = campaign.grids[one.grid];
    return fmt::format("{}; {} {}; {} {}{}{}", grid.title, grid.row_title, grid.rows[one.row], grid.column_title,
                       grid.columns[one.column], one.variant.empty() ? "" : "; ", one.variant);
}

// The cause without its numbers, so that alike causes are counted together.
std::string cause(const std::string& words) {
    const std::size_t from = words.starts_with("at t =") ? words.find(": ") + 2 : 0;
    const std::size_t to = words.find_first_of(";(0123456789", from);
    return words.substr(from, std::min(to, words.size()) - from);
}

std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (char c : text) {
        if (c == '"') out += '"';
        out += c == '\n' ? ' ' : c;
    }
    return out + '"';
}

// A line for each grid with the count of each outcome, largest residual and most steps a second; then every failure
// with its cause, then how often each cause of stopping came up.
std::string stress_text(const sim::Campaign& campaign, const std::vector<sim::StressResult>& results) {
    std::vector<Tally> tallies(campaign.grids.size());
    Tally whole;
    std::map<std::string, long> causes;
    std::string failures;
    for (std::size_t i = 0; i < results.size(); ++i) {
        const sim::StressCase& one = campaign.cases[i];
        tallies[one.grid].count(results[i]);
        whole.count(results[i]);
        if (results[i].outcome == sim::Outcome::refused || results[i].outcome == sim::Outcome::stopped)
            ++causes[fmt::format("{}: {}", name(results[i].outcome), cause(results[i].message))];
        if (results[i].outcome == sim::Outcome::failed)
            failures += fmt::format("failed: {}: {}\n", place(campaign, one), results[i].message);
    }
    std::string text = fmt::format("{:<30} {:>6} {:>7} {:>6} {:>8} {:>8} {:>7} {:>8} {:>10}\n", "", "cases", "closed",
                                   "open", "refused", "stopped", "failed", "worst*", "steps/s**");
    for (std::size_t i = 0; i < tallies.size(); ++i) text += tallies[i].line(campaign.grids[i].title);
    text += whole.line("all");
    text +=
        "*  residual of the energy balance over rtol times energy scale, of the closed ones (closed: at most 10)\n"
        "** most steps for a simulated second of those that ended\n\n";
    std::vector<std::pair<long, std::string>> ordered;
    for (const auto& [words, count] : causes) ordered.emplace_back(-count, words);
    std::ranges::sort(ordered);
    for (const auto& [count, words] : ordered) text += fmt::format("{:>6}  {}\n", -count, words);
    return text + failures;
}

// One line a case.
std::string stress_csv(const sim::Campaign& campaign, const std::vector<sim::StressResult>& results) {
    std::string text = "plate,row,column,variant,outcome,closure,steps_per_second,steps,impacts,reached,words\n";
    for (std::size_t i = 0; i < results.size(); ++i) {
        const sim::StressCase& one = campaign.cases[i];
        const sim::StressResult& r = results[i];
        const sim::CaseGrid& grid = campaign.grids[one.grid];
        text += fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", quoted(grid.title), quoted(grid.rows[one.row]),
                            quoted(grid.columns[one.column]), quoted(one.variant), name(r.outcome),
                            std::isnan(r.closure) ? "" : fmt::format("{:.6g}", r.closure), r.steps_per_second, r.steps,
                            r.impacts, r.reached, quoted(r.message));
    }
    return text;
}

std::string stress_json(const sim::Campaign& campaign, const std::vector<sim::StressResult>& results) {
    Node grids = array_node(campaign.grids, [](const sim::CaseGrid& grid) {
        return object_node({{"title", grid.title},
                            {"row_title", grid.row_title},
                            {"column_title", grid.column_title},
                            {"rows", grid.rows},
                            {"columns", grid.columns}});
    });
    Node cases = array_node();
    for (std::size_t i = 0; i < results.size(); ++i) {
        const sim::StressCase& one = campaign.cases[i];
        const sim::StressResult& r = results[i];
        cases.items.push_back(object_node({{"plate", one.grid},
                                           {"row", one.row},
                                           {"column", one.column},
                                           {"variant", one.variant},
                                           {"outcome", name(r.outcome)},
                                           {"closure", r.closure},
                                           {"steps_per_second", r.steps_per_second},
                                           {"steps", r.steps},
                                           {"impacts", r.impacts},
                                           {"reached", r.reached},
                                           {"words", r.message}}));
    }
    return to_text(object_node({{"plates", std::move(grids)}, {"cases", std::move(cases)}}));
}

// ---- the command ---------------------------------------------------------------------------------

void write(const output::Target& file, const sim::Campaign& campaign, const std::vector<sim::StressResult>& results) {
    const std::string ending = ending_of(file.path);
    if (ending == ".png")
        output::write_png(file, survival_picture(campaign, results));
    else
        output::write_file(file, ending == ".csv" ? stress_csv(campaign, results) : stress_json(campaign, results));
}

int act(const StressArguments& args) {
    if (args.quick && args.full) throw UsageError("--quick and --full exclude each other; keep one");
    output::FileList file_list(args.common.force);
    for (const std::string& file : args.files) {
        require_ending("-o", file, {".csv", ".json", ".png"});
        file_list.require_replaceable(file);
    }
    const sim::Campaign campaign = sim::stress_campaign(args.full);
    const std::vector<sim::StressResult> results = run_cases(campaign, args.common);
    print_text(stress_text(campaign, results));
    const int code =
        for_each_file(args.files, [&](const std::string& file) { write(file_list.target(file), campaign, results); });
    const bool failed =
        std::ranges::any_of(results, [](const sim::StressResult& r) { return r.outcome == sim::Outcome::failed; });
    if (failed)
        throw std::logic_error("the stress campaign found cases that neither finish nor are rejected with a message");
    return code;
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
