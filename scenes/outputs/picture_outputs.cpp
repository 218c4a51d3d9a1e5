// Outputs "video", "frames", "still" and "page": pictures of the mechanism and its charts.

#include "output/film/video_format.hpp"
#include "scenes/format/checks.hpp"
#include "scenes/format/value_formats.hpp"
#include "scenes/outputs/picture_keys.hpp"
#include "scenes/plan/planner.hpp"
#include "scenes/scene/files.hpp"

namespace beamcam::scenes {

using sim::Named, sim::required, sim::written_if;

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
