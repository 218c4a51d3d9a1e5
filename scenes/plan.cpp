#include "scenes/plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "scenes/film_times.hpp"
#include "scenes/time_map.hpp"

namespace beamcam::scenes {
namespace {

using sim::ChannelKind;

const std::vector<sim::Channel> kTraceChannels = {
    {ChannelKind::t, 0}, {ChannelKind::contact_x, 0}, {ChannelKind::contact_s, 0}, {ChannelKind::contact_force, 0}};

// Puts the instants of a picture where its runs are asked for them.
void put_times(Pictures& p, sim::Request& request, FilmTimes times) {
    p.first_frame = times.first;
    p.speeds = std::move(times.speeds);
    p.callouts = std::move(times.callouts);
    for (ComparedMotion& other : p.compared) {
        other.request.poses.front().times = times.frames;
        other.request.tables.front().times = times.chart;
        if (other.request.tables.size() > 1) other.request.tables[1].times = times.trace;
    }
    if (!p.compared.empty()) return;
    request.poses[p.poses].times = std::move(times.frames);
    request.tables[p.chart].times = std::move(times.chart);
    if (p.trace) request.tables[*p.trace].times = std::move(times.trace);
}

FilmTimes times_of(const Pictures& p, double end_time, const sim::Result& motion) {
    return p.kind == Pictures::Kind::still ? still_times(p.at, motion) : film_times(p.span, end_time, motion);
}

std::vector<sim::Channel> channels_of(const Picture& picture, const FrameSpan& span, const sim::Problem& problem) {
    const std::vector<render::PanelSpec> panels =
        picture.layout ? render::panels_of(*picture.layout)
                       : render::standard_panels(problem, span.speed.around || span.speed.factor < 0.5);
    return render::chart_channels(panels);
}

// Collects what the outputs want of the one simulation.
class Planner {
  public:
    explicit Planner(const Scene& scene) : scene_(scene), studies_(scene.problem, simulation_.request) {}

    Plan make() {
        for (std::size_t i = 0; i < scene_.outputs.size(); ++i)
            std::visit([&](const auto& output) { want(output, i); }, scene_.outputs[i]);
        if (!studies_.main_because().empty()) look_until(studies_.main_until(), studies_.main_because());
        plan_.studies = studies_.take();
        if (needed_) plan_.simulation = std::move(simulation_);
        note_skipped();
        return std::move(plan_);
    }

  private:
    void look_until(double t, const std::string& file) {
        needed_ = true;
        if (t > simulation_.request.end_time || simulation_.until_because.empty()) {
            simulation_.request.end_time = std::max(t, simulation_.request.end_time);
            simulation_.until_because = file;
        }
    }

    std::size_t add_table(std::vector<double> times, std::vector<sim::Channel> channels) {
        simulation_.request.tables.push_back({std::move(times), std::move(channels)});
        return simulation_.request.tables.size() - 1;
    }

    // `ends` is the latest instant that the picture can look at.
    void want_pictures(Pictures p, double ends) {
        p.end_time = ends;
        const bool still = p.kind == Pictures::Kind::still;
        p.settled = still ? p.at.kind == Instant::Kind::time : !p.span.looks_at_impacts();
        p.chart_channels = channels_of(p.picture, p.span, scene_.problem);
        sim::Request& request = simulation_.request;
        if (p.picture.compare.empty()) {
            look_until(ends, p.file);
            p.poses = request.poses.size();
            request.poses.push_back({});
            p.chart = add_table({}, p.chart_channels);
            if (scene_.problem.cam) p.trace = add_table({}, kTraceChannels);
        } else {
            add_compared(p);
        }
        if (p.settled)
            put_times(p, request, times_of(p, ends, {}));
        else
            plan_.impacts_until = std::max(plan_.impacts_until.value_or(0), ends);
        plan_.pictures.push_back(std::move(p));
    }

    void add_compared(Pictures& p) {
        for (const Compared& each : p.picture.compare) {
            ComparedMotion motion{each.label, each.problem, {}};
            motion.request.end_time = p.end_time;
            motion.request.poses.push_back({});
            motion.request.tables.push_back({{}, p.chart_channels});
            if (each.problem.cam) motion.request.tables.push_back({{}, kTraceChannels});
            p.compared.push_back(std::move(motion));
        }
    }

    template <class Output>
    static Pictures pictures(Pictures::Kind kind, const Output& output, std::size_t index) {
        Pictures p;
        p.kind = kind;
        p.output = index;
        p.file = output.file;
        p.picture = output;
        return p;
    }

    void want(const VideoOutput& video, std::size_t index) {
        Pictures p = pictures(Pictures::Kind::video, video, index);
        p.span = video.span;
        p.encoding = video.encoding;
        want_pictures(std::move(p), film_end(video.span));
    }
    void want(const FramesOutput& frames, std::size_t index) {
        Pictures p = pictures(Pictures::Kind::frames, frames, index);
        p.span = frames.span;
        want_pictures(std::move(p), film_end(frames.span));
    }
    void want(const StillOutput& still, std::size_t index) {
        Pictures p = pictures(Pictures::Kind::still, still, index);
        p.at = still.at;
        want_pictures(std::move(p), still.at.kind == Instant::Kind::time ? still.at.t : scene_.end_time);
    }
    double film_end(const FrameSpan& span) const { return span.to.value_or(scene_.end_time); }
    void want(const FigureOutput& figure, std::size_t index) {
        const Recipe* recipe = recipe_named(figure.figure);
        if (!recipe) throw std::logic_error("a figure that the reader does not know: " + figure.figure);
        plan_.figures.push_back({index, figure.file, figure.figure, recipe->prepare(scene_, figure.lang, studies_)});
    }
    void want(const TrajectoryOutput& table, std::size_t index) {
        std::vector<sim::Channel> channels = table.channels.empty() ? all_channels(scene_.problem) : table.channels;
        const sim::Channel t{ChannelKind::t, 0};
        if (std::find(channels.begin(), channels.end(), t) == channels.end()) channels.insert(channels.begin(), t);
        std::vector<double> times = table.times.empty() ? rows(0, scene_.end_time, table.rate) : table.times;
        look_until(*std::max_element(times.begin(), times.end()), table.file);
        plan_.tables.push_back({index, table.file, add_table(std::move(times), std::move(channels))});
    }
    void want(const ImpactsOutput& impacts, std::size_t index) {
        look_until(scene_.end_time, impacts.file);
        plan_.impacts.push_back({index, impacts.file});
    }
    void want(const SummaryOutput& summary, std::size_t index) {
        look_until(scene_.end_time, summary.file);
        if (simulation_.request.extrema.empty())
            for (const sim::Channel& channel : all_channels(scene_.problem))
                if (channel.kind != ChannelKind::t) simulation_.request.extrema.push_back(channel);
        if (summary.horizon) simulation_.request.horizon = true;
        plan_.summaries.push_back({index, summary.file});
    }

