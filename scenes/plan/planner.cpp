#include "scenes/plan/planner.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "render/plot/user_text.hpp"
#include "scenes/motions/identity.hpp"
#include "sim/base/counted.hpp"

namespace beamcam::scenes {
namespace {

using sim::ChannelKind;

const std::vector<sim::Channel> kTraceChannels = {
    {ChannelKind::t, 0}, {ChannelKind::contact_x, 0}, {ChannelKind::contact_s, 0}, {ChannelKind::contact_force, 0}};

std::string omitted_panels(const PlannedPictures& picture) {
    std::string out;
    if (!picture.layout) return out;
    render::Shown shown = picture.view.shown();
    shown.captions = !picture.times.callouts.empty();
    shown.warning = false;  // few motions need it
    for (const render::PanelSpec& panel :
         render::omitted_panels(picture.size.width, picture.size.height, *picture.layout, shown))
        out += (out.empty() ? "" : ", ") +
               (panel.channels.empty() ? std::string(type_of(panel.kind).name) : name(panel.channels.front()));
    return out;
}

constexpr double kCurveStray = 2e-3;  // of the range: two pixels of a panel that fills a frame of 1080 lines
// Poses in contact: about ten collisions; the hardest are among them, because every collision dissipates energy.
constexpr std::size_t kSurveyedContacts = 400;

// The curve that a panel draws from the chart's table.
std::optional<std::pair<sim::Channel, sim::Channel>> drawn_curve(const std::vector<render::PanelSpec>& panels) {
    for (const render::PanelSpec& panel : panels)
        if (const render::PanelType& type = type_of(panel.kind); type.draws_curve)
            return std::pair{sim::Channel{type.channels[0], 0}, sim::Channel{type.channels[1], 0}};
    return std::nullopt;
}

sim::Request request_of(const PlannedPictures& p, const sim::Problem& problem,
                        const std::vector<render::PanelSpec>& panels) {
    sim::Request request;
    request.end_time = p.end_time;
    const FilmTimes& times = p.times;
    request.poses.resize(3);
    request.poses[kFramePoses].times = times.frames;
    request.poses[kSurveyPoses].times = times.survey;
    request.poses[kSurveyPoses].contacts = kSurveyedContacts;
    request.poses[kPathPoses].times = times.path;
    request.tables = {{times.chart, render::chart_channels(panels), drawn_curve(panels), kCurveStray}};
    if (problem.cam) request.tables.push_back({times.trace, kTraceChannels});
    return request;
}

double latest(const std::vector<double>& times) { return times.empty() ? 0 : *std::ranges::max_element(times); }

}  // namespace

PlanWithFigures Planner::make() {
    for (const std::size_t finished : existing_.finished) plan_.kept.push_back(file_of(scene().outputs[finished]));
    for (const ResolvedOutput& each : resolved_.outputs)
        std::visit([&](const auto& output) { scenes::plan(*this, output, each); }, each.output);
    std::ranges::stable_sort(plan_.data, {}, [&](const DataFile& d) { return scene().outputs[d.output].index(); });
    return std::move(plan_);
}

const std::string& Planner::own_key() {
    if (own_key_.empty()) own_key_ = motion_key(scene().problem);
    return own_key_;
}

std::size_t Planner::add_motion(MotionRequest motion) {
    plan_.motions.push_back(std::move(motion));
    return plan_.motions.size() - 1;
}

sim::Request& Planner::run_until(double t) {
    if (!plan_.run) plan_.run = add_motion({scene().problem, own_key()});
    sim::Request& request = plan_.motions[*plan_.run].request;
    request.end_time = std::max(request.end_time, t);
    return request;
}

std::size_t Planner::add_table(std::vector<double> times, std::vector<sim::Channel> channels) {
    std::vector<sim::TableRequest>& tables = run_until(0).tables;
    tables.push_back({std::move(times), std::move(channels)});
    return tables.size() - 1;
}

void Planner::add(const ResolvedOutput& picture) {
    PlannedPictures p;
    static_cast<PictureOutput&>(p) = std::get<PictureOutput>(picture.output);
    p.output = picture.index;
    p.end_time = picture.end_time;
    p.times = picture.times;
    if (p.kind == PictureOutput::Kind::video) p.poster_file = poster_file(p);
    const auto existing = existing_.frames.find(p.output);
    std::size_t kept = 0;
    for (int k = 0; k < static_cast<int>(p.times.frames.size()); ++k)
        if (existing != existing_.frames.end() && existing->second.contains(p.times.first + k))
            ++kept;
        else
            p.draw.push_back(k);
    if (kept > 0) plan_.kept.push_back(fmt::format("{} of {}", counted(kept, "frame"), p.file));
    if (p.draw.empty()) return;
    p.omitted_panels = omitted_panels(p);
    std::vector<render::PanelSpec> panels = panels_of(p, scene(), p.end_time);
    if (p.kind == PlannedPictures::Kind::still && !p.layout && p.compare.empty())
        panels = render::standard_panels(scene().problem, true);  // in contact it shows the collision
    if (p.compare.empty())
        p.motions.push_back(add_motion({scene().problem, own_key(), request_of(p, scene().problem, panels)}));
    for (const Compared& each : p.compare)
        p.motions.push_back(add_motion(
            {each.problem, motion_key(each.problem), request_of(p, each.problem, panels), each.label, p.file}));
    plan_.pictures.push_back(std::move(p));
}

void Planner::add(FigureFile figure, FigureMaker maker, std::vector<MotionRequest> motions) {
    for (MotionRequest& motion : motions) {
        motion.file = motion.key == own_key() ? "" : figure.file;
        figure.motions.push_back(add_motion(std::move(motion)));
    }
    plan_.figures.push_back(std::move(figure));
    plan_.makers.push_back(std::move(maker));
}

PlanWithFigures plan(const ResolvedScene& scene, const ExistingWork& existing) {
    return Planner(scene, existing).make();
}

bool Plan::needs_gl() const {
    return std::ranges::any_of(pictures, [](const PlannedPictures& p) { return p.view.style != render::Style::flat; });
}

std::string too_small(const Size& size) {
    return fmt::format("{} × {} is too small for them; increase \"size\", or remove panels", size.width, size.height);
}

std::string characters_without_font(const PictureOutput& p, const Scene& scene) {
    if (p.kind == PictureOutput::Kind::page) return {};
    std::string written = scene.title;
    for (const FilmEvent& event : p.span.events) written += event.text;
    for (const Compared& motion : p.compare) written += motion.label;
    for (const Measurement& data : scene.data) written += data.label;
    const std::string lost = render::characters_without_font(written);
    return lost.empty() ? lost : fmt::format("{} omits {}: no font has these characters", p.file, lost);
}

double run_end(const Scene& scene) {
    double end = scene.end_time;
    for (const Output& output : scene.outputs) {
        if (const auto* table = std::get_if<TrajectoryOutput>(&output)) end = std::max(end, latest(table->times));
        if (const auto* state = std::get_if<StateOutput>(&output)) end = std::max(end, state->at);
    }
    return end;
}

}  // namespace beamcam::scenes
