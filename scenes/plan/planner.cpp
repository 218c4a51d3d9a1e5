#include "scenes/plan/planner.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scenes/motions/identity.hpp"
#include "scenes/plan/output_times.hpp"
#include "sim/base/counted.hpp"
#include "sim/observe/recorder_set.hpp"

namespace beamcam::scenes {
namespace {

using sim::ChannelKind;

const std::vector<sim::Channel> kTraceChannels = {
    {ChannelKind::t, 0}, {ChannelKind::contact_x, 0}, {ChannelKind::contact_s, 0}, {ChannelKind::contact_force, 0}};

std::vector<render::PanelSpec> panels_of(const Pictures& p, const sim::Problem& problem) {
    if (p.layout) return render::panels_of(*p.layout);
    const sim::Problem* shown = p.compare.empty() ? &problem : &p.compare.front().problem;
    for (const Compared& each : p.compare)
        if (!shown->cam) shown = &each.problem;
    return render::standard_panels(*shown, is_slow_motion(p));
}

std::string omitted_panels(const Picture& picture) {
    std::string out;
    if (!picture.layout) return out;
    for (const render::PanelSpec& panel :
         render::omitted_panels(picture.size.width, picture.size.height, *picture.layout, picture.view.show))
        out += (out.empty() ? "" : ", ") +
               (panel.channels.empty() ? std::string(type_of(panel.kind).name) : name(panel.channels.front()));
    return out;
}

// A strip of one collision at a time needs more rows than one of the whole time, a page more instants.
bool shows_collisions(const Pictures& p, const sim::Problem& problem) {
    if (!p.compare.empty() || !problem.cam) return false;
    return p.kind == Pictures::Kind::page ||
           std::ranges::any_of(panels_of(p, problem), &render::PanelSpec::by_collision);
}

sim::PoseRequest survey() {
    sim::PoseRequest request;
    request.contacts =
        400;  // about ten collisions; the hardest are among them, because every collision dissipates energy
    return request;
}

constexpr double kCurveStray = 2e-3;  // of the range: two pixels of a panel that fills a frame of 1080 lines

// The curve that a panel draws from the chart's table.
std::optional<std::pair<sim::Channel, sim::Channel>> drawn_curve(const std::vector<render::PanelSpec>& panels) {
    for (const render::PanelSpec& panel : panels)
        if (const render::PanelType& type = type_of(panel.kind); type.draws_curve)
            return std::pair{sim::Channel{type.channels[0], 0}, sim::Channel{type.channels[1], 0}};
    return std::nullopt;
}

// The number of the first frame, and how many there are; nullopt if that depends on events.
std::optional<std::pair<long, long>> known_numbers(const Pictures& p, const FilmTimes& times) {
    if (p.times_known) return std::pair(times.first, static_cast<long>(std::ssize(times.frames)));
    if (!p.has_frames()) return std::nullopt;
    const auto numbers = frame_numbers(p.span, p.end_time);
    return numbers ? std::optional(std::pair(numbers->first, numbers->second - numbers->first)) : std::nullopt;
}

}  // namespace

Planner::Planner(const Scene& scene, const Shard& shard, const ExistingWork& existing)
    : scene_(scene), shard_(shard), existing_(existing), simulation_{scene.problem, motion_key(scene.problem)} {}

Plan Planner::make() {
    for (std::size_t i = 0; i < scene_.outputs.size(); ++i) {
        const Output& output = scene_.outputs[i];
        if (const auto finished = existing_.finished.find(i); finished != existing_.finished.end()) {
            plan_.kept.push_back(finished->second);
        } else {
            std::visit([&](const auto& each) { each.plan(*this, i); }, output);
        }
    }
    if (needed_) plan_.simulation = std::move(simulation_);
    // In the order of the types.
    std::ranges::stable_sort(plan_.data, {}, [&](const DataFile& d) { return scene_.outputs[d.output].index(); });
    return std::move(plan_);
}

// ---- what outputs need -------------------------------------------------------------------------

double Planner::run_end() const { return std::max(scene_.end_time, existing_.until); }

void Planner::simulate_until(double t) {
    needed_ = true;
    simulation_.simulate_until(t);
}

void Planner::simulate_until_event() {
    needed_ = true;
    simulation_.ends_at_event = true;
}

std::size_t Planner::add_table(std::vector<double> times, std::vector<sim::Channel> channels) {
    simulation_.request.tables.push_back({std::move(times), std::move(channels)});
    return simulation_.request.tables.size() - 1;
}

void Planner::add(Pictures p, double end) {
    p.end_time = end;
    if (const auto found = existing_.frames.find(p.output); found != existing_.frames.end()) p.existing = found->second;
    const bool still = p.kind == Pictures::Kind::still;
    p.collisions = shows_collisions(p, scene_.problem);
    const bool moves_by_events = std::ranges::any_of(p.view.keyframes, &Instant::is_event, &Keyframe::at);
    p.times_known = !p.collisions && !moves_by_events && (still ? !p.at.is_event() : !p.span.needs_events());
    p.chart_channels = render::chart_channels(panels_of(p, scene_.problem));
    p.omitted_panels = omitted_panels(p);
    FilmTimes times;
    if (p.times_known) times = times_of(p, {});
    if (const auto numbers = known_numbers(p, times)) {
        const auto [first, count] = *numbers;
        choose_frames(p, first, count);
        if (!p.existing.empty())
            plan_.kept.push_back(fmt::format("{} of {}", counted(p.existing.size(), "frame"), p.file));
    }
    if (p.compare.empty()) p.shown.push_back({.problem = scene_.problem, .key = simulation_.key, .of_scene = true});
    for (const Compared& each : p.compare)
        p.shown.push_back({.problem = each.problem, .key = motion_key(each.problem), .label = each.label});
    for (Study& motion : p.shown) {
        add_requests(p, motion);
        add_study(motion, p.ends_at_event(), motion.label);
    }
    if (p.times_known)
        put_times(p, std::move(times));
    else
        find_events(end, !p.ends_at_event());
    plan_.pictures.push_back(std::move(p));
}

// The times follow (put_times).
void Planner::add_requests(const Pictures& p, Study& motion) const {
    motion.request.end_time = p.end_time;
    motion.request.horizon = p.horizon;
    motion.request.poses = {{}, survey(), {}};
    motion.request.tables = {{{}, p.chart_channels, drawn_curve(panels_of(p, scene_.problem)), kCurveStray}};
    if (motion.problem.cam) motion.request.tables.push_back({{}, kTraceChannels});
}

void Planner::add(FigureFile figure) {
    for (const Study& study : figure.studies) add_study(study, figure.ends_at_event);
    plan_.figures.push_back(std::move(figure));
}

void Planner::find_events(double until, bool all) {
    plan_.events_until = std::max(plan_.events_until.value_or(0), until);
    plan_.all_events = plan_.all_events || all;
}

// Studies of the same motion share one simulation.
void Planner::add_study(const Study& study, bool ends_at_event, const std::string& label) {
    if (study.of_scene) {
        ends_at_event ? simulate_until_event() : simulate_until(end_of(study.request));
        simulation_.horizon = simulation_.horizon || study.request.horizon;
        return;
    }
    auto same = std::ranges::find(plan_.others, study.key, &PlannedMotion::key);
    if (same == plan_.others.end()) same = plan_.others.insert(same, {study.problem, study.key});
    same->simulate_until(end_of(study.request));
    if (!label.empty()) same->label = label;
    same->horizon = same->horizon || study.request.horizon;
}

}  // namespace beamcam::scenes
