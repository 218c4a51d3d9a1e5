#include "scenes/format/checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include "output/files/numbers.hpp"
#include "output/film/video_format.hpp"
#include "output/image/png_reader.hpp"
#include "render/plot/user_text.hpp"
#include "scenes/scene/files.hpp"
#include "scenes/scene/film_times.hpp"

namespace beamcam::scenes {

// ---- physics -----------------------------------------------------------------------------------

namespace {

// Where a key path stands: its value, or else the key of its nearest ancestor in the file.
Place place_in_scene(const Node& root, std::string_view path, bool& exact) {
    const Node* node = &root;
    Place place = root.place;
    exact = true;
    while (!path.empty()) {
        const std::size_t dot = std::min(path.find('.'), path.size());
        const std::string_view key = path.substr(0, dot);
        path.remove_prefix(std::min(dot + 1, path.size()));
        if (const Member* member = node->find(key)) {
            place = path.empty() ? member->value.place : member->key_place;
            node = &member->value;
            continue;
        }
        const auto index = output::number_in<std::size_t>(key);
        if (node->kind != Node::Kind::array || !index || *index >= node->items.size()) {
            exact = false;
            break;
        }
        node = &node->items[*index];
        place = node->place;
    }
    return place;
}

}  // namespace

void check_physics(ObjectReader& r, const sim::Problem& problem) {
    const bool partial = r.diagnostics().any();
    for (const sim::Issue& finding : sim::validate(problem)) {
        bool exact = false;
        const Place place = place_in_scene(*r.node(), finding.path, exact);
        // With unread values replaced by defaults, only what the user wrote himself can be judged.
        if (partial && (!exact || !finding.fatal || r.diagnostics().failed(finding.path))) continue;
        const bool named = finding.message.starts_with(finding.path);
        r.diagnostics().add(
            {place, named ? finding.message : fmt::format("{}: {}", finding.path, finding.message), finding.fatal});
    }
}

void check_words(ObjectReader& r, const char* key, const std::string& text) {
    if (const std::string problem = render::markup_problem(text); !problem.empty())
        r.diagnostics().warning(r.place(key).place,
                                fmt::format("{}: {}; it is shown as it is written", r.path(key), problem));
}

// ---- pictures ----------------------------------------------------------------------------------

void take_written_units(ObjectReader& r, render::Units& units) {
    const auto ends_in = [&](const char* object, const char* key, std::initializer_list<std::string_view> names) {
        const Member* inside = r.node()->find(object);
        const Member* value = inside ? inside->value.find(key) : nullptr;
        return value && value->value.kind == Node::Kind::string && std::ranges::any_of(names, [&](auto name) {
                   return std::string_view(value->value.text).ends_with(name);
               });
    };
    units.degrees = ends_in("initial", "angle", {"deg", "°"});
    units.rpm = ends_in("cam", "speed", {"rpm"});
}

static bool needs_cam(const render::Anchor& anchor) {
    return anchor.kind == render::Anchor::Kind::contact || anchor.kind == render::Anchor::Kind::cam;
}

void check_camera(ObjectReader& r, const View& view) {
    for (const char* key : {"yaw", "pitch", "swing"})
        if (r.has(key) && view.style != render::Style::solid)
            r.diagnostics().warning(
                r.place(key).place,
                fmt::format("{} turns the solid view alone; \"style\": \"solid\" shows that", r.path(key)));
    const auto judge = [&](const render::Anchor& follow, const std::string& key) {
        if (needs_cam(follow) && !r.context().scene.problem.cam)
            r.fail(r.place(key), key,
                   fmt::format("{}: there is no cam to follow; follow the tip, the hub or a place", r.path(key)));
    };
    judge(view.shot.follow, "follow");
    for (std::size_t i = 0; i < view.keyframes.size(); ++i)
        if (view.keyframes[i].follow) judge(*view.keyframes[i].follow, fmt::format("keyframes.{}.follow", i));
}

void check_view(ObjectReader& r, const View& view) {
    if (r.has("exposures") && view.poses() == 1)
        r.diagnostics().warning(
            r.place("exposures").place,
            fmt::format("{} needs a \"shutter\" or \"strobe\" to be exposed for", r.path("exposures")));
}

// Beyond these shapes a logo as high as the clock's line, or a third of it wide, is a hairline.
static constexpr int kWidestLogo = 10, kTallestLogo = 5;

static void read_logo(ObjectReader& r, Picture& picture) {
    if (!r.has("logo") || r.diagnostics().failed(r.path("logo"))) return;
    if (picture.logo.empty())
        return r.fail(r.place("logo"), "logo",
                      fmt::format("{} is empty; name a .png file, or remove the key", r.path("logo")));
    const auto path = std::filesystem::path(r.context().source.name).parent_path() / picture.logo;
    try {
        const output::Raster raster = output::read_png(path);
        if (raster.width > kWidestLogo * raster.height || raster.height > kTallestLogo * raster.width)
            return r.fail(r.place("logo"), "logo",
                          fmt::format("{} = {} has {} × {} pixels; a logo is at most {} times as wide as high and {} "
                                      "times as high as wide",
                                      r.path("logo"), as_written(r.place("logo")), raster.width, raster.height,
                                      kWidestLogo, kTallestLogo));
        picture.logo_digest = output::digest(raster);
        picture.logo_image = std::make_shared<const render::Image>(output::to_image(raster));
    } catch (const output::IoError& error) {
        r.fail(r.place("logo"), "logo",
               fmt::format("{} = {}: {}", r.path("logo"), as_written(r.place("logo")), error.what()));
    }
}

void check_picture(ObjectReader& r, Picture& picture) {
    read_logo(r, picture);
    if (const double memory = memory_of(picture); memory >= kMuchMemory)  // told before it is drawn
        r.diagnostics().warning(r.node()->place,
                                fmt::format("{} of {} × {} pixels takes about {:.2g} GB of memory for each thread",
                                            r.object_name(), picture.size.width, picture.size.height, memory / 1e9));
    if (const auto paper = picture.view.paper) {
        const render::Color ink =
            picture.view.colors.ink ? render::rgb(*picture.view.colors.ink) : render::palette(picture.view.theme).ink;
        if (render::contrast(ink, render::rgb(*paper)) < 3)
            r.diagnostics().warning(
                r.place("background").place,
                fmt::format("{} leaves the text hardly readable; choose another \"theme\"", r.path("background")));
    }
    if (picture.comparison == render::Comparison::ghosts && !r.has("compare"))
        r.diagnostics().warning(
            r.node()->place,
            fmt::format("{} = \"ghosts\" shows none without \"compare\", or more scenes given to `beamcam render`",
                        r.path("comparison")));
    for (std::size_t i = 0; i < picture.compare.size(); ++i)
        if (std::string& label = picture.compare[i].label; label.empty()) label = std::to_string(i + 1);
    check_layout(r, picture);
}

// ---- films -------------------------------------------------------------------------------------

std::string problem_with_span(const FrameSpan& span, double end_time) {
    const double to = span.to.value_or(end_time), fps = span.fps.value();
    if (span.from_event || span.to_event) return {};
    if (!span.real_time()) {
        if (to > span.from) return {};  // how many frames, only the motion tells
        return fmt::format("the film ends at {:g} s and begins at {:g} s; \"to\" must be later than \"from\"", to,
                           span.from);
    }
    const double first = std::round(span.from * fps), last = std::round(to * fps);
    if (!(last > first))
        return fmt::format(
            "no frame lies between {:g} s and {:g} s at {:g} frames a second; {}", span.from, to, fps,
            to > span.from ? "let \"to\" be later, or raise \"fps\"" : "\"to\" must be later than \"from\"");
    if (last - first > kMostFrames)
        return fmt::format(
            "{:.0f} frames are more than the {:.0f} that one output can have; use \"from\" and \"to\", or fewer frames "
            "a second",
            last - first, kMostFrames);
    return {};
}

void check_speed(ObjectReader& r, const Speed& speed) {
    if (r.diagnostics().failed(r.object_name())) return;
    for (std::size_t i = 1; i < speed.intervals.size(); ++i) {
        const Instant &before = speed.intervals[i - 1].to, &from = speed.intervals[i].from;
        const std::string key = fmt::format("intervals.{}.from", i);
        if (before.kind == Instant::Kind::time && from.kind == Instant::Kind::time && from.t < before.t)
            r.fail(r.place(key), key,
                   fmt::format("{} = {:g} s is before the end of the interval before it, {:g} s; list the intervals in "
                               "their order, without overlap",
                               r.path(key), from.t, before.t));
    }
    for (std::size_t i = 0; speed.around && i < speed.around->collisions.size(); ++i)
        if (const double number = speed.around->collisions[i]; number != std::round(number)) {
            const std::string key = fmt::format("collisions.{}", i);
            r.fail(r.place(key), key, fmt::format("{} = {:g} must be a whole number", r.path(key), number));
        }
}

namespace {

// Instants that a film does not reach are warnings, so that films can be shortened.
void check_instants(ObjectReader& r, const FrameSpan& span, const View& view, double end) {
    const auto judge = [&](const std::string& key, const Instant& at, const char* consequence) {
        if (at.kind == Instant::Kind::time && (at.t < span.from || at.t > end))
            r.diagnostics().warning(r.place(key).place,
                                    fmt::format("{} = {:g} s is no instant of a film from {:g} s to {:g} s: {}",
                                                r.path(key), at.t, span.from, end, consequence));
    };
    const auto readable = [&](const char* key) { return !r.diagnostics().failed(r.path(key)); };
    for (std::size_t i = 0; i < span.events.size() && readable("events"); ++i)
        judge(fmt::format("events.{}.at", i), span.events[i].at, "it is not shown");
    for (std::size_t i = 0; i < span.speed.intervals.size() && readable("speed"); ++i) {
        const SpeedInterval& each = span.speed.intervals[i];
        judge(fmt::format("speed.intervals.{}.from", i), each.from, "the interval is cut there");
        judge(fmt::format("speed.intervals.{}.to", i), each.to, "the interval is cut there");
    }
    for (std::size_t i = 0; i < view.keyframes.size() && readable("view"); ++i) {
        const Instant& at = view.keyframes[i].at;
        const std::string key = fmt::format("view.camera.keyframes.{}.at", i);
        judge(key, at, "the camera is not seen to arrive");
        if (i == 0 || at.kind != Instant::Kind::time) continue;
        const Instant& before = view.keyframes[i - 1].at;
        if (before.kind == Instant::Kind::time && at.t <= before.t)
            r.fail(r.place(key), key,
                   fmt::format("{} = {:g} s is not after the keyframe before it, {:g} s; list the keyframes in the "
                               "order of time",
                               r.path(key), at.t, before.t));
    }
}

}  // namespace

void check_span(ObjectReader& r, const FrameSpan& span, const Picture& picture) {
    const Diagnostics& diagnostics = r.diagnostics();
    if (diagnostics.failed(r.path("from")) || diagnostics.failed(r.path("to")) || diagnostics.failed("time")) return;
    if (const std::string problem = problem_with_span(span, r.context().scene.end_time); !problem.empty())
        return r.fail(*r.node(), "to", fmt::format("{}: {}", r.object_name(), problem));
    check_instants(r, span, picture.view, span.to.value_or(r.context().scene.end_time));
    const sim::Problem& shown = picture.compare.empty() ? r.context().scene.problem : picture.compare.front().problem;
    for (std::size_t i = 0; i < span.events.size() && !shown.cam; ++i)
        if (const auto& anchor = span.events[i].anchor; anchor && needs_cam(*anchor)) {
            const std::string key = fmt::format("events.{}.anchor", i);
            r.fail(r.place(key), key,
                   fmt::format("{}: there is no cam; anchor the words to the tip, the hub or a place", r.path(key)));
        }
}

void take_usual_codec(ObjectReader& r, VideoOutput& video) {
    name_after_scene(r, video.file, ".mp4");
    video.encoding.codec =
        output::default_codec(std::filesystem::path(video.file).extension().string()).value_or(output::Codec::h264);
}

namespace {

// What the codec, the container and the picture ask of each other.
void check_format(ObjectReader& r, const VideoOutput& video) {
    const std::string ending = std::filesystem::path(video.file).extension().string();
    const output::Codec codec = video.encoding.codec;
    const auto refuse = [&](const char* key, const std::string& problem) {
        if (!problem.empty()) r.fail(r.place(key), key, fmt::format("{}: {}", r.path(key), problem));
    };
    if (const std::string problem = output::format_problem(ending, codec, video.view.transparent); !problem.empty())
        return r.fail(r.place(output::goes_into(codec, ending) ? "background" : "codec"), "codec",
                      fmt::format("{}: {}", r.object_name(), problem));
    refuse("size", output::size_problem(codec, video.size.width, video.size.height));
    refuse("fps", output::rate_problem(codec, video.span.fps.value()));
    if (r.has("preset") && codec != output::Codec::h264)
        refuse("preset", fmt::format("{} has no presets, H.264 alone has; remove it", title(codec)));
    const auto quality = output::quality_scale(codec);
    if (r.has("crf") && !quality)
        refuse("crf", fmt::format("{} has no crf, it keeps what its format can; remove it", title(codec)));
    else if (quality && video.encoding.crf.value_or(0) > quality->worst)
        r.fail(r.place("crf"), "crf",
               fmt::format("{} = {} is outside 0 … {} of {}", r.path("crf"), *video.encoding.crf, quality->worst,
                           title(codec)));
}

}  // namespace

void check_video(ObjectReader& r, VideoOutput& video) {
    constexpr FrameRate kGifRate{25, 1};  // what a GIF has by default
    if (video.encoding.codec == output::Codec::gif && !r.has("fps")) video.span.fps = kGifRate;
    if (!video.encoding.crf)
        if (const auto quality = output::quality_scale(video.encoding.codec)) video.encoding.crf = quality->usual;
    check_span(r, video.span, video);
    check_format(r, video);
}

// ---- tables, files -----------------------------------------------------------------------------

namespace {

void refuse_many_rows(ObjectReader& r, double rate, double each) {
    constexpr double kMostRows = 20'000'000;  // 160 MB a channel
    const double rows = rate * r.context().scene.end_time * each;
    if (r.has("rate") && rows > kMostRows)
        r.fail(r.place("rate"), "rate",
               fmt::format("{} = {} would make {:.3g} rows, more than {:.3g}; lower it", r.path("rate"),
                           as_written(r.place("rate")), rows, kMostRows));
}

}  // namespace

void check_table(ObjectReader& r, TrajectoryOutput& table) {
    name_after_scene(r, table.file, ".csv");
    refuse_many_rows(r, table.rate, 1);
}

void check_shapes(ObjectReader& r, ShapesOutput& shapes) {
    name_after_scene(r, shapes.file, "-shapes.csv");
    refuse_many_rows(r, shapes.rate, shapes.stations);
}

void check_sweep(ObjectReader& r, SweepOutput& sweep) {
    name_after_scene(r, sweep.file, "-sweep.nc");
    if (!r.context().scene.sweep && !r.diagnostics().any())
        r.fail(*r.node(), "type",
               fmt::format("{}: the scene has no \"sweep\", whose points it would hold", r.object_name()));
}

void name_after_scene(ObjectReader& r, std::string& file, const char* ending) {
    if (file.empty()) file = r.context().scene.name + ending;
}

namespace {

// Two outputs must not write one file.
void refuse_shared_files(ObjectReader& r, const Node& list, const std::vector<Output>& outputs) {
    const auto nameless = [](const Output& output) { return file_of(output).empty(); };  // it could not be read
    if (std::ranges::any_of(outputs, nameless)) return;
    FileClaims claims;
    for (std::size_t i = 0; i < outputs.size(); ++i)
        for (const std::string& file : written_by(outputs[i])) claims.add(file, i);
    for (const auto& [later, earlier] : claims.clashes()) {
        const Node& object = list.items[later.owner];
        const Member* file = object.find("file");
        r.fail(file ? file->value : object, fmt::format("outputs.{}.file", later.owner),
               fmt::format("outputs.{} writes {}, which outputs.{} writes too ({}); give it a \"file\" of its own",
                           later.owner, in_quotes(later.file), earlier.owner, in_quotes(earlier.file)));
    }
}

}  // namespace

void check_outputs(ObjectReader& r, Scene& scene) {
    const Member* list = r.node()->find("outputs");
    if (!list || list->value.items.size() != scene.outputs.size()) return;
    const Source& source = r.context().source;
    Locator locator(source.text);
    for (const Node& object : list->value.items) {
        std::string& place = scene.output_places.emplace_back(source.name);
        if (object.place.source != 0) continue;
        const LineColumn at = locator.at(object.place.offset);
        place += fmt::format(":{}:{}", at.line, at.column);
    }
    refuse_shared_files(r, list->value, scene.outputs);
}

}  // namespace beamcam::scenes
