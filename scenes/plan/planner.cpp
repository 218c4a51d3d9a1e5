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

// Shards divide films, sequences and sweeps.
bool is_shared(const Output& output) {
    const auto* pictures = std::get_if<PictureOutput>(&output);
    return (pictures && pictures->has_frames()) || std::holds_alternative<SweepOutput>(output);
}

// The number of the first frame, and how many there are; nullopt if that depends on events.
std::optional<std::pair<long, long>> known_numbers(const Pictures& p, const FilmTimes& times) {
    if (p.times_known) return std::pair(times.first, static_cast<long>(std::ssize(times.frames)));
    if (!p.has_frames()) return std::nullopt;
    const auto numbers = frame_numbers(p.span, p.end_time);
    return numbers ? std::optional(std::pair(numbers->first, numbers->second - numbers->first)) : std::nullopt;
}

}  // namespace

Planner::Planner(const Scene& scene, const Selection& selection, const ExistingWork& existing)
    : scene_(scene),
      selection_(selection),
      existing_(existing),
      simulation_{scene.problem, motion_key(scene.problem)} {}

Plan Planner::make() {
    for (std::size_t i = 0; i < scene_.outputs.size(); ++i) {
        const Output& output = scene_.outputs[i];
        if (const auto finished = existing_.finished.find(i); finished != existing_.finished.end()) {
            ++finished_;
            skip(finished->second, "up to date");
        } else if (selection_.shard.number > 1 && !is_shared(output)) {
            skip(file_of(output), "the first shard writes it");
        } else {
            std::visit([&](const auto& each) { each.plan(*this, i); }, output);
        }
    }
    if (needed_) plan_.simulation = std::move(simulation_);
    // In the order of the types.
    std::ranges::stable_sort(plan_.data, {}, [&](const DataFile& d) { return scene_.outputs[d.output].index(); });
    add_skipped_stages();
    return std::move(plan_);
}

// ---- what outputs need -------------------------------------------------------------------------

double Planner::run_end() const { return std::max(scene_.end_time, existing_.until); }

void Planner::simulate_until(double t, const std::string& file) {
    needed_ = true;
    simulation_.simulate_until(t, file);
}

void Planner::simulate_until(const Instant& event, const std::string& file) {
    needed_ = true;
    simulation_.until_events.push_back(fmt::format("{}, for {}", name_of(event), file));
}

std::size_t Planner::add_table(std::vector<double> times, std::vector<sim::Channel> channels) {
    simulation_.request.tables.push_back({std::move(times), std::move(channels)});
    return simulation_.request.tables.size() - 1;
}

