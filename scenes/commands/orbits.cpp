// `beamcam orbits`: periodic orbits of a scene, and their branches over one of its keys.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include "output/data/orbit_records.hpp"
#include "output/files/atomic_file.hpp"
#include "scenes/commands/orbit_text.hpp"
#include "scenes/commands/result_files.hpp"
#include "scenes/figures/command_figures.hpp"
#include "scenes/format/checks.hpp"
#include "scenes/format/sweep_keys.hpp"
#include "scenes/format/units.hpp"
#include "scenes/motions/progress.hpp"
#include "scenes/scene/files.hpp"
#include "scenes/sweep/swept_rows.hpp"
#include "sim/base/ode.hpp"
#include "sim/problem/number_keys.hpp"

namespace beamcam::scenes {
namespace {

constexpr int kMostFollowed = 16;  // orbits at the start of --over

struct OrbitsArguments {
    Common common;
    std::string scene;
    ResultFiles files;
    std::optional<std::string> transient, over, at, scene_file, sweep_file;
    sim::OrbitRequest search;
    sim::ContinuationRequest branches;
    int impacts = -1, row = 0;
};

// A key of the scene and a range of its values: "cam.speed=40:60".
struct KeyRange {
    sim::NumberKey key;
    double from = 0, to = 0;
};

// The range of `--over`, whose unit diagrams take over.
KeyRange range_argument(const std::string& over, const sim::Problem& problem, render::Units& units) {
    const std::size_t equals = over.find('='), colon = over.find(':', equals);
    if (equals == std::string::npos || colon == std::string::npos || over.find(':', colon + 1) != std::string::npos)
        throw UsageError(fmt::format("--over {}: write KEY=FROM:TO, for example cam.speed=40:60", over));
    const std::string path = over.substr(0, equals), option = "--over " + over;
    if (const std::string wrong = problem_with_number_key(problem, path); !wrong.empty())
        throw SceneError(fmt::format("{}: {}", option, wrong));
    const auto key = sim::number_key(problem, path);
    if (key->whole)
        throw UsageError(
            fmt::format("{}: {} takes whole numbers alone, and an orbit is followed over a key that varies "
                        "continuously; give sweep --over {} a list of them",
                        option, path, path));
    const std::string from = over.substr(equals + 1, colon - equals - 1);
    const std::string to = over.substr(colon + 1);
    require_units(option, {from, to});
    adopt_unit(from, key->dimension, units);
    KeyRange range{*key, signed_argument(option, from, key->dimension), signed_argument(option, to, key->dimension)};
    if (!(range.from < range.to)) throw UsageError(fmt::format("{}: the range must ascend", option));
    return range;
}

// The scene's value if it lies in the range, else its middle.
double start_value(const OrbitsArguments& args, const KeyRange& range) {
    const auto within = [&](double value) { return value >= range.from && value <= range.to; };
    if (args.at) {
        const double at = signed_argument("--at", *args.at, range.key.dimension);
        if (!within(at)) throw UsageError(fmt::format("--at {} lies outside the range of --over", *args.at));
        return at;
    }
    return within(range.key.value) ? range.key.value : 0.5 * (range.from + range.to);
}

// Steps along a branch are shares of the range: one of many decades would be too coarse for every value in it.
void need_narrow(const output::BranchTable& table, const render::Units& units) {
    constexpr double kWidest = 1e4;  // of the value that a branch begins at
    if (table.to - table.from > kWidest * std::abs(table.start) && table.start != 0)
        throw UsageError(
            fmt::format("--over {}: the range is wider than {:g} times {}, where the branch begins; narrow it",
                        table.key, kWidest, value_text(table, table.start, units)));
}

bool is_data_file(const std::string& file) { return is_stdout(file) || file.ends_with(".json"); }

// True without orbits, too.
bool all_rest(const std::vector<sim::PeriodicOrbit>& orbits) {
    return std::ranges::all_of(orbits, &sim::PeriodicOrbit::chatters);
}

// Searches at other values of the range if there is no orbit to continue at the start.
void search_elsewhere(output::BranchTable& table, const sim::Family& family, const KeyRange& range,
                      sim::OrbitRequest request, const sim::Progress& progress) {
    request.transient = 0;
    for (const double share : {0.5, 0.25, 0.75, 0.125, 0.375, 0.625, 0.875}) {
        const double value = range.from + share * (range.to - range.from);
        const sim::Problem problem = family(value);
        if (std::ranges::any_of(sim::validate(problem), &sim::Issue::fatal)) continue;  // the initial state
        std::vector<sim::PeriodicOrbit> found = sim::find_orbits(problem, request, progress);
        if (all_rest(found)) continue;
        table.start = value;
        table.orbits = std::move(found);
        return;
    }
}

// Follows the orbits found, first those of short periods, whose period doublings may lead to the others; those that
// rest on the cam last. An orbit on a branch already followed is left out.
void follow_branches(output::BranchTable& table, const sim::Family& family, const KeyRange& range,
                     const sim::OrbitRequest& request, const OrbitsArguments& args, const sim::Progress& progress) {
    sim::ContinuationRequest how = args.branches;
    how.from = range.from, how.to = range.to;
    const auto problem_at = [&](double value) {
        try {
            return family(value);
        } catch (const SceneError& impossible) {  // ends the branch
            throw sim::StepFailure(impossible.what());
        }
    };
    const auto passes = [](const sim::Branch& branch, const sim::PeriodicOrbit& orbit) {
        return std::ranges::any_of(branch.at_start, [&](const auto& other) { return sim::same_orbit(orbit, other); });
    };
    int followed = 0;
    const auto follow = [&](double value, std::vector<sim::PeriodicOrbit> orbits, bool resting) {
        std::ranges::stable_sort(orbits, {}, &sim::PeriodicOrbit::turns);
        for (const sim::PeriodicOrbit& orbit : orbits) {
            if (orbit.chatters() != resting) continue;
            if (std::ranges::any_of(table.branches, [&](const auto& branch) { return passes(branch, orbit); }))
                continue;
            if (++followed > kMostFollowed) continue;
            for (sim::Branch& branch : sim::continue_orbit(problem_at, {value, orbit}, how, progress))
                table.branches.push_back(std::move(branch));
        }
    };
    const double start = table.start;
    const std::vector<sim::PeriodicOrbit> found = table.orbits;
    if (all_rest(found)) search_elsewhere(table, family, range, request, progress);
    follow(table.start, table.orbits, false);
    follow(start, found, true);
    if (followed > kMostFollowed)
        inform(args.common,
               fmt::format("{} orbits were found; the branches of the first {} are followed", followed, kMostFollowed));
}

// The scene that begins on the orbit, with one film of the second period, which loops. The film looks like the scene's
// own and lasts as long, but at least three seconds.
Scene scene_on(const Scene& scene, const sim::PeriodicOrbit& orbit, const sim::Problem& begun, std::string name) {
    constexpr double kShortest = 3;  // [s]
    PictureOutput film = film_template(scene);
    const FrameSpan before = film.span;
    film.span = {.fps = before.fps};
    film.span.from = orbit.period;
    film.span.to = 2 * orbit.period;
    const double length = std::max(kShortest, before.duration.value_or(orbit.period / before.speed.factor));
    film.span.duration = std::max(1.0, std::round(length * before.fps.value())) / before.fps.value();
    film.file = name + ".mp4";
    Scene out = scene;
    out.name = std::move(name);
    out.problem = begun;
    out.end_time = 2 * orbit.period;
    out.sweep.reset();
    out.data.clear();
    out.set_outputs({std::move(film)});
    return out;
}

// False if the beam never leaves the cam: a scene must begin in flight.
bool write_scene(const OrbitsArguments& args, const Scene& scene, const std::vector<sim::PeriodicOrbit>& orbits,
                 output::FileList& file_list) {
    for (const sim::PeriodicOrbit& orbit : orbits)
        if (const std::optional<sim::Problem> begun = sim::begun_on(scene.problem, orbit)) {
            const Scene on = scene_on(scene, orbit, *begun, std::filesystem::path(*args.scene_file).stem().string());
            output::write_file(file_list.target(*args.scene_file), to_json(on));
            inform(args.common, "wrote " + *args.scene_file);
            return true;
        }
    if (!orbits.empty())
        inform(args.common, fmt::format("{} is not written: on these orbits the beam never leaves the cam; film the "
                                        "scene itself, after its transient",
                                        *args.scene_file));
    return false;
}

void reject_unused_options(const OrbitsArguments& args) {
    for (const std::string& file : args.files.names)
        if (!args.over && !is_data_file(file))
            throw UsageError(fmt::format("-o {}: a branch diagram needs --over", file));
    if (!args.over && (args.at || args.branches.doublings > 0))
        throw UsageError("--at and --doublings belong to branches; add --over KEY=FROM:TO");
    if (args.row > 0 && !args.sweep_file) throw UsageError("--row: name the table with --sweep");
    if (args.sweep_file && !args.over && args.row == 0)
        throw UsageError(
            "--sweep: the points of a sweep are drawn with branches (add --over), or begin a search (add --row)");
}

// Before any work.
void require_writable_files(const OrbitsArguments& args, output::FileList& file_list) {
    require_writable("-o", args.files.names, {".json", ".png", ".svg", ".pdf"}, file_list);
    if (args.scene_file) {
        require_ending("--scene", *args.scene_file, {".json"});
        require_writable("--scene", {*args.scene_file}, {".json"}, file_list);
    }
}

sim::OrbitRequest request_of(const OrbitsArguments& args, const sim::Problem& problem) {
    sim::OrbitRequest request = args.search;
    if (args.transient) request.transient = transient_argument(*args.transient, problem);
    if (args.impacts >= 0) request.impacts = args.impacts;
    request.coexisting = args.over.has_value();
    return request;
}

// The transient, then the motion that the search integrates, of a length that is not known before.
sim::Progress search_progress(Progress& progress, double transient) {
    if (transient > 0) progress.begin("transient", transient, "s");
    return [&progress, transient, searching = false, before = 0.0, last = 0.0](double t) mutable {
        if (!searching && t < transient) return progress.reach(t);
        if (!std::exchange(searching, true)) progress.begin("search", std::nullopt, "s of motion");
        if (t < last) before += last;
        last = t;
        return progress.reach(before + t);
    };
}

// The orbits of the scene; with a range, the orbits at its start value and their branches.
output::BranchTable compute(const OrbitsArguments& args, sim::Problem& problem, const std::optional<KeyRange>& range,
                            const render::Units& units) {
    sim::Family family;
    output::BranchTable table;
    if (range) {
        // A branch begins on an orbit, wherever the initial state is.
        family = [problem, key = range->key.path](double value) { return problem_with(problem, key, value, true); };
        for (const double end : {range->from, range->to}) family(end);  // throws if the end is impossible
        table.key = range->key.path;
        table.unit = si_unit(range->key.dimension);
        table.start = start_value(args, *range);
        table.from = range->from, table.to = range->to;
        need_narrow(table, units);
        problem = problem_with(problem, range->key.path, table.start);
    }
    const double start = table.start;
    if (const auto refusal = sim::orbit_refusal(problem)) throw UsageError(*refusal);
    const sim::OrbitRequest request = request_of(args, problem);
    Progress progress(progress_style(args.common));
    table.orbits = sim::find_orbits(problem, request, search_progress(progress, request.transient));
    if (range) {
        progress.begin("branches", std::nullopt, "points");
        double last = start;
        long points = 0;
        follow_branches(table, family, *range, request, args, [&](double value) {
            if (value != last) ++points;
            last = value;
            return progress.reach(static_cast<double>(points));
        });
    }
    progress.end();
    if (table.start != start)
        inform(args.common, fmt::format("at {} no orbit was found, or only such that rest on the cam; the search went "
                                        "on at {}",
                                        value_text(table, start, units), value_text(table, table.start, units)));
    return table;
}

int act(const OrbitsArguments& args) {
    // 1. The request.
    Scene scene = load_scene(args.scene, args.common);
    if (args.row > 0 && args.sweep_file) scene.problem = problem_at_row(scene.problem, *args.sweep_file, args.row);
    std::optional<KeyRange> range;
    if (args.over) range = range_argument(*args.over, scene.problem, scene.units);
    reject_unused_options(args);
    output::FileList file_list(args.common.force);
    require_writable_files(args, file_list);
    SweptImpacts swept;
    if (args.sweep_file && range) swept = swept_impacts(*args.sweep_file, range->key.path, range->from, range->to);
    if (args.sweep_file && range && swept.parameter.empty())
        inform(args.common,
               fmt::format("warning: --sweep {}: it has no impacts of a lasting motion in the range of --over",
                           *args.sweep_file));

    // 2. The orbits and their branches.
    const output::BranchTable table = compute(args, scene.problem, range, scene.units);

    // 3. What is missing, the result and its files; the code of an error of a file comes first.
    const bool written = !args.scene_file || write_scene(args, scene, table.orbits, file_list);
    if (table.orbits.empty())
        inform(args.common, nothing_found(request_of(args, scene.problem)));
    else if (std::ranges::none_of(table.orbits, &sim::PeriodicOrbit::stable))
        inform(args.common, "none of these orbits is stable: the motion of the scene settles on none of them");
    const bool followed = !range || !table.branches.empty();
    if (!followed && !table.orbits.empty())
        inform(args.common, fmt::format("the orbits that were found could not be followed: Newton's method did not "
                                        "converge at {} = {}; try another start (--at)",
                                        table.key, value_text(table, table.start, scene.units)));
    const int code =
        write_result({[&] { return output::orbits_json(table); }, [&] { return to_text(table, scene.units); },
                      [&] { return branches_figure(table, swept, scene, args.files.lang); }},
                     args.files, scene, args.common, file_list);
    if (code != kDone) return code;
    return written && followed && !table.orbits.empty() ? kDone : kSolverFailed;
}

}  // namespace

void add_orbits(Program& program) {
    const auto [app, args] = add_command<OrbitsArguments>(
        program, "orbits", "Find periodic orbits and their stability, and follow them over a parameter", act);
    add_examples(app, {"orbits pressed.json --turns 1",
                       "orbits pressed.json --over cam.speed=40:60 -o branches.pdf -o branches.json"});
    add_note(
        app,
        "`beamcam init --from pressed` writes the scene of the examples. The exit code is 4 if no orbit is found, or "
        "if none can be followed, and 3 if only the picture is missing: of orbits without impacts there is none.");
    add_scene(app, args.scene, args.common);
    add_result_options(app, args.files, args.common,
                       "Write the result, too: .json, or a branch diagram as .png, .svg or .pdf (repeatable)");
    add_option(
        app, "--over", args.over, "KEY=FROM:TO",
        fmt::format("Follow the orbits found at the start, stable or not, at most {}, over this key of the scene, "
                    "also through folds, for example cam.speed=40:60. A branch ends when its motions have taken "
                    "about solver.max_steps steps in one direction",
                    kMostFollowed));
    add_option(app, "--at", args.at, "VALUE",
               "Start value in that range, with or without a unit (default: the scene's value, or the middle)");
    within(add_option(
               app, "--turns", args.search.turns, "N",
               "Period of the orbit in turns of the cam (default: the shortest of the motion). Orbits of several turns "
               "beside the motion, such as coexisting ones, are found with this option only"),
           1, 1000);
    within(add_option(app, "--most-turns", args.search.most_turns, "N",
                      "Longest period to try without --turns (default: 8)"),
           1, 1000);
    within(add_option(app, "--impacts", args.impacts, "M", "Number of impacts of the orbit in a period (default: any)"),
           0, 100000);
    add_option(app, "--transient", args.transient, "T",
               "Time left out before the search: turns of the cam (200) or a time (\"30 s\") (default: 20 s)");
    within(add_option(app, "--doublings", args.branches.doublings, "K",
                      "Number of successive period doublings to follow (default: 0)"),
           0, 20);
    within(add_option(app, "--step", args.branches.step, "SHARE",
                      "Longest step along a branch, as a share of the range (default: 0.01)"),
           1e-6, 0.5);
    within(add_option(app, "--most-points", args.branches.most_points, "N",
                      "Largest number of points of a branch in each direction (default: 2000)"),
           1, 1000000);
    add_option(app, "--sweep", args.sweep_file, "FILE",
               "Draw the impacts of a sweep over the same key (.csv or .npz) beneath the branches");
    within(add_option(app, "--row", args.row, "K",
                      "Start from row K of the table of --sweep: its state and the values of its swept keys"),
           1, 1000000000);
    add_option(app, "--scene", args.scene_file, "FILE.json",
               "Write a scene that begins on the first orbit, with a looping film of one period");
}

}  // namespace beamcam::scenes
