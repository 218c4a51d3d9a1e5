#include "scenes/regression/entry_group.hpp"

#include <algorithm>
#include <iterator>

#include "output/files/interrupt.hpp"
#include "scenes/outputs/run.hpp"
#include "sim/base/clock.hpp"

namespace beamcam::scenes {

void EntryGroup::run(const RegressionOptions& options, RegressionResult& all) {
    std::erase_if(jobs_, [](Job& job) { return !job.test->attempt([&] { prepare(job); }); });
    if (jobs_.empty()) return;
    std::vector<sim::Request> requests;
    for (const Job& job : jobs_)
        for (sim::Request& request : requests_of(job.plan)) requests.push_back(std::move(request));
    std::vector<sim::Result> results;
    try {
        results = sim::simulate(problem(), requests, [](double) { return !output::interrupted(); });
    } catch (const sim::SolverError& error) {
        return run_alone(options, all, error);
    }
    ++all.simulations;
    auto next = results.begin();
    for (Job& job : jobs_) {
        const auto last = next + static_cast<std::ptrdiff_t>(requests_of(job.plan).size());
        const auto started = Clock::now();
        job.test->attempt([&] { judge(job, {std::make_move_iterator(next), std::make_move_iterator(last)}, options); });
        next = last;
        job.test->result().seconds = seconds_since(started);
        all.pictures += job.test->result().frames.size();
    }
}

// The integration may succeed for an entry that ends earlier.
void EntryGroup::run_alone(const RegressionOptions& options, RegressionResult& all, const sim::SolverError& error) {
    if (jobs_.size() == 1) {
        jobs_.front().test->attempt([&] { throw error; });
        return;
    }
    for (const Job& job : jobs_) {
        EntryGroup alone;
        alone.add(*job.test);
        alone.run(options, all);
    }
}

void EntryGroup::prepare(Job& job) {
    const Scene& scene = job.test->entry().scene;
    job.plan = plan(scene);
    resolve_event_times(job.plan, scene, [](const sim::Problem& some, const sim::Request& events) {
        return sim::simulate(some, events, [](double) { return !output::interrupted(); });
    });
    // A picture that compares other motions than the scene's own needs no simulation of the scene. A figure of statics
    // needs no motion at all.
    if (!job.plan.simulation) {
        job.plan.simulation.emplace();
        double& until = job.plan.simulation->request.end_time;
        for (const Pictures& p : job.plan.pictures) until = std::max(until, p.end_time);
        for (const Variant& v : job.plan.variants) until = std::max(until, v.simulation.request.end_time);
        if (job.plan.pictures.empty() && job.plan.variants.empty() && !job.plan.figures.empty())
            job.test->ignore_motion();
    }
    sim::Request& request = job.plan.simulation->request;
    job.until = request.end_time;
    if (job.test->needs_horizon()) request.horizon = true;  // some figures request it anyway
    job.motion = request.tables.size();
    const auto table = std::ranges::find_if(job.plan.data, [](const DataFile& d) { return d.table.has_value(); });
    if (table != job.plan.data.end())
        job.motion = *table->table;
    else if (job.test->needs_motion())
        request.tables.push_back(motion_behind_picture(scene.problem, job.until));
    if (records_all_channels(job.test->entry()))
        std::erase_if(request.tables[job.motion].channels,
                      [](const sim::Channel& channel) { return channel.kind == sim::ChannelKind::energy_residual; });
    if (job.test->needs_motion()) record_compared(job);
}

void EntryGroup::record_compared(Job& job) {
    for (Pictures& p : job.plan.pictures)
        for (std::size_t i = 0; i < p.compared.size(); ++i) {
            ComparedMotion& other = p.compared[i];
            other.request.tables.push_back(job.test->motion().compared_table(i, other.problem, p.end_time));
            if (job.test->needs_horizon()) other.request.horizon = true;
        }
}

void EntryGroup::judge(Job& job, std::vector<sim::Result> results, const RegressionOptions& options) {
    EntryTest& test = *job.test;
    const sim::Result& run = results.front();
    test.require_reproducible(run, job.until);
    if (test.needs_motion())
        test.motion().judge(run.tables[job.motion], run.impacts, job.until, run.reproducible_until);
    DrawCallbacks callbacks{
        std::move(results),
        [&](const Pictures&, long frame, const render::Image& image) { test.pictures().judge(frame, image); },
        [&](const render::Image& image) { test.pictures().judge(0, image); },
        {}};
    if (test.needs_motion())
        callbacks.compared = [&](std::size_t picture, std::size_t index, const sim::Result& result) {
            const Pictures& shown = job.plan.pictures[picture];
            test.require_reproducible(result, shown.end_time);
            test.motion().judge_compared(index, shown.compared[index].label, result.tables.back(), result.impacts,
                                         result.reproducible_until);
        };
    RunOptions run_options = options.run;
    run_options.no_cache = true;  // the test runs the present program
    scenes::draw(job.plan, test.entry().scene, callbacks, run_options);
    test.finish();
}

}  // namespace beamcam::scenes
