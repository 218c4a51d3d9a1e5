#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <optional>

#include "output/data/orbit_records.hpp"
#include "output/data/table_reader.hpp"
#include "output/files/atomic_file.hpp"
#include "output/files/interrupt.hpp"
#include "scenes/commands/answer_files.hpp"
#include "scenes/figures/branches.hpp"
#include "scenes/format/suggest.hpp"
#include "scenes/format/units.hpp"
#include "scenes/motions/identity.hpp"
#include "scenes/motions/progress.hpp"
#include "scenes/scene/version.hpp"
#include "sim/base/ode.hpp"
#include "sim/problem/number_keys.hpp"
#include "sim/sweep/attractor.hpp"

namespace beamcam::scenes {
namespace {

struct OrbitsArguments {
    Common common;
    std::string scene;
    AnswerFiles files;
    std::optional<std::string> transient, over, scene_file, sweep_file;
    std::optional<double> at;
    int turns = 0, most_turns = 8, impacts = -1, doublings = 0, most_points = 2000, row = 0;
    double step = 0.01;
};

// "cam.speed=40:60"
struct KeyRange {
    sim::NumberKey key;
    double from = 0, to = 0;
};

KeyRange range_argument(const std::string& over, const sim::Problem& problem) {
    const std::size_t equals = over.find('='), colon = over.find(':', equals);
    if (equals == std::string::npos || colon == std::string::npos || over.find(':', colon + 1) != std::string::npos)
        throw UsageError(fmt::format("--over {}: write KEY=FROM:TO, for example cam.speed=40:60", over));
    const std::string path = over.substr(0, equals), option = "--over " + over;
    const std::vector<sim::NumberKey> keys = sim::number_keys(problem);
    const auto key = std::ranges::find(keys, path, &sim::NumberKey::path);
    if (key == keys.end()) {
        std::vector<std::string> known;
        for (const sim::NumberKey& each : keys) known.push_back(each.path);
        throw SceneError(fmt::format("{}: {} is no number of this scene{}", option, in_quotes(path),
                                     suggestion_or_list(path, known)));
    }
    KeyRange range{*key, signed_argument(option, over.substr(equals + 1, colon - equals - 1), key->dimension),
                   signed_argument(option, over.substr(colon + 1), key->dimension)};
    if (!(range.from < range.to)) throw UsageError(fmt::format("{}: the range must ascend", option));
    return range;
}

// The problems of the range.
class ProblemFamily {
  public:
    ProblemFamily(sim::Problem problem, std::string key) : problem_(std::move(problem)), key_(std::move(key)) {}

    // Throws SceneError where the problem is impossible.
    sim::Problem at(double value) const {
        sim::Problem problem = problem_;
        if (!sim::set_number(problem, key_, value))
            throw SceneError(fmt::format("{} = {:.10g} is outside its range or no whole number", key_, value));
        for (const sim::Finding& finding : sim::validate(problem))
            if (finding.fatal)
                throw SceneError(fmt::format("at {} = {:.10g}: {}: {}", key_, value, finding.path, finding.message));
        return problem;
    }
    // Between the ends of the range a value may still be impossible.
    sim::Problem operator()(double value) const try { return at(value); } catch (const SceneError& error) {
        throw sim::StepFailure(error.what());
    }

