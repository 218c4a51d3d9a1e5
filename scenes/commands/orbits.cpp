#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "output/data/manifest.hpp"
#include "output/data/records.hpp"
#include "output/files/atomic_file.hpp"
#include "output/files/interrupt.hpp"
#include "render/plot/style.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/figures/branches.hpp"
#include "scenes/figures/make.hpp"
#include "scenes/format/reader.hpp"
#include "scenes/motions/progress.hpp"
#include "sim/base/ode.hpp"

namespace beamcam::scenes {
namespace {

struct OrbitsArguments {
    Common common;
    std::string scene;
    std::vector<std::string> files;
    std::optional<std::string> transient, over;
    std::optional<double> at;
    std::string column = "elsevier", lang = "en";
    int turns = 0, most_turns = 8, impacts = -1, doublings = 0, most_points = 2000;
    double step = 0.01;
};

// "cam.speed=40:60"
struct KeyRange {
    std::string key;
    double from = 0, to = 0;
};

double bound(const std::string& over, const std::string& text) {
    const QuantityText read = parse_quantity(text);
    if (!read.quantity) throw UsageError(fmt::format("--over {}: {}", over, read.problem));
    return read.quantity->value;
}

KeyRange range_argument(const std::string& over) {
    const std::size_t equals = over.find('='), colon = over.find(':', equals);
    if (equals == std::string::npos || colon == std::string::npos)
        throw UsageError(fmt::format("--over {}: write KEY=FROM:TO, for example cam.speed=40:60", over));
    KeyRange range{over.substr(0, equals), bound(over, over.substr(equals + 1, colon - equals - 1)),
                   bound(over, over.substr(colon + 1))};
    if (!(range.from < range.to)) throw UsageError(fmt::format("--over {}: the range must ascend", over));
    return range;
}

// The scene's own number at the key; nothing where it has none.
std::optional<double> own_value(const Scene& scene, const std::string& key) {
    Node node = node_of(to_json(scene));
    for (std::size_t from = 0; from <= key.size();) {
        const std::size_t dot = std::min(key.find('.', from), key.size());
        const Member* member = node.find(std::string_view(key).substr(from, dot - from));
        if (!member) return std::nullopt;
        node = Node(member->value);
        from = dot + 1;
    }
    return node.kind == Node::Kind::number ? std::optional(node.number) : std::nullopt;
}

// Reads the scene anew for each value.
class SceneFamily {
  public:
    SceneFamily(const OrbitsArguments& args, std::string key)
        : source_(load_source(args.scene)), overrides_(args.common.overrides), key_(std::move(key)) {
        overrides_.emplace_back();
    }
    Scene scene(double value) const {
        overrides_.back() = fmt::format("{}={}", key_, value);
        Reading reading = read_scene(source_, overrides_);
        if (!reading.scene) throw SceneError(reading.report());
        return std::move(*reading.scene);
    }
    // Between the ends of the range a value may still be impossible.
    sim::Problem operator()(double value) const try { return scene(value).problem; } catch (const SceneError& error) {
        throw sim::StepFailure(error.what());
    }

