#include "scenes/regression/regression.hpp"

#include <fmt/format.h>

#include <memory>
#include <mutex>

#include "output/files/atomic_file.hpp"
#include "output/files/standard_output.hpp"
#include "render/base/error.hpp"
#include "scenes/motions/fan_out.hpp"
#include "scenes/regression/entry_group.hpp"
#include "sim/base/clock.hpp"

namespace beamcam::scenes {
namespace {

enum class Drawn { nothing, flat, lit, figure, elsewhere };

Drawn drawn(const Baseline& entry) {
    if (!entry.file.empty()) return Drawn::elsewhere;
    if (!entry.has_pictures()) return Drawn::nothing;
    const Picture* picture = entry.picture();
    return !picture ? Drawn::figure : picture->view.style == render::Style::flat ? Drawn::flat : Drawn::lit;
}

Fingerprint fingerprint_of(Drawn how) {
    switch (how) {
        case Drawn::nothing:
            return {};
        case Drawn::flat:
            return flat_fingerprint();
        case Drawn::lit:
            return lit_fingerprint();
        case Drawn::figure:
            return figure_fingerprint();
        case Drawn::elsewhere:
            return {{{"pictures", "of another tool"}}};
    }
    throw std::logic_error("a way of drawing that has no fingerprint");
}

class Regression {
  public:
    Regression(const std::string& path, const RegressionOptions& options)
        : path_(path), options_(options), baselines_(read_recovered(path)), report_files_(options.run.force) {}

    RegressionResult go() {
        const auto started = Clock::now();
        result_.baselines = path_;
        if (path_ == "-" && (!options_.update.empty() || adds()))
            throw UsageError("baselines from standard input cannot be changed; name the file");
        choose();
        run_groups();
        run_others();
        write_changes();
        report_files_.save();
        result_.seconds = seconds_since(started);
        return std::move(result_);
    }

  private:
    bool adds() const { return options_.add_digest || options_.rule.new_renderer == NewRenderer::accept; }

    // An update that replaces begins at once, one that adds when there is something to add.
    void open_update() {
        if (!options_.update.empty()) {
            update_ = std::make_unique<ReferenceUpdate>(path_, baselines_.references, options_.run.force);
            access_.replace = [this](const std::string& entry) { return update_->begin(entry); };
            access_.keep = [this](const std::string& entry) {
                const std::lock_guard lock(mutex_);
                update_->extend(entry);
            };
        } else if (adds()) {
            access_.extend = [this](const std::string& entry) {
                const std::lock_guard lock(mutex_);
                if (!update_)
                    update_ = std::make_unique<ReferenceUpdate>(path_, baselines_.references, options_.run.force);
                return update_->extend(entry);
            };
        }
        access_.drop = [this](const std::string& entry) {
            const std::lock_guard lock(mutex_);
            if (update_) update_->drop(entry);
        };
    }

    void choose() {
        const std::vector<const Baseline*> chosen =
            chosen_entries(baselines_, path_, options_.update.empty() ? options_.only : options_.update);
        result_.entries.resize(chosen.size());
        open_update();
        for (std::size_t i = 0; i < chosen.size(); ++i) {
            EntryResult& result = result_.entries[i];
            result.name = chosen[i]->name;
            if (!chosen[i]->problem.empty()) {
                refuse(result, chosen[i]->problem, kBadScene);
                continue;
            }
            const Drawn how = drawn(*chosen[i]);
            try {
                if (!renderers_.contains(how)) renderers_[how] = fingerprint_of(how);
                tests_.push_back(std::make_unique<EntryTest>(baselines_, *chosen[i], options_, renderers_[how], access_,
                                                             report_files_, result));
            } catch (const render::MissingPart& error) {  // such as OpenGL for a lit view
                refuse(result, fmt::format("{}\n", error.what()), kMissingPart);
            } catch (const output::IoError& error) {  // a damaged marker
                if (!options_.update.empty()) throw;
                refuse(result, fmt::format("{}\n", error.what()), kInputOutput);
            }
        }
    }

