// `beamcam cam`: the outline of the cam and the straight lever that follows it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "output/data/records.hpp"
#include "output/data/tables.hpp"
#include "output/files/atomic_file.hpp"
#include "scenes/commands/result_files.hpp"
#include "scenes/figures/cam_drawing.hpp"
#include "scenes/figures/figure_files.hpp"
#include "scenes/motions/progress.hpp"
#include "scenes/scene/files.hpp"
#include "sim/cam/lever.hpp"
#include "sim/studies/beam_jump.hpp"

namespace beamcam::scenes {
namespace {

struct CamArguments {
    Common common;
    std::string scene;
    std::vector<std::string> files;
    bool beam = false;
};

double in_degrees(double angle) { return angle * 180 / std::numbers::pi; }

constexpr double kSameRadius = 1e-9;  // rounding of the radii of a circle

std::string summary_text(const sim::Lever::Summary& s) {
    std::string text = fmt::format("base radius                  {:.9g} m\n", s.base_radius);
    text += fmt::format("least radius of curvature    {:.9g} m", s.rho_min);
    const bool differs = s.rho_max - s.rho_min > kSameRadius * s.rho_max;
    if (differs && std::isfinite(s.rho_min_phi))
        text += fmt::format(" at the turn {:.6g} deg", in_degrees(s.rho_min_phi));
    text += fmt::format("\nlargest radius of curvature  {:.9g} m\n", s.rho_max);
    text += fmt::format("largest pressure angle       {:.6g} deg\n", in_degrees(s.pressure_angle_max));
    text += s.jump
                ? fmt::format(
                      "jump speed                   {:.10g} rad/s ({:.6g} rpm) at the turn {:.6g} deg, of a "
                      "straight rigid lever\n",
                      s.jump->speed, s.jump->speed * 30 / std::numbers::pi, in_degrees(s.jump->phi))
                : "jump speed                   none: a straight rigid lever stays on the cam, or the drive depends on "
                  "time\n";
    return text;
}

// The speed at which the beam of the scene leaves the cam.
sim::BeamJump jump_of_beam(const Scene& scene, const sim::Lever::Summary& summary, const Common& common) {
    const sim::Problem& p = scene.problem;
    if (is_prescribed(p.hub.drive)) throw UsageError("--beam: the drive prescribes the hub's angle; use a free hub");
    if (!summary.jump || !(summary.jump->speed > 0))
        throw UsageError(
            "--beam: a straight rigid lever has no jump speed from which the search could begin; see the gap_peak of "
            "`beamcam sweep SCENE --over cam.speed=FIRST:LAST:COUNT --sample peaks`");
    Progress progress(progress_style(common));
    progress.begin("jump speed of the beam", std::nullopt, "motions");
    const auto found = sim::beam_jump(p, summary.jump->speed, [&](double motion) { return progress.reach(motion); });
    if (!found)
        throw UsageError(
            fmt::format("--beam: the beam follows the cam up to twice the lever's jump speed, {:.6g} rad/s",
                        2 * summary.jump->speed));
    return *found;
}

std::string beam_text(const sim::BeamJump& jump) {
    const double speed = jump.leaves, rpm = speed * 30 / std::numbers::pi;
    if (jump.follows == 0)
        return fmt::format("jump speed of the beam       below {:.6g} rad/s ({:.6g} rpm)\n", speed, rpm);
    return fmt::format("jump speed of the beam       {:.6g} rad/s ({:.6g} rpm), started at rest on the cam\n", speed,
                       rpm);
}

// Points of the outline at equal steps of the normal: the angle of the normal and the points are in the cam's frame,
// `phi` is the turn of the cam at which a straight lever touches it there. `points` of a profile read them back.
output::ColumnTable outline_table(const sim::Lever& lever) {
    constexpr int kPoints = 1800;  // a fifth of a degree
    output::ColumnTable table;
    for (const char* name : {"alpha", "phi", "x", "y", "arc_length", "curvature"}) table.columns.push_back({name});
    for (int i = 0; i < kPoints; ++i) {
        const double alpha = sim::kFullTurn * i / kPoints;
        const sim::Lever::State state = lever.at_normal(alpha);
        const sim::Vec2 p = state.point.position(alpha);
        const double phi = state.phi - sim::kFullTurn * std::floor(state.phi / sim::kFullTurn);
        const double row[] = {alpha, phi, p.x, p.y, lever.shape().arc(alpha), 1 / state.point.radius};
        for (std::size_t k = 0; k < table.columns.size(); ++k) table.columns[k].values.push_back(row[k]);
    }
    return table;
}

void write_outline(const std::string& file, const Scene& scene, const sim::Lever& lever, output::FileList& file_list) {
    if (is_table(file)) return output::write_table(file_list.target(file), outline_table(lever));
    Scene alone = scene;
    alone.outputs.clear();
    const std::string text = to_json(alone);
    const std::string title =
        scene.title.empty() ? "Outline of the cam at 1:1" : scene.title + ": outline of the cam at 1:1";
    output::write_file(target_of(file, scene, file_list),
                       cam_drawing(scene.problem, lever, medium_of(file), document_of(title, "", text)));
}

int act(const CamArguments& args) {
    const Scene scene = load_scene(args.scene, args.common);
    if (!scene.problem.cam) throw SceneError(fmt::format("{}: the scene has no cam; give it one\n", args.scene));
    if (std::ranges::any_of(args.files, is_stdout))
        throw UsageError("-o -: name a file; standard output gets the summary");
    output::FileList file_list(args.common.force);
    require_writable("-o", args.files, {".csv", ".npz", ".svg", ".pdf"}, file_list);
    const sim::Lever lever(scene.problem);
    const sim::Lever::Summary summary = lever.summary();
    std::optional<sim::BeamJump> beam;
    if (args.beam) beam = jump_of_beam(scene, summary, args.common);
    print_result(args.common, output::cam_json(summary, beam), summary_text(summary) + (beam ? beam_text(*beam) : ""));
    return for_each_file(args.files, [&](const std::string& file) {
        write_outline(file, scene, lever, file_list);
        inform(args.common, "wrote " + file);
    });
}

}  // namespace

void add_cam(Program& program) {
    const auto [app, args] = add_command<CamArguments>(
        program, "cam", "Print base circle, curvature, pressure angle and jump speed of the cam; write its outline",
        act);
    add_examples(app, {"cam valve-lever.json", "cam valve-lever.json --json -o cam.csv -o cam.pdf"});
    add_note(
        app,
        "The jump speed is that of a straight rigid lever with the beam's inertia, pressed by gravity, the hub's "
        "spring "
        "and a constant torque. In JSON lengths are in m, angles in rad, speeds in rad/s; without a jump its values "
        "are null.");
    add_scene(app, args.scene, args.common);
    add_option(
        app, "-o,--output", args.files, "FILE",
        "Write the outline, too: its points as .csv or .npz, or the drawing at 1:1 as .svg or .pdf (repeatable)");
    app.add_flag("--beam", args.beam,
                 "Find the jump speed of the scene's beam, too, by simulating six turns at each of some speeds");
    add_json(app, args.common);
    add_force(app, args.common);
}

}  // namespace beamcam::scenes
