#include <fmt/format.h>

#include <cmath>

#include "output/film/video_format.hpp"
#include "scenes/format/checks.hpp"
#include "scenes/scene/files.hpp"
#include "scenes/scene/film_times.hpp"

namespace beamcam::scenes {

static bool needs_cam(const render::Anchor& anchor) {
    return anchor.kind == render::Anchor::Kind::contact || anchor.kind == render::Anchor::Kind::cam;
}

void check_camera(ObjectReader& r, const View& view) {
    for (const char* key : {"yaw", "pitch"})
        if (r.has(key) && view.style != render::Style::solid)
            r.warn(key, " has an effect in the solid view only; add \"style\": \"solid\"");
    const auto check = [&](const render::Anchor& follow, const std::string& key) {
        if (needs_cam(follow) && !r.context().scene.problem.cam)
            r.reject(key, ": the scene has no cam to follow; follow the tip, the hub or a place");
    };
    check(view.shot.follow, "follow");
    for (std::size_t i = 0; i < view.keyframes.size(); ++i)
        if (view.keyframes[i].follow) check(*view.keyframes[i].follow, fmt::format("keyframes.{}.follow", i));
}

void check_speed(ObjectReader& r, const Speed& speed) {
    if (r.diagnostics().failed(r.object_name())) return;
    for (std::size_t i = 1; i < speed.intervals.size(); ++i) {
        const Instant &before = speed.intervals[i - 1].to, &from = speed.intervals[i].from;
        const std::string key = fmt::format("intervals.{}.from", i);
        if (before.kind == Instant::Kind::time && from.kind == Instant::Kind::time && from.t < before.t)
            r.reject(key,
                     " = {:g} s is before the end of the previous interval, {:g} s; list the intervals in order of "
                     "time, without overlap",
                     from.t, before.t);
    }
    for (std::size_t i = 0; speed.around && i < speed.around->collisions.size(); ++i)
        if (const double number = speed.around->collisions[i]; number != std::round(number)) {
            const std::string key = fmt::format("collisions.{}", i);
            r.reject(key, " = {:g} must be a whole number", number);
        }
}

namespace {

// Instants outside a film are only warnings, so that a film can be shortened.
void check_instants(ObjectReader& r, const FrameSpan& span, const View& view, double end) {
    const auto check = [&](const std::string& key, const Instant& at, const char* consequence) {
        if (at.kind == Instant::Kind::time && (at.t < span.from || at.t > end))
            r.warn(key, " = {:g} s is outside the film from {:g} s to {:g} s: {}", at.t, span.from, end, consequence);
    };
    const auto readable = [&](const char* key) { return !r.diagnostics().failed(r.path(key)); };
    for (std::size_t i = 0; i < span.events.size() && readable("events"); ++i)
        check(fmt::format("events.{}.at", i), span.events[i].at, "it is not shown");
    for (std::size_t i = 0; i < span.speed.intervals.size() && readable("speed"); ++i) {
        const SpeedInterval& each = span.speed.intervals[i];
        check(fmt::format("speed.intervals.{}.from", i), each.from, "the interval is cut there");
        check(fmt::format("speed.intervals.{}.to", i), each.to, "the interval is cut there");
    }
    for (std::size_t i = 0; i < view.keyframes.size() && readable("view"); ++i) {
        const Instant& at = view.keyframes[i].at;
        const std::string key = fmt::format("view.camera.keyframes.{}.at", i);
        check(key, at, "the film does not show the arrival of the camera");
        if (i == 0 || at.kind != Instant::Kind::time) continue;
        const Instant& before = view.keyframes[i - 1].at;
        if (before.kind == Instant::Kind::time && at.t <= before.t)
            r.reject(key, " = {:g} s is not after the previous keyframe, {:g} s; list the keyframes in order of time",
                     at.t, before.t);
    }
}

}  // namespace

void check_end(ObjectReader& r, const char* key, double t) {
    const double end = r.context().scene.end_time;
    if (t > end && !r.diagnostics().failed(r.path(key)) && !r.diagnostics().failed("time"))
        r.warn(key, " = {:g} s is after the end of the scene, time.end = {:g} s: the motion is computed until then", t,
               end);
}

void check_span(ObjectReader& r, const FrameSpan& span, const Picture& picture) {
    if (span.story && picture.compare.empty() && !r.context().scene.problem.cam && !r.diagnostics().failed("cam"))
        r.reject("story", " needs a collision, but the scene has no cam");
    if (span.story && !picture.compare.empty())
        r.reject("story", " tells one motion, but the film compares {}; remove \"story\" or \"compare\"",
                 picture.compare.size());
    const Diagnostics& diagnostics = r.diagnostics();
    if (diagnostics.failed(r.path("from")) || diagnostics.failed(r.path("to")) || diagnostics.failed("time")) return;
    if (const std::string problem = problem_with_span(span, r.context().scene.end_time); !problem.empty())
        return r.reject_object("to", ": {}", problem);
    if (span.to) check_end(r, "to", *span.to);
    check_instants(r, span, picture.view, span.to.value_or(r.context().scene.end_time));
}

void set_default_codec(PictureOutput& video) {
    video.encoding.codec = output::default_codec(ending_of(video.file)).value_or(output::Codec::h264);
}

namespace {

// Rules between codec, container and picture.
void check_format(ObjectReader& r, const PictureOutput& video) {
    const std::string ending = ending_of(video.file);
    const output::Codec codec = video.encoding.codec;
    if (const std::string problem = output::format_problem(ending, codec, video.view.transparent); !problem.empty())
        return r.fail(r.place(output::goes_into(codec, ending) ? "background" : "codec"), "codec",
                      fmt::format("{}: {}", r.object_name(), problem));
    r.reject_if("size", output::size_problem(codec, video.size.width, video.size.height));
    r.reject_if("fps", output::rate_problem(codec, video.span.fps.value()));
    if (r.has("preset") && codec != output::Codec::h264)
        r.reject("preset", ": only H.264 has presets, {} has none; remove the key", title(codec));
    r.reject_if("crf", output::quality_problem(codec, video.encoding.crf));
}

}  // namespace

void check_video(ObjectReader& r, PictureOutput& video) {
    constexpr FrameRate kGifRate{25, 1};  // default of a GIF
    if (video.encoding.codec == output::Codec::gif && !r.has("fps")) video.span.fps = kGifRate;
    if (!video.encoding.crf)
        if (const auto quality = output::quality_scale(video.encoding.codec)) video.encoding.crf = quality->usual;
    check_span(r, video.span, video);
    check_format(r, video);
}

}  // namespace beamcam::scenes
