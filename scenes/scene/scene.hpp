// What a scene says, resolved: every default filled in, every unit turned into SI.
//
// Plain values; nothing here reads, checks or runs. The format is described, key by key, in
// beamcam-scene.schema.json; `reader.hpp` makes a Scene from a file.
#pragma once

#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "output/film/video_format.hpp"
#include "render/film/film.hpp"
#include "scenes/scene/measurement.hpp"
#include "scenes/scene/sweep.hpp"
#include "sim/observe/channels.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::scenes {

// Frames a second as a fraction, so that 30000/1001 stays exact.
struct FrameRate {
    int numerator = 60, denominator = 1;  // both > 0, in lowest terms

    double value() const { return static_cast<double>(numerator) / denominator; }
    bool operator==(const FrameRate&) const = default;
};

struct Size {
    int width = 1920, height = 1080;  // [px]
    bool operator==(const Size&) const = default;
};

// How a film is encoded. The file's ending names the container.
struct Encoding {
    output::Codec codec = output::Codec::h264;
    std::optional<int> crf;           // 0 (best) …; absent: the codec's usual one, or it has none
    std::string preset = "veryfast";  // of x264
    bool variable_rate = false;       // pictures that do not change are coded once and last longer
};

// An instant of the motion: a time, the end, or an event counted from 1: the first touch of an impact or a collision,
// the release of an impact, the apex of a rebound (the largest hub angle between two collisions).
struct Instant {
    enum class Kind { time, last, impact, collision, release, apex };
    Kind kind = Kind::time;
    double t = 0;    // [s], >= 0
    int number = 1;  // of the event
    bool operator==(const Instant&) const = default;

    bool is_event() const { return kind != Kind::time && kind != Kind::last; }
};
// How scenes write events: "impact:3", or a word that is enough for the first one, "touch".
struct EventWord {
    std::string_view word;  // singular
    Instant::Kind kind;
    bool alone = false;  // without a number: the first
};
inline constexpr EventWord kEventWords[] = {{"impact", Instant::Kind::impact},
                                            {"collision", Instant::Kind::collision},
                                            {"apex", Instant::Kind::apex},
                                            {"release", Instant::Kind::release, true},
                                            {"touch", Instant::Kind::impact, true}};
std::string name_of(const Instant& at);  // "impact 3", "0.2 s"

// How fast the motion runs in a film.
struct SlowMotion {
    double factor = 0.02;  // of real time, around impacts
    // All in seconds of the motion: slow from so long before the first touch of an impact …
    double before = 2e-3;
    double after = 10e-3;                 // … until so long after its release …
    double ease = 20e-3;                  // … and on the way from one speed to the other for so long
    std::vector<double> collisions = {};  // whose impacts are meant, counted from 1; none: all
    bool operator==(const SlowMotion&) const = default;
};
struct SpeedInterval {
    Instant from, to;
    double factor = 0.1;  // of real time
    bool operator==(const SpeedInterval&) const = default;
};
struct Speed {
    double factor = 1;  // of real time, away from impacts and intervals
    std::optional<SlowMotion> around = {};
    std::vector<SpeedInterval> intervals = {};  // in place of `around`
    double ease = 20e-3;                        // at their ends [s of the motion]
    bool real_time() const { return factor == 1 && !around && intervals.empty(); }
    bool operator==(const Speed&) const = default;
};

// What the film does at an instant: stands still, says something.
struct FilmEvent {
    Instant at;
    double freeze = 0;                          // [s] of the film
    std::string text;                           // plain, with formulas between dollars
    std::optional<double> show = {};            // [s] of the film; absent: 1.5 s, or until the next words come
    std::optional<render::Anchor> anchor = {};  // of the words
    double fade = 0;                            // they come and go in so long [s] of the film
};

// Another motion in the same picture: this scene with some of its mechanics changed.
struct Compared {
    std::string label;
    sim::Problem problem;
};

// What the camera has come to at an instant. What is absent stays as the keyframe before left it.
struct Keyframe {
    Instant at;
    std::optional<double> zoom = {};
    std::optional<render::Anchor> follow = {};
    std::optional<double> yaw = {}, pitch = {};  // [rad]
    std::optional<double> over = {};             // it moves for so long [s of the film]; absent: since the one before
    render::Ease ease = render::Ease::smooth;
};
struct View : render::View {
    std::vector<Keyframe> keyframes = {};
    std::optional<double> shutter = {};       // open over so much of a frame, 2π: all of it [rad]
    std::optional<double> strobe_every = {};  // flashes at the multiples of it [s of the motion]; excludes the shutter
    int exposures = 8;                        // within the shutter's opening, or the latest flashes

