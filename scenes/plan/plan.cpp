#include "scenes/plan/plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "render/base/error.hpp"
#include "render/film/parameter_line.hpp"
#include "scenes/motions/motions.hpp"
#include "scenes/scene/film_times.hpp"
#include "scenes/scene/time_map.hpp"
#include "sim/observe/observe.hpp"

namespace beamcam::scenes {
namespace {

using sim::ChannelKind;

const std::vector<sim::Channel> kTraceChannels = {
    {ChannelKind::t, 0}, {ChannelKind::contact_x, 0}, {ChannelKind::contact_s, 0}, {ChannelKind::contact_force, 0}};

// Which of the frames are asked for and not there yet.
void choose_frames(Pictures& p, long count) {
    const long begin = p.first_frame, end = begin + count;
    long from = begin, to = end;
    if (p.kind != Pictures::Kind::still && p.ask.frames) {
        from = std::max(begin, p.ask.frames->first);
        to = std::min(end, p.ask.frames->second);
    } else if (p.kind != Pictures::Kind::still && p.ask.shards > 1) {
        from = begin + count * (p.ask.shard - 1) / p.ask.shards;
        to = begin + count * p.ask.shard / p.ask.shards;
    }
    if (p.kind == Pictures::Kind::video && (from > begin || to < end))
        p.part = fmt::format("{}:{} of {}:{}", from, to, begin, end);
    p.draw.clear();
    for (long k = from; k < to; ++k)
        if (!p.there.contains(k)) p.draw.push_back(static_cast<int>(k - begin));
}

// Puts the instants of a picture where its runs are asked for them.
void put_times(Pictures& p, sim::Request& request, FilmTimes times) {
    p.first_frame = times.first;
    choose_frames(p, static_cast<long>(times.frames.size()));
    p.speeds = std::move(times.speeds);
    p.callouts = std::move(times.callouts);
    p.unshown = std::move(times.unshown);
    p.poster = times.poster;
    for (ComparedMotion& other : p.compared) {
        other.request.poses.front().times = times.frames;
        other.request.poses.back().times = times.survey;
        other.request.tables.front().times = times.chart;
        if (other.problem.cam) other.request.tables[1].times = times.trace;
    }
    if (!p.compared.empty()) return;
    request.poses[p.poses].times = std::move(times.frames);
    request.poses[p.survey].times = std::move(times.survey);
    request.tables[p.chart].times = std::move(times.chart);
    if (p.trace) request.tables[*p.trace].times = std::move(times.trace);
}

std::vector<render::PanelSpec> panels_of(const Pictures& p, const sim::Problem& problem) {
    if (p.picture.layout) return render::panels_of(*p.picture.layout);
    const sim::Problem* shown = p.picture.compare.empty() ? &problem : &p.picture.compare.front().problem;
    for (const Compared& each : p.picture.compare)
        if (!shown->cam) shown = &each.problem;
    return render::standard_panels(*shown, is_slow_motion(p));
}

std::string too_small(const Picture& picture) {
    std::string out;
    if (!picture.layout) return out;
    for (const render::PanelSpec& panel : render::left_out(picture.size.width, picture.size.height, *picture.layout))
        out += (out.empty() ? "" : ", ") +
               (panel.channels.empty() ? std::string(render::name(panel.kind)) : name(panel.channels.front()));
    return out;
}

// One collision after the other, which takes more rows than the whole time does.
bool shows_collisions(const Pictures& p, const sim::Problem& problem) {
    return p.picture.compare.empty() && problem.cam &&
           std::ranges::any_of(panels_of(p, problem), &render::PanelSpec::by_collision);
}

// A still of an instant is chosen by what led to it; one of an impact, which is found in the whole motion, by that.
double surveyed_until(const Pictures& p) { return p.at.kind == Instant::Kind::time ? p.at.t : p.end_time; }

FilmTimes times_of(const Pictures& p, double end_time, const sim::Result& motion) {
    return p.kind == Pictures::Kind::still ? still_times(p.at, motion, surveyed_until(p), p.collisions)
                                           : film_times(p.span, end_time, motion, p.collisions);
}

sim::PoseRequest survey() {
    sim::PoseRequest request;
    request.contacts = 400;  // ten collisions of a flexible beam: the hardest are among them, since each takes energy
    return request;
}

// Collects what the outputs want of the one simulation.
class Planner {
  public:
    Planner(const Scene& scene, const Ask& ask, const Known& known)
        : scene_(scene), ask_(ask), known_(known), own_key_(Studies::key(scene.problem)) {}

