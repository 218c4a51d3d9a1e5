// A film: everything that a sequence of frames shares is prepared once, then any frame can be drawn in any order
// with the same pixels. Nothing grows with the number of frames drawn; what a drawing thread keeps from one frame to
// the next only saves time.
//
// A frame is a grid of panels (panel.hpp) that share one instant, on a background that never changes. The mechanism is
// drawn lit through OpenGL (lit.hpp) or flat with Cairo alone; titles, charts and labels are Cairo's in both. Drawing
// never changes what was simulated and never simulates.
#pragma once

#include <algorithm>
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "render/draw/color.hpp"
#include "render/draw/dirty_tiles.hpp"
#include "render/draw/geometry.hpp"
#include "render/draw/image.hpp"
#include "render/film/camera.hpp"
#include "render/film/layout.hpp"
#include "render/mechanism/exaggeration.hpp"
#include "render/plot/lang.hpp"
#include "render/plot/ticks.hpp"
#include "sim/observe/channels.hpp"
#include "sim/observe/pose.hpp"
#include "sim/problem/problem.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::render {

// lit: shaded, from the front; flat: a drawing; solid: bodies in perspective.
enum class Style { lit, flat, solid };

// What colours the trace of the contact on the disc: the largest force so far, or how long ago the last touch was.
enum class TraceColor { force, age };

// What is drawn of a picture, at its place in the whole: layers of transparent films lie over each other as if they
// were one. charts: all but the mechanism's panels.
enum class LayerOf { all, mechanism, charts };

struct View {
    Style style = Style::lit;
    Theme theme = Theme::light;
    std::optional<double> exaggeration;  // of deflection, >= 1; absent: a round factor that shows it
    Shot shot = {};                      // until the camera moves
    double swing = 0;  // of the solid view: over the film its yaw goes once to either side and back [rad], within ±1.2
    TraceColor trace = TraceColor::force;
    bool tip_path = false;                    // all of the tip's path so far, not only its last second
    bool transparent = false;                 // no paper: the pictures have an alpha channel
    std::optional<std::uint32_t> paper = {};  // 0xrrggbb in place of the theme's
    OwnColors colors = {};
    Shown show = {};
    LayerOf layer = LayerOf::all;
    bool strobe = false;   // other exposures are shown faintly under the beam; else all are blended into one
    Lang lang = Lang::en;  // of what the picture says of itself
};

// Poses kept elsewhere than in memory, read by several threads at once.
class PoseStore {
  public:
    virtual ~PoseStore() = default;
    virtual std::size_t size() const = 0;
    virtual double time(std::size_t frame) const = 0;  // of its pose [s]
    virtual sim::Pose pose(std::size_t frame) const = 0;
};

// One run of one mechanism as a film shows it.
struct Motion {
    sim::Problem problem;
    std::string label;                        // plain text; told where several motions stand beside each other
    std::vector<sim::Pose> poses;             // of each frame, true geometry, times not decreasing, at least one
    std::shared_ptr<const PoseStore> stored;  // in place of `poses`
    std::size_t exposures = 1;                // poses of a frame: at its instant, then the others that it shows
    // The motion over the time that the film shows, in any order: what scales and camera are chosen by, so that they do
    // not depend on which instants the frames happen to be of. Absent: the frames.
    std::shared_ptr<const PoseStore> survey;
    sim::Table chart;  // t and the channels that the panels show, times increasing; any number of rows
    sim::Table trace;  // t, contact_x, contact_s, contact_force, finely sampled; rows with force > 0 are dots
    std::vector<sim::Impact> impacts;
    std::vector<Range> unreliable;  // within them θ is not reproducible, and curves are paler [s]

    bool is_reliable(double t) const {
        return std::ranges::none_of(unreliable, [t](const Range& r) { return t > r.low && t <= r.high; });
    }
    std::size_t frames() const { return (stored ? stored->size() : poses.size()) / exposures; }
    double time(std::size_t frame) const {
        return stored ? stored->time(frame * exposures) : poses[frame * exposures].t;
    }
    sim::Pose pose(std::size_t frame, std::size_t exposure = 0) const {
        const std::size_t at = frame * exposures + exposure;
        return stored ? stored->pose(at) : poses[at];
    }
    std::size_t surveyed() const { return survey ? survey->size() : frames(); }
    sim::Pose surveyed(std::size_t k) const { return survey ? survey->pose(k) : pose(k); }
};