    // Poses that a frame shows.
    std::size_t poses() const {
        return static_cast<std::size_t>(shutter ? exposures : strobe_every ? exposures + 1 : 1);
    }
};

// What every picture has.
struct Picture {
    Size size;
    View view;
    std::optional<render::LayoutNode> layout;  // absent: the standard arrangement
    // Absent: this motion alone. The first is the main one; the scene itself is one of them only if listed.
    std::vector<Compared> compare;
    render::Comparison comparison = render::Comparison::panels;
    bool horizon = false;  // strip charts are paler where θ is not reproducible
    std::string logo;      // file of a picture, from the scene's folder; may be empty
    std::string logo_digest;
    std::shared_ptr<const render::Image> logo_image;
};

// Pictures of the instants k / fps with from <= k/fps < to, by rounded frame numbers; with a speed other than real
// time or with events, k / fps is the film's own time.
struct FrameSpan {
    FrameRate fps;
    double from = 0;                // [s] of the motion, >= 0
    std::optional<double> to = {};  // [s], > from; absent: the end of the scene
    Speed speed = {};
    std::optional<double> duration = {};  // wanted of the film, freezes and all, in place of a speed [s], > 0
    double hold = 0;                      // the last picture stands so long [s]
    std::vector<FilmEvent> events = {};
    std::optional<Instant> from_event = {}, to_event = {};  // in place of `from` and `to`
    std::optional<Instant> poster = {};                     // of a video: its frame that is put beside it as a picture

    bool real_time() const { return speed.real_time() && events.empty() && !duration && hold == 0; }
    std::vector<Instant> instants() const;  // all that it names
    bool needs_events() const;              // events have to be known before the frames' instants are
};

using render::Lang;
enum class Subtitles { none, vtt, srt };

class Planner;       // plan/planner.hpp
class SceneVisitor;  // format/keys.hpp

// What decides until when an output looks at the motion: its own keys, the scene's end, or the run of all outputs.
enum class Extent { keys, scene, run };

// The types of outputs. Each is complete in a file of its own (outputs/): `visit` names its keys, `plan` says what it
// needs of the motion and how its file is written. A new type is such a file, a struct here, and a line in Output.

struct VideoOutput : Picture {
    static constexpr const char *kType = "video", *kMeaning = "A film; the ending of its name decides the format.";
    static constexpr bool kIsData = false;  // holds numbers alone: the scene's title is not in it
    std::string file;                       // relative to the output directory, as in every output
    FrameSpan span;
    Encoding encoding;
    Subtitles subtitles = Subtitles::none;  // a file beside it
    bool chapters = false;                  // in it, at impacts

    Extent extent() const { return span.to ? Extent::keys : Extent::scene; }
    void visit(SceneVisitor& v);
    void plan(Planner& planner, std::size_t output) const;  // `output`: its index in the scene
};
struct FramesOutput : Picture {
    static constexpr const char *kType = "frames", *kMeaning = "A sequence of PNG files.";
    static constexpr bool kIsData = false;
    std::string file;  // with one run of '#', replaced by the frame number
    FrameSpan span;

    Extent extent() const { return span.to ? Extent::keys : Extent::scene; }
    void visit(SceneVisitor& v);
    void plan(Planner& planner, std::size_t output) const;
};
struct StillOutput : Picture {
    static constexpr const char *kType = "still", *kMeaning = "One picture.";
    static constexpr bool kIsData = false;
    std::string file;
    Instant at;

    Extent extent() const { return at.kind == Instant::Kind::time ? Extent::keys : Extent::scene; }
    void visit(SceneVisitor& v);
    void plan(Planner& planner, std::size_t output) const;
};
// The poses looked at are thinned by what the page can interpolate; its keys are few, since it fits any window.
struct PageOutput : Picture {
    static constexpr const char *kType = "page", *kMeaning = "A self-contained HTML page that plays the motion.";
    static constexpr bool kIsData = false;
    std::string file;  // .html
    FrameSpan span{.fps = {1000, 1}};

    Extent extent() const { return span.to ? Extent::keys : Extent::scene; }
    void visit(SceneVisitor& v);
    void plan(Planner& planner, std::size_t output) const;
};
struct ModelOutput : Picture {
    static constexpr const char *kType = "model",
                                *kMeaning =
                                    "The moving mechanism as a three-dimensional model, for Blender and slides.";
    static constexpr bool kIsData = false;
    std::string file;  // .glb
    FrameSpan span;

