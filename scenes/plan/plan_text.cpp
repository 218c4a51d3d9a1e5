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

// "; about 0.31 s, 5200 steps"; a cached motion needs no steps.
std::string motion_cost(const Simulation& s) {
    if (!s.cost) return "";
    return fmt::format("; about {} s{}", about(s.cost->seconds),
                       s.from_cache ? "" : fmt::format(", {} steps", about(s.cost->amount)));
}

std::string size_text(double bytes) {
    return bytes < 1e6   ? about(std::max(1.0, bytes / 1e3)) + " kB"
           : bytes < 1e9 ? about(bytes / 1e6) + " MB"
                         : about(bytes / 1e9) + " GB";
}

// "; about 12 s, 3.1 MB"
std::string file_cost(const std::optional<Cost>& cost) {
    if (!cost) return "";
    return fmt::format("; about {} s{}", about(cost->seconds), cost->amount > 0 ? ", " + size_text(cost->amount) : "");
}

std::string simulation_text(const Simulation& simulation) {
    const double end = simulation.request.end_time;
    std::string text = model_text(simulation.problem) + "; ",
                events = fmt::format("{}", fmt::join(simulation.until_events, ", "));
    if (end > 0) text += fmt::format("until {:g} s, needed by {}", end, simulation.until_because);
    if (!events.empty()) text += fmt::format("{}until {}", end > 0 ? ", or, if later, " : "", events);
    if (!(end > 0) && events.empty()) text += "the initial state only, without integration";
    if (!simulation.label.empty()) text += fmt::format(" for \"{}\"", simulation.label);
    if (simulation.from_cache) text += "; from the cache";
    if (simulation.keep) text += "; added to the cache, unless it is short or too large";
    if (simulation.horizon) text += "; further runs find the reproducible horizon";
    return text + motion_cost(simulation);
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
    return text + file_cost(p.cost);
}

// What the total does not include: no earlier run did similar work, or its amount depends on events.
std::vector<std::string> work_without_cost(const Plan& plan) {
    std::vector<std::string> all;
    const auto check = [&](const std::optional<Cost>& cost, const std::string& name) {
        if (!cost) all.push_back(name);
    };
    if (plan.simulation) check(plan.simulation->cost, "the motion");
    for (const Simulation& other : plan.others) check(other.cost, fmt::format("the motion of \"{}\"", other.label));
    for (const Pictures& p : plan.pictures)
        check(p.cost, p.times_known ? p.file : p.file + " (at events, which are found first)");
    for (const FigureFile& f : plan.figures) check(f.cost, f.file);
    for (const DataFile& d : plan.data)
        if (d.numbers > 0) check(d.cost, d.file);
    return all;
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
    for (const FigureFile& f : plan.figures)
        line("figure", fmt::format("{}: {}{}", f.file, f.figure, file_cost(f.cost)));
    for (const DataFile& d : plan.data)
        line(d.stage, d.file + (d.content.empty() ? "" : ": " + d.content) + file_cost(d.cost));
    if (const auto cost = plan.cost()) {
        const std::vector<std::string> more = work_without_cost(plan);
        line("total", fmt::format("{}{}, estimated from earlier runs{}", more.empty() ? "" : "more than ",
                                  file_cost(cost).substr(2),
                                  more.empty() ? "" : fmt::format("; not known: {}", fmt::join(more, ", "))));
    }
    text += "skipped\n";
    for (const Skipped& skipped : plan.skipped) text += fmt::format("  {}: {}\n", skipped.what, skipped.why);
    return text;
}

}  // namespace beamcam::scenes
