#include "scenes/format/keys.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <span>

#include "output/film/video_format.hpp"
#include "render/plot/style.hpp"
#include "scenes/figures/recipes.hpp"
#include "scenes/format/checks.hpp"
#include "scenes/format/forms.hpp"

namespace beamcam::scenes {

namespace dim = sim::dimension;
using sim::between, sim::kNotNegative, sim::kPositive, sim::Named, sim::Range, sim::required, sim::written_if;

namespace {

template <class Enum, std::size_t n>
void choice(SceneVisitor& v, const Key& key, Enum& value, const Named<Enum> (&among)[n], const char* meaning) {
    v.choice(key, value, std::span<const Named<Enum>>(among), meaning);
}

// A text that is one of these words.
void word(SceneVisitor& v, const Key& key, std::string& value, const std::vector<std::string>& words,
          const char* meaning) {
    auto chosen = static_cast<std::size_t>(std::ranges::find(words, value) - words.begin());
    if (chosen == words.size()) chosen = 0;
    v.word(key, words, chosen, meaning);
    value = words[chosen];
}

// ---- how pictures look -------------------------------------------------------------------------

}  // namespace

static void visit(SceneVisitor& v, render::Orbit& orbit) {
    // Further round, beam and cam hide each other.
    constexpr Range kVisible = between(-1.2, 1.2, "is outside −1.2 … 1.2 rad, from where the mechanism can be seen");
    v.number("yaw", orbit.yaw, dim::kAngle, kVisible, "Angle to the right of the plane of motion.");
    v.number("pitch", orbit.pitch, dim::kAngle, kVisible, "Angle above the horizontal.");
    v.number("swing", orbit.swing, dim::kAngle, kVisible,
             "Amplitude of the yaw: over a film the camera swings once to either side and back.");
}

static void visit(SceneVisitor& v, render::View& view) {
    using render::Style, render::TraceColor;
    choice(v, "style", view.style, {{Style::lit, "lit"}, {Style::flat, "flat"}, {Style::solid, "solid"}},
           "lit: shaded metal from the front, by OpenGL; flat: a clean drawing; solid: bodies in perspective with "
           "shadows, by OpenGL.");
    choice(v, "trace", view.trace, {{TraceColor::force, "force"}, {TraceColor::age, "age"}},
           "What colours the trace of the contact on the disc: the largest force, or the time since the last touch.");
    choice(v, "tip_path", view.tip_path, {{false, "recent"}, {true, "whole"}},
           "recent: the tip's path over the last frames of a film; whole: all of it since the film's first instant, "
           "in a still since the motion's start.");
    v.object(written_if(view.style == Style::solid, "camera"), view.orbit, "Camera of the solid view.");
    v.check([&view](ObjectReader& r) { warn_of_unused_camera(r, view); });
    v.number(written_if(view.exaggeration.has_value(), "exaggeration"), view.exaggeration, sim::kPlainNumber,
             between(1, 1e6, "is outside 1 (true shape) … 1e6"),
             "Factor on the deflection, stated on the picture; 1 is the true shape. auto picks a round one by the "
             "motion over the time that a film shows (whatever its frame rate), that a scene lasts (stills at impacts) "
             "or that leads to a still of an instant.",
             "auto");
}

static void visit_picture(SceneVisitor& v, Picture& picture) {
    using render::Theme, render::Comparison;
    v.object("view", picture.view, "How the mechanism is seen.");
    choice(v, "theme", picture.view.theme, {{Theme::light, "light"}, {Theme::dark, "dark"}, {Theme::print, "print"}},
           "Colours.");
    choice(v, "background", picture.view.transparent, {{false, "paper"}, {true, "transparent"}},
           "transparent: no paper behind the picture, where the format can.");
    v.form("size", size_form(picture.size), "Width and height in pixels; even for H.264, VP9 and AV1.");
    v.either(
        "layout", layout_form(picture.layout),
        [&picture](sim::Visitor& inside) {
            if (!picture.layout) picture.layout.emplace();
            visit(static_cast<SceneVisitor&>(inside), *picture.layout);
        },
        "auto, a panel, or a grid: {\"columns\": [{\"panel\": \"mechanism\", \"share\": 2}, {\"rows\": [\"theta\", "
        "\"contact_force\", \"close-up\"]}]}.");
    choice(v, written_if(!picture.compare.empty(), "comparison"), picture.comparison,
           {{Comparison::panels, "panels"}, {Comparison::ghosts, "ghosts"}},
           "panels: each motion in a mechanism of its own; ghosts: all in one, those after the first as outlines.");
    List compare = SceneVisitor::items_of(picture.compare);
    compare.least = 2, compare.most = kMostCompared, compare.of = "motions";
    compare.example = "[{\"label\": \"flexible\"}, {\"label\": \"rigid\", \"set\": {\"beam.model\": \"rigid\"}}]";
    v.list("compare", compare,
           "The motions that the picture shows, aligned in time: this scene's mechanics, or another scene's, with "
           "changes. The first is the main one.");
    v.check([&picture](ObjectReader& r) { judge_picture(r, picture); });
}

// ---- how time runs in films --------------------------------------------------------------------

static void visit(SceneVisitor& v, Speed& speed) {
    if (!speed.around) speed.around.emplace();
    SlowMotion& slow = *speed.around;
    const auto fields = [&](sim::Visitor& inside) {
        inside.number("factor", slow.factor, dim::kNone, kSpeedRange, "Speed there.");
        inside.number("otherwise", speed.factor, dim::kNone, kSpeedRange, "Speed elsewhere.");
        inside.number("before", slow.before, dim::kTime, kNotNegative, "Slow from so long before the first touch.");
        inside.number("after", slow.after, dim::kTime, kNotNegative, "Slow until so long after the release.");
        inside.number("ease", slow.ease, dim::kTime, kNotNegative,
                      "Time of the motion in which one speed becomes the other.");
    };
    v.alternatives({{{{"around", "impacts"}}, "Slow motion around impacts.", true, fields}});
}

static void visit(SceneVisitor& v, FilmEvent& event) {
    v.form(required("at", "\"impact:1\""), instant_form(event.at), "When.");
    v.number("freeze", event.freeze, dim::kTime, kNotNegative,
             "The picture stands still for so long, in the film's time.");
    v.text("text", event.text, "Words beside the contact.");
    v.number("show", event.show, dim::kTime, kNotNegative,
             "How long the words are shown, in the film's time; at least as long as the picture stands still.");
}

static void visit_span(SceneVisitor& v, FrameSpan& span) {
    v.form("fps", frame_rate_form(span.fps),
           "Frames a second, 0.1 to 1000, or a fraction such as \"30000/1001\"; 29.97 means that one.");
    v.number("from", span.from, dim::kTime, kFromStart, "First instant.");
    v.number("to", span.to, dim::kTime, kFromStart, "Last instant; the end of the scene when left out.");
    v.either(
        "speed", speed_form(span.speed),
        [&span](sim::Visitor& inside) { visit(static_cast<SceneVisitor&>(inside), span.speed); },
        "How fast time runs: a factor, 1 is real time; \"impacts\": slow motion around them, or an object that says "
        "how "
        "slow.");
    v.list("events", SceneVisitor::items_of(span.events),
           "What the film does at instants: it stands still, or says something at the contact.");
}

// ---- outputs -----------------------------------------------------------------------------------

static void visit(SceneVisitor& v, VideoOutput& video) {
    using output::Codec;
    static const std::vector<Named<Codec>> kCodecs = [] {
        std::vector<Named<Codec>> all;
        for (const Codec codec :
             {Codec::h264, Codec::vp9, Codec::av1, Codec::prores, Codec::ffv1, Codec::gif, Codec::apng, Codec::webp})
            all.push_back({codec, output::name(codec)});
        return all;
    }();
    Encoding& encoding = video.encoding;
    v.form("file", file_form(video.file, {".mp4", ".webm", ".mov", ".mkv", ".gif", ".apng", ".webp"}),
           "Name of the film; the scene's name with .mp4 when left out.");
    v.check([&video](ObjectReader& r) { take_usual_codec(r, video); });
    visit_picture(v, video);
    visit_span(v, video.span);
    v.form(
        "poster", instant_form(video.span.poster),
        "The frame at this instant, or the first after it, is also put beside the film as a picture: fall.png beside "
        "fall.mp4. A time outside the film stands for its nearest frame.");
    v.choice(sim::derived("codec"), encoding.codec, std::span<const Named<Codec>>(kCodecs),
             "Codec; by the ending when left out: .mp4 h264 (or av1), .webm vp9 (av1), .mov prores (h264), .mkv ffv1 "
             "(h264, vp9, av1).");
    v.whole("crf", encoding.crf, 0, 63,
            "Quality of h264 (to 51), vp9 and av1: 0 is best; 18, 24 and 26 look lossless and are the defaults.");
    word(v, written_if(encoding.codec == Codec::h264, "preset"), encoding.preset,
         {"ultrafast", "superfast", "veryfast", "faster", "fast", "medium", "slow", "slower", "veryslow"},
         "x264's trade of time for size; of h264 alone.");
    choice(v, written_if(encoding.variable_rate, "rate_mode"), encoding.variable_rate,
           {{false, "constant"}, {true, "variable"}},
           "variable: a picture that does not change is coded once and lasts longer, up to 5 s; players show the same, "
           "some editors want a constant rate. Parts (--shard, --frames) are constant.");
    v.check([&video](ObjectReader& r) { judge_video(r, video); });
}

static void visit(SceneVisitor& v, FramesOutput& frames) {
    v.form("file", numbered_file_form(frames.file),
           "Name of the files with #### for the frame number; the scene's name with -####.png when left out.");
    visit_picture(v, frames);
    visit_span(v, frames.span);
    v.check([&frames](ObjectReader& r) {
        name_after_scene(r, frames.file, "-####.png");
        judge_span(r, frames.span);
    });
}

static void visit(SceneVisitor& v, StillOutput& still) {
    v.form("file", file_form(still.file, {".png"}), "Name of the file; the scene's name with .png when left out.");
    visit_picture(v, still);
    v.form(required("at", "\"370 ms\""), instant_form(still.at), "The instant that it shows.");
    v.check([&still](ObjectReader& r) { name_after_scene(r, still.file, ".png"); });
}

static void visit(SceneVisitor& v, FigureOutput& figure) {
    static const std::vector<std::string> kFigures = [] {
        std::vector<std::string> all;
        for (const Recipe& recipe : recipes()) all.emplace_back(recipe.name);
        return all;
    }();
    v.form("file", file_form(figure.file, {".pdf", ".svg", ".png"}),
           "Name of the file; the figure's name with .pdf when left out.");
    word(v, required("figure", "\"free-fall\""), figure.figure, kFigures, "Its name.");
    word(v, "column", figure.column, render::figure::column_names(),
         "The journal's column that it fits: width and size of letters.");
    v.number("dpi", figure.dpi, sim::kPlainNumber, between(50, 2400), "Dots per inch of a .png.");
    choice(v, "lang", figure.lang, {{Lang::en, "en"}, {Lang::zh, "zh"}}, "Language of labels and caption.");
    v.number("width", figure.width, dim::kLength,
             between(0.03, 1, "is outside 30 … 1000 mm; a plain number is in metres, \"90 mm\" says its unit"),
             "Another width than the column's.");
    v.check([&figure](ObjectReader& r) { judge_figure(r, figure); });
}

static void visit(SceneVisitor& v, TrajectoryOutput& table) {
    v.form("file", file_form(table.file, {".csv", ".npz"}),
           "Name of the file; the scene's name with .csv when left out.");
    v.form("channels", channels_form(table.channels),
           "Columns in this order; the time always comes first. All when left out.");
    v.number(written_if(table.times.empty(), "rate"), table.rate, dim::kFrequency, kPositive,
             "Rows at k/rate, and at the end.");
    v.numbers("times", table.times, dim::kTime, kFromStart, {1}, "Exactly these rows, in this order.");
    v.exclude("rate", "times");
    v.check([&table](ObjectReader& r) { judge_table(r, table); });
}

static void visit(SceneVisitor& v, ImpactsOutput& impacts) {
    v.form("file", file_form(impacts.file, {".json", ".csv"}),
           "Name of the file; the scene's name with -impacts.json when left out.");
    v.check([&impacts](ObjectReader& r) { name_after_scene(r, impacts.file, "-impacts.json"); });
}

static void visit(SceneVisitor& v, SummaryOutput& summary) {
    v.form("file", file_form(summary.file, {".json"}),
           "Name of the file; the scene's name with -summary.json when left out.");
    v.truth("horizon", summary.horizon,
            "State during which intervals the motion is reproducible; costs a second run, by another method.");
    v.check([&summary](ObjectReader& r) { name_after_scene(r, summary.file, "-summary.json"); });
}

template <class Type>
static sim::Alternative output_of(Output& output, const char* type, const char* meaning) {
    return {{{"type", type}}, meaning, std::holds_alternative<Type>(output), [&output](sim::Visitor& v) {
                if (!std::holds_alternative<Type>(output)) output.emplace<Type>();
                visit(static_cast<SceneVisitor&>(v), std::get<Type>(output));
            }};
}

void visit(SceneVisitor& v, Output& output) {
    v.alternatives({output_of<VideoOutput>(output, "video", "A film; the ending of its name decides the format."),
                    output_of<FramesOutput>(output, "frames", "A sequence of PNG files."),
                    output_of<StillOutput>(output, "still", "One picture."),
                    output_of<FigureOutput>(output, "figure",
                                            "A figure for print: one of those that `beamcam figure SCENE` lists."),
                    output_of<TrajectoryOutput>(output, "trajectory", "A table of channels against time."),
                    output_of<ImpactsOutput>(output, "impacts", "All impacts and collisions."),
                    output_of<SummaryOutput>(output, "summary", "Counts, extremes, energy balance, warnings.")});
}

void visit_outputs(SceneVisitor& v, Scene& scene) {
    v.list("outputs", SceneVisitor::items_of(scene.outputs),
           "The files that `beamcam run` makes. None: one film named after the scene.");
    v.check([&scene](ObjectReader& r) { judge_outputs(r, scene); });
}

// ---- the scene ---------------------------------------------------------------------------------

void visit(SceneVisitor& v, Scene& scene) {
    std::string schema;
    v.text(written_if(false, "$schema"), schema, "Where an editor finds the schema.");
    v.text(written_if(!scene.title.empty(), "title"), scene.title, "Shown on pictures.");
    v.problem(scene.problem);
    // A step of a millisecond is 16 digits less than the latest end.
    const auto time = [&scene](sim::Visitor& inside) {
        inside.number("end", scene.end_time, dim::kTime,
                      {0, 1e12, true, false, "must be positive and at most 1e12 s; write how many seconds to simulate"},
                      "Time to simulate, from 0.");
    };
    v.object("time", time, "How long.", nullptr);
    v.check([&scene](ObjectReader& r) { judge_physics(r, scene.problem); });
    visit_outputs(v, scene);
}

}  // namespace beamcam::scenes
