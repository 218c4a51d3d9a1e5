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

// The position of a key path: its value, or the key of its nearest ancestor in the file. `exact`: it is the value.
Place place_in_scene(const Node& root, std::string_view path, bool& exact) {
    const Node* node = &root;
    Place place = root.place;
    const std::vector<std::string> names = split(path);
    exact = true;
    for (std::size_t i = 0; i < names.size() && exact; ++i) {
        const Node* inner = child(*node, names[i]);
        exact = inner != nullptr;
        if (!inner) break;
        const Member* member = node->find(names[i]);
        place = member && i + 1 < names.size() ? member->key_place : inner->place;
        node = inner;
    }
    return place;
}

}  // namespace

void check_physics(ObjectReader& r, const sim::Problem& problem) {
    const bool partial = r.diagnostics().any();
    for (const sim::Issue& finding : sim::validate(problem)) {
        bool exact = false;
        const Place place = place_in_scene(*r.node(), finding.path, exact);
        // Some values could not be read and are defaults now: check only values that the file contains.
        if (partial && (!exact || !finding.fatal || r.diagnostics().failed(finding.path))) continue;
        const bool named = finding.message.starts_with(finding.path);
        r.diagnostics().add(
            {place, named ? finding.message : fmt::format("{}: {}", finding.path, finding.message), finding.fatal});
    }
}

void check_words(ObjectReader& r, const char* key, const std::string& text) {
    if (const std::string problem = render::markup_problem(text); !problem.empty())
        r.warn(key, ": {}; the picture shows it unchanged", problem);
}

// ---- pictures ----------------------------------------------------------------------------------

// The units of the first of these keys that is a text with a unit.
void infer_units(ObjectReader& r, render::Units& units) {
    using Keys = std::initializer_list<const char*>;
    const auto first_ends_in = [&](std::initializer_list<Keys> all, std::initializer_list<std::string_view> names) {
        for (const Keys& keys : all) {
            const Node* at = r.node();
            for (const char* key : keys) {
                const Member* member = at ? at->find(key) : nullptr;
                at = member ? &member->value : nullptr;
            }
            if (at && at->kind == Node::Kind::string)
                return std::ranges::any_of(names,
                                           [&](auto name) { return std::string_view(at->text).ends_with(name); });
        }
        return false;
    };
    units.degrees = first_ends_in({{"initial", "angle"}, {"cam", "phase"}}, {"deg", "°"});
    units.rpm = first_ends_in({{"cam", "speed"}, {"hub", "drive", "speed"}, {"initial", "angular_velocity"}}, {"rpm"});
}

static bool needs_cam(const render::Anchor& anchor) {
    return anchor.kind == render::Anchor::Kind::contact || anchor.kind == render::Anchor::Kind::cam;
}

