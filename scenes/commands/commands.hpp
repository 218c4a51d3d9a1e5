// The commands and what they share: common options, reading of scenes, checks of arguments. Each command is one file of
// this folder: `add_NAME` adds its options to the program and binds its action.
#pragma once

#include <exception>
#include <functional>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "output/files/standard_output.hpp"
#include "scenes/commands/program.hpp"
#include "scenes/format/units.hpp"
#include "scenes/outputs/run.hpp"
#include "scenes/scene/exit_code.hpp"
#include "scenes/scene/scene.hpp"

namespace beamcam::scenes {

// The commands, in the order of --help.
using AddCommand = void(Program& program);
AddCommand add_run, add_render, add_simulate, add_sweep, add_collect, add_lyapunov, add_orbits, add_modes, add_cam,
    add_check, add_plan, add_init, add_examples, add_schema, add_keys, add_hash, add_diff, add_test, add_info,
    add_doctor, add_accuracy, add_figure;
inline constexpr AddCommand* kCommands[] = {
    add_run,  add_render, add_simulate, add_sweep,  add_collect,  add_lyapunov, add_orbits, add_modes,
    add_cam,  add_check,  add_plan,     add_init,   add_examples, add_schema,   add_keys,   add_hash,
    add_diff, add_test,   add_info,     add_doctor, add_accuracy, add_figure,
};

// ---- options that several commands share --------------------------------------------------------

struct Common : RunOptions {
    std::vector<std::string> overrides;
    bool dry_run = false, json = false;
};

void add_set(CLI::App& app, Common& common);                                       // --set
void add_quiet(CLI::App& app, Common& common);                                     // -q
void add_scene(CLI::App& app, std::string& scene, Common& common);                 // SCENE, --set, -q
void add_scenes(CLI::App& app, std::vector<std::string>& scenes, Common& common);  // SCENE..., --set, -q
void add_jobs(CLI::App& app, Common& common, const char* what);                    // -j
void add_progress(CLI::App& app, Common& common);                                  // --progress
void add_json(CLI::App& app, Common& common);                                      // --json
void add_force(CLI::App& app, Common& common);                                     // --force
void add_column(CLI::App& app, std::string& column);                               // --column
void add_lang(CLI::App& app, Lang& lang);                                          // --lang
void add_work(CLI::App& app, Common& common);                                      // -v -j --progress --force -n --json

// ---- steps that several commands share ----------------------------------------------------------

std::string lowered(std::string text);  // in lower case (ASCII)

// A message on standard error, unless -q.
void inform(const Common& common, const std::string& text);
// Prints the message of an error, and returns its exit code.
int report(const std::exception& error);
// The work for each file; an error of one is reported, and the others follow. Returns the exit code of the first error.
int for_each_file(const std::vector<std::string>& files, const std::function<void(const std::string& file)>& work);
using output::print_data;
using output::print_json;
using output::print_text;
// Prints the result as JSON or as text.
void print_result(const Common& common, const std::string& json, const std::string& text);
// Throws SceneError with every issue of the scene; warnings go to standard error.
Scene load_scene(const std::string& path, const Common& common);
// The same, with its film if it lists no outputs.
Scene load_scene_with_output(const std::string& path, const Common& common);
// Loads the scenes that can be read, each with its film if it lists no outputs; the errors of the others are
// reported.
struct LoadedScenes {
    std::vector<Scene> scenes;
    int code;  // of the first error
};
LoadedScenes load_scenes(const std::vector<std::string>& paths, const Common& common);
// The look of new films of a scene: its first film, sequence or still picture, else the default film.
PictureOutput film_template(const Scene& scene);
ProgressStyle progress_style(const Common& common);                   // resolved; none with -q
RunOptions run_options(const Common& common, std::string directory);  // with this style
void print_plans(std::span<const Scene> scenes, const RunOptions& options, bool json);
void run_or_plan(std::span<const Scene> scenes, const RunOptions& options, const Common& common);  // -n: the plans

// The value of an option, with a unit or as a plain number in SI units; throws UsageError.
double signed_argument(const std::string& option, const std::string& text, const Dimension& dimension);
// Requires the values of a range or list to have a unit each, or none; 0 needs none. Throws UsageError.
void require_units(const std::string& option, const std::vector<std::string>& values);
// A positive quantity, read in the same way.
double positive_argument(const char* option, const std::string& text, const Dimension& dimension);
// A length of time: turns of the cam if it is a plain number or an angle, or a time.
sim::CamSpan span_argument(const char* option, const std::string& text);

// Throws UsageError unless `file` ends in one of these, or unless it is "-" where that is possible.
void require_ending(const char* option, const std::string& file, std::initializer_list<const char*> endings);
void require_ending_or_stdout(const char* option, const std::string& file, std::initializer_list<const char*> endings);
inline constexpr std::initializer_list<const char*> kCaptionEndings{".txt", ".md"};

}  // namespace beamcam::scenes
