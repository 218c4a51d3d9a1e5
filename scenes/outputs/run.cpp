#include "scenes/outputs/run.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <memory>

#include "render/gl/renderer.hpp"
#include "scenes/figures/figure_files.hpp"
#include "scenes/outputs/picture_sinks.hpp"
#include "scenes/outputs/scene_run.hpp"
#include "scenes/scene/files.hpp"

namespace beamcam::scenes {

RunContext::RunContext(const RunOptions& run_options)
    : options(run_options),
      progress(resolve(run_options.progress)),
      file_list(run_options.force),
      motions(progress, {thread_count(run_options.threads), run_options.quiet, run_options.verbose}) {}

namespace {

using SceneRuns = std::vector<std::unique_ptr<SceneRun>>;

void reject_clashes(std::span<const Scene> scenes) {
    FileClaims claims;
    std::vector<std::string> places;  // of the outputs
    for (const Scene& scene : scenes)
        for (std::size_t i = 0; i < scene.outputs.size(); ++i) {
            for (const std::string& file : written_by(scene.outputs[i])) claims.add(file, places.size());
            places.push_back(i < scene.output_places.size() ? scene.output_places[i] : scene.name);
        }
    for (const auto& [later, earlier] : claims.clashes())
        throw NameClash(
            fmt::format("{}: {} and {}: {} are the same file; rename one of them, or run the scenes one by one with "
                        "different -o",
                        places[later.owner], later.file, places[earlier.owner], earlier.file));
}

void warn_of_ignored_gl_settings(const RunContext& context, const SceneRuns& all) {
    const std::vector<std::string>& ignored = render::ignored_gl_settings();
    const bool drawn = std::ranges::any_of(all, [](const auto& scene) { return scene->needs_gl(); });
    if (drawn && !ignored.empty())
        context.print("warning: lit and solid views ignore these settings of OpenGL: {}\n", fmt::join(ignored, ", "));
}

void compute_motions(RunContext& context, const SceneRuns& all) {
    const auto start = Clock::now();
    for (const auto& scene : all) scene->request_motions();
    context.motions.compute();
    context.times.simulate += seconds_since(start);
    const sim::Effort& effort = context.motions.effort();
    context.work.integrations = effort.integrations;
    context.work.steps = effort.spent.steps;
    context.work.rhs_evaluations = effort.spent.rhs_evaluations;
    context.work.gap_evaluations = effort.spent.gap_evaluations;
}

void report_times_and_work(const RunContext& context) {
    const Times& times = context.times;
    output::print_message(
        "time: {:.2f} s in total; motion {:.2f} s, drawing {:.2f} s ({}), conversion {:.2f} s, "
        "encoding {:.2f} s, other files {:.2f} s\n",
        seconds_since(context.started), times.simulate, times.draw, counted(times.threads, "thread"), times.convert,
        times.encode, times.write);
    const Work& w = context.work;
    output::print_message(
        "work: integrations={} steps={} rhs_evaluations={} gap_evaluations={} sweep_points={} font_sets={}"
        " gl_contexts={} encoder_modules={} encoders={} frames_drawn={} figures_drawn={} bodies_drawn={}"
        " frames_repeated={} frames_encoded={} frames_left={} files_written={} files_left={} bytes_written={}\n",
        w.integrations, w.steps, w.rhs_evaluations, w.gap_evaluations, w.sweep_points, w.font_sets, w.gl_contexts,
        w.encoder_modules, w.encoders, w.frames_drawn, w.figures_drawn, w.bodies_drawn, w.frames_repeated,
        w.frames_encoded, w.frames_left, w.files_written, w.files_left, w.bytes_written);
}

}  // namespace

void run(std::span<const Scene> scenes, const RunOptions& options) {
    // 1. Plan every scene, and reject files that cannot be written.
    reject_clashes(scenes);
    RunContext context(options);
    SceneRuns all;
    for (const Scene& scene : scenes) all.push_back(std::make_unique<SceneRun>(scene, context));
    for (const auto& scene : all) scene->prepare();
    for (const auto& scene : all) scene->plan();
    warn_of_ignored_gl_settings(context, all);
    // 2. Integrate each motion once.
    compute_motions(context, all);
    for (const auto& scene : all) scene->compute_sweep();
    // 3. Write the files, and record them.
    for (const auto& scene : all) scene->write_outputs();
    // 4. Report.
    if (options.verbose) report_times_and_work(context);
    std::size_t outputs = 0;
    for (const Scene& scene : scenes) outputs += scene.outputs.size();
    if (context.rejected == 0) return;
    try {
        std::rethrow_exception(context.first_error);
    } catch (...) {
        std::throw_with_nested(Incomplete(
            outputs == 1 ? "" : fmt::format("{} of {} outputs could not be written", context.rejected, outputs)));
    }
}

void run(const Scene& scene, const RunOptions& options) { run({&scene, 1}, options); }

void draw(const PlanWithFigures& plan, const Scene& scene, std::vector<sim::Result> results, DrawCallbacks& callbacks,
          const RunOptions& options) {
    RunContext context(options);
    std::optional<SweepRun> sweep;
    if (!plan.sweep.empty()) {
        sweep.emplace(scene);
        sweep->make(options.threads, context.progress);
    }
    for (std::size_t i = 0; i < plan.figures.size(); ++i) {
        MotionResults of_figure;
        for (const std::size_t motion : plan.figures[i].motions) of_figure.motions.push_back(&results[motion]);
        if (sweep) of_figure.sweep = sweep->result();
        const auto& how = std::get<FigureOutput>(scene.outputs[plan.figures[i].output]);
        callbacks.figure(figure_image(plan.makers[i](of_figure), how));
    }
    for (const PlannedPictures& p : plan.pictures) {
        stop_if_interrupted();
        std::vector<sim::Result*> shown;
        for (const std::size_t motion : p.motions) shown.push_back(&results[motion]);
        const render::Film film(film_setup(plan, p, scene, shown));
        draw(p, film, *make_callback_sink(p, callbacks), context);
    }
}

Plan plan_for(const Scene& scene, const RunOptions& options) {
    RunContext context(options);
    return SceneRun(scene, context).dry_plan();
}

}  // namespace beamcam::scenes