    Plan make() {
        for (std::size_t i = 0; i < scene_.outputs.size(); ++i) {
            if (known_.finished.contains(i)) {
                ++finished_;
                skip(file_of(scene_.outputs[i]), "it is there already, made from the same inputs");
            } else if (ask_.shard > 1 && !is_shared(scene_.outputs[i])) {
                skip(file_of(scene_.outputs[i]), "the first shard makes it");
            } else {
                std::visit([&](const auto& output) { want(output, i); }, scene_.outputs[i]);
            }
        }
        if (needed_) finish_simulation();
        for (Variant& variant : plan_.variants) {
            const auto kept = known_.variants_kept.find(Studies::key(variant.problem));
            settle_cache(variant.simulation,
                         kept == known_.variants_kept.end() ? std::nullopt : std::optional(kept->second));
        }
        note_skipped();
        return std::move(plan_);
    }

  private:
    // Films and sequences are what shards share.
    static bool is_shared(const Output& output) {
        return std::holds_alternative<VideoOutput>(output) || std::holds_alternative<FramesOutput>(output);
    }

    void finish_simulation() {
        const double end = simulation_.request.end_time;
        for (Pictures& p : plan_.pictures) {
            if (!p.compared.empty() || !(p.end_time < end)) continue;
            std::vector<double>& ends = simulation_.ends;
            const auto at = std::find(ends.begin(), ends.end(), p.end_time);
            p.until = static_cast<std::size_t>(at - ends.begin());
            if (at == ends.end()) ends.push_back(p.end_time);
        }
        sim::Request& request = simulation_.request;
        request.turning_points = !plan_.summaries.empty();
        simulation_.keep = worth_keeping(scene_.problem, request);
        for (const sim::Request& of_figure : figures_ask_)
            simulation_.keep = simulation_.keep || worth_keeping(scene_.problem, of_figure);
        settle_cache(simulation_, known_.kept_until);
        plan_.simulation = std::move(simulation_);
    }

    // `keep` says so far whether it is worth it.
    void settle_cache(Simulation& simulation, std::optional<double> kept_until) const {
        simulation.from_cache = kept_until && *kept_until >= simulation.request.end_time;
        simulation.keep = simulation.keep && known_.keeps && !simulation.from_cache;
    }

