#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "output/data/orbit_records.hpp"
#include "output/files/interrupt.hpp"
#include "scenes/commands/answer_files.hpp"
#include "scenes/figures/exponents.hpp"
#include "scenes/motions/progress.hpp"

namespace beamcam::scenes {
namespace {

struct LyapunovArguments {
    Common common;
    std::string scene;
    AnswerFiles files;
    std::optional<std::string> transient, duration;
    int count = 0, blocks = 20;
};

const char* verdict(sim::Chaos chaos) {
    switch (chaos) {
        case sim::Chaos::shown:
            return "the largest exponent is positive beyond its error: the motion is chaotic\n";
        case sim::Chaos::doubtful:
            return "whether the motion is chaotic is doubtful: the largest exponent is positive beyond its error only "
                   "by what near-grazing impacts add to it\n";
        case sim::Chaos::not_shown:
            return "no chaos is shown: the largest exponent is not positive beyond its error, differences grow by less "
                   "than e³ in the later half, or the motion had not settled\n";
    }
    return "";
}

std::string report(const sim::Exponents& e) {
    std::string text = fmt::format("Lyapunov exponents over {:g} s after {:g} s; {} impacts, {} near grazing\n",
                                   e.duration, e.transient, e.impacts, e.near_grazing);
    double sum = 0;
    for (std::size_t i = 0; i < e.lambda.size(); ++i) {
        sum += e.lambda[i];
        text += std::isfinite(e.lambda[i])
                    ? fmt::format("  {:3}  {:16.9g} ± {:.2g} 1/s\n", i + 1, e.lambda[i], e.error[i])
                    : fmt::format("  {:3}  {:>16}\n", i + 1, "-inf");
    }
    text += fmt::format("  sum  {:16.12g}\n", sum);
    return text + verdict(e.chaos());
}

int act(const LyapunovArguments& args) {
    const Scene scene = read_or_refuse(args.scene, args.common);
    if (const auto refusal = sim::tangent_refusal(scene.problem)) throw UsageError(*refusal);
    sim::ExponentsRequest request;
    request.count = args.count;
    request.blocks = args.blocks;
    request.transient = args.transient ? transient_argument(*args.transient, scene.problem) : 20;
    request.duration = args.duration ? seconds_argument("--duration", *args.duration) : 100;
    if (!(request.duration > 0)) throw UsageError("--duration must be positive");
    output::Manifest manifest(args.common.force);
    need_room("-o", args.files.names, {".json", ".png", ".svg", ".pdf"}, manifest);
    Progress progress(run_options(args.common, "").progress);
    const auto reached = [&](double t) {
        progress.reach(t);
        return !output::interrupted();
    };
    progress.begin("exponents", request.transient + request.duration, "s");
    sim::Exponents found = sim::lyapunov_exponents(scene.problem, request, reached);
    progress.end();
    if (found.chaos() != sim::Chaos::not_shown) {
        progress.begin("does it last", request.transient + 2 * request.duration, "s");
        sim::confirm_chaos(scene.problem, request, found, reached);
        progress.end();
    }
    const auto content = [&](const std::string& file) {
        if (file == "-" || file.ends_with(".json")) return output::exponents_json(found);
        return args.files.drawn(exponents_figure(found, scene.problem, args.files.lang()), scene, file);
    };
    write_answer({[&] { return output::exponents_json(found); }, [&] { return report(found); }, content}, args.files,
                 args.common, manifest);
    if (std::cmp_greater(args.count, found.lambda.size()))
        say(args.common, fmt::format("note: there are {} exponents, no {}", found.lambda.size(), args.count));
    for (const std::string& warning : found.warnings) say(args.common, "warning: " + warning);
    return 0;
}

}  // namespace

void add_lyapunov(Grammar& grammar) {
    auto args = std::make_shared<LyapunovArguments>();
    Command& app = grammar.command("lyapunov", "Lyapunov exponents of a motion: is it chaotic?");
    add_scene(app, args->scene, args->common);
    app.option("-o,--output", &args->files.names, "FILE",
               "Also as .json, or their convergence as .png, .svg or .pdf (repeatable)");
    app.option("--count", &args->count, "K", "Only the K largest (default: the whole spectrum)").range(1, 82);
    app.option("--transient", &args->transient, "T",
               "Left out at the start: turns of the cam, as 200, or a time, as \"30 s\" (default: 20 s)");
    app.option("--duration", &args->duration, "T", "Averaged over (default: 100 s)");
    app.option("--blocks", &args->blocks, "N", "Blocks whose spread gives the error (default: 20)").range(2, 1000);
    add_answer_files(app, args->files, args->common);
    app.bind(args, act);
}

}  // namespace beamcam::scenes
