// `beamcam paper`: all figures of the paper and the table of findings.
#include <fmt/format.h>

#include <filesystem>

#include "output/data/file_list.hpp"
#include "output/files/atomic_file.hpp"
#include "output/files/errors.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/figures/figure_files.hpp"
#include "scenes/figures/figure_types.hpp"
#include "scenes/figures/findings.hpp"
#include "scenes/format/embedded.hpp"
#include "scenes/format/reader.hpp"
#include "scenes/motions/fan_out.hpp"
#include "scenes/motions/motion_store.hpp"
#include "scenes/plan/output_times.hpp"
#include "scenes/plan/up_to_date.hpp"
#include "scenes/scene/version.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;

struct PaperArguments {
    Common common;
    std::string directory, column;
    Lang lang = Lang::en;
    double dpi = 300;
    bool data = false;
};

struct Job {
    Scene scene;
    FigureOutput how;
    FigureMaker make;
};

constexpr const char* kPictureEndings[] = {".png", ".svg", ".pdf"};

std::string with_ending(const std::string& file, const char* ending) {
    return fs::path(file).replace_extension(ending).string();
}

// All figures of the embedded scenes of the paper.
std::vector<Job> jobs_of(const PaperArguments& args) {
    std::vector<Job> jobs;
    for (const EmbeddedScene& embedded : embedded_scenes()) {
        if (!embedded.is_of_paper()) continue;
        Reading reading = read_scene({fmt::format("{}.json", embedded.name), std::string(embedded.text), true},
                                     args.common.overrides);
        if (!reading.scene) throw SceneError(reading.report());
        for (const Output& output : reading.scene->outputs) {
            const auto* figure = std::get_if<FigureOutput>(&output);
            if (!figure) continue;
            FigureOutput how = *figure;
            how.lang = args.lang;
            if (!args.column.empty()) how.column = args.column;
            how.dpi = args.dpi;
            Scene alone = *reading.scene;
            alone.outputs = {output};
            jobs.push_back({alone, how, {}});
        }
    }
    std::ranges::sort(jobs, [](const Job& a, const Job& b) { return a.how.file < b.how.file; });
    return jobs;
}

// Adds the studies that the figures need. Without `find`, figures that begin or end at events cover their whole scenes.
void prepare(std::vector<Job>& jobs, const FindEvents& find, Studies& studies) {
    for (Job& job : jobs) {
        const bool known = find || !job.how.series.needs_events();
        const FigureOutput how = known ? with_found_times(job.how, job.scene, find) : without_events(job.how);
        job.make = figure_type(how.figure)->prepare(job.scene, how, studies);
    }
}

std::vector<std::string> files_of(const PaperArguments& args, const std::vector<Job>& jobs) {
    std::vector<std::string> files{"findings.md", "captions.md"};
    for (const Job& job : jobs) {
        for (const char* ending : kPictureEndings) files.push_back(with_ending(job.how.file, ending));
        if (args.data) files.push_back(with_ending(job.how.file, ".csv"));
    }
    return files;
}

class PaperWriter {
  public:
    PaperWriter(const PaperArguments& args) : args_(args), file_list_(args.common.force) {}

    // Before any work: throws what `write` would throw.
    void prepare(const std::vector<std::string>& files) {
        output::ensure_directory(args_.directory);
        for (const std::string& file : files) {
            const fs::path path = fs::path(args_.directory) / file;
            std::error_code ignored;
            if (fs::is_directory(path, ignored))
                throw output::IoError(fmt::format("{} is a directory; choose another -o", path.string()));
            file_list_.require_replaceable(path);
        }
    }
    void write(const std::string& file, const std::string& bytes) {
        stop_if_interrupted();
        const fs::path path = fs::path(args_.directory) / file;
        output::Target target = file_list_.target(path, {{}, std::string(kVersion), {}});
        target.within = args_.directory;
        output::write_file(target, bytes);
        ++count_;
    }
    void finish() { inform(args_.common, fmt::format("wrote {} to {}", counted(count_, "file"), args_.directory)); }

  private:
    const PaperArguments& args_;
    output::FileList file_list_;
    int count_ = 0;
};

std::string plan_text(const std::vector<Study>& studies, const std::vector<std::string>& files) {
    std::string text;
    for (const Study& s : studies)
        text +=
            fmt::format("simulate  {} until {:g} s, because of {}{}\n", name(s.problem.beam.model), s.request.end_time,
                        s.label, s.request.horizon ? ", and again for its reproducible horizon" : "");
    for (const std::string& file : files) text += fmt::format("write     {}\n", file);
    return text;
}

void act(const PaperArguments& args) {
    const RunOptions options = run_options(args.common, args.directory);
    Studies studies;
    std::vector<Job> jobs = jobs_of(args);
    if (args.common.dry_run) {
        prepare(jobs, {}, studies);
        prepare_findings(studies);
        print_text(plan_text(studies.take(), files_of(args, jobs)));
        return;
    }
    PaperWriter writer(args);
    writer.prepare(files_of(args, jobs));
    Progress progress(resolve(options.progress));
    MotionStore motions(progress, {thread_count(options.threads), options.quiet, options.verbose});
    prepare(
        jobs,
        [&](const sim::Problem& problem, const sim::Request& request) { return motions.find_events(problem, request); },
        studies);
    const auto findings = prepare_findings(studies);
    const std::vector<Study> all = studies.take();
    for (const Study& study : all) motions.request(study.problem, {study.request}, study.label);
    motions.compute();
    std::vector<sim::Result> made;
    for (std::size_t i = 0; i < all.size(); ++i) made.push_back(std::move(motions.take_results(i).front()));
    Results results;
    for (const sim::Result& result : made) results.studies.push_back(&result);

    std::string captions;
    for (const Job& job : jobs) {
        const render::figure::Figure figure = job.make(results);
        for (const char* ending : kPictureEndings) {
            FigureOutput how = job.how;
            how.file = with_ending(job.how.file, ending);
            for (const auto& [file, bytes] : figure_files(figure, how, scene_of_figure(job.scene, how)))
                writer.write(file, bytes);
        }
        if (args.data) writer.write(with_ending(job.how.file, ".csv"), render::figure::data_csv(figure));
        captions +=
            fmt::format("## {}\n\n{}\n", fs::path(job.how.file).stem().string(), caption_text(figure, "captions.md"));
    }
    writer.write("captions.md", captions);
    writer.write("findings.md", findings_markdown(findings(results)));
    writer.finish();
}

}  // namespace

void add_paper(Grammar& grammar) {
    const auto [app, args] = grammar.command<PaperArguments>(
        "paper", "Make all figures of the paper as .png, .svg and .pdf, their captions, and the table of findings",
        act);
    app.examples = {"paper -o paper --column aps"};
    app.option("-o,--output", &args.directory, "DIR", "Directory for the files").required();
    add_column(app, args.column);
    add_lang(app, args.lang);
    app.option("--dpi", &args.dpi, "N", "Dots per inch of the .png files (default: 300)").range(50, 2400);
    app.flag("--data", args.data, "Write the plotted numbers, too, as .csv");
    add_set(app, args.common);
    add_quiet(app, args.common);
    add_work(app, args.common);
}

}  // namespace beamcam::scenes
