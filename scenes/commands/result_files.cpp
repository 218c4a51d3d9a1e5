#include "scenes/commands/result_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "output/files/atomic_file.hpp"
#include "render/base/error.hpp"
#include "scenes/figures/figure_files.hpp"
#include "scenes/scene/files.hpp"
#include "scenes/scene/version.hpp"

namespace beamcam::scenes {
namespace {

// The bytes of a .json, .png, .svg or .pdf file. A figure carries the scene without outputs: none of them makes it
// again.
std::string content_of(const Result& result, const ResultFiles& files, Scene scene, const std::string& file) {
    if (file.ends_with(".json")) return result.json();
    const render::figure::Figure figure = result.figure();
    FigureOutput how;
    how.file = file;
    how.figure = figure.name;
    how.column = files.column;
    how.lang = files.lang;
    scene.outputs.clear();
    return figure_files(figure, how, to_json(scene)).front().second;
}

void write_to(const std::string& file, const Result& result, const ResultFiles& files, const Scene& scene,
              output::FileList& file_list) {
    if (is_stdout(file))
        print_data(result.json());
    else
        output::write_file(target_of(file, scene, file_list), content_of(result, files, scene, file));
}

}  // namespace

output::FileTarget target_of(const std::string& file, const Scene& scene, output::FileList& file_list) {
    const std::string ending = ending_of(file);
    if (ending != ".pdf" && ending != ".svg") return file_list.target(file);
    Scene shown = scene;
    shown.outputs.clear();
    return file_list.target(file, {.inputs = {}, .version = std::string(kVersion), .scene = to_json(shown)});
}

void add_result_options(CLI::App& app, ResultFiles& files, Common& common, const char* what) {
    add_option(app, "-o,--output", files.names, "FILE", what);
    add_column(app, files.column);
    add_lang(app, files.lang);
    add_progress(app, common);
    add_json(app, common);
    add_force(app, common);
}

void require_writable(const char* option, const std::vector<std::string>& files,
                      std::initializer_list<const char*> endings, output::FileList& file_list) {
    for (const std::string& file : files) {
        require_ending_or_stdout(option, file, endings);
        if (!is_stdout(file)) file_list.require_replaceable(file);
    }
}

int write_result(const Result& result, const ResultFiles& files, const Scene& scene, const Common& common,
                 output::FileList& file_list) {
    const bool prints_data = std::ranges::find(files.names, "-") != files.names.end();
    if (common.json && !prints_data)
        print_json(result.json());
    else if (!prints_data)
        print_text(result.text());
    const int code = for_each_file(files.names, [&](const std::string& file) {
        try {
            write_to(file, result, files, scene, file_list);
        } catch (const render::PictureError& error) {  // such as a diagram of branches without impacts
            throw render::PictureError(fmt::format("{} is not written: {}", file, error.what()));
        }
        if (!is_stdout(file)) inform(common, "wrote " + file);
    });
    return code;
}

double transient_argument(const std::string& text, const sim::Problem& problem) {
    const sim::CamSpan span = span_argument("--transient", text);
    if (span.time || span.turns == 0) return span.time.value_or(0);
    if (!problem.cam || problem.cam->speed == 0)
        throw UsageError(fmt::format("--transient {}: the cam does not turn; write a time such as \"30 s\"", text));
    return 2 * std::numbers::pi * span.turns / std::abs(problem.cam->speed);
}

bool is_table(const std::string& file) {
    return file.ends_with(".csv") || file.ends_with(".npz") || file.ends_with(".nc");
}

}  // namespace beamcam::scenes
