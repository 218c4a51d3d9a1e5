#include "scenes/plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace beamcam::scenes {
namespace {

using sim::ChannelKind;

// Strip charts show steps down to a quarter of a millisecond, and never more points than a screen
// of ten thousand columns could tell apart twice; but also a very short film has enough of them to be smooth.
constexpr double kChartRate = 4000;  // [Hz]
constexpr double kMostChartPoints = 20000, kFewestChartPoints = 2000;

const std::vector<sim::Channel> kTraceChannels = {
    {ChannelKind::t, 0}, {ChannelKind::contact_x, 0}, {ChannelKind::contact_s, 0}, {ChannelKind::contact_force, 0}};

// k / rate from `from`, and `to` itself.
std::vector<double> rows(double from, double to, double rate) {
    std::vector<double> times;
    const double first = std::ceil(from * rate), last = std::floor(to * rate);
    times.reserve(static_cast<std::size_t>(std::max(0.0, last - first)) + 2);
    for (double k = first; k <= last; ++k) times.push_back(k / rate);
    // k/rate and `to` may be one instant, written twice by rounding.
    if (!times.empty() && std::abs(times.back() - to) < 1e-9 / rate) times.back() = to;
    if (times.empty() || times.back() < to) times.push_back(to);
    return times;
}

double chart_rate(double duration) {
    const double seconds = std::max(duration, 1e-12);
    return std::clamp(kChartRate, kFewestChartPoints / seconds, kMostChartPoints / seconds);
}

std::vector<double> frame_times(const FrameSpan& span, double end_time, long& first) {
    const double fps = span.fps.value();
    first = std::lround(span.from * fps);
    const long last = std::lround(span.to.value_or(end_time) * fps);
    std::vector<double> times;
    for (long k = first; k < last; ++k)
        times.push_back(static_cast<double>(k) * span.fps.denominator / span.fps.numerator);
    return times;
}

// Collects what the outputs want of the one simulation.
class Planner {
  public:
    explicit Planner(const Scene& scene) : scene_(scene) {}

    Plan make() {
        for (std::size_t i = 0; i < scene_.outputs.size(); ++i)
            std::visit([&](const auto& output) { want(output, i); }, scene_.outputs[i]);
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

    void want_pictures(Pictures pictures, std::vector<double> times, double chart_from, double chart_to) {
        const double last = *std::max_element(times.begin(), times.end());
        look_until(std::max(last, chart_to), pictures.file);
        pictures.poses = simulation_.request.poses.size();
        simulation_.request.poses.push_back({std::move(times)});
        pictures.chart = add_table(rows(chart_from, chart_to, chart_rate(chart_to - chart_from)),
                                   render::chart_channels(render::standard_panels(scene_.problem, false)));
        // The trace keeps what happened before the film began.
        if (scene_.problem.cam) pictures.trace = add_table(rows(0, chart_to, chart_rate(chart_to)), kTraceChannels);
        plan_.pictures.push_back(std::move(pictures));
    }

    void want(const VideoOutput& video, std::size_t index) {
        Pictures p{.kind = Pictures::Kind::video,
                   .output = index,
                   .file = video.file,
                   .size = video.size,
                   .view = video.view,
                   .fps = video.span.fps,
                   .encoding = video.encoding,
                   .trace = {}};
        std::vector<double> times = frame_times(video.span, scene_.end_time, p.first_frame);
        want_pictures(std::move(p), std::move(times), video.span.from, video.span.to.value_or(scene_.end_time));
    }
    void want(const FramesOutput& frames, std::size_t index) {
        Pictures p{.kind = Pictures::Kind::frames,
                   .output = index,
                   .file = frames.file,
                   .size = frames.size,
                   .view = frames.view,
                   .fps = frames.span.fps,
                   .encoding = {},
                   .trace = {}};
        std::vector<double> times = frame_times(frames.span, scene_.end_time, p.first_frame);
        want_pictures(std::move(p), std::move(times), frames.span.from, frames.span.to.value_or(scene_.end_time));
    }
    void want(const StillOutput& still, std::size_t index) {
        Pictures p{.kind = Pictures::Kind::still,
                   .output = index,
                   .file = still.file,
                   .size = still.size,
                   .view = still.view,
                   .fps = {},
                   .encoding = {},
                   .trace = {}};
        want_pictures(std::move(p), {still.at}, 0, still.at);
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
        if (!needed_) return skip("simulation", "no output looks at the motion");
        const double end = plan_.simulation->request.end_time;
        if (end < scene_.end_time)
            skip(fmt::format("simulation from {:g} s to {:g} s", end, scene_.end_time), "no output looks that far");
        if (!scene_.problem.cam) skip("contact", "the scene has no cam");
        note_unread_channels();
        if (plan_.pictures.empty())
            skip("pictures, fonts and OpenGL", "no output is a picture");
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
    bool needed_ = false;
};

}  // namespace

bool Plan::needs_gl() const {
    return std::any_of(pictures.begin(), pictures.end(),
                       [](const Pictures& p) { return p.view.style == render::Style::lit; });
}

bool Plan::needs_encoder() const {
    return std::any_of(pictures.begin(), pictures.end(),
                       [](const Pictures& p) { return p.kind == Pictures::Kind::video; });
}

std::size_t Plan::frames() const {
    std::size_t count = 0;
    for (const Pictures& p : pictures) count += simulation->request.poses[p.poses].times.size();
    return count;
}

Plan plan(const Scene& scene) { return Planner(scene).make(); }

}  // namespace beamcam::scenes
