// Outputs "video", "frames", "still" and "page": pictures of the mechanism and its charts.

#include "output/film/video_format.hpp"
#include "scenes/format/checks.hpp"
#include "scenes/format/value_formats.hpp"
#include "scenes/plan/planner.hpp"
#include "scenes/scene/files.hpp"

namespace beamcam::scenes {

namespace dim = sim::dimension;
using sim::between, sim::kNotNegative, sim::kPositive, sim::Range, sim::required, sim::written_if;

// ---- how pictures look -------------------------------------------------------------------------

// At larger angles beam and cam hide each other.
static constexpr Range kVisible =
    between(-1.2, 1.2, "is outside −1.2 … 1.2 rad, the range from which the mechanism is visible");
static constexpr Range kZooms = between(0.1, 100, "is outside 0.1 … 100; 1 shows everything");

static void visit(SceneVisitor& v, Keyframe& key) {
    using render::Ease;
    v.value(required("at", "\"impact:1\""), instant_format(key.at), "The instant at which the camera arrives.");
    v.number("zoom", key.zoom, dim::kNone, kZooms, "Magnification; by default unchanged, like the next three keys.");
    v.value("follow", anchor_format(key.follow), "The point at the centre of the picture.");
    v.number("yaw", key.yaw, dim::kAngle, kVisible, "In the solid view: yaw angle.");
    v.number("pitch", key.pitch, dim::kAngle, kVisible, "In the solid view: pitch angle.");
    v.number("over", key.over, dim::kTime, kNotNegative,
             "Duration of the camera's movement in film time; by default since the previous keyframe. 0 is a cut.");
    v.choice("ease", key.ease,
             {{Ease::smooth, "smooth"}, {Ease::linear, "linear"}, {Ease::in, "in"}, {Ease::out, "out"}},
             "smooth: gentle start and stop; in: gentle start; out: gentle stop.");
}

static void visit_camera(SceneVisitor& v, View& view) {
    v.number("zoom", view.shot.zoom, dim::kNone, kZooms, "Magnification of the mechanism; 1 shows all of its motion.");
    v.value("follow", anchor_format(view.shot.follow),
            "The point at the centre of the picture: of everything that the film shows (all), the tip, the contact "
            "(where beam and cam are nearest), the axis of the cam or of the hub, or a place [x, y]. The camera "
            "follows the mean over a third of a second of film time, so that it does not vibrate.");
    v.number("yaw", view.shot.yaw, dim::kAngle, kVisible,
             "In the solid view: yaw angle, to the right of the normal of the plane of motion.");
    v.number("pitch", view.shot.pitch, dim::kAngle, kVisible, "In the solid view: pitch angle, above the horizontal.");
    v.list("keyframes", SceneVisitor::items_of(view.keyframes),
           "Movements of the camera in a film; a still shows the camera at its instant.");
    v.check([&view](ObjectReader& r) { check_camera(r, view); });
}

static void visit(SceneVisitor& v, View& view) {
    v.choice("style", view.style, kStyles,
             "lit: shaded metal from the front (OpenGL); flat: a line drawing; solid: bodies in perspective with "
             "shadows (OpenGL).");
    const bool moved = !(view.shot == render::Shot{}) || !view.keyframes.empty();
    v.object(written_if(moved || view.style == render::Style::solid, "camera"),
             SceneVisitor::keys_of(view, visit_camera), "The camera.", nullptr);
    visit_exaggeration(
        v, view.exaggeration,
        "Factor of the deflection, stated on the picture; 1 is the true shape. auto: a round factor up to "
        "50 that suits the motion during the film, at any frame rate, or during the whole scene of a still.");
}

static void visit_theme(SceneVisitor& v, View& view) {
    using render::Theme;
    v.choice("theme", view.theme, {{Theme::light, "light"}, {Theme::dark, "dark"}, {Theme::print, "print"}},
             "Colour theme.");
}

static void visit_picture(SceneVisitor& v, Picture& picture) {
    using render::Comparison, render::Show;
    v.object("view", picture.view, "View of the mechanism.");
    visit_theme(v, picture.view);
    v.value(
        "background", background_format(picture.view),
        "paper: background of the theme; \"#rrggbb\": this colour; transparent: none, if the file format allows it.");
    v.choice(
        "show", picture.view.show,
        {{Show::all, "all"}, {Show::talk, "talk"}, {Show::paper, "paper"}, {Show::clean, "clean"}},
        "The parts around the panels. talk: no parameters and warning; paper: only labels, legend and clock; clean: "
        "none, so that the picture does not state the factor of the deflection.");
    v.choice(written_if(picture.view.lang != Lang::en, "lang"), picture.view.lang, kLanguages, "Language of labels.");
    v.number(written_if(picture.view.text_scale != 1, "text_scale"), picture.view.text_scale, sim::kPlainNumber,
             between(0.5, 4, "is outside 0.5 … 4"),
             "Size of text, lines and marks; at 1 the numbers of axes have 2 % of the height of a 16:9 picture.");
    v.value("size", size_format(picture.size), "Width and height in pixels; H.264 and VP9 need even numbers.");
    v.value("layout", layout_format(picture.layout),
            "auto, a panel, or a grid: {\"columns\": [{\"panel\": \"mechanism\", \"share\": 2}, {\"rows\": [\"theta\", "
            "\"contact_force\", \"close-up\"]}]}.",
            [&picture](sim::Visitor& inside) {
                if (!picture.layout) picture.layout.emplace();
                visit(static_cast<SceneVisitor&>(inside), *picture.layout);
            });
    v.choice(written_if(!picture.compare.empty(), "comparison"), picture.comparison,
             {{Comparison::panels, "panels"}, {Comparison::ghosts, "ghosts"}},
             "panels: a separate mechanism for each motion; ghosts: one mechanism, with the motions after the first as "
             "outlines.");
    v.list("compare", compared_motions(picture.compare),
           "The motions that the picture shows at equal times: the mechanics of this or another scene, with changes. "
           "The first one is the main motion.");
    v.check([&picture](ObjectReader& r) { check_picture(r, picture); });
}

// ---- how time runs in films --------------------------------------------------------------------

static void visit(SceneVisitor& v, SpeedInterval& interval) {
    v.value(required("from", "\"impact:1\""), instant_format(interval.from), "First instant.");
    v.value(required("to", "\"0.4 s\""), instant_format(interval.to), "Last instant.");
    v.number("factor", interval.factor, dim::kNone, kSpeedRange, "Playback speed in the interval; 1 is real time.");
    v.check([&interval](ObjectReader& r) {
        const bool times = interval.from.kind == Instant::Kind::time && interval.to.kind == Instant::Kind::time;
        if (times && !(interval.from.t < interval.to.t)) r.reject("to", " must be later than \"from\"");
    });
}

static void visit(SceneVisitor& v, Speed& speed) {
    const bool by_intervals = !speed.intervals.empty();
    const auto intervals = [&](sim::Visitor& inside) {
        speed.around.reset();
        static_cast<SceneVisitor&>(inside).list("intervals", SceneVisitor::items_of(speed.intervals),
                                                "The intervals, in order of time, without overlap.");
        inside.number("otherwise", speed.factor, dim::kNone, kSpeedRange, "Playback speed elsewhere.");
        inside.number("ease", speed.ease, dim::kTime, kNotNegative,
                      "Transition time between two speeds, in time of the motion; at most half of the time between two "
                      "intervals.");
    };
    const auto fields = [&](sim::Visitor& inside) {
        if (!speed.around) speed.around.emplace();
        SlowMotion& slow = *speed.around;
        inside.number("factor", slow.factor, dim::kNone, kSpeedRange, "Playback speed around impacts.");
        inside.number("otherwise", speed.factor, dim::kNone, kSpeedRange, "Playback speed elsewhere.");
        inside.number("before", slow.before, dim::kTime, kNotNegative,
                      "Slow motion starts this time before the first touch.");
        inside.number("after", slow.after, dim::kTime, kNotNegative, "Slow motion ends this time after the release.");
        inside.number("ease", slow.ease, dim::kTime, kNotNegative,
                      "Transition time between the speeds, in time of the motion.");
        inside.numbers("collisions", slow.collisions, sim::kPlainNumber, between(1, 1e6), {},
                       "Only around the impacts of these collisions, counted from 1; by default all.");
    };
    v.alternatives({{{{"around", "impacts"}}, "Slow motion around impacts.", !by_intervals, fields},
                    {{{"around", "intervals"}}, "Different speeds in intervals of time.", by_intervals, intervals}});
    v.check([&speed](ObjectReader& r) { check_speed(r, speed); });
}

static void visit(SceneVisitor& v, FilmEvent& event) {
    v.value(required("at", "\"impact:1\""), instant_format(event.at), "The instant.");
    v.number("freeze", event.freeze, dim::kTime, kNotNegative, "The picture freezes for this time, in film time.");
    v.text("text", event.text, "Text in the band below the panels; formulas as in the title.");
    v.number(written_if(event.fade > 0, "fade"), event.fade, dim::kTime, kNotNegative,
             "Time of fading in and out, in film time.");
    v.check([&event](ObjectReader& r) { check_words(r, "text", event.text); });
    v.number(
        "show", event.show, dim::kTime, kNotNegative,
        "Duration of the text in film time, at least the duration of the freeze; the next text ends it. By default "
        "1.5 s.");
}

static void visit_bounds(SceneVisitor& v, FrameSpan& span) {
    v.value("from", bound_format(span.from, span.from_event),
            "First instant; in real time the first frame is at the nearest multiple of 1/fps.");
    v.value("to", bound_format(span.to, span.to_event), "Last instant; by default the end of the scene.");
}

static void visit_span(SceneVisitor& v, FrameSpan& span) {
    v.value(
        "fps", frame_rate_format(span.fps),
        "Frames per second, 0.1 to 1000, or a fraction such as \"30000/1001\", which is also the meaning of 29.97.");
    visit_bounds(v, span);
    v.value(
        written_if(!span.duration && !span.story, "speed"), speed_format(span.speed),
        "Playback speed: a factor, where 1 is real time; \"impacts\": slow motion around impacts; or an object with "
        "the details.",
        SceneVisitor::keys_of(span.speed));
    v.number("duration", span.duration, dim::kTime, kPositive,
             "Duration of the film with its freezes, in place of \"speed\".");
    v.exclusive("speed", "duration");
    v.number(written_if(span.hold > 0, "hold"), span.hold, dim::kTime, kNotNegative,
             "The last picture freezes for this time, in film time.");
    v.list(written_if(!span.story, "events"), SceneVisitor::items_of(span.events),
           "Freezes and texts of the film at instants.");
    v.choice(
        "story", span.story,
        "impact: the film tells the first collision from \"from\" on, from the fall to the rebound, with slow motion, "
        "freezes, texts, a camera that moves closer, and a layout; settle: it tells how the motion comes to a "
        "contact that lasts, faster and faster.");
    for (const char* key : kKeysOfStories) v.exclusive("story", key);
}

// ---- the outputs -------------------------------------------------------------------------------

using sim::Named;

namespace {

void visit_video(SceneVisitor& v, PictureOutput& video) {
    using output::Codec;
    static const std::vector<Named<Codec>> kCodecs = [] {
        std::vector<Named<Codec>> all;
        for (const Codec codec : {Codec::h264, Codec::vp9, Codec::prores, Codec::ffv1, Codec::gif, Codec::webp})
            all.push_back({codec, output::name(codec)});
        return all;
    }();
    visit_file(v, video.file, {".mp4", ".webm", ".mov", ".mkv", ".gif", ".webp"}, ".mp4");
    v.check([&video](ObjectReader&) { set_default_codec(video); });
    visit_picture(v, video);
    visit_span(v, video.span);
    v.value("poster", instant_format(video.span.poster),
            "The first frame at or after this instant, of a freeze the middle one, is also written as a picture: "
            "fall.png beside fall.mp4. For a time outside the film the nearest frame.");
    v.choice(
        sim::derived("codec"), video.encoding.codec, std::span<const Named<Codec>>(kCodecs),
        "Codec. The default depends on the ending: .mp4 h264, .webm vp9, .mov prores (or h264), .mkv ffv1 (or h264, "
        "vp9).");
    v.integer("crf", video.encoding.crf, 0, 63,
              "Quality of h264 (up to 51) and vp9: 0 is best; the defaults 18 and 24 look lossless.");
    v.choice(written_if(video.encoding.codec == Codec::h264, "preset"), video.encoding.preset,
             {"ultrafast", "superfast", "veryfast", "faster", "fast", "medium", "slow", "slower", "veryslow"},
             "Preset of x264, from fast to small files; only for h264.");
    v.choice(written_if(video.encoding.variable_rate, "rate_mode"), video.encoding.variable_rate,
             {{false, "constant"}, {true, "variable"}},
             "variable: an unchanged picture is encoded once and lasts up to 5 s; players show the same film, but some "
             "editors need a constant rate.");
    v.check([&video](ObjectReader& r) { check_video(r, video); });
}

void visit_frames(SceneVisitor& v, PictureOutput& p) {
    visit_file(v, p.file, {".png"}, "-####.png", "Name of the files with #### for the frame number");
    visit_picture(v, p);
    visit_span(v, p.span);
    v.check([&p](ObjectReader& r) { check_span(r, p.span, p); });
}

void visit_still(SceneVisitor& v, PictureOutput& p) {
    visit_file(v, p.file, {".png", ".pdf", ".svg"}, ".png", "Name of the file",
               " .pdf and .svg are vector graphics; solid bodies are an image in them, \"flat\" ones are not.");
    visit_picture(v, p);
    v.value(required("at", "\"370 ms\""), instant_format(p.at), "The instant of the picture.");
    v.check([&p](ObjectReader& r) {
        if (p.at.kind == Instant::Kind::time) check_end(r, "at", p.at.t);
    });
}

void visit_page(SceneVisitor& v, PictureOutput& p) {
    visit_file(v, p.file, {".html"}, ".html");
    visit_theme(v, p.view);
    v.choice(written_if(p.view.lang != Lang::en, "lang"), p.view.lang, kLanguages, "Language of the words.");
    visit_exaggeration(v, p.view.exaggeration, "Factor of the deflection, as in films.");
    v.value("fps", frame_rate_format(p.span.fps),
            "Poses per second from which the page is made, at least a thousand in all; poses that the page can "
            "interpolate are left out.");
    visit_bounds(v, p.span);
    v.check([&p](ObjectReader& r) { check_span(r, p.span, p); });
}

}  // namespace

void PictureOutput::visit(SceneVisitor& v) {
    switch (kind) {
        case Kind::video:
            return visit_video(v, *this);
        case Kind::frames:
            return visit_frames(v, *this);
        case Kind::still:
            return visit_still(v, *this);
        case Kind::page:
            return visit_page(v, *this);
    }
}

void plan(Planner& planner, const PictureOutput&, const ResolvedOutput& resolved) { planner.add(resolved); }

}  // namespace beamcam::scenes
