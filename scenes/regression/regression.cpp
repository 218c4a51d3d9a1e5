#include "scenes/regression/regression.hpp"

#include <fmt/format.h>

#include <memory>

#include "output/files/atomic_file.hpp"
#include "output/files/standard_output.hpp"
#include "render/base/error.hpp"
#include "scenes/motions/fan_out.hpp"
#include "scenes/motions/identity.hpp"
#include "scenes/motions/motion_pool.hpp"
#include "scenes/regression/entry_test.hpp"
#include "scenes/scene/exit_code.hpp"
#include "sim/base/clock.hpp"

namespace beamcam::scenes {
namespace {

// Identifies what draws the pictures of an entry.
using Renderer = std::string (*)();

Renderer renderer_of(const Baseline& entry) {
    if (!entry.has_pictures()) return [] { return std::string(); };
    const Picture* picture = entry.picture();
    return !picture                                     ? figure_fingerprint
           : picture->view.style == render::Style::flat ? flat_fingerprint
                                                        : body_fingerprint;
}

class Regression {
  public:
    Regression(const std::string& path, const RegressionOptions& options)
        : path_(path), options_(options), baselines_(read_baselines(path)), report_files_(options.run.force) {}

    RegressionResult run() {
        const auto started = Clock::now();
        result_.baselines = path_;
        choose_entries();
        run_motions();
        run_sweeps();
        for (const EntryResult& entry : result_.entries) result_.pictures += entry.frames.size();
        result_.seconds = seconds_since(started);
        return std::move(result_);
    }

  private:
    void choose_entries() {
        const std::vector<const Baseline*> chosen =
            chosen_entries(baselines_, path_, options_.update.empty() ? options_.only : options_.update);
        result_.entries.resize(chosen.size());
        for (std::size_t i = 0; i < chosen.size(); ++i) {
            EntryResult& result = result_.entries[i];
            result.name = chosen[i]->name;
            if (!chosen[i]->problem.empty()) {
                reject(result, chosen[i]->problem, kBadScene);
                continue;
            }
            const Renderer renderer = renderer_of(*chosen[i]);
            try {
                if (!renderers_.contains(renderer)) renderers_[renderer] = renderer();
                tests_.push_back(std::make_unique<EntryTest>(baselines_, *chosen[i], options_, renderers_[renderer],
                                                             report_files_, result));
            } catch (const render::MissingPart& error) {  // such as OpenGL for a lit view
                reject(result, fmt::format("{}\n", error.what()), kMissingPart);
            } catch (const output::IoError& error) {  // damaged digests
                reject(result, fmt::format("{}\n", error.what()), kInputOutput);
            }
        }
    }

    // The result of an entry that cannot be tested.
    static void reject(EntryResult& result, const std::string& problem, int exit_code) {
        output::print_message("{}", problem);
        result.picture = Verdict::not_run;
        result.picture_lines = {problem.substr(0, problem.find('\n'))};
        result.exit_code = exit_code;
    }

    // Entries with the same mechanics share one integration. They are judged in parallel; each draws with an equal
    // share of the threads.
    void run_motions() {
        std::vector<EntryTest*> tests;
        for (const auto& test : tests_)
            if (!test->entry().is_sweep) tests.push_back(test.get());
        const int threads = thread_count(options_.run.threads);
        fan_out(tests.size(), threads, [&](std::size_t k) {
            if (!tests[k]->attempt([&] { tests[k]->prepare(); })) tests[k] = nullptr;
        });
        std::erase(tests, nullptr);
        Progress silent(ProgressStyle::none);
        MotionPool pool(silent, {.threads = threads, .quiet = true});
        for (EntryTest* test : tests) test->request(pool);
        pool.compute();
        result_.simulations = pool.motions();
        RunOptions each = options_.run;
        each.threads = std::max(1, threads / std::max(1, static_cast<int>(tests.size())));
        fan_out(tests.size(), threads, [&](std::size_t k) {
            const auto started = Clock::now();
            tests[k]->attempt([&] { tests[k]->judge(pool, each); });
            tests[k]->result().seconds = seconds_since(started);
        });
    }

    // Their points run in parallel.
    void run_sweeps() {
        Progress progress(resolve(options_.run.progress));
        for (const auto& test : tests_) {
            if (!test->entry().is_sweep) continue;
            const auto started = Clock::now();
            test->attempt([&] { test->judge_sweep(options_.run.threads, progress); });
            test->result().seconds = seconds_since(started);
        }
    }

    std::string path_;
    const RegressionOptions& options_;
    Baselines baselines_;
    output::FileList report_files_;
    std::map<Renderer, std::string> renderers_;  // their ids
    RegressionResult result_;
    std::vector<std::unique_ptr<EntryTest>> tests_;
};

}  // namespace

RegressionResult test_regression(const std::string& path, const RegressionOptions& options) {
    return Regression(path, options).run();
}

}  // namespace beamcam::scenes
