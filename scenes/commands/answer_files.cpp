#include "scenes/commands/answer_files.hpp"

#include <algorithm>
#include <cmath>

#include "output/data/tables.hpp"
#include "output/files/atomic_file.hpp"
#include "render/plot/style.hpp"
#include "scenes/figures/figure_files.hpp"
#include "scenes/format/units.hpp"

namespace beamcam::scenes {

std::string AnswerFiles::drawn(const render::figure::Figure& figure, Scene scene, const std::string& file) const {
    FigureOutput how;
    how.file = file;
    how.figure = figure.name;
    how.column = column;
    how.lang = lang();
    scene.outputs.clear();
    return figure_files(figure, how, to_json(scene)).front().second;
}

void add_answer_files(Command& app, AnswerFiles& files, Common& common) {
    app.option("--column", &files.column, "COLUMN", "Width and letters of a journal's column, for the diagram")
        .one_of(render::figure::column_names());
    app.option("--lang", &files.lang_name, "LANG", "Language of the diagram: en or zh").one_of({"en", "zh"});
    app.option("--progress", &common.progress, "STYLE", "Progress on standard error: auto, bar, plain, json or none");
    app.flag("--json", common.json, "As JSON on standard output");
    app.flag("--force", common.force, "Replace files that beamcam did not make");
}

double transient_argument(const std::string& text, const sim::Problem& problem) {
    const QuantityText read = parse_quantity(text);
    const bool plain = read.quantity && same(read.quantity->dimension, dimension::kNone),
               turns = plain || (read.quantity && same(read.quantity->dimension, dimension::kAngle));
    if (!turns || (plain && read.quantity->value == 0)) return seconds_argument("--transient", text);
    if (!problem.cam || problem.cam->speed == 0)
        throw UsageError(fmt::format("--transient {}: the cam does not turn; write a time such as \"30 s\"", text));
    const double angle = plain ? 2 * std::numbers::pi * read.quantity->value : read.quantity->value;
    if (!(angle >= 0)) throw UsageError(fmt::format("--transient {} must not be negative", text));
    return angle / std::abs(problem.cam->speed);
}

bool is_table(const std::string& file) {
    return file.ends_with(".csv") || file.ends_with(".npz") || file.ends_with(".nc");
}

void need_room(const char* option, const std::vector<std::string>& files, std::initializer_list<const char*> endings,
               output::Manifest& manifest) {
    for (const std::string& file : files) {
        need_ending(option, file, endings);
        if (file == "-") continue;
        manifest.require_replaceable(file);
        output::AtomicFile(manifest.target(file));  // created and removed: a place that cannot be written is told now
    }
}

void write_answer(const Answer& answer, const AnswerFiles& files, const Common& common, output::Manifest& manifest) {
    const bool prints_data = std::ranges::find(files.names, "-") != files.names.end();
    if (common.json && !prints_data)
        print_json(answer.json());
    else if (!prints_data)
        print_text(answer.words());
    for (const std::string& file : files.names) {
        if (file == "-") {
            print_data(answer.file(file));
            continue;
        }
        if (answer.table && is_table(file))
            output::write_table(manifest.target(file), answer.table());
        else
            output::write_file(manifest.target(file), answer.file(file));
        say(common, "wrote " + file);
    }
    manifest.save();
}

}  // namespace beamcam::scenes
