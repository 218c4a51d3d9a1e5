// A plan in words.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/plan.hpp"

namespace beamcam::scenes {
const char* view_name(const render::View& view) { return view.style == render::Style::lit ? "lit" : "flat"; }

const char* kind_name(Pictures::Kind kind) {
    switch (kind) {
        case Pictures::Kind::video:
            return "video";
        case Pictures::Kind::frames:
            return "frames";
        case Pictures::Kind::still:
            return "still";
    }
    return "?";
}

namespace {

std::string model_words(const sim::Problem& problem) {
    std::string words = name(problem.beam.model);
    const sim::ModelKind model = problem.beam.model;
    if (model == sim::ModelKind::exact)
        words += fmt::format(", {} shape functions", problem.beam.modes);
    else if (model != sim::ModelKind::rigid)
        words += fmt::format(", {} {} mode{}", problem.beam.modes, name(resolved_basis(problem)),
                             problem.beam.modes == 1 ? "" : "s");
    words += problem.cam ? fmt::format(", {} contact", name(problem.contact.model)) : ", no contact";
    return words;
}

std::string simulation_words(const Simulation& simulation, const sim::Problem& problem) {
    const sim::Request& request = simulation.request;
    std::string words = request.end_time > 0
                            ? fmt::format("{}; until {:g} s, because of {}", model_words(problem), request.end_time,
                                          simulation.until_because)
                            : fmt::format("{}; the initial state only, nothing to integrate", model_words(problem));
    if (request.horizon) words += "; a second run finds until when it is reproducible";
    return words;
}

std::string picture_words(const Pictures& p, std::size_t frames, double first, double last) {
    std::string words = p.kind == Pictures::Kind::still
                            ? fmt::format("{}: one picture of {:g} s", p.file, first)
                            : fmt::format("{}: {} frames of {:g} s to {:g} s at {:g} a second", p.file, frames, first,
                                          last, p.fps.value());
    words += fmt::format(", {} × {}, {}", p.size.width, p.size.height, view_name(p.view));
    if (p.kind == Pictures::Kind::video) words += fmt::format("; H.264, crf {}, {}", p.encoding.crf, p.encoding.preset);
    return words;
}

}  // namespace

std::string to_text(const Plan& plan, const Scene& scene) {
    std::string text = "to do\n";
    auto line = [&](std::string_view what, const std::string& how) { text += fmt::format("  {:<9} {}\n", what, how); };
    if (plan.simulation) line("simulate", simulation_words(*plan.simulation, scene.problem));
    for (const Pictures& p : plan.pictures) {
        const std::vector<double>& times = plan.simulation->request.poses[p.poses].times;
        line(kind_name(p.kind), picture_words(p, times.size(), times.front(), times.back()));
    }
    for (const TableFile& t : plan.tables) {
        const sim::TableRequest& table = plan.simulation->request.tables[t.table];
        line("table", fmt::format("{}: {} rows of {} channels", t.file, table.times.size(), table.channels.size()));
    }
    for (const ImpactsFile& i : plan.impacts) line("impacts", i.file);
    for (const SummaryFile& s : plan.summaries) line("summary", s.file);
    text += "skipped\n";
    for (const Skipped& skipped : plan.skipped) text += fmt::format("  {}: {}\n", skipped.what, skipped.why);
    return text;
}

}  // namespace beamcam::scenes