void check_camera(ObjectReader& r, const View& view) {
    for (const char* key : {"yaw", "pitch", "swing"})
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

void check_view(ObjectReader& r, const View& view) {
    if (r.has("exposures") && view.poses() == 1)
        r.warn("exposures", " has no effect without a \"shutter\" or \"strobe\"");
}

// A longer logo would be a hairline at the height of the clock.
static constexpr int kWidestLogo = 10, kTallestLogo = 5;

static void read_logo(ObjectReader& r, Picture& picture) {
    if (!r.has("logo") || r.diagnostics().failed(r.path("logo"))) return;
    if (picture.logo.empty()) return r.reject("logo", " is empty; name a .png file, or remove the key");
    const auto path = std::filesystem::path(r.context().source.name).parent_path() / picture.logo;
    try {
        const output::Raster raster = output::read_png(path);
        if (raster.width > kWidestLogo * raster.height || raster.height > kTallestLogo * raster.width)
            return r.reject_value(
                r.place("logo"), "logo",
                " has {} × {} pixels; a logo is at most {} times as wide as high and {} times as high as wide",
                raster.width, raster.height, kWidestLogo, kTallestLogo);
        picture.logo_digest = output::digest(raster);
        picture.logo_image = std::make_shared<const render::Image>(output::to_image(raster));
    } catch (const output::IoError& error) {
        r.reject_value(r.place("logo"), "logo", ": {}", error.what());
    }
}

void check_picture(ObjectReader& r, Picture& picture) {
    read_logo(r, picture);
    if (const double memory = memory_of(picture); memory >= kMuchMemory)
        r.diagnostics().warning(r.node()->place,
                                fmt::format("{} of {} × {} pixels needs about {:.2g} GB of memory for each thread",
                                            r.object_name(), picture.size.width, picture.size.height, memory / 1e9));
    if (const auto paper = picture.view.paper) {
        const render::Color ink =
            picture.view.colors.ink ? render::rgb(*picture.view.colors.ink) : render::palette(picture.view.theme).ink;
        if (render::contrast(ink, render::rgb(*paper)) < 3)
            r.warn("background", " makes the text hardly readable; choose another \"theme\"");
    }
    if (picture.comparison == render::Comparison::ghosts && !r.has("compare"))
        r.diagnostics().warning(
            r.node()->place,
            fmt::format("{} = \"ghosts\" has no effect without \"compare\", or several scenes for `beamcam render`",
                        r.path("comparison")));
    check_layout(r, picture);
}

// ---- films -------------------------------------------------------------------------------------

std::string problem_with_span(const FrameSpan& span, double end_time) {
    const double to = span.to.value_or(end_time), fps = span.fps.value();
    if (span.from_event || span.to_event) return {};
    if (!span.real_time()) {
        if (to > span.from) return {};  // the number of frames depends on the motion
        return fmt::format("the film begins at {1:g} s and ends at {0:g} s; \"to\" must be later than \"from\"", to,
                           span.from);
    }
    const double first = std::round(span.from * fps), last = std::round(to * fps);
    if (!(last > first))
        return fmt::format("no frame lies between {:g} s and {:g} s at {:g} frames a second; {}", span.from, to, fps,
                           to > span.from ? "increase \"to\" or \"fps\"" : "\"to\" must be later than \"from\"");
    if (last - first > kMostFrames)
        return fmt::format(
            "{:.0f} frames are too many: an output has at most {:.0f}; use \"from\" and \"to\", or reduce \"fps\"",
            last - first, kMostFrames);
    return {};
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

void check_span(ObjectReader& r, const FrameSpan& span, const Picture& picture) {
    const Diagnostics& diagnostics = r.diagnostics();
    if (diagnostics.failed(r.path("from")) || diagnostics.failed(r.path("to")) || diagnostics.failed("time")) return;
    if (const std::string problem = problem_with_span(span, r.context().scene.end_time); !problem.empty())
        return r.reject_object("to", ": {}", problem);
    check_instants(r, span, picture.view, span.to.value_or(r.context().scene.end_time));
    const sim::Problem& shown = picture.compare.empty() ? r.context().scene.problem : picture.compare.front().problem;
    for (std::size_t i = 0; i < span.events.size() && !shown.cam; ++i)
        if (const auto& anchor = span.events[i].anchor; anchor && needs_cam(*anchor)) {
            const std::string key = fmt::format("events.{}.anchor", i);
            r.reject(key, ": the scene has no cam; anchor the text to the tip, the hub or a place");
        }
}

void set_default_codec(PictureOutput& video) {
    video.encoding.codec =
        output::default_codec(std::filesystem::path(video.file).extension().string()).value_or(output::Codec::h264);
}

namespace {

// Rules between codec, container and picture.
void check_format(ObjectReader& r, const PictureOutput& video) {
    const std::string ending = std::filesystem::path(video.file).extension().string();
    const output::Codec codec = video.encoding.codec;
    const auto reject = [&](const char* key, const std::string& problem) {
        if (!problem.empty()) r.reject(key, ": {}", problem);
    };
    if (const std::string problem = output::format_problem(ending, codec, video.view.transparent); !problem.empty())
        return r.fail(r.place(output::goes_into(codec, ending) ? "background" : "codec"), "codec",
                      fmt::format("{}: {}", r.object_name(), problem));
    reject("size", output::size_problem(codec, video.size.width, video.size.height));
    reject("fps", output::rate_problem(codec, video.span.fps.value()));
    if (r.has("preset") && codec != output::Codec::h264)
        reject("preset", fmt::format("only H.264 has presets, {} has none; remove the key", title(codec)));
    const auto quality = output::quality_scale(codec);
    if (r.has("crf") && !quality)
        reject("crf", fmt::format("{} has no crf; remove the key", title(codec)));
    else if (quality && video.encoding.crf.value_or(0) > quality->worst)
        r.reject("crf", " = {} is outside 0 … {}, the range of {}", *video.encoding.crf, quality->worst, title(codec));
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

// ---- tables, files -----------------------------------------------------------------------------

void limit_rows(ObjectReader& r, double rate, double rows_each) {
    constexpr double kMostRows = 20'000'000;  // 160 MB for each channel
    const double rows = rate * r.context().scene.end_time * rows_each;
    if (r.has("rate") && rows > kMostRows)
        r.reject_value(r.place("rate"), "rate", " gives {:.3g} rows, but a table has at most {:.3g}; reduce the rate",
                       rows, kMostRows);
}

namespace {

// Two outputs must not write one file.
void check_distinct_files(ObjectReader& r, const Node& list, const std::vector<Output>& outputs) {
    FileClaims claims;
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        if (file_of(outputs[i]).empty() || r.diagnostics().failed(fmt::format("outputs.{}", i))) continue;
        for (const std::string& file : written_by(outputs[i])) claims.add(file, i);
    }
    for (const auto& [later, earlier] : claims.clashes()) {
        const Node& object = list.items[later.owner];
        const Member* file = object.find("file");
        r.fail(file ? file->value : object, fmt::format("outputs.{}.file", later.owner),
               fmt::format("outputs.{} and outputs.{} would write the same file {}; give one of them another \"file\"",
                           later.owner, earlier.owner, in_quotes(later.file)));
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
    check_distinct_files(r, list->value, scene.outputs);
}

}  // namespace beamcam::scenes
