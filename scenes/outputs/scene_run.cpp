#include "scenes/outputs/scene_run.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "output/data/netcdf_library.hpp"
#include "output/data/tables.hpp"
#include "output/files/atomic_file.hpp"
#include "render/base/error.hpp"
#include "render/base/limits.hpp"
#include "render/film/page.hpp"
#include "scenes/figures/figure_files.hpp"
#include "scenes/outputs/film_setup.hpp"
#include "scenes/outputs/picture_sinks.hpp"
#include "scenes/scene/files.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

// Without the rows that a failed run did not reach; their values are all NaN.
sim::Table reached_rows(const sim::Table& table) {
    sim::Table reached{table.channels, std::vector<std::vector<double>>(table.values.size())};
    for (std::size_t row = 0; row < table.rows(); ++row) {
        if (std::ranges::all_of(table.values, [&](const auto& column) { return std::isnan(column[row]); })) continue;
        for (std::size_t c = 0; c < table.values.size(); ++c) reached.values[c].push_back(table.values[c][row]);
    }
    return reached;
}

}  // namespace

SceneRun::SceneRun(const Scene& scene, RunContext& context)
    : scene_(scene),
      context_(context),
      up_to_date_(check_up_to_date(scene, context.options.shard, context.options.directory, context.file_list,
                                   context.options.force)),
      plan_(scenes::plan(scene, context.options.shard, up_to_date_.existing)),
      files_(scene, up_to_date_.inputs, context),
      motions_(plan_, context.motions) {}

// ---- before the motions ------------------------------------------------------------------------

void SceneRun::prepare() {
    report_up_to_date();
    files_.recover();
    files_.claim(plan_);
    check_libraries();
}

void SceneRun::report_up_to_date() {
    for (const auto& [output, file] : up_to_date_.existing.finished) {
        ++context_.work.files_left;
        context_.print("kept {}: up to date (--force writes it again)\n", files_.path_of(file).string());
    }
    for (const auto& [output, frames] : up_to_date_.existing.frames) {
        context_.work.frames_left += static_cast<long>(frames.size());
        context_.print("kept {} of {}: up to date\n", counted(frames.size(), "frame"),
                       files_.path_of(file_of(scene_.outputs[output])).string());
    }
}

// Opens and discards a film of each codec, so that a missing library is reported before any computation.
void SceneRun::check_libraries() {
    for (const DataFile& d : plan_.data)
        if (d.file.ends_with(".nc")) output::netcdf_library();
    std::set<output::Codec> tried;
    for (const Pictures& p : plan_.pictures)
        if (p.kind == Pictures::Kind::video && tried.insert(p.encoding.codec).second) {
            const output::VideoWriter trial(files_.target(files_.path_of(p.file)), video_options(p));
            context_.work.encoder_modules = 1;
            ++context_.work.encoders;
        }
}

void SceneRun::find_events() {
    if (!plan_.events_until) return;
    const auto start = Clock::now();
    resolve_event_times(
        plan_, scene_,
        [&](const sim::Problem& problem, const sim::Request& request) {
            return context_.motions.find_events(problem, request);
        },
        [&](std::size_t output, const std::string& why) { reject(output, why); });
    context_.times.simulate += seconds_since(start);
    files_.claim(plan_);  // the number of frames is known now
}

// ---- the sweep ---------------------------------------------------------------------------------

// The points are stored beside the first file that needs them until all files are written.
void SceneRun::compute_sweep() {
    if (plan_.sweep.empty()) return;
    if (is_stdout(plan_.sweep)) {
        sweep_ = std::make_unique<SweepRun>(scene_);
    } else {
        const fs::path store = files_.path_of(plan_.sweep).string() + ".part";
        sweep_ = std::make_unique<SweepRun>(scene_, context_.options.shard, store, context_.options.force);
    }
    const std::uint64_t found = sweep_->points_there();
    if (found > 0) context_.print("found {} of an earlier run\n", counted(found, "point"));
    try {
        sweep_->make(context_.options.threads, context_.progress);
    } catch (const sim::Interrupted&) {
        context_.progress.end();
        if (!is_stdout(plan_.sweep))
            context_.print("stored {}; the same command continues from there\n",
                           counted(sweep_->points_there(), "point"));
        throw;
    }
    context_.work.sweep_points += static_cast<long>(sweep_->points_there() - found);
    context_.print("{}\n", sweep_->summary());
}

