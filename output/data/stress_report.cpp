#include "output/data/stress_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "output/json/tree.hpp"

namespace beamcam::output {
namespace {

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
    const sim::CaseGrid& plate = campaign.grids[one.grid];
    return fmt::format("{}; {} {}; {} {}{}{}", plate.title, plate.row_title, plate.rows[one.row], plate.column_title,
                       plate.columns[one.column], one.variant.empty() ? "" : "; ", one.variant);
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

}  // namespace

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
        "*  ledger residual over rtol times energy scale, of the closed ones (closed: at most 10)\n"
        "** most steps for a simulated second of those that ended\n\n";
    std::vector<std::pair<long, std::string>> ordered;
    for (const auto& [words, count] : causes) ordered.emplace_back(-count, words);
    std::sort(ordered.begin(), ordered.end());
    for (const auto& [count, words] : ordered) text += fmt::format("{:>6}  {}\n", -count, words);
    return text + failures;
}

std::string stress_csv(const sim::Campaign& campaign, const std::vector<sim::StressResult>& results) {
    std::string text = "plate,row,column,variant,outcome,closure,steps_per_second,steps,impacts,reached,words\n";
    for (std::size_t i = 0; i < results.size(); ++i) {
        const sim::StressCase& one = campaign.cases[i];
        const sim::StressResult& r = results[i];
        const sim::CaseGrid& plate = campaign.grids[one.grid];
        text += fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", quoted(plate.title), quoted(plate.rows[one.row]),
                            quoted(plate.columns[one.column]), quoted(one.variant), name(r.outcome),
                            std::isnan(r.closure) ? "" : fmt::format("{:.6g}", r.closure), r.steps_per_second, r.steps,
                            r.impacts, r.reached, quoted(r.message));
    }
    return text;
}

std::string stress_json(const sim::Campaign& campaign, const std::vector<sim::StressResult>& results) {
    Node plates = array_node(), cases = array_node();
    for (const sim::CaseGrid& grid : campaign.grids)
        plates.items.push_back(object_node({{"title", grid.title},
                                            {"row_title", grid.row_title},
                                            {"column_title", grid.column_title},
                                            {"rows", grid.rows},
                                            {"columns", grid.columns}}));
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
    return to_text(object_node({{"plates", std::move(plates)}, {"cases", std::move(cases)}}));
}

}  // namespace beamcam::output