  private:
    Source source_;
    mutable std::vector<std::string> overrides_;
    std::string key_;
};

std::string complex_text(std::complex<double> m) {
    return m.imag() == 0 ? fmt::format("{:.9g}", m.real()) : fmt::format("{:.9g}{:+.9g}i", m.real(), m.imag());
}

std::string orbit_text(const sim::PeriodicOrbit& orbit) {
    std::string text = fmt::format(
        "period {} {} of the cam, {} {}: {}{}\n", orbit.turns, orbit.turns == 1 ? "turn" : "turns",
        orbit.impacts.size(), orbit.impacts.size() == 1 ? "impact" : "impacts", orbit.stable() ? "stable" : "unstable",
        orbit.chatters            ? ", rests on the cam for a while"
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
double start_value(const OrbitsArguments& args, const Scene& scene, const KeyRange& range) {
    const double middle = 0.5 * (range.from + range.to);
    const double start = args.at.value_or(own_value(scene, range.key).value_or(middle));
    if (args.at && !(start >= range.from && start <= range.to))
        throw UsageError("--at lies outside the range of --over");
    return start >= range.from && start <= range.to ? start : middle;
}

std::string content(const output::BranchTable& table, const OrbitsArguments& args, Scene scene,
                    const std::string& file) {
    if (file == "-" || file.ends_with(".json")) return output::orbits_json(table);
    if (file.ends_with(".csv")) return output::orbits_csv(table);
    FigureOutput how;
    how.file = file;
    how.figure = "branches";
    how.column = args.column;
    how.lang = args.lang == "zh" ? Lang::zh : Lang::en;
    scene.outputs.clear();
    return figure_files(branches_figure(table, scene.problem, how.lang), how, to_json(scene)).front().second;
}

// The first that can be continued.
const sim::PeriodicOrbit* first_smooth(const std::vector<sim::PeriodicOrbit>& orbits) {
    for (const sim::PeriodicOrbit& orbit : orbits)
        if (!orbit.chatters) return &orbit;
    return nullptr;
}

// Where the start has no orbit to continue, another value of the range may have.
void begin_elsewhere(output::BranchTable& table, const SceneFamily& family, const KeyRange& range,
                     sim::OrbitRequest request, const sim::Progress& progress) {
    request.transient = 0;
    for (const double share : {0.5, 0.25, 0.75, 0.125, 0.375, 0.625, 0.875}) {
        const double value = range.from + share * (range.to - range.from);
        std::vector<sim::PeriodicOrbit> found = sim::find_orbits(family.scene(value).problem, request, progress);
        if (!first_smooth(found)) continue;
        table.start = value;
        table.orbits = std::move(found);
        return;
    }
}

void write_results(const output::BranchTable& table, const OrbitsArguments& args, const Scene& scene,
                   output::Manifest& manifest) {
    const bool prints_data = std::find(args.files.begin(), args.files.end(), "-") != args.files.end();
    if (args.common.json) {
        print_json(output::orbits_json(table));
    } else if (!prints_data) {
        for (const sim::PeriodicOrbit& orbit : table.orbits) print_text(orbit_text(orbit));
        print_text(branches_text(table));
    }
    for (const std::string& file : args.files) {
        const std::string text = content(table, args, scene, file);
        if (file == "-") {
            print_data(text);
            continue;
        }
        output::write_file(manifest.target(file), text);
        say(args.common, "wrote " + file);
    }
}

int act(const OrbitsArguments& args) {
    Scene scene = read_or_refuse(args.scene, args.common);
    std::optional<KeyRange> range;
    if (args.over) range = range_argument(*args.over);
    output::Manifest manifest(args.common.force);
    for (const std::string& file : args.files) {
        need_ending("-o", file, {".json", ".csv", ".png", ".svg", ".pdf"});
        const bool table = file == "-" || file.ends_with(".json") || file.ends_with(".csv");
        if (!table && !range) throw UsageError(fmt::format("-o {}: a branch diagram needs --over", file));
        if (file != "-") manifest.require_replaceable(file);
    }
    std::optional<SceneFamily> family;
    double start = 0;
    if (range) {
        family.emplace(args, range->key);
        family->scene(range->from);  // refused with its place in the scene
        family->scene(range->to);
        start = start_value(args, scene, *range);
        scene.problem = family->scene(start).problem;
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
        table.key = range->key;
        table.start = start;
        if (!first_smooth(table.orbits)) begin_elsewhere(table, *family, *range, request, goes_on);
        const sim::ContinuationRequest how{range->from, range->to, args.step, args.most_points, args.doublings};
        if (const sim::PeriodicOrbit* orbit = first_smooth(table.orbits))
            table.branches = sim::continue_orbit([&](double value) { return (*family)(value); }, {table.start, *orbit},
                                                 how, goes_on);
    }
    progress.end();

    write_results(table, args, scene, manifest);
    manifest.save();
    if (table.orbits.empty())
        say(args.common, "no periodic orbit was found: try another initial state, --turns, --impacts or --transient");
    else if (range && table.branches.empty())
        say(args.common, "only orbits that rest on the cam for a while were found; they are not continued");
    return 0;
}

}  // namespace

void add_orbits(Grammar& grammar) {
    auto args = std::make_shared<OrbitsArguments>();
    Command& app = grammar.command("orbits", "Periodic orbits, their stability, and their branches over a parameter");
    add_scene(app, args->scene, args->common);
    app.option("-o,--output", &args->files, "FILE",
               "Also as .json or .csv, or a branch diagram as .png, .svg or .pdf (repeatable)");
    app.option("--over", &args->over, "KEY=FROM:TO",
               "Continue the orbit over this key of the scene, through folds, for example cam.speed=40:60");
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
    app.option("--column", &args->column, "COLUMN", "Width and letters of a journal's column, for the diagram")
        .one_of(render::figure::column_names());
    app.option("--lang", &args->lang, "LANG", "Language of the diagram: en or zh").one_of({"en", "zh"});
    app.option("--progress", &args->common.progress, "STYLE",
               "Progress on standard error: auto, bar, plain, json or none");
    app.flag("--json", args->common.json, "As JSON on standard output");
    app.flag("--force", args->common.force, "Replace files that beamcam did not make");
    app.bind(args, act);
}

}  // namespace beamcam::scenes