    void note_left_frames(const Pictures& p, std::size_t count) {
        if (!p.part.empty() || (p.kind == Pictures::Kind::frames && p.draw.size() + p.there.size() < count))
            skip(fmt::format("{} of {} frames of {}", count - p.draw.size() - p.there.size(), count, p.file),
                 p.ask.frames ? "outside the frames asked for" : "other shards draw them");
        if (!p.there.empty())
            skip(fmt::format("{} frames of {}", p.there.size(), p.file),
                 "they are there already, made from the same inputs");
    }

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
        p.ask = ask_;
        if (const auto there = known_.frames.find(p.output); there != known_.frames.end()) p.there = there->second;
        if (p.kind == Pictures::Kind::video && ask_.shards > 1) p.file = shard_file(p.file, ask_.shard, ask_.shards);
        const bool still = p.kind == Pictures::Kind::still;
        p.collisions = shows_collisions(p, scene_.problem);
        p.settled = !p.collisions && (still ? p.at.kind == Instant::Kind::time : !p.span.looks_at_impacts());
        p.chart_channels = render::chart_channels(panels_of(p, scene_.problem));
        p.too_small = too_small(p.picture);
        if (!p.too_small.empty()) skip("panels " + p.too_small + " of " + p.file, no_room(p.picture.size));
        if (p.settled) {
            const FilmTimes times = times_of(p, ends, {});
            p.first_frame = times.first;
            choose_frames(p, static_cast<long>(times.frames.size()));
            note_left_frames(p, times.frames.size());
            if (p.draw.empty()) return;
        }
        sim::Request& request = simulation_.request;
        if (p.picture.compare.empty()) {
            look_until(ends, p.file);
            p.poses = request.poses.size();
            request.poses.push_back({});
            p.survey = request.poses.size();
            request.poses.push_back(survey());
            p.chart = add_table({}, p.chart_channels);
            request.tables[p.chart].curve = drawn_curve(p);
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

    // What a phase panel draws of the chart's table.
    std::optional<std::pair<sim::Channel, sim::Channel>> drawn_curve(const Pictures& p) const {
        const auto panels = panels_of(p, scene_.problem);
        if (std::ranges::none_of(panels, [](const auto& panel) { return panel.kind == render::PanelKind::phase; }))
            return std::nullopt;
        return std::pair{sim::Channel{ChannelKind::theta, 0}, sim::Channel{ChannelKind::theta_dot, 0}};
    }

    void add_compared(Pictures& p) {
        for (const Compared& each : p.picture.compare) {
            ComparedMotion motion{each.label, each.problem, {}, {}};
            motion.request.end_time = p.end_time;
            motion.request.turning_points = false;
            motion.request.poses.push_back({});
            motion.request.poses.push_back(survey());
            motion.request.tables.push_back({{}, p.chart_channels, drawn_curve(p)});
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
        if (video.span.poster) p.poster_file = poster_file(video);
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
        Studies studies;
        FigureFile file{index, figure.file, figure.figure, {}, recipe->prepare(scene_, figure.lang, studies), {}};
        file.studies = studies.take();
        for (Study& study : file.studies) add_study(study, figure.file);
        plan_.figures.push_back(std::move(file));
    }
    // A figure's run joins others of its motion.
    void add_study(Study& study, const std::string& file) {
        const std::string key = Studies::key(study.problem);
        study.of_scene = key == own_key_;
        if (study.of_scene) {
            look_until(end_of(study.request), file);
            figures_ask_.push_back(study.request);
            simulation_.horizon = simulation_.horizon || study.request.horizon;
            return;
        }
        auto same = std::find_if(plan_.variants.begin(), plan_.variants.end(),
                                 [&](const Variant& variant) { return Studies::key(variant.problem) == key; });
        if (same == plan_.variants.end()) {
            plan_.variants.push_back({study.problem, {}});
            same = plan_.variants.end() - 1;
        }
        Simulation& all = same->simulation;
        if (all.until_because.empty() || end_of(study.request) > all.request.end_time) {
            all.request.end_time = std::max(all.request.end_time, end_of(study.request));
            all.until_because = file;
        }
        all.horizon = all.horizon || study.request.horizon;
        all.keep = all.keep || worth_keeping(study.problem, study.request);
    }
    void want(const TrajectoryOutput& table, std::size_t index) {
        std::vector<sim::Channel> channels = table.channels.empty() ? all_channels(scene_.problem) : table.channels;
        const sim::Channel t{ChannelKind::t, 0};
        if (std::find(channels.begin(), channels.end(), t) == channels.end()) channels.insert(channels.begin(), t);
        std::vector<double> times = table.times.empty() ? rows(0, scene_.end_time, table.rate) : table.times;
        look_until(*std::max_element(times.begin(), times.end()), table.file);
        plan_.tables.push_back({index, table.file, add_table(std::move(times), std::move(channels)), {}});
    }
    void want(const ImpactsOutput& impacts, std::size_t index) {
        look_until(std::max(scene_.end_time, known_.until), impacts.file);
        plan_.impacts.push_back({index, impacts.file});
    }
    void want(const SummaryOutput& summary, std::size_t index) {
        look_until(std::max(scene_.end_time, known_.until), summary.file);
        if (simulation_.request.extrema.empty())
            for (const sim::Channel& channel : all_channels(scene_.problem))
                if (channel.kind != ChannelKind::t) simulation_.request.extrema.push_back(channel);
        if (summary.horizon) simulation_.request.horizon = simulation_.horizon = true;
        plan_.summaries.push_back({index, summary.file});
    }

    void skip(std::string what, std::string why) { plan_.skipped.push_back({std::move(what), std::move(why)}); }

    void note_skipped() {
        const bool compares =
            std::ranges::any_of(plan_.pictures, [](const Pictures& p) { return !p.compared.empty(); });
        if (!needed_ && !compares && !plan_.variants.empty())
            return skip("simulation of the scene itself", "its figures look at variants of it");
        if (!needed_)
            return skip(compares ? "simulation of the scene itself" : "simulation",
                        compares        ? "only compared motions are shown"
                        : finished_ > 0 ? "everything is there already"
                                        : "no output looks at the motion");
        const double end = plan_.simulation->request.end_time;
        if (end < scene_.end_time)
            skip(fmt::format("simulation from {:g} s to {:g} s", end, scene_.end_time), "no output looks that far");
        if (!scene_.problem.cam) skip("contact", "the scene has no cam");
        if (plan_.simulation->from_cache) skip("integration", "the motion is kept from an earlier run");
        note_unread_channels();
        if (plan_.pictures.empty())
            skip(plan_.figures.empty() ? "pictures, fonts and OpenGL" : "films and OpenGL", "no output is a picture");
        else if (!plan_.needs_gl())
            skip("OpenGL", "every view is flat");
        if (!plan_.needs_encoder()) skip("video encoder", "no output is a video");
        if (plan_.summaries.empty()) skip("extrema and turning points", "no output is a summary");
        if (!plan_.simulation->horizon) skip("second run for the reproducible horizon", "nothing asks for it");
    }

    void note_unread_channels() {
        const std::vector<sim::Channel> every = all_channels(scene_.problem);
        auto read = [&](const sim::Channel& channel) {
            const sim::Request& request = plan_.simulation->request;
            auto holds = [&](const std::vector<sim::Channel>& some) {
                return std::find(some.begin(), some.end(), channel) != some.end();
            };
            const auto in_tables = [&](const sim::Request& some) {
                return std::ranges::any_of(some.tables, [&](const sim::TableRequest& t) { return holds(t.channels); });
            };
            return holds(request.extrema) || in_tables(request) || std::ranges::any_of(figures_ask_, in_tables);
        };
        const auto unread = std::count_if(every.begin(), every.end(),
                                          [&](const sim::Channel& c) { return c.kind != ChannelKind::t && !read(c); });
        if (unread > 0) skip(fmt::format("{} of {} channels", unread, every.size() - 1), "no output reads them");
    }

    const Scene& scene_;
    const Ask& ask_;
    const Known& known_;
    Plan plan_;
    Simulation simulation_;
    const std::string own_key_;
    std::vector<sim::Request> figures_ask_;  // of the scene's motion
    bool needed_ = false;
    int finished_ = 0;
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

std::optional<Cost> Plan::cost() const {
    std::optional<Cost> all;
    const auto add = [&](const std::optional<Cost>& one, bool bytes) {
        if (!one) return;
        if (!all) all.emplace();
        all->seconds += one->seconds;
        if (bytes) all->amount += one->amount;
    };
    if (simulation) add(simulation->cost, false);
    for (const Variant& v : variants) add(v.simulation.cost, false);
    for (const Pictures& p : pictures) {
        for (const ComparedMotion& each : p.compared) add(each.cost, false);
        add(p.cost, true);
    }
    for (const FigureFile& f : figures) add(f.cost, true);
    for (const TableFile& t : tables) add(t.cost, true);
    return all;
}

std::size_t Plan::frames() const {
    std::size_t count = 0;
    for (const Pictures& p : pictures) count += p.draw.size();
    return count;
}

const std::vector<double>& Plan::times(const Pictures& p) const {
    return p.compared.empty() ? simulation->request.poses[p.poses].times
                              : p.compared.front().request.poses.front().times;
}

std::vector<sim::Request> requests_of(const Plan& plan) {
    std::vector<sim::Request> all;
    if (!plan.simulation) return all;
    all.push_back(plan.simulation->request);
    for (double end : plan.simulation->ends) {
        all.emplace_back();
        all.back().end_time = end;
        all.back().turning_points = false;
    }
    for (const FigureFile& figure : plan.figures)
        for (const Study& study : figure.studies)
            if (study.of_scene) all.push_back(study.request);
    return all;
}

std::string shard_file(const std::string& file, int shard, int shards) {
    const std::filesystem::path path(file);
    return (path.parent_path() /
            fmt::format("{}.{}of{}{}", path.stem().string(), shard, shards, path.extension().string()))
        .string();
}

std::string no_room(const Size& size) {
    return fmt::format(
        "{} × {} is too small for them; a larger \"size\", larger shares or fewer panels would show them", size.width,
        size.height);
}

std::string no_room_to_write(const Size& size) {
    return fmt::format("{} × {} leaves no room to write them; a larger \"size\" would", size.width, size.height);
}

std::string unwritten(const Pictures& p, const Scene& scene) {
    const Picture& picture = p.picture;
    std::vector<const sim::Problem*> problems;
    for (const Compared& each : picture.compare) problems.push_back(&each.problem);
    if (problems.empty()) problems.push_back(&scene.problem);
    const int members = picture.comparison == render::Comparison::panels ? static_cast<int>(problems.size()) : 1;
    return fmt::format("{}", fmt::join(render::without_room(picture.size.width, picture.size.height, picture.layout,
                                                            members, scene.title, problems),
                                       "; "));
}

void note_unwritten(Plan& plan, const Scene& scene) {
    std::vector<Skipped> notes;
    try {
        for (const Pictures& p : plan.pictures)
            if (const std::string what = unwritten(p, scene); !what.empty())
                notes.push_back({fmt::format("{} on {}", what, p.file), no_room_to_write(p.picture.size)});
    } catch (const render::FontError&) {
        return;  // told by whoever draws
    }
    plan.skipped.insert(plan.skipped.begin(), notes.begin(), notes.end());
}

bool is_slow_motion(const Pictures& p) {
    return p.picture.compare.empty() && (p.span.speed.around || p.span.speed.factor <= 0.1);
}

bool Pictures::makes_poster() const { return poster && std::ranges::binary_search(draw, *poster); }

Plan plan(const Scene& scene, const Ask& ask, const Known& known) { return Planner(scene, ask, known).make(); }

namespace {

// Slow around the impacts of all that is shown; "impact:N" counts those of the first.
FilmTimes times_of_compared(const Pictures& p, const FindImpacts& find) {
    const sim::Result first = find(p.compared.front().problem, p.end_time);
    std::vector<sim::Impact> all = first.impacts;
    for (std::size_t i = 1; i < p.compared.size(); ++i) {
        const sim::Result other = find(p.compared[i].problem, p.end_time);
        all.insert(all.end(), other.impacts.begin(), other.impacts.end());
    }
    std::ranges::stable_sort(all, {}, &sim::Impact::t_start);
    return p.kind == Pictures::Kind::still ? still_times(p.at, first, surveyed_until(p))
                                           : film_times(p.span, p.end_time, first, all);
}

}  // namespace

void settle(Plan& plan, const Scene& scene, const FindImpacts& find, const RefusePicture& refuse) {
    std::optional<sim::Result> own;
    sim::Request none;
    for (Pictures& p : plan.pictures) {
        if (p.settled) continue;
        const bool compares = !p.compared.empty();
        if (!compares && !own) own = find(scene.problem, *plan.impacts_until);
        try {
            put_times(p, compares ? none : plan.simulation->request,
                      compares ? times_of_compared(p, find) : times_of(p, p.end_time, *own));
            p.settled = true;
        } catch (const render::PictureError& error) {
            if (!refuse) throw;
            refuse(p, error.what());
        }
    }
    std::erase_if(plan.pictures, [](const Pictures& p) { return !p.settled; });
    plan.impacts_until.reset();
}

}  // namespace beamcam::scenes