// ---- files -------------------------------------------------------------------------------------

void SceneRun::write_outputs() {
    const auto write_each_data = [&](bool reporting) {
        for (const DataFile& d : plan_.data)
            if (d.reports_work == reporting) attempt(d.output, [&] { write_data(d); });
    };
    write_each_data(false);
    for (std::size_t i = 0; i < plan_.figures.size(); ++i) attempt(plan_.figures[i].output, [&] { write_figure(i); });
    for (std::size_t i = 0; i < plan_.pictures.size(); ++i)
        attempt(plan_.pictures[i].output, [&] { write_pictures(i); });
    write_each_data(true);
    if (sweep_ && !rejected_) sweep_->remove();
}

DataSource SceneRun::source_of(const sim::Result& run, const output::Target* file) const {
    static const sim::Request kNone;
    return {scene_.problem,
            plan_.simulation ? plan_.simulation->request : kNone,
            run,
            context_.work,
            file,
            sweep_ ? &sweep_->data() : nullptr,
            context_.progress};
}

void SceneRun::write_data(const DataFile& d) {
    stop_if_interrupted();
    const auto start = Clock::now();
    if (is_stdout(d.file)) {
        d.write(source_of(results_.run, nullptr));
    } else {
        const fs::path file = files_.path_of(d.file);
        const output::Target target = files_.target(file, d.output);
        files_.wrote(file, d.write(source_of(results_.run, &target)));
    }
    context_.times.write += seconds_since(start);
}

void SceneRun::write_figure(std::size_t figure) {
    stop_if_interrupted();
    const auto start = Clock::now();
    const FigureFile& f = plan_.figures[figure];
    const auto& how = std::get<FigureOutput>(scene_.outputs[f.output]);
    Results results = results_.of_figure(figure);
    Scene carried = scene_;
    if (sweep_) results.swept = sweep_->swept(), carried.sweep = sweep_->grid().sweep();
    const render::figure::Figure made = f.make(results);
    for (const std::string& what : missing_data(made)) context_.print("warning: {} shows {}\n", how.file, what);
    for (const auto& [file, bytes] : figure_files(made, how, scene_of_figure(std::move(carried), how))) {
        output::write_file(files_.target(files_.path_of(file), f.output), bytes);
        files_.wrote(files_.path_of(file), file == how.file ? f.figure : "");
    }
    ++context_.work.figures_drawn;
    ++context_.work.font_sets;
    context_.times.write += seconds_since(start);
}

void SceneRun::write_pictures(std::size_t picture) {
    const Pictures& p = plan_.pictures[picture];
    if (p.draw.empty()) return;  // all frames of a sequence are up to date
    stop_if_interrupted();
    warn_of_omissions(p);
    render::FilmSetup setup = film_setup(plan_, picture, scene_, results_);
    if (p.kind == Pictures::Kind::page) return write_page(p, render::html_page(setup));
    const SinkFiles to{
        scene_, files_, context_,
        accuracy_note(scene_.problem, p.compare.empty() ? results_.shown[picture].front() : results_.run)};
    render::Film film(std::move(setup));
    if (const auto requested = p.view.exaggeration; requested && film.exaggeration_reduced())
        context_.print(
            "warning: {} shows deflection ×{:g} instead of ×{:g}, which would draw the beam inside the cam or far from "
            "its contact\n",
            p.file, film.exaggeration(), *requested);
    if (film.exaggeration() > 1 && film.has_mechanism() && !film.states_exaggeration())
        context_.print("note: {} shows deflection ×{:g} without stating it; state it in the caption\n", p.file,
                       film.exaggeration());
    if (!p.callouts.empty() && !film.shows_captions())
        context_.print("warning: {} shows no texts of events: {}\n", p.file, why_text_is_omitted(p.size));
    if (film.title_truncated())
        context_.print("warning: {} shows only the beginning of the title: {}\n", p.file, why_text_is_omitted(p.size));
    if (const int empty = film.empty_frames(); empty > 0)
        context_.print(
            "warning: the mechanism is outside the picture in {1} of {2} of {0}; change \"follow\" or \"zoom\"\n",
            p.file, empty, counted(film.frames(), "frame"));
    const auto sink = p.kind == Pictures::Kind::video ? make_video_sink(p, film, to) : make_png_sink(p, to);
    draw(p, film, *sink, context_);
}