    Extent extent() const { return span.to ? Extent::keys : Extent::scene; }
    void visit(SceneVisitor& v);
    void plan(Planner& planner, std::size_t output) const;
};
struct TrajectoryOutput {
    static constexpr const char *kType = "trajectory", *kMeaning = "A table of channels against time.";
    static constexpr bool kIsData = true;
    std::string file;                    // .csv or .npz
    std::vector<sim::Channel> channels;  // in this order; the time comes first in any case
    double rate = 1000;                  // [Hz], rows k/rate and the end; unless there are times
    std::vector<double> times;           // [s], rows in this order

    Extent extent() const { return times.empty() ? Extent::scene : Extent::keys; }
    void visit(SceneVisitor& v);
    void plan(Planner& planner, std::size_t output) const;
};
struct ShapesOutput {
    static constexpr const char *kType = "shapes",
                                *kMeaning = "The deflection along the beam in time: a row for each instant and place.";
    static constexpr bool kIsData = true;
    std::string file;                // .csv or .npz
    double rate = 1000;              // [Hz], instants k/rate and the end
    std::vector<double> times = {};  // [s]; not empty: these instants instead
    int stations = 33;               // places along the beam, both ends included

    Extent extent() const { return times.empty() ? Extent::scene : Extent::keys; }
    void visit(SceneVisitor& v);
    void plan(Planner& planner, std::size_t output) const;
};
struct ImpactsOutput {
    static constexpr const char *kType = "impacts", *kMeaning = "All impacts and collisions.";
    static constexpr bool kIsData = true;
    std::string file;  // .json or .csv

    Extent extent() const { return Extent::run; }
    void visit(SceneVisitor& v);
    void plan(Planner& planner, std::size_t output) const;
};
struct SummaryOutput {
    static constexpr const char *kType = "summary", *kMeaning = "Counts, extremes, energy balance, warnings.";
    static constexpr bool kIsData = true;
    std::string file;  // .json
    bool horizon = false;

    Extent extent() const { return Extent::run; }
    void visit(SceneVisitor& v);
    void plan(Planner& planner, std::size_t output) const;
};
struct SweepOutput {
    static constexpr const char *kType = "sweep", *kMeaning = "The points of the scene's sweep: a row for each sample.";
    static constexpr bool kIsData = true;
    std::string file;  // .nc, .csv or .npz

    Extent extent() const { return Extent::keys; }
    void visit(SceneVisitor& v);
    void plan(Planner& planner, std::size_t output) const;
};
inline constexpr std::initializer_list<const char*> kSweepFilmEndings{".mp4", ".mov", ".mkv", ".webm"};
struct SweepFilmOutput {
    static constexpr const char *kType = "sweep-film",
                                *kMeaning =
                                    "A film of the scene's sweep over one key: the bifurcation diagram grows "
                                    "while the beam of that value moves beside it.";
    static constexpr bool kIsData = false;
    std::string file;  // .mp4, .mov, .mkv or .webm
    Size size;
    FrameRate fps{30, 1};
    double duration = 30;  // [s]
    double turns = 2;      // of the cam in a second of the film
    render::Style style = render::Style::lit;
    std::optional<double> exaggeration = {};
    Lang lang = Lang::en;
    std::string value = {};  // what the diagram shows; empty: the usual
    std::optional<int> crf = {};