void Planner::add(Pictures p, double end) {
    p.end_time = end;
    p.selection = selection_;
    if (const auto found = existing_.frames.find(p.output); found != existing_.frames.end()) p.existing = found->second;
    if (p.kind == Pictures::Kind::video && !selection_.shard.whole()) p.file = shard_file(p.file, selection_.shard);
    const bool still = p.kind == Pictures::Kind::still;
    p.collisions = shows_collisions(p, scene_.problem);
    const bool moves_by_events = std::ranges::any_of(p.view.keyframes, &Instant::is_event, &Keyframe::at);
    p.times_known = !p.collisions && !moves_by_events && (still ? !p.at.is_event() : !p.span.needs_events());
    p.chart_channels = render::chart_channels(panels_of(p, scene_.problem));
    p.omitted_panels = omitted_panels(p);
    if (!p.omitted_panels.empty()) skip("panels " + p.omitted_panels + " of " + p.file, why_panels_are_omitted(p.size));
    FilmTimes times;
    if (p.times_known) times = times_of(p, {});
    if (const auto numbers = known_numbers(p, times)) {
        const auto [first, count] = *numbers;
        choose_frames(p, first, count);
        add_skipped_frames(p, static_cast<std::size_t>(count));
        if (p.draw.empty()) return;
    }
    if (p.compare.empty()) p.shown.push_back({.problem = scene_.problem, .key = simulation_.key, .of_scene = true});
    for (const Compared& each : p.compare)
        p.shown.push_back({.problem = each.problem, .key = motion_key(each.problem), .label = each.label});
    for (Study& motion : p.shown) {
        add_requests(p, motion);
        add_study(motion, p.file, p.ends_at_event() ? p.span.to_event : std::nullopt, motion.label);
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
    for (const Study& study : figure.studies) add_study(study, figure.file, figure.ends_at);
    plan_.figures.push_back(std::move(figure));
}

void Planner::find_events(double until, bool all) {
    plan_.events_until = std::max(plan_.events_until.value_or(0), until);
    plan_.all_events = plan_.all_events || all;
}

// Studies of the same motion share one simulation.
void Planner::add_study(const Study& study, const std::string& file, const std::optional<Instant>& ends_at,
                        const std::string& label) {
    if (study.of_scene) {
        ends_at ? simulate_until(*ends_at, file) : simulate_until(end_of(study.request), file);
        study_requests_.push_back(study.request);
        simulation_.horizon = simulation_.horizon || study.request.horizon;
        return;
    }
    auto same = std::ranges::find(plan_.others, study.key, &Simulation::key);
    if (same == plan_.others.end()) same = plan_.others.insert(same, {study.problem, study.key});
    same->simulate_until(end_of(study.request), file);
    if (!label.empty()) same->label = label;
    same->horizon = same->horizon || study.request.horizon;
}

// ---- what is skipped ---------------------------------------------------------------------------

void Planner::add_skipped_frames(const Pictures& p, std::size_t count) {
    if (!p.part.empty() || (p.kind == Pictures::Kind::frames && p.draw.size() + p.existing.size() < count))
        skip(fmt::format("{} of {} frames of {}", count - p.draw.size() - p.existing.size(), count, p.file),
             p.selection.frames ? "outside the selected frames" : "other shards draw them");
    if (!p.existing.empty()) skip(fmt::format("{} of {}", counted(p.existing.size(), "frame"), p.file), "up to date");
}

void Planner::add_skipped_stages() {
    const bool compares = std::ranges::any_of(plan_.pictures, [](const Pictures& p) { return !p.compare.empty(); });
    if (!needed_ && !compares && !plan_.others.empty())
        return skip("simulation of the scene itself", "its figures show only variants of it");
    if (!needed_)
        return skip(compares || !plan_.sweep.empty() ? "simulation of the scene itself" : "simulation",
                    compares               ? "only compared motions are shown"
                    : !plan_.sweep.empty() ? "only the sweep is shown"
                    : finished_ > 0        ? "all outputs are up to date"
                                           : "no output needs the motion");
    const double end = plan_.simulation->request.end_time;
    if (end < scene_.end_time && plan_.simulation->until_events.empty())
        skip(fmt::format("simulation from {:g} s to {:g} s", end, scene_.end_time), "no output needs it");
    if (!scene_.problem.cam) skip("contact", "the scene has no cam");
    add_unread_channels();
    if (plan_.pictures.empty())
        skip(plan_.figures.empty() ? "pictures, fonts and OpenGL" : "films and OpenGL", "no output is a picture");
    else if (!plan_.needs_gl())
        skip("OpenGL", "every view is flat");
    if (!plan_.needs_encoder()) skip("video encoder", "no output is a video");
    if (plan_.simulation->request.extrema.empty()) skip("extrema and zero crossings", "no output is a summary");
    if (!plan_.simulation->horizon) skip("further runs for the reproducible horizon", "no output needs it");
}

void Planner::add_unread_channels() {
    const std::vector<sim::Channel> every = all_channels(scene_.problem);
    auto read = [&](const sim::Channel& channel) {
        const sim::Request& request = plan_.simulation->request;
        auto holds = [&](const std::vector<sim::Channel>& some) { return std::ranges::count(some, channel) > 0; };
        const auto in_tables = [&](const sim::Request& some) {
            return std::ranges::any_of(some.tables, [&](const sim::TableRequest& t) { return holds(t.channels); });
        };
        return holds(request.extrema) || in_tables(request) || std::ranges::any_of(study_requests_, in_tables);
    };
    const auto unread =
        std::ranges::count_if(every, [&](const sim::Channel& c) { return c.kind != ChannelKind::t && !read(c); });
    if (unread > 0) skip(fmt::format("{} of {} channels", unread, every.size() - 1), "no output needs them");
}

}  // namespace beamcam::scenes
