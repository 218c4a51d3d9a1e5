// A scene with resolved defaults and SI units: plain values without reading, checks or work. FORMAT.md describes the
// keys; `reader.hpp` reads a Scene from a file.
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

// Frames per second as a fraction, so that 30000/1001 is exact.
struct FrameRate {
    int numerator = 60, denominator = 1;  // both > 0, in lowest terms

    double value() const { return static_cast<double>(numerator) / denominator; }
    bool operator==(const FrameRate&) const = default;
};

struct Size {
    int width = 1920, height = 1080;  // [px]
    bool operator==(const Size&) const = default;
};

// The encoding of a film; the ending of the file selects the container.
struct Encoding {
    output::Codec codec = output::Codec::h264;
    std::optional<int> crf;           // 0 is best; nullopt: the default of the codec, if it has a crf
    std::string preset = "veryfast";  // of x264
    bool variable_rate = false;       // unchanged pictures are encoded once and last longer
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
// Notation of events: "impact:3"; some words mean the first event, "touch".
struct EventWord {
    std::string_view word;  // singular
    Instant::Kind kind;
    bool alone = false;  // valid without a number, for the first event
};
inline constexpr EventWord kEventWords[] = {{"impact", Instant::Kind::impact},
                                            {"collision", Instant::Kind::collision},
                                            {"apex", Instant::Kind::apex},
                                            {"release", Instant::Kind::release, true},
                                            {"touch", Instant::Kind::impact, true}};
std::string name_of(const Instant& at);  // "impact 3", "0.2 s"

// The playback speed of a film.
struct SlowMotion {
    double factor = 0.02;  // of real time, around impacts
    // In seconds of the motion: slow motion from `before` the first touch of an impact to `after` its release, with a
    // transition of `ease` on both sides.
    double before = 2e-3, after = 10e-3, ease = 20e-3;
    std::vector<double> collisions = {};  // only around the impacts of these, counted from 1; empty: all
    bool operator==(const SlowMotion&) const = default;
};
struct SpeedInterval {
    Instant from, to;
    double factor = 0.1;  // of real time
    bool operator==(const SpeedInterval&) const = default;
};
struct Speed {
    double factor = 1;  // of real time, outside of impacts and intervals
    std::optional<SlowMotion> around = {};
    std::vector<SpeedInterval> intervals = {};  // in place of `around`
    double ease = 20e-3;                        // transition at their ends [s of the motion]
    bool real_time() const { return factor == 1 && !around && intervals.empty(); }
    bool operator==(const Speed&) const = default;
};

// A freeze or a text of a film at an instant.
struct FilmEvent {
    Instant at;
    double freeze = 0;                          // [s] of the film
    std::string text;                           // plain, with formulas between dollars
    std::optional<double> show = {};            // [s] of the film; nullopt: 1.5 s, or until the next text
    std::optional<render::Anchor> anchor = {};  // of the text
    double fade = 0;                            // duration of fading in and out [s] of the film
};

// One motion of a comparison: the mechanics of this or another scene with changes.
struct Compared {
    std::string label;
    sim::Problem problem;
};

// The camera at an instant. Absent values are those of the previous keyframe.
struct Keyframe {
    Instant at;
    std::optional<double> zoom = {};
    std::optional<render::Anchor> follow = {};
    std::optional<double> yaw = {}, pitch = {};  // [rad]
    std::optional<double> over = {};  // duration of the movement [s of the film]; nullopt: since the previous keyframe
    render::Ease ease = render::Ease::smooth;
};
struct View : render::View {
    std::vector<Keyframe> keyframes = {};
    std::optional<double> shutter = {};       // shutter angle; 2π is the whole frame [rad]
    std::optional<double> strobe_every = {};  // interval of the flashes [s of the motion]; excludes the shutter
    int exposures = 8;                        // while the shutter is open, or number of the latest flashes

