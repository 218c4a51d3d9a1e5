// Outputs "video", "frames" and "still": pictures of the mechanism and its charts.
#include <numbers>

#include "output/film/video_format.hpp"
#include "scenes/format/checks.hpp"
#include "scenes/format/value_formats.hpp"
#include "scenes/plan/picture_times.hpp"
#include "scenes/plan/planner.hpp"

namespace beamcam::scenes {

namespace dim = sim::dimension;
using sim::between, sim::kNotNegative, sim::kPositive, sim::Named, sim::Range, sim::required, sim::written_if;

// ---- how pictures look -------------------------------------------------------------------------

// Further round, beam and cam hide each other.
static constexpr Range kVisible = between(-1.2, 1.2, "is outside −1.2 … 1.2 rad, from where the mechanism can be seen");
static constexpr Range kZooms = between(0.1, 100, "is outside 0.1 … 100; 1 shows all");

static void visit(SceneVisitor& v, Keyframe& key) {
    using render::Ease;
    v.value(required("at", "\"impact:1\""), instant_format(key.at), "The instant at which the camera has arrived.");
    v.number("zoom", key.zoom, dim::kNone, kZooms, "Magnification; as before when left out, like all of these.");
    v.value("follow", anchor_format(key.follow), "What stands in the middle.");
    v.number("yaw", key.yaw, dim::kAngle, kVisible, "Of the solid view.");
    v.number("pitch", key.pitch, dim::kAngle, kVisible, "Of the solid view.");
    v.number("over", key.over, dim::kTime, kNotNegative,
             "The camera moves for so long, in the film's time; since the keyframe before when left out. 0 is a cut.");
    v.choice("ease", key.ease,
             {{Ease::smooth, "smooth"}, {Ease::linear, "linear"}, {Ease::in, "in"}, {Ease::out, "out"}},
             "smooth: it starts and stops gently; in: it starts so; out: it stops so.");
}

static void visit_camera(SceneVisitor& v, View& view) {
    v.number("zoom", view.shot.zoom, dim::kNone, kZooms, "Magnification of the mechanism; 1 shows all of its motion.");
    v.value(
        "follow", anchor_format(view.shot.follow),
        "What stands in the middle: all that the film shows, the tip, the contact (where beam and cam are nearest), "
        "the cam's axis, the hub's, or a place [x, y]. What vibrates is followed by its mean over a third of a second "
        "of the film.");
    v.number("yaw", view.shot.yaw, dim::kAngle, kVisible,
             "Of the solid view: angle to the right of the plane of motion.");
    v.number("pitch", view.shot.pitch, dim::kAngle, kVisible, "Of the solid view: angle above the horizontal.");
    v.number("swing", view.swing, dim::kAngle, kVisible,
             "Of the solid view: amplitude of the yaw; over a film the camera swings once to either side and back.");
    v.list("keyframes", SceneVisitor::items_of(view.keyframes),
           "Where the camera moves to, in a film; a still shows where it is then.");
    v.check([&view](ObjectReader& r) { check_camera(r, view); });
}

static void visit(SceneVisitor& v, View& view) {
    using render::Style, render::TraceColor;
    v.choice("style", view.style, {{Style::lit, "lit"}, {Style::flat, "flat"}, {Style::solid, "solid"}},
             "lit: shaded metal from the front, by OpenGL; flat: a clean drawing; solid: bodies in perspective with "
             "shadows, by OpenGL.");
    v.choice("trace", view.trace, {{TraceColor::force, "force"}, {TraceColor::age, "age"}},
             "What colours the trace of the contact on the disc: the largest force, or the time since the last touch.");
    v.choice("tip_path", view.tip_path, {{false, "recent"}, {true, "whole"}},
             "recent: the tip's path over the last frames of a film; whole: all of it since the film's first instant, "
             "in a still since the motion's start.");
    const bool moved = !(view.shot == render::Shot{}) || !view.keyframes.empty();
    v.object(
        written_if(moved || view.style == Style::solid, "camera"),
        [&view](sim::Visitor& inside) { visit_camera(static_cast<SceneVisitor&>(inside), view); },
        "Where the mechanism is seen from.", nullptr);
    v.number(
        "shutter", view.shutter, dim::kAngle,
        {0, 2 * std::numbers::pi + 1e-9, true, false, "is no angle up to 360 deg"},
        "Motion blur: the shutter is open for this angle of a turn, which is the time from frame to frame; 180 deg is "
        "a camera's.");
    v.number("strobe", view.strobe_every, dim::kTime, kPositive,
             "Multiple exposure: the beam is also seen where it was at the multiples of this time of the motion; cam "
             "and hub "
             "stand as they are at the frame's own instant.");
    v.exclusive("shutter", "strobe");
    v.integer(written_if(view.poses() > 1, "exposures"), view.exposures, 2, 64,
              "How many exact instants the shutter sees, or how many of the latest flashes are shown.");
    v.check([&view](ObjectReader& r) { check_view(r, view); });
    v.number(written_if(view.exaggeration.has_value(), "exaggeration"), view.exaggeration, sim::kPlainNumber,
             between(1, 1e6, "is outside 1 (true shape) … 1e6"),
             "Factor on the deflection, stated on the picture; 1 is the true shape. auto picks a round one by the "
             "motion over the time that a film shows (whatever its frame rate), that a scene lasts (stills at impacts) "
             "or that leads to a still of an instant.",
             "auto");
}

static void visit(SceneVisitor& v, render::Shown& show) {
    v.boolean("title", show.title, "The scene's title.");
    v.boolean("parameters", show.parameters, "The line below the title.");
    v.boolean("clock", show.clock, "The time.");
    v.boolean("legend", show.legend, "Colour scales, and how far deflection is exaggerated and time slowed down.");
    v.boolean("accuracy", show.accuracy, "Tolerance and closure of the energy balance, in the corner.");
    v.boolean("labels", show.labels, "Names, numbers and scale bar within the mechanism.");
}

static void visit(SceneVisitor& v, render::OwnColors& colors) {
    v.value("ink", color_format(colors.ink), "Of words and axes.");
    v.value("motion", color_format(colors.motion), "Of the beam's bending, of curves of motion.");
    v.value("contact", color_format(colors.contact), "Of forces and impacts.");
    v.value("steel", color_format(colors.steel), "Of the bodies.");
}

static void visit_picture(SceneVisitor& v, Picture& picture) {
    using render::Theme, render::Comparison, render::LayerOf;
    v.object("view", picture.view, "How the mechanism is seen.");
    v.choice("theme", picture.view.theme, {{Theme::light, "light"}, {Theme::dark, "dark"}, {Theme::print, "print"}},
             "Colours.");
    v.value(
        "background", background_format(picture.view),
        "paper: the theme's; \"#rrggbb\": this colour; transparent: none behind the picture, where the format can.");
    v.value_or_object(
        "show", show_format(picture.view.show),
        [&picture](sim::Visitor& inside) { visit(static_cast<SceneVisitor&>(inside), picture.view.show); },
        "What stands around the panels: all, a preset (talk: no parameters, no accuracy; paper: labels, legend and "
        "clock, "
        "since the caption tells the rest; clean: nothing), or an object that leaves parts out. Without the legend the "
        "picture does not say by how much it exaggerates deflection.");
    v.object(
        written_if(picture.view.colors != render::OwnColors{}, "palette"),
        [&picture](sim::Visitor& inside) { visit(static_cast<SceneVisitor&>(inside), picture.view.colors); },
        "Colours in place of the theme's.", nullptr);
    v.text(
        written_if(!picture.logo.empty(), "logo"), picture.logo,
        "A PNG picture, from the scene's folder, in the lower right corner: at the clock's height, right of the colour "
        "scales or, where these stand below the clock, above them.");
    v.choice(written_if(picture.view.layer != LayerOf::all, "layer"), picture.view.layer,
             {{LayerOf::all, "all"}, {LayerOf::mechanism, "mechanism"}, {LayerOf::charts, "charts"}},
             "What is drawn of the picture, at its place: the mechanism alone, or all but it; with a transparent "
             "background the two lie over each other as if they were one.");
    v.choice(written_if(picture.view.lang != Lang::en, "lang"), picture.view.lang, {{Lang::en, "en"}, {Lang::zh, "zh"}},
             "Language of the picture's own words, of subtitles and of chapters.");
    v.number(written_if(picture.view.show.size != 1, "text_scale"), picture.view.show.size, sim::kPlainNumber,
             between(0.5, 4, "is outside 0.5 … 4"),
             "Size of words, lines and marks; at 1 the numbers of axes are 2 % of the height of a 16:9 picture.");
    v.value("size", size_format(picture.size), "Width and height in pixels; even for H.264, VP9 and AV1.");
    v.value_or_object(
        "layout", layout_format(picture.layout),
        [&picture](sim::Visitor& inside) {
            if (!picture.layout) picture.layout.emplace();
            visit(static_cast<SceneVisitor&>(inside), *picture.layout);
        },
        "auto, a panel, or a grid: {\"columns\": [{\"panel\": \"mechanism\", \"share\": 2}, {\"rows\": [\"theta\", "
        "\"contact_force\", \"close-up\"]}]}.");
    v.choice(written_if(!picture.compare.empty(), "comparison"), picture.comparison,
             {{Comparison::panels, "panels"}, {Comparison::ghosts, "ghosts"}},
             "panels: each motion in a mechanism of its own; ghosts: all in one, those after the first as outlines.");
    List compare = SceneVisitor::items_of(picture.compare);
    compare.least = 2, compare.most = kMostCompared, compare.of = "motions";
    compare.example = "[{\"label\": \"flexible\"}, {\"label\": \"rigid\", \"set\": {\"beam.model\": \"rigid\"}}]";
    v.list("compare", compare,
           "The motions that the picture shows, aligned in time: this scene's mechanics, or another scene's, with "
           "changes. The first is the main one.");
    v.boolean(written_if(picture.horizon, "horizon"), picture.horizon,
              "Curves against time are paler during the intervals in which θ is not reproducible; costs further runs, "
              "tighter and by another method.");
    v.check([&picture](ObjectReader& r) { check_picture(r, picture); });
}

// ---- how time runs in films --------------------------------------------------------------------

static void visit(SceneVisitor& v, SpeedInterval& interval) {
    v.value(required("from", "\"impact:1\""), instant_format(interval.from), "Its first instant.");
    v.value(required("to", "\"0.4 s\""), instant_format(interval.to), "Its last.");
    v.number("factor", interval.factor, dim::kNone, kSpeedRange, "Speed there.");
    v.check([&interval](ObjectReader& r) {
        const bool times = interval.from.kind == Instant::Kind::time && interval.to.kind == Instant::Kind::time;
        if (times && !(interval.from.t < interval.to.t))
            r.fail(r.place("to"), "to", fmt::format("{} must be after \"from\"", r.path("to")));
    });
}

static void visit(SceneVisitor& v, Speed& speed) {
    const bool by_intervals = !speed.intervals.empty();
    const auto intervals = [&](sim::Visitor& inside) {
        speed.around.reset();
        static_cast<SceneVisitor&>(inside).list("intervals", SceneVisitor::items_of(speed.intervals),
                                                "Which, in their order; they do not overlap.");
        inside.number("otherwise", speed.factor, dim::kNone, kSpeedRange, "Speed elsewhere.");
        inside.number(
            "ease", speed.ease, dim::kTime, kNotNegative,
            "Time of the motion in which one speed becomes the other, at most half of what lies between two.");
    };
    const auto fields = [&](sim::Visitor& inside) {
        if (!speed.around) speed.around.emplace();
        SlowMotion& slow = *speed.around;
        inside.number("factor", slow.factor, dim::kNone, kSpeedRange, "Speed there.");
        inside.number("otherwise", speed.factor, dim::kNone, kSpeedRange, "Speed elsewhere.");
        inside.number("before", slow.before, dim::kTime, kNotNegative, "Slow from so long before the first touch.");
        inside.number("after", slow.after, dim::kTime, kNotNegative, "Slow until so long after the release.");
        inside.number("ease", slow.ease, dim::kTime, kNotNegative,
                      "Time of the motion in which one speed becomes the other.");
        inside.numbers("collisions", slow.collisions, sim::kPlainNumber, between(1, 1e6), {},
                       "Around the impacts of these collisions alone, counted from 1; all when left out.");
    };
    v.alternatives({{{{"around", "impacts"}}, "Slow motion around impacts.", !by_intervals, fields},
                    {{{"around", "intervals"}}, "Speeds of intervals of time.", by_intervals, intervals}});
    v.check([&speed](ObjectReader& r) { check_speed(r, speed); });
}

static void visit(SceneVisitor& v, FilmEvent& event) {
    v.value(required("at", "\"impact:1\""), instant_format(event.at), "When.");
    v.number("freeze", event.freeze, dim::kTime, kNotNegative,
             "The picture stands still for so long, in the film's time.");
    v.text("text", event.text, "Words beside the contact; mathematics as in the title.");
    v.value(
        "anchor", anchor_format(event.anchor),
        "What the words stand beside, with a line to it, in place of the contact; all: they stand at the lower edge.");
    v.number(written_if(event.fade > 0, "fade"), event.fade, dim::kTime, kNotNegative,
             "The words come and go in so long, in the film's time.");
    v.check([&event](ObjectReader& r) { check_words(r, "text", event.text); });
    v.number(
        "show", event.show, dim::kTime, kNotNegative,
        "How long the words are shown, in the film's time; at least as long as the picture stands still. When left "
        "out, 1.5 s or until the next words come.");
}

static void visit_span(SceneVisitor& v, FrameSpan& span) {
    v.value("fps", frame_rate_format(span.fps),
            "Frames a second, 0.1 to 1000, or a fraction such as \"30000/1001\"; 29.97 means that one.");
    v.value("from", bound_format(span.from, span.from_event), "First instant.");
    v.value("to", bound_format(span.to, span.to_event), "Last instant; the end of the scene when left out.");
    v.value_or_object(
        written_if(!span.duration, "speed"), speed_format(span.speed),
        [&span](sim::Visitor& inside) { visit(static_cast<SceneVisitor&>(inside), span.speed); },
        "How fast time runs: a factor, 1 is real time; \"impacts\": slow motion around them, or an object that says "
        "how "
        "slow.");
    v.number("duration", span.duration, dim::kTime, kPositive,
             "How long the film is to last, freezes and all, in place of \"speed\".");
    v.exclusive("speed", "duration");
    v.number(written_if(span.hold > 0, "hold"), span.hold, dim::kTime, kNotNegative,
             "The last picture stands still for so long, in the film's time.");
    v.list("events", SceneVisitor::items_of(span.events),
           "What the film does at instants: it stands still, or says something at the contact.");
}

// ---- the outputs -------------------------------------------------------------------------------

void VideoOutput::visit(SceneVisitor& v) {
    using output::Codec;
    static const std::vector<Named<Codec>> kCodecs = [] {
        std::vector<Named<Codec>> all;
        for (const Codec codec : {Codec::h264, Codec::hevc, Codec::vp9, Codec::av1, Codec::prores, Codec::ffv1,
                                  Codec::gif, Codec::apng, Codec::webp})
            all.push_back({codec, output::name(codec)});
        return all;
    }();
    v.value("file", file_format(file, {".mp4", ".webm", ".mov", ".mkv", ".gif", ".apng", ".webp"}),
            "Name of the film; the scene's name with .mp4 when left out.");
    v.check([this](ObjectReader& r) { take_usual_codec(r, *this); });
    visit_picture(v, *this);
    visit_span(v, span);
    v.value(
        "poster", instant_format(span.poster),
        "The frame at this instant, or the first after it, is also put beside the film as a picture: fall.png beside "
        "fall.mp4. A time outside the film stands for its nearest frame.");
    v.choice(written_if(subtitles != Subtitles::none, "subtitles"), subtitles,
             {{Subtitles::none, "none"}, {Subtitles::vtt, "vtt"}, {Subtitles::srt, "srt"}},
             "A file beside the film that tells of its impacts and captions: fall.vtt beside fall.mp4.");
    v.boolean(written_if(chapters, "chapters"), chapters, "Chapters at the impacts, in .mp4, .mov and .mkv.");
    v.choice(
        sim::derived("codec"), encoding.codec, std::span<const Named<Codec>>(kCodecs),
        "Codec; by the ending when left out: .mp4 h264 (or av1, hevc), .webm vp9 (av1), .mov prores (h264, hevc), .mkv "
        "ffv1 "
        "(h264, vp9, av1).");
    v.integer("crf", encoding.crf, 0, 63,
              "Quality of h264 and hevc (to 51), vp9 and av1: 0 is best; 18, 20, 24 and 26 look lossless and are the "
              "defaults.");
    v.choice(written_if(encoding.codec == Codec::h264, "preset"), encoding.preset,
             {"ultrafast", "superfast", "veryfast", "faster", "fast", "medium", "slow", "slower", "veryslow"},
             "x264's trade of time for size; of h264 alone.");
    v.choice(
        written_if(encoding.variable_rate, "rate_mode"), encoding.variable_rate,
        {{false, "constant"}, {true, "variable"}},
        "variable: a picture that does not change is coded once and lasts longer, up to 5 s; players show the same, "
        "some editors want a constant rate. Parts (--shard, --frames) are constant.");
    v.check([this](ObjectReader& r) { check_video(r, *this); });
}

void FramesOutput::visit(SceneVisitor& v) {
    v.value("file", numbered_file_format(file),
            "Name of the files with #### for the frame number; the scene's name with -####.png when left out.");
    visit_picture(v, *this);
    visit_span(v, span);
    v.check([this](ObjectReader& r) {
        name_after_scene(r, file, "-####.png");
        check_span(r, span, *this);
    });
}

void StillOutput::visit(SceneVisitor& v) {
    v.value(
        "file", file_format(file, {".png"}),
        "Name of the file; the scene's name with .png when left out. In lines, for print, it is the figure \"strobe\" "
        "with \"at\".");
    visit_picture(v, *this);
    v.value(required("at", "\"370 ms\""), instant_format(at), "The instant that it shows.");
    v.check([this](ObjectReader& r) { name_after_scene(r, file, ".png"); });
}

void PageOutput::visit(SceneVisitor& v) {
    using render::Theme;
    v.value("file", file_format(file, {".html"}), "Name of the page; the scene's name with .html when left out.");
    v.choice("theme", view.theme, {{Theme::light, "light"}, {Theme::dark, "dark"}, {Theme::print, "print"}},
             "Colours.");
    v.number(written_if(view.exaggeration.has_value(), "exaggeration"), view.exaggeration, sim::kPlainNumber,
             between(1, 1e6, "is outside 1 (true shape) … 1e6"), "Factor on the deflection, as in films.", "auto");
    v.value(
        "fps", frame_rate_format(span.fps),
        "Poses a second that are looked at, at least a thousand in all; those that the page finds by interpolation are "
        "left out of it.");
    v.value("from", bound_format(span.from, span.from_event), "First instant.");
    v.value("to", bound_format(span.to, span.to_event), "Last instant; the end of the scene when left out.");
    v.check([this](ObjectReader& r) {
        name_after_scene(r, file, ".html");
        check_span(r, span, *this);
    });
}

void ModelOutput::visit(SceneVisitor& v) {
    v.value("file", file_format(file, {".glb"}), "Name of the model; the scene's name with .glb when left out.");
    v.number(written_if(view.exaggeration.has_value(), "exaggeration"), view.exaggeration, sim::kPlainNumber,
             between(1, 1e6, "is outside 1 (true shape) … 1e6"), "Factor on the deflection, as in films.", "auto");
    v.value("fps", frame_rate_format(span.fps), "Poses a second, between which players interpolate.");
    v.value("from", bound_format(span.from, span.from_event), "First instant.");
    v.value("to", bound_format(span.to, span.to_event), "Last instant; the end of the scene when left out.");
    v.check([this](ObjectReader& r) {
        name_after_scene(r, file, ".glb");
        check_span(r, span, *this);
    });
}

namespace {

template <class Output>
Pictures pictures(Pictures::Kind kind, const Output& output, std::size_t index) {
    Pictures p;
    p.kind = kind;
    p.output = index;
    p.file = output.file;
    p.picture = output;
    return p;
}

}  // namespace

void VideoOutput::plan(Planner& planner, std::size_t output) const {
    Pictures p = pictures(Pictures::Kind::video, *this, output);
    p.span = span;
    p.encoding = encoding;
    if (span.poster) p.poster_file = poster_file(*this);
    p.subtitles = subtitles, p.chapters = chapters;
    p.subtitles_file = subtitles_file(*this);
    planner.add(std::move(p), span.to.value_or(planner.scene().end_time));
}

void FramesOutput::plan(Planner& planner, std::size_t output) const {
    Pictures p = pictures(Pictures::Kind::frames, *this, output);
    p.span = span;
    planner.add(std::move(p), span.to.value_or(planner.scene().end_time));
}

void PageOutput::plan(Planner& planner, std::size_t output) const {
    Pictures p = pictures(Pictures::Kind::page, *this, output);
    p.picture.view = view;
    p.picture.view.style = render::Style::flat;
    p.span = span;
    const double end = span.to.value_or(planner.scene().end_time);
    p.span.fps = rate_of_page(span.fps, span.from, end);
    planner.add(std::move(p), end);
}

void ModelOutput::plan(Planner& planner, std::size_t output) const {
    Pictures p = pictures(Pictures::Kind::model, *this, output);
    p.picture.view.style = render::Style::flat;
    p.span = span;
    planner.add(std::move(p), span.to.value_or(planner.scene().end_time));
}

void StillOutput::plan(Planner& planner, std::size_t output) const {
    Pictures p = pictures(Pictures::Kind::still, *this, output);
    p.at = at;
    if (at.kind == Instant::Kind::last) p.at = {.kind = Instant::Kind::time, .t = planner.scene().end_time};
    planner.add(std::move(p), p.at.is_event() ? planner.scene().end_time : p.at.t);
}

}  // namespace beamcam::scenes
