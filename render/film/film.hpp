// A film: everything that its frames share is prepared once; then any frame can be drawn in any order with the same
// pixels. Memory does not grow with the number of frames drawn; data that a thread keeps between frames only save time.
//
// A frame is a grid of panels (panel.hpp) that share one instant, on a background that never changes. The mechanism is
// drawn as solid bodies with OpenGL (gl/bodies.hpp) or flat with Cairo; titles, charts and labels are always drawn with
// Cairo. Drawing neither simulates nor changes the simulated motion.
#pragma once

#include <algorithm>
#include <atomic>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "render/draw/color.hpp"
#include "render/draw/dirty_tiles.hpp"
#include "render/draw/geometry.hpp"
#include "render/draw/image.hpp"
#include "render/draw/vector_file.hpp"
#include "render/film/camera.hpp"
#include "render/film/layout.hpp"
#include "render/mechanism/exaggeration.hpp"
#include "render/plot/labels.hpp"
#include "render/plot/lang.hpp"
#include "render/plot/ticks.hpp"
#include "sim/observe/channels.hpp"
#include "sim/observe/pose.hpp"
#include "sim/problem/problem.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::render {

// lit: solid bodies, from the front; flat: a drawing; solid: the same bodies in perspective.
enum class Style { lit, flat, solid };

// Parts beside the panels. all: title, parameters, warning and labels, which are clock, colour scales, the letters of
// the mechanism and peaks; talk: title and labels; paper: labels; clean: none.
enum class Show { all, talk, paper, clean };

struct View {
    Style style = Style::lit;
    Theme theme = Theme::light;
    std::optional<double> exaggeration;       // factor of deflection, >= 1; absent: chosen automatically
    Shot shot = {};                           // at the start
    bool transparent = false;                 // without paper: the pictures have an alpha channel
    std::optional<std::uint32_t> paper = {};  // 0xrrggbb in place of the theme's
    Show show = Show::all;
    double text_scale = 1;  // of letters, lines and marks
    Lang lang = Lang::en;   // language of the picture's own text

    bool labelled() const { return show != Show::clean; }
    Shown shown() const {
        return {.title = show == Show::all || show == Show::talk,
                .parameters = show == Show::all,
                .labels = labelled(),
                .warning = show == Show::all,
                .size = text_scale};
    }
};

// One motion of one mechanism as a film shows it.
struct Motion {
    sim::Problem problem;
    std::string label;             // plain text; shown if the film has several motions
    std::vector<sim::Pose> poses;  // of each frame, not exaggerated, times not decreasing, at least one
    // Poses over the time that the film shows, in any order. Scales and camera are chosen from them, so that they do
    // not depend on the instants of the frames. Empty: the frames are used.
    std::vector<sim::Pose> survey;
    std::vector<sim::Pose> path;  // between frames that are far apart, for the path of the tip, times increasing
    sim::Table chart;             // t and the channels that the panels show, times increasing; any number of rows
    sim::Table trace;  // t, contact_x, contact_s, contact_force, finely sampled; rows with force > 0 are dots
    std::vector<sim::Impact> impacts;
    double end = std::numeric_limits<double>::infinity();  // later impacts are not among them [s]

    std::size_t frames() const { return poses.size(); }
    double time(std::size_t frame) const { return poses[frame].t; }
    const sim::Pose& pose(std::size_t frame) const { return poses[frame]; }
    std::size_t surveyed() const { return survey.empty() ? frames() : survey.size(); }
    const sim::Pose& surveyed(std::size_t k) const { return survey.empty() ? pose(k) : survey[k]; }
};

// Measured or external data: drawn over the charts of their channels, and as a straight beam if they contain θ.
struct FilmData {
    std::string label;                                                 // plain text
    bool line = false;                                                 // line in charts; otherwise points
    std::vector<double> t;                                             // [s], increasing
    std::vector<std::pair<sim::Channel, std::vector<double>>> values;  // SI units; NaN: none

    const std::vector<double>* find(sim::Channel channel) const {  // null: no such channel
        const auto found = std::ranges::find(values, channel, &std::pair<sim::Channel, std::vector<double>>::first);
        return found == values.end() ? nullptr : &found->second;
    }
};

// Several motions: each in its own mechanism panel, or all in one panel, those after the first as outlines.
enum class Comparison { panels, ghosts };