    void skip(std::string what, std::string why) { plan_.skipped.push_back({std::move(what), std::move(why)}); }

    void note_skipped() {
        const bool compares =
            std::ranges::any_of(plan_.pictures, [](const Pictures& p) { return !p.compared.empty(); });
        if (!needed_ && !compares && !plan_.studies.empty())
            return skip("simulation of the scene itself", "its figures look at variants of it");
        if (!needed_)
            return skip(compares ? "simulation of the scene itself" : "simulation",
                        compares ? "only compared motions are shown" : "no output looks at the motion");
        const double end = plan_.simulation->request.end_time;
        if (end < scene_.end_time)
            skip(fmt::format("simulation from {:g} s to {:g} s", end, scene_.end_time), "no output looks that far");
        if (!scene_.problem.cam) skip("contact", "the scene has no cam");
        note_unread_channels();
        if (plan_.pictures.empty())
            skip(plan_.figures.empty() ? "pictures, fonts and OpenGL" : "films and OpenGL", "no output is a picture");
        else if (!plan_.needs_gl())
            skip("OpenGL", "every view is flat");
        if (!plan_.needs_encoder()) skip("video encoder", "no output is a video");
        if (plan_.summaries.empty()) skip("extrema", "no output is a summary");
        if (!plan_.simulation->request.horizon)
            skip("second run for the reproducible horizon", "no summary asks for it");
    }

    void note_unread_channels() {
        const std::vector<sim::Channel> every = all_channels(scene_.problem);
        auto read = [&](const sim::Channel& channel) {
            const sim::Request& request = plan_.simulation->request;
            auto holds = [&](const std::vector<sim::Channel>& some) {
                return std::find(some.begin(), some.end(), channel) != some.end();
            };
            return holds(request.extrema) || std::any_of(request.tables.begin(), request.tables.end(),
                                                         [&](const sim::TableRequest& t) { return holds(t.channels); });
        };
        const auto unread = std::count_if(every.begin(), every.end(),
                                          [&](const sim::Channel& c) { return c.kind != ChannelKind::t && !read(c); });
        if (unread > 0) skip(fmt::format("{} of {} channels", unread, every.size() - 1), "no output reads them");
    }

    const Scene& scene_;
    Plan plan_;
    Simulation simulation_;
    Studies studies_;
    bool needed_ = false;
};

}  // namespace

bool Plan::needs_gl() const {
    return std::any_of(pictures.begin(), pictures.end(),
                       [](const Pictures& p) { return p.picture.view.style != render::Style::flat; });
}

bool Plan::needs_encoder() const {
    return std::any_of(pictures.begin(), pictures.end(),
                       [](const Pictures& p) { return p.kind == Pictures::Kind::video; });
}

std::size_t Plan::frames() const {
    std::size_t count = 0;
    for (const Pictures& p : pictures) count += times(p).size();
    return count;
}

const std::vector<double>& Plan::times(const Pictures& p) const {
    return p.compared.empty() ? simulation->request.poses[p.poses].times
                              : p.compared.front().request.poses.front().times;
}

Plan plan(const Scene& scene) { return Planner(scene).make(); }

void settle(Plan& plan, const Scene& scene, const FindImpacts& find) {
    std::optional<sim::Result> own;
    for (Pictures& p : plan.pictures) {
        if (p.settled) continue;
        p.settled = true;
        if (p.compared.empty()) {
            if (!own) own = find(scene.problem, *plan.impacts_until);
            put_times(p, plan.simulation->request, times_of(p, p.end_time, *own));
            continue;
        }
        // Slow around the impacts of all that is shown; "impact:N" counts those of the first.
        sim::Result first = find(p.compared.front().problem, p.end_time), all;
        all = first;
        for (std::size_t i = 1; i < p.compared.size(); ++i) {
            const sim::Result other = find(p.compared[i].problem, p.end_time);
            all.impacts.insert(all.impacts.end(), other.impacts.begin(), other.impacts.end());
        }
        std::ranges::stable_sort(all.impacts, {}, &sim::Impact::t_start);
        FrameSpan span = p.span;
        const auto fix = [&](Instant& at) { at = {.kind = Instant::Kind::time, .t = instant_of(at, first)}; };
        for (FilmEvent& event : span.events) fix(event.at);
        sim::Request none;
        if (p.kind == Pictures::Kind::still)
            put_times(p, none, still_times({.kind = Instant::Kind::time, .t = instant_of(p.at, first)}, all));
        else
            put_times(p, none, film_times(span, p.end_time, all));
    }
    plan.impacts_until.reset();
}

}  // namespace beamcam::scenes