    // Number of poses in a frame.
    std::size_t poses() const {
        return static_cast<std::size_t>(shutter ? exposures : strobe_every ? exposures + 1 : 1);
    }
};

// The keys of all pictures.
struct Picture {
    Size size;
    View view;
    std::optional<render::LayoutNode> layout;  // nullopt: the standard layout
    // Empty: only the motion of the scene. The first is the main motion; the scene itself must be listed to be shown.
    std::vector<Compared> compare;
    render::Comparison comparison = render::Comparison::panels;
    bool horizon = false;  // strip charts are paler where θ is not reproducible
    std::string logo;      // picture file relative to the scene's folder; may be empty
    std::string logo_digest;
    std::shared_ptr<const render::Image> logo_image;
};

// Frames at the times k / fps with from <= k / fps < to, by rounded frame numbers. With another speed than real time,
// or with events, k / fps is film time.
struct FrameSpan {
    FrameRate fps;
    double from = 0;                // [s] of the motion, >= 0
    std::optional<double> to = {};  // [s], > from; nullopt: the end of the scene
    Speed speed = {};
    std::optional<double> duration = {};  // of the film with its freezes, in place of a speed [s], > 0
    double hold = 0;                      // duration of the last picture [s]
    std::vector<FilmEvent> events = {};
    std::optional<Instant> from_event = {}, to_event = {};  // in place of `from` and `to`
    std::optional<Instant> poster = {};                     // of a video: the frame that is also written as a picture

    bool real_time() const { return speed.real_time() && events.empty() && !duration && hold == 0; }
    std::vector<Instant> instants() const;  // all that its keys name
    bool needs_events() const;              // the frames depend on events
};

using render::Lang;
// track: in the film itself.
enum class Subtitles { none, vtt, srt, track };

class Planner;       // plan/planner.hpp
class SceneVisitor;  // format/keys.hpp

// The parts of a scene, besides its mechanics, that the files of an output type depend on. A file without the title
// contains only numbers.
struct OutputInputs {
    bool title = false, units = false, data = false, sweep = false;
};

// What determines the end of the motion that an output needs: its keys, the scene's end, or the run of all outputs.
enum class Extent { keys, scene, run };

// The output types. Each is implemented in one file in outputs/: `visit` describes its keys, `plan` adds its needs and
// the writer of its file to the plan. A new type is such a file, a struct here, and an entry in Output.

// Pictures of the mechanism.
struct PictureOutput : Picture {
    enum class Kind { video, frames, still, page, model };
    static constexpr OutputInputs kInputs{.title = true, .units = true, .data = true};

    Kind kind = Kind::video;
    std::string file;                       // relative to the output directory; of frames with one run of '#'
    FrameSpan span = {};                    // of all but stills
    Instant at = {};                        // of a still
    Encoding encoding = {};                 // this and the next two of a video
    Subtitles subtitles = Subtitles::none;  // a file beside it
    bool chapters = false;                  // in it, at impacts

    static PictureOutput of(Kind kind);
    Extent extent() const;
    void visit(SceneVisitor& v);
    void plan(Planner& planner, std::size_t output) const;  // `output`: its index in the scene
};
struct PictureType {
    PictureOutput::Kind kind;
    const char *name, *meaning;
};
inline constexpr PictureType kPictureTypes[] = {
    {PictureOutput::Kind::video, "video", "A film; the ending of its name selects the format."},
    {PictureOutput::Kind::frames, "frames", "A sequence of PNG files."},
    {PictureOutput::Kind::still, "still", "One picture."},
    // It leaves out poses that it can interpolate, and adapts to any window size.
    {PictureOutput::Kind::page, "page", "A self-contained HTML page that plays the motion."},
    {PictureOutput::Kind::model, "model",
     "An animated three-dimensional model of the mechanism, for Blender and slides."}};

struct TrajectoryOutput {
    static constexpr const char *kType = "trajectory", *kMeaning = "A table of channels against time.";
    static constexpr OutputInputs kInputs{};
    std::string file;                    // .csv or .npz
    std::vector<sim::Channel> channels;  // in this order, always after the time
    double rate = 1000;                  // [Hz]: rows k/rate and the end, unless `times` is given
    std::vector<double> times;           // [s]: rows in this order