    Extent extent() const { return Extent::keys; }
    void visit(SceneVisitor& v);
    void plan(Planner& planner, std::size_t output) const;
};
// A curve that is a sum of channels of one unit; channels without values add nothing.
struct SeriesSum {
    std::string label;
    std::vector<sim::Channel> plus = {}, minus = {};  // with `minus` it is a balance, drawn in black
};
// One of the panels of the figure "series": curves of channels of one unit, and of another one at the right axis.
struct SeriesPanel {
    std::vector<sim::Channel> channels = {}, right = {};
    std::vector<SeriesSum> sums = {};  // curves instead of the channels, of their unit
    bool logarithmic = false;
    std::optional<double> low = {}, high = {};  // of the axis at the left, in SI units
    std::vector<double> lines = {};             // across the panel, at these values of that axis
    std::string label = {};                     // of that axis, before the unit; empty: the channels' symbols
    std::string title = {};
};
// A line at an instant, with words.
struct SeriesNote {
    Instant at;
    std::string text;
};
// What the figure "series" shows; other figures have content of their own.
struct SeriesKeys {
    std::vector<SeriesPanel> panels = {};
    std::string against = "t";                              // "t", "turns" of the cam, "frequency", or a channel
    std::optional<double> x_low = {}, x_high = {};          // of its axis; SI units or turns
    double from = 0;                                        // [s]
    std::optional<double> to = {};                          // [s]; absent: the end of the scene
    std::optional<Instant> from_event = {}, to_event = {};  // in place of `from` and `to`
    std::optional<Instant> at = {};                         // of a strobe: the one instant, in place of both
    std::vector<Compared> compare = {};                     // absent: this motion alone
    bool apart = false;                                     // each of these in panels of its own
    bool impacts = false;                                   // lines where impacts begin
    bool residuals = false;                                 // below each panel with data, what the data differ by
    std::optional<double> height = {};                      // [m]; absent: what suits the panels
    std::vector<SeriesNote> notes = {};
    std::optional<double> window = {}, highest = {};  // of a spectrogram [s], [Hz]; absent: what suits the motion

    bool needs_events() const { return from_event || to_event || (at && at->is_event()); }
};
inline constexpr std::initializer_list<const char*> kFigureEndings{".pdf", ".svg", ".eps", ".png", ".tif", ".tiff"};
struct FigureOutput {
    static constexpr const char *kType = "figure",
                                *kMeaning = "A figure for print: one of those that `beamcam figure SCENE` lists.";
    static constexpr bool kIsData = false;
    std::string file;                 // of one of kFigureEndings
    std::string figure;               // its name, see figures/recipes.hpp
    std::string column = "elsevier";  // a journal's, see render/plot/style.hpp
    std::optional<double> width;      // [m]; absent: the column's
    Lang lang = Lang::en;
    std::optional<double> dpi;  // of pixels; absent: 300 of .png, 600 of .tif
    bool editable = false;      // text of .svg as text
    bool serif = false;         // letters as those of text set by LaTeX
    bool dark = false;          // on the dark theme's paper, for slides
    SeriesKeys series;
    int collision = 1;                    // which one the figure "collision" shows, counted from 1
    std::string value = {};               // of a diagram of a sweep: what it shows; empty: the usual
    std::string data_file, caption_file;  // beside it; empty: none

    Extent extent() const {
        const bool ends = series.to || (series.at && series.at->kind == Instant::Kind::time);
        return ends ? Extent::keys : Extent::scene;
    }
    bool is_tiff() const { return file.ends_with(".tif") || file.ends_with(".tiff"); }
    double resolution() const { return dpi.value_or(is_tiff() ? 600 : 300); }
    void visit(SceneVisitor& v);
    void plan(Planner& planner, std::size_t output) const;
};
using Output = std::variant<VideoOutput, FramesOutput, StillOutput, PageOutput, ModelOutput, FigureOutput,
                            TrajectoryOutput, ShapesOutput, ImpactsOutput, SweepOutput, SweepFilmOutput, SummaryOutput>;

// About what a thread needs to draw it [bytes], and from where on people are told.
double memory_of(const Picture& picture);
constexpr double kMuchMemory = 1e9;

const std::string& file_of(const Output& output);
std::string poster_file(const VideoOutput& video);          // "fall.png" beside "fall.mp4"
std::string subtitles_file(const VideoOutput& video);       // "fall.vtt"; empty: none
std::vector<std::string> written_by(const Output& output);  // its file, and what stands beside it
bool is_data(const Output& output);
bool is_picture(const Output& output);

struct Scene {
    std::string name = "scene";  // the file's name without its ending
    std::string title;
    render::Units units;  // that films write
    sim::Problem problem;
    double end_time = 1.5;  // [s], > 0
    std::optional<Sweep> sweep;
    std::vector<Measurement> data;
    std::vector<Output> outputs;
    // Where each stands, for messages: "fall.json:12:5"; none of those that a command adds.
    std::vector<std::string> output_places;

    void set_outputs(std::vector<Output> others) {
        outputs = std::move(others);
        output_places.clear();
    }
};

// The film that a scene without outputs yields.
VideoOutput default_film(const Scene& scene);

// The scene as JSON text in the scene format, every default written out: it reads back to the same
// scene, and goes into the metadata of what was made from it. Without `outputs`: physics only.
std::string to_json(const Scene& scene);

}  // namespace beamcam::scenes