// A caption and the frames that show it, unless a later one begins.
struct Callout {
    int first = 0, last = 0;  // frames
    std::string text;         // plain, with formulas between dollars
    int fade = 0;             // frames of fading in, and of fading out

    bool shown(int frame) const { return first <= frame && frame <= last; }
    double opacity(int frame) const {
        return std::clamp((std::min(frame - first, last - frame) + 1.0) / (fade + 1.0), 0.0, 1.0);
    }
};

// Display units of angles and rotational speeds; SI otherwise.
struct Units {
    bool degrees = false;
    SpeedUnit speed = SpeedUnit::automatic;
    SpeedUnit speed_in_charts() const;  // automatic: as angles, per second
    // Factor from an SI unit to the one that is shown, and that one.
    double factor(const std::string& si) const;
    std::string unit(const std::string& si) const;
    bool operator==(const Units&) const = default;
};

struct FilmSetup : Motion {
    std::string title;                // plain text; cut before an ellipsis if too long
    double scene_end = 0;             // chooses the unit of a still's clock [s]
    int width = 1920, height = 1080;  // [px], 1…16384
    View view;
    Units units;
    std::optional<LayoutNode> layout;  // absent: the standard arrangement
    std::vector<Motion> others;        // motions to compare with, poses at the same instants
    Comparison comparison = Comparison::panels;
    double fps = 60;                // frames per second, > 0: fades have durations in seconds
    std::vector<double> speeds;     // playback speed at each frame, 1 = real time; empty: always 1
    std::vector<CameraMove> moves;  // sorted by arrival
    bool by_collision = false;      // the standard layout shows the latest collision
    std::vector<Callout> callouts;
    std::vector<FilmData> data;
    std::string warning;  // in the corner, plain text with formulas; may be empty
};

// The panels that the standard layout shows beside the mechanism.
std::vector<PanelSpec> standard_panels(const sim::Problem& problem, bool slow_motion);
// Channels that these panels read from Motion::chart, t first.
std::vector<sim::Channel> chart_channels(const std::vector<PanelSpec>& panels);

// Positions in a frame, for tests and for programs that compose frames.
struct FrameGeometry {
    Layout layout;
    Camera camera;
    DrawnBeam beam;
    std::vector<Box> texts;  // ink of every text [px]
};

// Counters of work done by all Films that share their prepared data.
struct DrawingCounts {
    std::atomic<long> font_sets = 0, gl_contexts = 0;
    std::atomic<long> bodies_drawn = 0;  // drawings by OpenGL, which are skipped while nothing moves
};

// Each thread uses its own Film; `for_thread` returns another one that shares the prepared data. Throws PictureError
// for an impossible size, factor or an empty film; FontError or GlError (exit code 5) if fonts or the renderer are
// missing.
class Film {
  public:
    explicit Film(FilmSetup setup);
    explicit Film(std::shared_ptr<const FilmSetup> setup);
    ~Film();
    Film(Film&&) noexcept;

    Film for_thread() const;

    int frames() const;
    // The frame equals the previous one, because time is frozen.
    bool repeats(int frame) const;
    // 0 <= frame < frames(). The picture is valid until the next one is drawn. Only parts that changed since the last
    // picture are redrawn; the pixels equal those of a full redraw.
    const Image& draw(int frame);
    const DirtyTiles& changed() const;  // where the last two pictures may differ; everything after the first
    void draw(int frame, Image& out);   // a copy; `out` is resized as needed
    // The same picture as a PDF or SVG; solid bodies are an image in it, with the pixels of the picture.
    std::string draw(int frame, Medium medium, const Document& document);
    FrameGeometry geometry(int frame);  // of the flat view: loads no OpenGL
    double exaggeration() const;
    bool exaggeration_reduced() const;  // below the requested factor, because the beam would enter the cam
    bool states_exaggeration() const;
    bool has_mechanism() const;
    bool shows_captions() const;
    bool shows_clock_line() const;                      // with exaggeration and speed
    const std::vector<std::string>& cut_texts() const;  // "the title", "names", "captions"
    int empty_frames() const;  // frames in which the first mechanism is outside the camera's view
    const DrawingCounts& counts() const;

  private:
    struct Prepared;
    struct FrameRenderer;
    explicit Film(std::shared_ptr<const Prepared> prepared);
    FrameRenderer& renderer_for(int frame);
    std::shared_ptr<const Prepared> prepared_;
    std::unique_ptr<FrameRenderer> renderer_;
};

}  // namespace beamcam::render