    // There is no test for an entry that cannot be read.
    static void refuse(EntryResult& result, const std::string& problem, int exit_code) {
        output::print_message("{}", problem);
        result.picture = Verdict::missing;
        result.picture_lines = {problem.substr(0, problem.find('\n'))};
        result.exit_code = exit_code;
    }

    // Side by side: as many threads as there are groups for, and those that are left draw.
    void run_groups() {
        std::vector<EntryGroup> all = groups();
        const auto count = static_cast<long>(all.size());
        const int threads = thread_count(options_.run.threads);
        RegressionOptions each = options_;
        each.run.threads = std::max(1, threads / static_cast<int>(std::max(1L, count)));
        Gate gate;
        fan_out(
            count, threads,
            [&] {
                return [&](long k) {
                    RegressionResult counts;
                    all[static_cast<std::size_t>(k)].run(each, counts);
                    const std::lock_guard lock(mutex_);
                    result_.simulations += counts.simulations;
                    result_.pictures += counts.pictures;
                };
            },
            gate);
    }

    std::vector<EntryGroup> groups() {
        std::map<std::string, std::size_t> index;
        std::vector<EntryGroup> all;
        for (const auto& test : tests_) {
            if (!shares_motion(test->entry())) continue;
            Scene physics = test->entry().scene;  // all that the motion depends on
            physics.outputs.clear();
            physics.title.clear();
            physics.sweep.reset();
            physics.end_time = 1;
            const auto [found, added] = index.emplace(to_json(physics), all.size());
            if (added) all.emplace_back();
            all[found->second].add(*test);
        }
        return all;
    }
    static bool shares_motion(const Baseline& entry) { return entry.file.empty() && !entry.is_sweep; }

    // Pictures of other tools, and sweeps, whose points are made side by side.
    void run_others() {
        Progress progress(resolve(options_.run.progress));
        for (const auto& test : tests_) {
            if (shares_motion(test->entry())) continue;
            const auto started = Clock::now();
            test->attempt([&] {
                if (test->entry().is_sweep) return test->motion().judge_sweep(options_.run.threads, progress);
                test->judge_file();
                test->finish();
            });
            test->result().seconds = seconds_since(started);
            result_.pictures += test->result().frames.size();
        }
    }

    void write_changes() {
        std::vector<BaselineEdit> edits;
        std::map<std::string, std::map<std::string, std::string>> pictures;
        for (const auto& test : tests_) {
            EntryResult& result = test->result();
            if (result.picture &&
                (test->is_updated() || (result.picture > Verdict::identical && result.exit_code == 0))) {
                const Fingerprint& renderer = renderers_.at(drawn(test->entry()));
                result.renderer = renderer.id();
                result_.renderers[result.renderer] = renderer.parts;
            }
            test->judge_renderer();
            auto change = test->edit();
            if (!change) continue;
            edits.push_back(std::move(*change));
            pictures[result.name] = test->new_pictures();
        }
        if (edits.empty()) return;
        const std::string text = edited(baselines_, edits, result_.renderers);
        if (update_)
            update_->commit(baselines_.source.text, text, pictures);
        else
            output::write_file(path_, text);
        result_.changed = true;
    }

    std::string path_;
    const RegressionOptions& options_;
    Baselines baselines_;
    std::mutex mutex_;  // of the counts in result_, and of update_
    std::unique_ptr<ReferenceUpdate> update_;
    UpdateAccess access_;
    output::Manifest report_files_;
    std::map<Drawn, Fingerprint> renderers_;
    RegressionResult result_;
    std::vector<std::unique_ptr<EntryTest>> tests_;
};

}  // namespace

RegressionResult test_regression(const std::string& path, const RegressionOptions& options) {
    return Regression(path, options).go();
}

}  // namespace beamcam::scenes
