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
#include "render/plot/user_text.hpp"
#include "scenes/figures/figure_files.hpp"
#include "scenes/outputs/picture_sinks.hpp"
#include "scenes/scene/files.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

// The table without the rows that a failed run did not reach, whose values are all NaN.
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
      inputs_(inputs_keys(scene)),
      existing_(context.options.force ? ExistingWork()
                                      : find_existing(scene, inputs_, context.options.directory, context.file_list)),
      files_(scene, inputs_, context) {}

// ---- before the motions ------------------------------------------------------------------------

Plan SceneRun::dry_plan() const {
    std::set<std::size_t> without = existing_.finished;
    std::vector<std::size_t> waiting;
    for (std::size_t i = 0; i < scene_.outputs.size(); ++i)
        if (needs_events(scene_.outputs[i], scene_) && without.insert(i).second) waiting.push_back(i);
    Plan made = scenes::plan(resolve(scene_, without, {}), existing_);
    made.waiting = std::move(waiting);
    return made;
}

void SceneRun::prepare() {
    report_up_to_date();
    std::vector<std::string> files;
    for (std::size_t i = 0; i < scene_.outputs.size(); ++i)
        if (!existing_.finished.contains(i)) std::ranges::move(written_by(scene_.outputs[i]), back_inserter(files));
    files_.claim(files);
    check_libraries();
}

void SceneRun::report_up_to_date() {
    for (const std::size_t output : existing_.finished) {
        ++context_.work.files_left;
        context_.print("kept {}: up to date (--force writes it again)\n",
                       files_.path_of(file_of(scene_.outputs[output])).string());
    }
}

void SceneRun::report_kept_frames(const ResolvedOutput& sequence) {
    const auto existing = existing_.frames.find(sequence.index);
    if (existing == existing_.frames.end()) return;
    std::size_t kept = 0;
    for (std::size_t k = 0; k < sequence.times.frames.size(); ++k)
        kept += existing->second.contains(sequence.times.first + static_cast<long>(k)) ? 1 : 0;
    const std::string file = files_.path_of(file_of(sequence.output)).string();
    if (kept == sequence.times.frames.size()) {
        ++context_.work.files_left;
        context_.print("kept {}: up to date (--force writes it again)\n", file);
    } else if (kept > 0) {
        context_.work.frames_left += static_cast<long>(kept);
        context_.print("kept {} of {}: up to date\n", counted(kept, "frame"), file);
    }
}

// Opens and discards a film of each codec, so that a missing library is reported before any computation.
void SceneRun::check_libraries() {
    std::set<output::Codec> tried;
    for (std::size_t i = 0; i < scene_.outputs.size(); ++i) {
        if (existing_.finished.contains(i)) continue;
        const Output& output = scene_.outputs[i];
        if (std::holds_alternative<SweepOutput>(output) && file_of(output).ends_with(".nc")) output::netcdf_library();
        const PictureOutput* video = picture_of(output, PictureOutput::Kind::video);
        if (!video || !tried.insert(video->encoding.codec).second) continue;
        const output::VideoWriter trial(files_.target(files_.path_of(video->file)), video_options(*video));
        context_.work.encoder_modules = 1;
        ++context_.work.encoders;
    }
}

void SceneRun::plan() {
    const auto start = Clock::now();
    const ResolvedScene resolved = resolve(
        scene_, existing_.finished,
        [&](const sim::Problem& problem, const sim::Request& request) {
            return context_.motions.find_events(problem, request);
        },
        [&](std::size_t output, const std::function<void()>& work) { attempt(output, work); });
    context_.times.simulate += seconds_since(start);
    plan_ = scenes::plan(resolved, existing_);
    std::vector<std::string> files;  // whose names are known now
    for (const PlannedPictures& p : plan_.pictures) {
        if (p.kind != PictureOutput::Kind::frames) continue;
        for (std::size_t k = 0; k < p.draw.size(); ++k) files.push_back(numbered_file(p.file, p.number_of(k)));
    }
    for (const ResolvedOutput& each : resolved.outputs) report_kept_frames(each);
    files_.claim(files);
}

void SceneRun::request_motions() {
    for (const MotionRequest& each : plan_.motions) requests_.push_back(context_.motions.add(each));
}

// ---- the sweep ---------------------------------------------------------------------------------

