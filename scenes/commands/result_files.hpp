// The result of a computation on standard output and in files, as `accuracy`, `lyapunov` and `orbits` give it: the
// options -o, --column, --lang, --progress, --json and --force.
#pragma once

#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

#include "output/data/file_list.hpp"
#include "render/plot/figure.hpp"
#include "scenes/commands/commands.hpp"

namespace beamcam::scenes {

struct ResultFiles {
    std::vector<std::string> names;
    std::string column = "elsevier";
    Lang lang = Lang::en;
};

struct Result {
    std::function<std::string()> json, text;
    std::function<render::figure::Figure()> figure;  // for .png, .svg and .pdf
};

// `what`: help of -o.
void add_result_options(CLI::App& app, ResultFiles& files, Common& common, const char* what);

// To be called before any work. Throws UsageError for other endings, WouldOverwrite, IoError where a file cannot be
// written.
void require_writable(const char* option, const std::vector<std::string>& files,
                      std::initializer_list<const char*> endings, output::FileList& file_list);

// Prints the result as JSON or as text, and writes the files. If "-" is one of them, prints JSON alone. Returns the
// exit code of for_each_file.
int write_result(const Result& result, const ResultFiles& files, const Scene& scene, const Common& common,
                 output::FileList& file_list);

// --transient of `lyapunov` and `orbits` [s], a span_argument.
double transient_argument(const std::string& text, const sim::Problem& problem);

// A file that carries the scene without outputs where it is .pdf or .svg.
output::FileTarget target_of(const std::string& file, const Scene& scene, output::FileList& file_list);

bool is_table(const std::string& file);  // by its ending

}  // namespace beamcam::scenes
