// Where the answer of a computation goes besides standard output, and how its diagrams look: the options -o, --column,
// --lang, --progress, --json and --force of `lyapunov` and `orbits`, and how both read --transient.
#pragma once

#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "output/data/column_table.hpp"
#include "output/data/manifest.hpp"
#include "render/plot/figure.hpp"
#include "scenes/commands/commands.hpp"

namespace beamcam::scenes {

struct AnswerFiles {
    std::vector<std::string> names;
    std::string column = "elsevier", lang_name = "en";

    Lang lang() const { return lang_name == "zh" ? Lang::zh : Lang::en; }
    // The bytes of a .png, .svg or .pdf file.
    std::string drawn(const render::figure::Figure& figure, Scene scene, const std::string& file) const;
};

// --transient of them [s]: turns of the cam, as a plain number always is (so of sweeps, too), or a time with its unit.
double transient_argument(const std::string& text, const sim::Problem& problem);

void add_answer_files(Command& app, AnswerFiles& files, Common& common);

bool is_table(const std::string& file);  // by its ending

// Before any work. Throws UsageError for another ending, WouldOverwrite, IoError where nothing can be written.
void need_room(const char* option, const std::vector<std::string>& files, std::initializer_list<const char*> endings,
               output::Manifest& manifest);

// The answer as JSON or in words on standard output, and each file; data alone where "-" is one of them.
struct Answer {
    std::function<std::string()> json, words;
    std::function<std::string(const std::string& file)> file;  // its content
    std::function<output::ColumnTable()> table = {};           // of .csv, .npz and .nc
};
void write_answer(const Answer& answer, const AnswerFiles& files, const Common& common, output::Manifest& manifest);

}  // namespace beamcam::scenes