    Extent extent() const { return times.empty() ? Extent::scene : Extent::keys; }
    void visit(SceneVisitor& v);
    void plan(Planner& planner, std::size_t output) const;
};
struct ShapesOutput {
    static constexpr const char *kType = "shapes",
                                *kMeaning = "The deflection along the beam in time: one row for each time and point.";
    static constexpr OutputInputs kInputs{};
    std::string file;                // .csv or .npz
    double rate = 1000;              // [Hz]: times k/rate and the end
    std::vector<double> times = {};  // [s]; replaces `rate` unless empty
    int stations = 33;               // points along the beam, both ends included

    Extent extent() const { return times.empty() ? Extent::scene : Extent::keys; }
    void visit(SceneVisitor& v);
    void plan(Planner& planner, std::size_t output) const;
};
struct ImpactsOutput {
    static constexpr const char *kType = "impacts", *kMeaning = "All impacts and collisions.";
    static constexpr OutputInputs kInputs{};
    std::string file;  // .json or .csv

    Extent extent() const { return Extent::run; }
    void visit(SceneVisitor& v);
    void plan(Planner& planner, std::size_t output) const;
};
struct SummaryOutput {
    static constexpr const char *kType = "summary", *kMeaning = "Counts, extrema, energy balance, warnings.";
    static constexpr OutputInputs kInputs{.data = true};
    std::string file;  // .json
    bool horizon = false;

    Extent extent() const { return Extent::run; }
    void visit(SceneVisitor& v);
    void plan(Planner& planner, std::size_t output) const;
};
struct SweepOutput {
    static constexpr const char *kType = "sweep",
                                *kMeaning = "The points of the scene's sweep: one row for each sample.";
    static constexpr OutputInputs kInputs{.sweep = true};
    std::string file;  // .nc, .csv or .npz

    Extent extent() const { return Extent::keys; }
    void visit(SceneVisitor& v);
    void plan(Planner& planner, std::size_t output) const;
};
inline constexpr std::initializer_list<const char*> kSweepFilmEndings{".mp4", ".mov", ".mkv", ".webm"};
struct SweepFilmOutput {
    static constexpr const char
        *kType = "sweep-film",
        *kMeaning =
            "A film of the scene's sweep over one key: a growing bifurcation diagram beside the motion at that value.";
    static constexpr OutputInputs kInputs{.title = true, .units = true, .sweep = true};
    std::string file;  // .mp4, .mov, .mkv or .webm
    Size size;
    FrameRate fps{30, 1};
    double duration = 30;  // [s]
    double turns = 2;      // of the cam per second of the film
    render::Style style = render::Style::lit;
    std::optional<double> exaggeration = {};
    Lang lang = Lang::en;
    std::string value = {};  // column of the diagram; empty: default
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
// A panel of the figure "series": curves of one unit, and of another unit on the right axis.
struct SeriesPanel {
    std::vector<sim::Channel> channels = {}, right = {};
    std::vector<SeriesSum> sums = {};  // curves instead of the channels, of their unit
    bool logarithmic = false;
    std::optional<double> low = {}, high = {};  // of the left axis, in SI units
    std::vector<double> lines = {};             // horizontal, at these values of the left axis
    std::string label = {};                     // of the left axis, without unit; empty: the channels' symbols
    std::string title = {};
};
// A vertical line with a text.
struct SeriesNote {
    Instant at;
    std::string text;
};
// The keys of the figure "series".
struct SeriesKeys {
    std::vector<SeriesPanel> panels = {};
    std::string against = "t";                              // "t", "turns" of the cam, "frequency", or a channel
    std::optional<double> x_low = {}, x_high = {};          // ends of the abscissa; SI units or turns
    double from = 0;                                        // [s]
    std::optional<double> to = {};                          // [s]; nullopt: the end of the scene
    std::optional<Instant> from_event = {}, to_event = {};  // in place of `from` and `to`
    std::optional<Instant> at = {};                         // of a strobe: the only instant, in place of both
    std::vector<Compared> compare = {};                     // empty: only the motion of the scene
    bool apart = false;                                     // separate panels for each of them
    bool impacts = false;                                   // lines at the beginnings of impacts
    bool residuals = false;                                 // a panel of differences below each panel with data
    std::optional<double> height = {};                      // [m]; nullopt: suits the panels
    std::vector<SeriesNote> notes = {};
    std::optional<double> window = {}, highest = {};  // of a spectrogram [s], [Hz]; nullopt: suits the motion