// The points are stored beside the first file that needs them until all files are written.
void SceneRun::compute_sweep() {
    if (plan_.sweep.empty()) return;
    if (is_stdout(plan_.sweep)) {
        sweep_ = std::make_unique<SweepRun>(scene_);
    } else {
        const fs::path store = files_.path_of(plan_.sweep).string() + ".part";
        sweep_ = std::make_unique<SweepRun>(scene_, plan_.shard, store, context_.options.force);
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
    for (const DataFile& d : plan_.data) attempt(d.output, [&] { write_data_file(d); });
    try {
        write_partial_data();
    } catch (const output::IoError& also) {
        output::print_message("beamcam: {}\n", also.what());  // the solver's failure is the one to report
    }
    for (std::size_t i = 0; i < plan_.figures.size(); ++i) attempt(plan_.figures[i].output, [&] { write_figure(i); });
    for (const PlannedPictures& p : plan_.pictures) attempt(p.output, [&] { write_pictures(p); });
    if (sweep_ && !rejected_) sweep_->remove();
}

std::vector<sim::Result*> SceneRun::results_of(const std::vector<std::size_t>& motions) {
    std::vector<sim::Result*> results;
    for (const std::size_t motion : motions) results.push_back(&context_.motions.result(requests_[motion]));
    return results;
}

DataSource SceneRun::source_of(const sim::Result& run, const output::FileTarget* file) const {
    static const sim::Request kNone;
    return {scene_, plan_.run ? plan_.motions[*plan_.run].request : kNone, run, file,
            sweep_ ? &sweep_->data() : nullptr};
}

void SceneRun::write_data_file(const DataFile& d) {
    static const sim::Result kNone;
    const sim::Result& run = plan_.run ? *results_of({*plan_.run}).front() : kNone;
    stop_if_interrupted();
    const auto start = Clock::now();
    if (is_stdout(d.file)) {
        write_data(d, source_of(run, nullptr));
    } else {
        const fs::path file = files_.path_of(d.file);
        const output::FileTarget target = files_.target(file, d.output);
        files_.wrote(file, write_data(d, source_of(run, &target)));
    }
    context_.times.write += seconds_since(start);
}

void SceneRun::write_figure(std::size_t figure) {
    stop_if_interrupted();
    const auto start = Clock::now();
    const FigureFile& f = plan_.figures[figure];
    const auto& how = std::get<FigureOutput>(scene_.outputs[f.output]);
    MotionResults results;
    std::ranges::copy(results_of(f.motions), back_inserter(results.motions));
    Scene carried = scene_;
    if (sweep_) results.sweep = sweep_->result(), carried.sweep = sweep_->grid().sweep();
    const render::figure::Figure made = plan_.makers[figure](results);
    for (const std::string& what : missing_data(made)) context_.print("warning: {} shows {}\n", how.file, what);
    for (const auto& [file, bytes] : figure_files(made, how, scene_of_figure(std::move(carried), how))) {
        output::write_file(files_.target(files_.path_of(file), f.output), bytes);
        files_.wrote(files_.path_of(file), file == how.file ? f.figure : "");
    }
    ++context_.work.figures_drawn;
    ++context_.work.font_sets;
    context_.times.write += seconds_since(start);
}

void SceneRun::write_pictures(const PlannedPictures& p) {
    stop_if_interrupted();
    warn_of_omissions(p);
    const std::vector<sim::Result*> results = results_of(p.motions);
    const std::string accuracy = accuracy_note(plan_.motions[p.motions.front()].problem, *results.front());
    render::FilmSetup setup = film_setup(plan_, p, scene_, results);
    if (p.kind == PlannedPictures::Kind::page) return write_whole(p, render::html_page(setup));
    const SinkFiles to{scene_, files_, context_, accuracy};
    render::Film film(std::move(setup));
    if (const auto requested = p.view.exaggeration; requested && film.exaggeration_reduced())
        context_.print(
            "warning: {} shows deflection ×{:g} instead of ×{:g}, which would draw the beam inside the cam or far from "
            "its contact\n",
            p.file, film.exaggeration(), *requested);
    if (film.exaggeration() > 1 && film.has_mechanism() && !film.states_exaggeration())
        context_.print("note: {} shows deflection ×{:g} without stating it; state it in the caption\n", p.file,
                       film.exaggeration());
    if (!p.times.callouts.empty() && !film.shows_captions())
        context_.print("warning: {} shows no texts of events: {}\n", p.file, too_small(p.size));
    if (!film.shows_clock_line())
        context_.print("warning: {} shows only a part of the line of the clock: {}\n", p.file, too_small(p.size));
    if (!film.cut_texts().empty())
        context_.print("warning: {} shows only the beginning of {}: {}\n", p.file, fmt::join(film.cut_texts(), " and "),
                       too_small(p.size));
    if (const int empty = film.empty_frames(); empty > 0)
        context_.print(
            "warning: the mechanism is outside the picture in {1} of {2} of {0}; change \"follow\" or \"zoom\"\n",
            p.file, empty, counted(film.frames(), "frame"));
    if (p.kind == PlannedPictures::Kind::still && ending_of(p.file) != ".png") return write_drawing(p, film, accuracy);
    const auto sink = p.kind == PlannedPictures::Kind::video ? make_video_sink(p, film, to) : make_png_sink(p, to);
    draw(p, film, *sink, context_);
}

void SceneRun::write_drawing(const PlannedPictures& p, render::Film& film, const std::string& accuracy) {
    const auto start = Clock::now();
    const std::string bytes = film.draw(static_cast<int>(p.draw.front()), medium_of(p.file),
                                        document_of(render::plain_text(scene_.title), accuracy, metadata_json(scene_)));
    context_.times.draw += seconds_since(start);
    ++context_.work.frames_drawn;
    write_whole(p, bytes);
}

void SceneRun::write_whole(const PlannedPictures& p, const std::string& bytes) {
    const fs::path file = files_.path_of(p.file);
    output::write_file(files_.target(file, p.output), bytes);
    files_.wrote(file, fmt::format("{:.0f} kB", static_cast<double>(bytes.size()) / 1000));
}

// Warns about requested parts that the picture does not show.
void SceneRun::warn_of_omissions(const PlannedPictures& p) const {
    if (!p.omitted_panels.empty())
        context_.print("warning: {} shows no {}: {}\n", p.file, p.omitted_panels, too_small(p.size));
    constexpr std::size_t kFewFrames = 12;
    if (const std::size_t frames = p.times.frames.size(); p.has_frames() && p.span.real_time() && frames < kFewFrames)
        context_.print(
            "warning: {} has only {}; \"duration\": \"4 s\" (speed {:.2g}) would show its {:g} s in slow motion\n",
            p.file, counted(frames, "frame"), (p.end_time - p.span.from) / 4, p.end_time - p.span.from);
    if (!p.times.unreached_events.empty())
        context_.print("warning: {} does not show {}: outside the film\n", p.file,
                       fmt::join(p.times.unreached_events, " or "));
    if (const std::string lost = characters_without_font(p, scene_); !lost.empty())
        context_.print("warning: {}\n", lost);
}

void SceneRun::write_partial_data() {
    const sim::Result* partial = plan_.run ? context_.motions.partial(requests_[*plan_.run]) : nullptr;
    if (!partial) return;
    for (const DataFile& d : plan_.data) {
        const bool is_table = std::holds_alternative<TrajectoryOutput>(output_of(d));
        const bool rows = is_table && partial->tables[d.tables.front()].rows() > 0;
        const bool events = std::holds_alternative<ImpactsOutput>(output_of(d)) && !partial->impacts.empty();
        if (is_stdout(d.file) || !(rows || events)) continue;
        fs::path file = files_.path_of(d.file);
        file.replace_extension(".partial" + (rows ? std::string(".csv") : ending_of(d.file)));
        const output::FileTarget target = files_.target(file);
        if (rows)
            output::write_table(target, reached_rows(partial->tables[d.tables.front()]));
        else
            write_data(d, source_of(*partial, &target));
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
    const std::string& file = file_of(scene_.outputs[output]);
    output::print_message("beamcam: {}: {}{}\n", listed ? scene_.output_places[output] : scene_.name,
                          is_stdout(file) ? "" : file + ": ", why);
    if (!context_.first_error) context_.first_error = std::current_exception();
    ++context_.rejected;
    rejected_ = true;
}

}  // namespace beamcam::scenes