  private:
    sim::Problem problem_;
    std::string key_;
};

std::string complex_text(std::complex<double> m) {
    return m.imag() == 0 ? fmt::format("{:.9g}", m.real()) : fmt::format("{:.9g}{:+.9g}i", m.real(), m.imag());
}

std::string orbit_text(const sim::PeriodicOrbit& orbit) {
    std::string text = fmt::format(
        "period {} {} of the cam, {} {}: {}{}\n", orbit.turns, orbit.turns == 1 ? "turn" : "turns",
        orbit.impacts.size(), orbit.impacts.size() == 1 ? "impact" : "impacts", orbit.stable() ? "stable" : "unstable",
        orbit.chatters()          ? ", rests on the cam for a while"
        : orbit.always_touching() ? ", always touching"
                                  : "");
    text += fmt::format("  period {:.12g} s, section at cam angle {:.9g} rad, residual {:.1e}\n", orbit.period,
                        orbit.section, orbit.residual);
    text += "  multipliers";
    for (const auto& m : orbit.multipliers) text += " " + complex_text(m);
    text += "\n";
    constexpr std::size_t kShown = 12;
    for (std::size_t i = 0; i < std::min(kShown, orbit.impacts.size()); ++i)
        text += fmt::format("  impact at cam angle {:.9g} rad, approach {:.9g} m/s\n", orbit.impacts[i].cam_angle,
                            orbit.impacts[i].approach);
    if (orbit.impacts.size() > kShown) text += fmt::format("  and {} more\n", orbit.impacts.size() - kShown);
    return text;
}

std::string branches_text(const output::BranchTable& table) {
    std::string text;
    for (const sim::Branch& branch : table.branches) {
        const auto [low, high] =
            std::minmax_element(branch.points.begin(), branch.points.end(),
                                [](const auto& a, const auto& b) { return a.parameter < b.parameter; });
        const sim::PeriodicOrbit& orbit = branch.points.front().orbit;
        text += fmt::format("branch of {} {}, {} impacts: {} points, {} from {:.9g} to {:.9g}\n", orbit.turns,
                            orbit.turns == 1 ? "turn" : "turns", orbit.impacts.size(), branch.points.size(), table.key,
                            low->parameter, high->parameter);
        for (const sim::SpecialPoint& point : branch.special)
            text += fmt::format("  {:16} {} = {:.13g} ± {:.0e}\n", name(point.change), table.key, point.at.parameter,
                                point.uncertainty);
        for (const std::string& end : {branch.first_end, branch.last_end})
            if (!end.empty()) text += fmt::format("  ends: {}\n", end);
    }
    return text;
}

// The scene's value if it lies in the range, else its middle.
double start_value(const OrbitsArguments& args, const KeyRange& range) {
    const double middle = 0.5 * (range.from + range.to), start = args.at.value_or(range.key.value);
    if (args.at && !(start >= range.from && start <= range.to))
        throw UsageError("--at lies outside the range of --over");
    return start >= range.from && start <= range.to ? start : middle;
}

// What a table of impacts, as `sweep` writes it, has in the range.
SweptImpacts swept_impacts(const std::string& file, const KeyRange& range) {
    const output::NamedTable table = output::read_table(file);
    const std::vector<double>*value = table.find(range.key.path), *speed = table.find("v_n_before");
    for (const auto& [column, name] : {std::pair{value, range.key.path.c_str()}, std::pair{speed, "v_n_before"}})
        if (!column)
            throw UsageError(
                fmt::format("--sweep {}: it has no column {}; write it by beamcam sweep --over {}=... "
                            "--sample impacts -o {}",
                            file, name, range.key.path, file));
    SweptImpacts out;
    const std::vector<double>* kind = table.find("class");
    std::vector<double> sections;
    for (const auto& [section, name] : sim::names(sim::AttractorClass{}))
        if (sim::has_section(section)) sections.push_back(static_cast<double>(section));
    for (std::size_t i = 0; i < table.rows(); ++i) {
        if (kind && std::ranges::none_of(sections, [&](double section) { return section == (*kind)[i]; })) continue;
        if (!((*value)[i] >= range.from && (*value)[i] <= range.to) || std::isnan((*speed)[i])) continue;
        out.parameter.push_back((*value)[i]);
        out.approach.push_back(-(*speed)[i]);
    }
    return out;
}

// The scene in the state of a row of a sweep's table: the values of its keys, the cam's angle, θ and θ̇. What else the
// beam has, its vibration, the transient brings.
sim::Problem at_row(sim::Problem problem, const std::string& file, int row) {
    const output::NamedTable table = output::read_table(file);
    const auto index = static_cast<std::size_t>(row - 1);
    if (index >= table.rows()) throw UsageError(fmt::format("--row {}: {} has {} rows", row, file, table.rows()));
    const auto value = [&](const char* name) {
        const std::vector<double>* column = table.find(name);
        if (!column || std::isnan((*column)[index]))
            throw UsageError(fmt::format("--row {}: there is no {} in this row of {}", row, name, file));
        return (*column)[index];
    };
    for (const sim::NumberKey& key : sim::number_keys(problem))
        if (const std::vector<double>* column = table.find(key.path))
            problem = ProblemFamily(problem, key.path).at((*column)[index]);
    if (!problem.cam) throw UsageError("--row: the scene has no cam");
    constexpr double kAbove = 1e-9;  // [rad] so that a row of impacts begins outside the cam
    problem.cam->phase = value("cam_angle");
    problem.initial = {};
    problem.initial.angle = value("theta") + kAbove;
    problem.initial.angular_velocity = value("theta_dot");
    return problem;
}

bool is_data_file(const std::string& file) { return file == "-" || file.ends_with(".json") || is_table(file); }

std::string content(const output::BranchTable& table, const SweptImpacts& swept, const OrbitsArguments& args,
                    const Scene& scene, const std::string& file) {
    if (file == "-" || file.ends_with(".json")) return output::orbits_json(table);
    return args.files.drawn(branches_figure(table, swept, scene.problem, args.files.lang()), scene, file);
}

// Of a NetCDF file.
std::vector<std::pair<std::string, std::string>> attributes_of(const Scene& scene) {
    return {{"Conventions", "CF-1.8"},
            {"source", fmt::format("beamcam {}", kVersion)},
            {"title", "Periodic orbits"},
            {"beamcam_scene", to_json(scene)},
            {"beamcam_program", program_identity()}};
}

// The first that rests on the cam for a while, or that does not.
const sim::PeriodicOrbit* first_of(const std::vector<sim::PeriodicOrbit>& orbits, bool resting) {
    for (const sim::PeriodicOrbit& orbit : orbits)
        if (orbit.chatters() == resting) return &orbit;
    return nullptr;
}

// Where the start has no orbit to continue, another value of the range may have.
void begin_elsewhere(output::BranchTable& table, const ProblemFamily& family, const KeyRange& range,
                     sim::OrbitRequest request, const sim::Progress& progress) {
    request.transient = 0;
    for (const double share : {0.5, 0.25, 0.75, 0.125, 0.375, 0.625, 0.875}) {
        const double value = range.from + share * (range.to - range.from);
        std::vector<sim::PeriodicOrbit> found = sim::find_orbits(family.at(value), request, progress);
        if (!first_of(found, false)) continue;
        table.start = value;
        table.orbits = std::move(found);
        return;
    }
}

// Of the first orbit without rest on the cam, and of the first with it.
void follow_branches(output::BranchTable& table, const ProblemFamily& family, const KeyRange& range,
                     const sim::OrbitRequest& request, const OrbitsArguments& args, const sim::Progress& progress) {
    const sim::ContinuationRequest how{range.from, range.to, args.step, args.most_points, args.doublings};
    const auto follow = [&](double value, const sim::PeriodicOrbit* orbit) {
        if (!orbit) return;
        for (sim::Branch& branch :
             sim::continue_orbit([&](double v) { return family(v); }, {value, *orbit}, how, progress))
            table.branches.push_back(std::move(branch));
    };
    const double start = table.start;
    const std::vector<sim::PeriodicOrbit> found = table.orbits;
    if (!first_of(found, false)) begin_elsewhere(table, family, range, request, progress);
    follow(table.start, first_of(table.orbits, false));
    follow(start, first_of(found, true));
}

std::string in_words(const output::BranchTable& table) {
    std::string text;
    for (const sim::PeriodicOrbit& orbit : table.orbits) text += orbit_text(orbit);
    return text + branches_text(table);
}

// The scene that moves on the orbit, with one film: the second period, whose first picture follows on its last. It
// looks like the scene's own film and lasts as long, at least three seconds.
Scene scene_on(const Scene& scene, const sim::PeriodicOrbit& orbit, const sim::Problem& begun, std::string name) {
    constexpr double kShortest = 3;  // [s]
    VideoOutput film = film_to_imitate(scene);
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

void write_scene(const OrbitsArguments& args, const Scene& scene, const std::vector<sim::PeriodicOrbit>& orbits,
                 output::Manifest& manifest) {
    for (const sim::PeriodicOrbit& orbit : orbits)
        if (const std::optional<sim::Problem> begun = sim::begun_on(scene.problem, orbit)) {
            const Scene on = scene_on(scene, orbit, *begun, std::filesystem::path(*args.scene_file).stem().string());
            output::write_file(manifest.target(*args.scene_file), to_json(on));
            manifest.save();
            return say(args.common, "wrote " + *args.scene_file);
        }
    if (!orbits.empty())
        say(args.common, fmt::format("{} is not written: on these orbits the beam never leaves the cam; film "
                                     "the scene itself, after its transient",
                                     *args.scene_file));
}

int act(const OrbitsArguments& args) {
    Scene scene = read_or_refuse(args.scene, args.common);
    if (args.row > 0 && args.sweep_file) scene.problem = at_row(scene.problem, *args.sweep_file, args.row);
    std::optional<KeyRange> range;
    if (args.over) range = range_argument(*args.over, scene.problem);
    output::Manifest manifest(args.common.force);
    need_room("-o", args.files.names, {".json", ".csv", ".npz", ".nc", ".png", ".svg", ".pdf"}, manifest);
    if (args.scene_file) {
        if (*args.scene_file == "-") throw UsageError("--scene -: give a file; films are named after it");
        need_room("--scene", {*args.scene_file}, {".json"}, manifest);
    }
    for (const std::string& file : args.files.names)
        if (!range && !is_data_file(file)) throw UsageError(fmt::format("-o {}: a branch diagram needs --over", file));
    if (!range && (args.at || args.doublings > 0))
        throw UsageError("--at and --doublings belong to branches: give --over KEY=FROM:TO");
    if (args.row > 0 && !args.sweep_file) throw UsageError("--row: give the table by --sweep");
    if (args.sweep_file && !range && args.row == 0)
        throw UsageError(
            "--sweep: the points of a sweep stand beneath branches (give --over), or begin a search (give --row)");
    const SweptImpacts swept = args.sweep_file && range ? swept_impacts(*args.sweep_file, *range) : SweptImpacts{};
    std::optional<ProblemFamily> family;
    double start = 0;
    if (range) {
        family.emplace(scene.problem, range->key.path);
        family->at(range->from);  // an impossible end is refused
        family->at(range->to);
        start = start_value(args, *range);
        scene.problem = family->at(start);
    }
    if (const auto refusal = sim::orbit_refusal(scene.problem)) throw UsageError(*refusal);

    sim::OrbitRequest request;
    if (args.transient) request.transient = seconds_argument("--transient", *args.transient);
    request.turns = args.turns;
    request.most_turns = args.most_turns;
    if (args.impacts >= 0) request.impacts = args.impacts;
    Progress progress(run_options(args.common, "").progress);
    progress.begin("orbits", range ? 0 : 1, "");
    const auto goes_on = [](double) { return !output::interrupted(); };
    output::BranchTable table;
    table.orbits = sim::find_orbits(scene.problem, request, goes_on);
    if (range) {
        table.key = range->key.path;
        table.unit = si_unit(range->key.dimension);
        table.start = start;
        follow_branches(table, *family, *range, request, args, goes_on);
    }
    progress.end();

    write_answer({[&] { return output::orbits_json(table); }, [&] { return in_words(table); },
                  [&](const std::string& file) { return content(table, swept, args, scene, file); },
                  [&] { return output::orbit_columns(table, attributes_of(scene)); }},
                 args.files, args.common, manifest);
    if (args.scene_file) write_scene(args, scene, table.orbits, manifest);
    if (table.orbits.empty())
        say(args.common, "no periodic orbit was found: try another initial state, --turns, --impacts or --transient");
    else if (range && table.branches.empty())
        say(args.common, "the orbits that were found could not be followed");
    return 0;
}

}  // namespace

void add_orbits(Grammar& grammar) {
    auto args = std::make_shared<OrbitsArguments>();
    Command& app = grammar.command("orbits", "Periodic orbits, their stability, and their branches over a parameter");
    add_scene(app, args->scene, args->common);
    app.option("-o,--output", &args->files.names, "FILE",
               "Also as .json, .csv, .npz or .nc, or a branch diagram as .png, .svg or .pdf (repeatable)");
    app.option("--over", &args->over, "KEY=FROM:TO",
               "Continue the orbit over this key of the scene, through folds, for example cam.speed=40:60, and one "
               "beside it that "
               "rests on the cam for a part of its period");
    app.option("--at", &args->at, "VALUE",
               "Where in that range to begin (default: the scene's own value, or the middle)");
    app.option("--turns", &args->turns, "N", "Only orbits of this period in turns of the cam (default: the fewest)")
        .range(1, 1000);
    app.option("--most-turns", &args->most_turns, "N", "Longest period that is tried (default: 8)").range(1, 1000);
    app.option("--impacts", &args->impacts, "M", "Only orbits of so many impacts").range(0, 100000);
    app.option("--transient", &args->transient, "T", "Left out before the search (default: 20 s)");
    app.option("--doublings", &args->doublings, "K", "Branches on which period doublings are followed (default: 0)")
        .range(0, 20);
    app.option("--step", &args->step, "SHARE", "Longest step along a branch, of the range (default: 0.01)")
        .range(1e-6, 0.5);
    app.option("--most-points", &args->most_points, "N", "Points of a branch in each direction (default: 2000)")
        .range(1, 1000000);
    app.option("--sweep", &args->sweep_file, "FILE",
               "Impacts of a sweep over the same key, .csv or .npz, beneath the branches of the diagram");
    app.option("--row", &args->row, "K",
               "Begin in the state of row K of the table of --sweep, with the values of its swept keys")
        .range(1, 1000000000);
    app.option("--scene", &args->scene_file, "FILE.json",
               "Also a scene that begins on the first orbit, with a film of one period that loops: render it next");
    add_answer_files(app, args->files, args->common);
    app.bind(args, act);
}

}  // namespace beamcam::scenes
