// The stress campaign: random mixtures of all keys and single hard cases (stress.hpp), of which every one must finish or
// be rejected with a clear message.
//
//   campaign_stress [--full]      --full: all mixtures, and single cases of minutes; otherwise one mixture in eleven
//
// Prints how the cases of both groups end, then each failure. The exit code is 1 if there is any.
#include "tests/campaign/stress.hpp"

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <cstring>
#include <thread>

namespace beamcam::sim::stress {
namespace {

constexpr unsigned kMixtures = 500;

std::vector<StressResult> run_all(const std::vector<StressCase>& cases) {
    std::vector<StressResult> results(cases.size());
    std::atomic<std::size_t> next = 0;
    std::vector<std::jthread> workers;
    for (unsigned k = 0; k < std::max(1u, std::thread::hardware_concurrency()); ++k)
        workers.emplace_back([&] {
            for (std::size_t i; (i = next++) < cases.size();) results[i] = run_case(cases[i]);
        });
    workers.clear();  // waits for all
    return results;
}

// Prints a line with the count of each outcome, the largest residual and the most steps a second. Returns whether no
// case failed.
bool report(const char* title, const std::vector<StressCase>& cases) {
    const std::vector<StressResult> results = run_all(cases);
    std::array<int, 5> counts{};
    double closure = 0, steps = 0;
    for (const StressResult& r : results) {
        ++counts[static_cast<std::size_t>(r.outcome)];
        if (r.outcome == Outcome::closed) closure = std::max(closure, r.closure);
        if (r.outcome == Outcome::closed || r.outcome == Outcome::open) steps = std::max(steps, r.steps_per_second);
    }
    fmt::print("| {} | {} | {} | {:.2g} | {:.2g} |\n", title, cases.size(), fmt::join(counts, " | "), closure, steps);
    for (std::size_t i = 0; i < cases.size(); ++i)
        if (results[i].outcome == Outcome::failed) fmt::print("failed: {}: {}\n", cases[i].title, results[i].message);
    return counts[static_cast<std::size_t>(Outcome::failed)] == 0;
}

int campaign(bool full) {
    std::vector<StressCase> mixtures;
    for (unsigned seed = 0; seed < kMixtures; seed += full ? 1 : 11) mixtures.push_back(mixture(seed));
    fmt::print("| group | cases | closed | open, reported | rejected | stopped | failed | worst balance | most steps |\n");
    const bool fine = report("random mixtures of everything", mixtures);
    return report("single cases", single_cases(full)) && fine ? 0 : 1;
}

}  // namespace
}  // namespace beamcam::sim::stress

int main(int argc, char** argv) { return beamcam::sim::stress::campaign(argc > 1 && !std::strcmp(argv[1], "--full")); }
