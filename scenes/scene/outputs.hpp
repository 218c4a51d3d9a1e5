// The outputs of a scene: the keys of each type.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scenes/scene/files.hpp"
#include "scenes/scene/pictures.hpp"
#include "sim/observe/channels.hpp"

namespace beamcam::scenes {

using render::Lang;
class SceneVisitor;  // format/keys.hpp

// The parts of a scene, besides its mechanics, that the files of an output type depend on. A file without the title
// contains only numbers.
struct OutputInputs {
    bool title = false, units = false, data = false, sweep = false;
};

// The output types. Each is implemented in one file in outputs/: `visit` describes its keys, `plan` (plan/planner.hpp)
// adds its needs to the plan. A new type is such a file, a struct here, and an entry in Output.

// Pictures of the mechanism.
struct PictureOutput : Picture {
    enum class Kind { video, frames, still, page };
    static constexpr OutputInputs kInputs{.title = true, .units = true, .data = true};

    Kind kind = Kind::video;
    std::string file;        // relative to the output directory; of frames with one run of '#'
    FrameSpan span = {};     // of all but stills
    Instant at = {};         // of a still
    Encoding encoding = {};  // of a video

    bool has_frames() const { return kind == Kind::video || kind == Kind::frames; }
    static PictureOutput of(Kind kind);
    void visit(SceneVisitor& v);
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
    {PictureOutput::Kind::page, "page", "A self-contained HTML page that plays the motion."}};

struct TrajectoryOutput {
    static constexpr const char *kType = "trajectory", *kMeaning = "A table of channels against time.";
    static constexpr OutputInputs kInputs{};
    std::string file;                    // .csv or .npz
    std::vector<sim::Channel> channels;  // in this order, always after the time
    std::optional<double> rate;          // [Hz]: rows k/rate and the end; absent: rows that follow the motion
    std::vector<double> times;           // [s]: rows in this order; replaces `rate` unless empty

    void visit(SceneVisitor& v);
};
struct ImpactsOutput {
    static constexpr const char *kType = "impacts", *kMeaning = "All impacts and collisions.";
    static constexpr OutputInputs kInputs{};
    std::string file;  // .json or .csv

    void visit(SceneVisitor& v);
};
// A scene that continues the motion from an instant.
struct StateOutput {
    static constexpr const char *kType = "state",
                                *kMeaning = "A scene that continues the motion from an instant, which is its time 0.";
    static constexpr OutputInputs kInputs{};
    std::string file;  // .json
    double at = 0;     // [s]

    void visit(SceneVisitor& v);
};
struct SummaryOutput {
    static constexpr const char *kType = "summary", *kMeaning = "Counts, extrema, energy balance, warnings.";
    static constexpr OutputInputs kInputs{.data = true};
    std::string file;                    // .json
    std::vector<sim::Channel> channels;  // whose extrema it lists; empty: the most important ones
    bool horizon = false;

    void visit(SceneVisitor& v);
};
struct SweepOutput {
    static constexpr const char *kType = "sweep",
                                *kMeaning = "The points of the scene's sweep: one row for each sample.";
    static constexpr OutputInputs kInputs{.sweep = true};
    std::string file;  // .nc, .csv or .npz, of the whole sweep
    Shard shard = {};  // the part that is made, on this machine; not a key

    void visit(SceneVisitor& v);
};
// The unit of an axis by its name, and its size in SI units; without a name the values choose it.
struct AxisUnit {
    std::string name = {};  // "kN"
    double si = 1;          // 1000
};
// Columns of a table over another one, in the figure "table".
struct PlottedTable {
    struct Column {
        std::string name, unit;
        bool prefixed = false;  // the unit is an SI unit that the values may give a prefix
        std::vector<double> values = {};
    };
    std::string file, x;
    std::vector<std::string> y = {};
    std::string label = {}, x_label = {}, unit = {}, x_unit = {};  // empty: those of the columns
    // Read from the file: x, then y.
    std::vector<Column> columns = {};
    std::string digest = {};
};
// A curve that is a sum of channels of one unit; channels without values add nothing.
struct SeriesSum {
    std::string label;
    std::vector<sim::Channel> plus = {}, minus = {};  // with `minus` it is a balance, drawn in black
};
// A panel of the figure "series": curves of one unit.
struct SeriesPanel {
    std::vector<sim::Channel> channels = {};
    std::vector<SeriesSum> sums = {};  // curves instead of the channels, of their unit
    bool logarithmic = false;
    std::optional<double> low = {}, high = {};  // of the vertical axis, in SI units
    std::vector<double> lines = {};             // horizontal, at these values of the vertical axis
    std::string label = {};                     // of the vertical axis, without unit; empty: the channels' symbols
    AxisUnit unit = {};
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
    std::string against = "t";                      // "t", "turns" of the cam, "frequency", or a channel
    std::optional<double> x_low = {}, x_high = {};  // ends of the abscissa; SI units or turns
    std::string x_label = {};                       // without unit; empty: the symbol
    AxisUnit x_unit = {};
    double from = 0;                                        // [s]
    std::optional<double> to = {};                          // [s]; nullopt: the end of the scene
    std::optional<Instant> from_event = {}, to_event = {};  // in place of `from` and `to`
    bool to_last = false;                                   // to the end of the scene, also in figures that end earlier
    std::vector<Compared> compare = {};                     // empty: only the motion of the scene
    bool apart = false;                                     // separate panels for each of them
    bool impacts = false;                                   // lines at the beginnings of impacts
    bool residuals = false;                                 // a panel of differences below each panel with data
    bool horizon = false;                                   // curves are paler where θ is not reproducible
    std::optional<double> height = {};                      // [m]; nullopt: suits the panels
    std::vector<SeriesNote> notes = {};
    std::optional<double> window = {}, highest = {};  // of a spectrogram [s], [Hz]; nullopt: suits the motion

    bool needs_events() const { return from_event || to_event; }
};
inline constexpr std::initializer_list<const char*> kFigureEndings{".pdf", ".svg", ".png"};
struct FigureOutput {
    static constexpr const char *kType = "figure",
                                *kMeaning = "A figure for print; `beamcam figure SCENE` lists all figures.";
    static constexpr OutputInputs kInputs{.title = true, .units = true, .data = true};
    std::string file;                 // of one of kFigureEndings
    std::string figure;               // its name, see figures/figure_types.hpp
    std::string title = {};           // markup; empty: that of the figure
    std::string column = "elsevier";  // of a journal, see render/plot/style.hpp
    std::optional<double> width;      // [m]; nullopt: that of the column
    Lang lang = Lang::en;
    double dpi = 300;    // of .png
    bool serif = false;  // serif font, as in LaTeX documents
    bool dark = false;   // dark theme, for slides
    SeriesKeys series;
    PlottedTable table = {};
    std::string value = {};               // column of a sweep's diagram; empty: default
    std::string data_file, caption_file;  // empty: none

    void visit(SceneVisitor& v);
};
using Output =
    std::variant<PictureOutput, FigureOutput, TrajectoryOutput, ImpactsOutput, StateOutput, SweepOutput, SummaryOutput>;

}  // namespace beamcam::scenes
