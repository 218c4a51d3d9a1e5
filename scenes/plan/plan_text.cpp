// The plan as text.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "scenes/format/keys.hpp"
#include "scenes/plan/plan.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {
const char* view_name(const render::View& view) {
    return std::ranges::find(kStyles, view.style, &sim::Named<render::Style>::value)->name;
}

const char* kind_name(PictureOutput::Kind kind) {
    return std::ranges::find(kPictureTypes, kind, &PictureType::kind)->name;
}

std::string encoding_text(const Encoding& encoding) {
    std::string text = output::title(encoding.codec);
    if (encoding.crf) text += fmt::format(", crf {}", *encoding.crf);
    if (encoding.codec == output::Codec::h264) text += ", " + encoding.preset;
    if (encoding.variable_rate) text += ", variable frame rate";
    return text;
}

namespace {

std::string model_text(const sim::Problem& problem) {
    std::string text = name(problem.beam.model);
    const sim::ModelKind model = problem.beam.model;
    if (model == sim::ModelKind::exact)
        text += fmt::format(", {} shape functions", problem.beam.modes);
    else if (model != sim::ModelKind::rigid)
        text += fmt::format(", {}", counted(problem.beam.modes, fmt::format("{} mode", name(resolved_basis(problem)))));
    text += problem.cam ? fmt::format(", {} contact", name(problem.contact.model)) : ", no contact";
    return text;
}

// Two digits: "0.31", "5200".
std::string about(double value) {
    if (!(value > 0)) return "0";
    const double unit = std::pow(10, std::floor(std::log10(value)) - 1);
    return fmt::format("{:.10g}", std::round(value / unit) * unit);
}

std::string size_text(double bytes) {
    return bytes < 1e6   ? about(std::max(1.0, bytes / 1e3)) + " kB"
           : bytes < 1e9 ? about(bytes / 1e6) + " MB"
                         : about(bytes / 1e9) + " GB";
}

std::string simulation_text(const Simulation& simulation) {
    const double end = simulation.request.end_time;
    std::string text = model_text(simulation.problem) + "; ",
                events = fmt::format("{}", fmt::join(simulation.until_events, ", "));
    if (end > 0) text += fmt::format("until {:g} s, needed by {}", end, simulation.until_because);
    if (!events.empty()) text += fmt::format("{}until {}", end > 0 ? ", or, if later, " : "", events);
    if (!(end > 0) && events.empty()) text += "the initial state only, without integration";
    if (!simulation.label.empty()) text += fmt::format(" for \"{}\"", simulation.label);
    if (simulation.horizon) text += "; further runs find the reproducible horizon";
    return text;
}

std::string span_text(const Pictures& p, const std::vector<double>& times) {
    const bool still = p.kind == Pictures::Kind::still;
    if (!p.times_known) {
        if (still && p.at.kind == Instant::Kind::time) return fmt::format("one picture at {:g} s", p.at.t);
        if (still) return "one picture at " + name_of(p.at);
        const auto bound = [](const std::optional<Instant>& event, double t) {
            return name_of(event.value_or(Instant{.t = t}));
        };
        return fmt::format("{} from {} to {} at {:g} per second{}",
                           p.draw.empty() ? "frames" : counted(p.draw.size(), "frame"),
                           bound(p.span.from_event, p.span.from), bound(p.span.to_event, p.end_time),
                           p.span.fps.value(), p.draw.empty() ? "; their number depends on the events" : "");
    }
    if (still) return fmt::format("one picture at {:g} s", times.front());
    return fmt::format("{} from {:g} s to {:g} s at {:g} per second", counted(p.draw.size(), "frame"),
                       times[static_cast<std::size_t>(p.draw.front())], times[static_cast<std::size_t>(p.draw.back())],
                       p.span.fps.value());
}

std::string pace_text(const Speed& speed) {
    if (!speed.intervals.empty()) return ", other speeds in " + counted(speed.intervals.size(), "interval");
    if (!speed.around) return speed.factor == 1 ? "" : fmt::format(", {:g} times real speed", speed.factor);
    return fmt::format(", {:g} times real speed around impacts", speed.around->factor);
}

std::string picture_text(const Pictures& p, const std::vector<double>& times) {
    std::string text = fmt::format("{}: {}{}", p.file, span_text(p, times), pace_text(p.span.speed));
    text += fmt::format(", {} × {}, {}", p.size.width, p.size.height, view_name(p.view));
    if (p.view.transparent) text += ", transparent";
    if (p.kind == Pictures::Kind::video) text += "; " + encoding_text(p.encoding);
    if (p.makes_poster())
        text +=
            fmt::format("; the frame at {:g} s also as {}", times[static_cast<std::size_t>(*p.poster)], p.poster_file);
    else if (!p.times_known && !p.poster_file.empty())
        text += fmt::format("; one of its frames also as {}", p.poster_file);
    if (const double memory = memory_of(p); memory >= kMuchMemory)
        text += fmt::format("; needs {} of memory for each thread", size_text(memory));
    return text;
}

}  // namespace

std::string to_text(const Plan& plan) {
    std::string text = "to do\n";
    auto line = [&](std::string_view what, const std::string& how) { text += fmt::format("  {:<9} {}\n", what, how); };
    if (plan.events_until)
        line("events",
             fmt::format("a first run until {:g} s{} finds the events at which outputs begin, end, freeze or slow down",
                         *plan.events_until, plan.all_events ? "" : " at most"));
    if (plan.simulation) line("simulate", simulation_text(*plan.simulation));
    for (const Simulation& other : plan.others) line("simulate", simulation_text(other));
    for (const Pictures& p : plan.pictures) line(kind_name(p.kind), picture_text(p, plan.times(p)));
    for (const FigureFile& f : plan.figures) line("figure", fmt::format("{}: {}", f.file, f.figure));
    for (const DataFile& d : plan.data) line(d.stage, d.file + (d.content.empty() ? "" : ": " + d.content));
    text += "skipped\n";
    for (const Skipped& skipped : plan.skipped) text += fmt::format("  {}: {}\n", skipped.what, skipped.why);
    return text;
}

}  // namespace beamcam::scenes