    bool needs_events() const { return from_event || to_event || (at && at->is_event()); }
};
inline constexpr std::initializer_list<const char*> kFigureEndings{".pdf", ".svg", ".eps", ".png", ".tif", ".tiff"};
struct FigureOutput {
    static constexpr const char *kType = "figure",
                                *kMeaning = "A figure for print; `beamcam figure SCENE` lists all figures.";
    static constexpr OutputInputs kInputs{.title = true, .data = true};
    std::string file;                 // of one of kFigureEndings
    std::string figure;               // its name, see figures/figure_types.hpp
    std::string column = "elsevier";  // of a journal, see render/plot/style.hpp
    std::optional<double> width;      // [m]; nullopt: that of the column
    Lang lang = Lang::en;
    std::optional<double> dpi;  // nullopt: 300 for .png, 600 for .tif
    bool editable = false;      // .svg contains text, not outlines
    bool serif = false;         // serif font, as in LaTeX documents
    bool dark = false;          // dark theme, for slides
    SeriesKeys series;
    int collision = 1;                    // number of the collision in the figure "collision", from 1
    std::string value = {};               // column of a sweep's diagram; empty: default
    std::string data_file, caption_file;  // empty: none

    Extent extent() const {
        const bool ends = series.to || (series.at && series.at->kind == Instant::Kind::time);
        return ends ? Extent::keys : Extent::scene;
    }
    bool is_tiff() const { return file.ends_with(".tif") || file.ends_with(".tiff"); }
    double resolution() const { return dpi.value_or(is_tiff() ? 600 : 300); }
    void visit(SceneVisitor& v);
    void plan(Planner& planner, std::size_t output) const;
};
using Output = std::variant<PictureOutput, FigureOutput, TrajectoryOutput, ShapesOutput, ImpactsOutput, SweepOutput,
                            SweepFilmOutput, SummaryOutput>;

// Estimated memory of a drawing thread [bytes], and the value above which a warning is printed.
double memory_of(const Picture& picture);
constexpr double kMuchMemory = 1e9;

const std::string& file_of(const Output& output);
std::string poster_file(const PictureOutput& video);        // "fall.png" beside "fall.mp4"; empty: none
std::string subtitles_file(const PictureOutput& video);     // "fall.vtt"; empty: none
std::vector<std::string> written_by(const Output& output);  // its file and its secondary files
OutputInputs inputs_of(const Output& output);
bool is_data(const Output& output);
const PictureOutput* picture_of(const Output& output, PictureOutput::Kind kind);  // null: it is none of this kind

struct Scene {
    std::string name = "scene";  // the file's name without its ending
    std::string title;
    render::Units units;  // of the labels in films
    sim::Problem problem;
    double end_time = 1.5;  // [s], > 0
    std::optional<Sweep> sweep;
    std::vector<Measurement> data;
    std::vector<Output> outputs;
    // Position of each output in the file, for messages: "fall.json:12:5". Outputs of commands have none.
    std::vector<std::string> output_places;

    void set_outputs(std::vector<Output> others) {
        outputs = std::move(others);
        output_places.clear();
    }
};

// The output of a scene without outputs.
PictureOutput default_film(const Scene& scene);

// The scene as JSON in the scene format with all defaults. It reads back to the same scene, and is the metadata of
// files made from it.
std::string to_json(const Scene& scene);

}  // namespace beamcam::scenes
