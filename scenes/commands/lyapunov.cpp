// `beamcam lyapunov`: the Lyapunov exponents of a motion.
#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "output/data/orbit_records.hpp"
#include "scenes/commands/result_files.hpp"
#include "scenes/figures/caption.hpp"
#include "scenes/figures/command_figures.hpp"
#include "scenes/motions/progress.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {
namespace {

struct LyapunovArguments {
    Common common;
    std::string scene;
    ResultFiles files;
    std::optional<std::string> transient, duration;
    sim::ExponentsRequest request{.count = 0};
};

std::string verdict(const sim::Exponents& e) {
    switch (e.chaos()) {
        case sim::Chaos::shown:
            return "the motion is chaotic: the largest exponent exceeds three times its error\n";
        case sim::Chaos::doubtful:
            return "it is doubtful whether the motion is chaotic: without the contribution of near-grazing impacts the "
                   "largest exponent does not exceed three times its error\n";
        case sim::Chaos::not_shown:
            return fmt::format("no chaos is shown: {}\n", e.against_chaos());
    }
    return "";
}

std::string exponents_text(const sim::Exponents& e) {
    std::string text = fmt::format("Lyapunov exponents over {:g} s after {:g} s; {}, {} near grazing\n", e.duration,
                                   e.transient, counted(e.impacts, "impact"), e.near_grazing);
    double sum = 0;
    for (std::size_t i = 0; i < e.lambda.size(); ++i) {
        sum += e.lambda[i];
        text += std::isfinite(e.lambda[i]) ? fmt::format("  {:3}  {:16.{}f} ± {:.2g} 1/s\n", i + 1, e.lambda[i],
                                                         decimals_of(e.error[i]), e.error[i])
                                           : fmt::format("  {:3}  {:>16}\n", i + 1, "-inf");
    }
    text += fmt::format("  sum  {:16.12g}\n", sum);
    return text + verdict(e);
}

int act(const LyapunovArguments& args) {
    const Scene scene = load_scene(args.scene, args.common);
    sim::ExponentsRequest request = args.request;
    request.transient = args.transient ? transient_argument(*args.transient, scene.problem) : 20;
    if (args.duration) request.duration = positive_argument("--duration", *args.duration, dimension::kTime);
    output::FileList file_list(args.common.force);
    require_writable("-o", args.files.names, {".json", ".png", ".svg", ".pdf"}, file_list);
    Progress progress(progress_style(args.common));
    const auto reached = [&](double t) { return progress.reach(t); };
    progress.begin("exponents", request.transient + request.duration, "s");
    sim::Exponents found = sim::lyapunov_exponents(scene.problem, request, reached);
    progress.end();
    if (found.chaos() != sim::Chaos::not_shown) {
        progress.begin("confirming", request.transient + 2 * request.duration, "s");
        sim::confirm_chaos(scene.problem, request, found, reached);
        progress.end();
    }
    const int code = write_result({[&] { return output::exponents_json(found); }, [&] { return exponents_text(found); },
                                   [&] { return exponents_figure(found, subject_of(scene, args.files.lang)); }},
                                  args.files, scene, args.common, file_list);
    if (std::cmp_greater(request.count, found.lambda.size()))
        inform(args.common,
               fmt::format("note: the motion has {}, not {}", counted(found.lambda.size(), "exponent"), request.count));
    for (const std::string& warning : found.warnings) inform(args.common, "warning: " + warning);
    return code;
}

}  // namespace

void add_lyapunov(Program& program) {
    const auto [app, args] = add_command<LyapunovArguments>(
        program, "lyapunov", "Compute the Lyapunov exponents of a motion, which show chaos", act);
    add_examples(app,
                 {"lyapunov pressed.json --set cam.speed=54.3 --transient 200 --duration '60 s' -o convergence.pdf"});
    add_note(
        app,
        "`beamcam init --from pressed` writes the scene of the example. In JSON, which has no infinities, an exponent "
        "of −∞ is null, as where lasting contact removes every difference; \"chaotic\" is null if it is doubtful.");
    add_scene(app, args.scene, args.common);
    add_result_options(app, args.files, args.common,
                       "Write the result, too: .json, or the convergence as .png, .svg or .pdf (repeatable)");
    within(add_option(app, "--count", args.request.count, "K", "Compute the K largest only (default: all)"), 1, 82);
    add_option(app, "--transient", args.transient, "T",
               "Time left out at the start: turns of the cam (200) or a time (\"30 s\") (default: 20 s)");
    add_option(app, "--duration", args.duration, "T", "Averaging time (default: 100 s)");
    within(add_option(app, "--blocks", args.request.blocks, "N",
                      "Number of blocks of that time; their scatter gives the error (default: 20)"),
           2, 1000);
}

}  // namespace beamcam::scenes