// Measured or foreign data of the first motion: over the charts of its channels, and a straight beam where it has θ.
struct FilmData {
    std::string label;                                                 // plain text
    bool line = false;                                                 // in charts; else points
    std::vector<double> t;                                             // [s], increasing
    std::vector<std::pair<sim::Channel, std::vector<double>>> values;  // SI units; NaN: none

    const std::vector<double>* find(sim::Channel channel) const {  // null: it has none
        const auto found = std::ranges::find(values, channel, &std::pair<sim::Channel, std::vector<double>>::first);
        return found == values.end() ? nullptr : &found->second;
    }
};

// Several motions: each in a mechanism of its own, or all in one, those after the first as outlines.
enum class Comparison { panels, ghosts };

// Words while these frames are shown.
struct Callout {
    int first = 0, last = 0;            // frames
    std::string text;                   // plain, with formulas between dollars
    std::optional<Anchor> anchor = {};  // what they belong to; absent: the contact; all: the whole picture
    int fade = 0;                       // frames in which they come, and go

    bool shown(int frame) const { return first <= frame && frame <= last; }
    double opacity(int frame) const {
        return std::clamp((std::min(frame - first, last - frame) + 1.0) / (fade + 1.0), 0.0, 1.0);
    }
};

// What angles and speeds of rotation are written in; SI otherwise.
struct Units {
    bool degrees = false, rpm = false;
    bool operator==(const Units&) const = default;
};

struct FilmSetup : Motion {
    std::string title;                // plain text; on two lines when long, cut with an ellipsis when too long
    int width = 1920, height = 1080;  // [px], 1…16384
    View view;
    Units units;
    int digits = 3;                    // of the cam's speed
    std::optional<LayoutNode> layout;  // absent: the standard arrangement
    std::vector<Motion> others;        // to compare with, poses at the same instants
    Comparison comparison = Comparison::panels;
    double fps = 60;                // frames a second that it is shown at, > 0: what fades does so by the clock
    std::vector<double> speeds;     // of time at each frame, 1: as it is; empty: always 1
    std::vector<CameraMove> moves;  // by when they arrive
    bool slow_motion = false;       // the standard arrangement shows collisions one by one
    std::vector<Callout> callouts;
    std::vector<FilmData> data;
    std::string accuracy_note;          // plain text in the corner; may be empty
    std::shared_ptr<const Image> logo;  // at the right end of the clock's line; null: none
};

// The panels of the standard arrangement beside the mechanism, and what their charts need.
std::vector<PanelSpec> standard_panels(const sim::Problem& problem, bool slow_motion);
// Channels that these panels read from Motion::chart, t first.
std::vector<sim::Channel> chart_channels(const std::vector<PanelSpec>& panels);

// What a frame shows, for tests and for programs that compose frames.
struct FrameGeometry {
    Layout layout;
    Camera camera;
    double factor = 1;  // of exaggeration
    DrawnBeam beam;
    std::vector<Box> texts;  // ink of every text [px]
    // Of the first mechanism [px]: which motion it is, the scale bar; its angle, speed and force.
    std::vector<Box> words, labels;
};

// What drawing has loaded and drawn so far, in all Films that share what is prepared.
struct DrawingCounts {
    std::atomic<long> font_sets = 0, gl_contexts = 0;
    std::atomic<long> mechanisms_lit = 0;  // by OpenGL: not again while nothing of it moves
    std::atomic<double> read_back = 0;     // from OpenGL [s]
};

// One Film a thread; `another` shares all that is prepared. Throws PictureError for an impossible size, factor or an
// empty film; FontError and GlError (exit code 5) when fonts or the lit renderer are missing.
class Film {
  public:
    explicit Film(FilmSetup setup);
    explicit Film(std::shared_ptr<const FilmSetup> setup);
    ~Film();
    Film(Film&&) noexcept;
    Film& operator=(Film&&) noexcept;

    Film another() const;

    int frames() const;
    // The frame shows what the one before shows: time stands still.
    bool repeats(int frame) const;
    // 0 <= frame < frames(). The picture is valid until the next one is drawn. Only parts that changed since the last
    // picture are redrawn; the pixels equal those of a full redraw.
    const Image& draw(int frame);
    const DirtyTiles& changed() const;  // where the last picture may differ from the one before; all of the first
    void draw(int frame, Image& out);   // a copy; `out` is resized as needed
    FrameGeometry geometry(int frame);  // of the flat view: loads no OpenGL
    double exaggeration() const;
    bool yields() const;       // less than wanted, since the beam would enter the cam
    bool cuts_title() const;   // it ends with an ellipsis, for want of room
    int empty_frames() const;  // in which the camera of the first mechanism sees no part of it
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