void SceneRun::write_page(const Pictures& p, const std::string& bytes) {
    const fs::path file = files_.path_of(p.file);
    output::write_file(files_.target(file, p.output), bytes);
    files_.wrote(file, fmt::format("{:.0f} kB", static_cast<double>(bytes.size()) / 1000));
}

// Warns about requested parts that the picture does not show.
void SceneRun::warn_of_omissions(const Pictures& p) const {
    if (!p.omitted_panels.empty())
        context_.print("warning: {} shows no {}: {}\n", p.file, p.omitted_panels, why_panels_are_omitted(p.size));
    constexpr std::size_t kFewFrames = 12;
    if (const std::size_t frames = plan_.times(p).size(); p.has_frames() && p.span.real_time() && frames < kFewFrames)
        context_.print(
            "warning: {} has only {}; \"duration\": \"4 s\" (speed {:.2g}) would show its {:g} s in slow motion\n",
            p.file, counted(frames, "frame"), (p.end_time - p.span.from) / 4, p.end_time - p.span.from);
    if (!p.unreached_events.empty())
        context_.print("warning: {} does not show {}: outside the film\n", p.file,
                       fmt::join(p.unreached_events, " or "));
    if (const std::string lost = characters_without_font(p, scene_); !lost.empty())
        context_.print("warning: {}\n", lost);
    if (p.kind == Pictures::Kind::page) return;
    if (!context_.options.verbose || context_.options.quiet) return;
    if (const std::string what = omitted_text(p, scene_); !what.empty())
        context_.print("warning: {} shows no {}: {}\n", p.file, what, why_text_is_omitted(p.size));
}

void SceneRun::write_partial_data() {
    const sim::Result* partial = motions_.partial_results();
    if (!partial) return;
    for (const DataFile& d : plan_.data) {
        const bool rows = d.table && *d.table < partial->tables.size() && partial->tables[*d.table].rows() > 0;
        const bool events = d.holds_events && !partial->impacts.empty();
        if (is_stdout(d.file) || !(rows || events)) continue;
        fs::path file = files_.path_of(d.file);
        file.replace_extension(".partial" + (rows ? std::string(".csv") : ending_of(d.file)));
        const output::Target target = files_.target(file);
        if (rows)
            output::write_table(target, reached_rows(partial->tables[*d.table]));
        else
            d.write(source_of(*partial, &target));
        files_.wrote(file, "as far as the solver came");
    }
}

// ---- outputs that cannot be written ------------------------------------------------------------

// An error rejects only its own output.
void SceneRun::attempt(std::size_t output, const std::function<void()>& work) {
    try {
        work();
    } catch (const sim::Interrupted&) {
        throw;
    } catch (const std::logic_error&) {  // a bug
        throw;
    } catch (const std::bad_alloc&) {
        reject(output, render::out_of_memory_message());
    } catch (const std::exception& error) {
        reject(output, error.what());
    }
}

// Called while its error is handled.
void SceneRun::reject(std::size_t output, const std::string& why) {
    context_.progress.end();
    const bool listed = output < scene_.output_places.size();
    output::print_message("beamcam: {}: {}: {}\n", listed ? scene_.output_places[output] : scene_.name,
                          file_of(scene_.outputs[output]), why);
    if (!context_.first_error) context_.first_error = std::current_exception();
    ++context_.rejected;
    rejected_ = true;
}

}  // namespace beamcam::scenes
