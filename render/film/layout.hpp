// The layout of a frame of any size: wide, square, portrait, odd or tiny.
//
// Letters and spacing scale with the frame down to half of their full size, below which text is not readable. Parts
// that do not fit then are left out (panels first, then lines of text); nothing overlaps.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "render/draw/geometry.hpp"
#include "sim/observe/channels.hpp"

namespace beamcam::render {

inline constexpr double kReadable = 9;  // smallest size of letters in any picture [px]

// The kinds of panels, in the order of the reference. A new panel is a name in this list and one file, which defines
// its PanelType in a function of this name with "_panel" behind it.
#define BEAMCAM_PANELS(entry) entry(mechanism) entry(overview) entry(phase) entry(energy) entry(close_up) entry(strip)

#define BEAMCAM_PANEL_KIND(name) name,
enum class PanelKind { BEAMCAM_PANELS(BEAMCAM_PANEL_KIND) };
#undef BEAMCAM_PANEL_KIND

struct PanelSpec {
    PanelKind kind = PanelKind::mechanism;
    std::vector<sim::Channel> channels = {};  // strip: at least one, all of one unit
    std::optional<double> window = {};        // strip, energy: duration of a moving window [s]; absent: the whole film
    bool by_collision = false;                // strip: show one collision after the other
    int member = 0;                           // mechanism, overview, close-up, energy: index of the motion
    bool operator==(const PanelSpec&) const = default;
};

// A chart of the contact force alone, in which the peaks of collisions have their values and compared motions a row
// each.
inline bool shows_peaks(const PanelSpec& spec) {
    return spec.kind == PanelKind::strip &&
           spec.channels == std::vector<sim::Channel>{{sim::ChannelKind::contact_force, 0}};
}

// A grid: a panel, rows or columns of smaller grids that divide the space by their shares, or nothing.
struct LayoutNode {
    enum class Kind { panel, rows, columns, empty };
    Kind kind = Kind::panel;
    double share = 1;  // > 0, relative to its siblings
    PanelSpec panel = {};
    std::vector<LayoutNode> children = {};
};

// Visible parts around the panels. The panels take the space of hidden parts.
struct Shown {
    bool title = true, parameters = true;
    bool labels = true;     // clock, colour scale, exaggeration, playback speed
    bool warning = true;    // of a motion that leaves its model, in the corner
    bool captions = false;  // texts of events, in a band below the panels
    double size = 1;        // scale factor of letters, lines and marks
    bool moment = true;     // the beam has the colours of its bending moment
};

// The three sizes of letters in a picture [px]: 34, 20 and 16 in one of 1280×720, with half as much again in a
// portrait.
struct Letters {
    double title = 51;    // and the clock
    double heading = 30;  // of panels, readings, names of motions
    double words = 24;    // all others
};

struct PanelSlot {
    PanelSpec spec;
    Box box;  // heading and axis labels included; whole pixels
};

struct Layout {
    double unit = 1;  // [px] of one design pixel (1920×1080)
    Letters letters;
    std::optional<Box> title;  // boxes of lines of text
    std::optional<Box> parameters;
    std::optional<Box> clock;  // and exaggeration and speed beside it
    std::optional<Box> scale;  // of the bending moment
    std::optional<Box> warning;
    std::optional<Box> captions;  // texts of events
    std::vector<PanelSlot> panels;

    const PanelSlot* first(PanelKind kind) const;
};

// The standard grid: the mechanisms, one for each of `members` motions or a single one with ghosts, and the `side`
// panels, the most important first: beside up to two mechanisms in a wide picture, else below them.
LayoutNode standard_grid(int width, int height, const std::vector<PanelSpec>& side, int members = 1);
// The layout of a picture, width, height >= 1, without the panels that are too small to read. In a portrait picture
// columns become rows, but those of more than three mechanisms.
Layout layout(int width, int height, const LayoutNode& grid, const Shown& shown = {});
// All panels of a grid in reading order; those that are too small to read.
std::vector<PanelSpec> panels_of(const LayoutNode& grid);
std::vector<PanelSpec> omitted_panels(int width, int height, const LayoutNode& grid, const Shown& shown = {});

// The rectangle of the axes in a panel's box, which leaves space for heading and axis labels of size `words`; whole
// pixels.
Box plot_area(const Box& box, double unit, double words);

// ---- kinds of panels ---------------------------------------------------------------------------

class FilmPanel;
struct FilmContext;

// Everything that layouts, scenes and films need to know about a kind of panel.
struct PanelType {
    PanelKind kind;
    const char* name;  // in scenes
    Vec2 smallest;     // smallest useful size [design px]
    std::unique_ptr<FilmPanel> (*make)(const FilmContext& context, const PanelSlot& slot);
    std::vector<sim::ChannelKind> channels = {};  // that it reads from Motion::chart, beside those that scenes name
    bool draws_curve = false;                     // plots the second of `channels` against the first
    bool takes_channels = false;                  // accepts the keys "channels", …
    bool takes_window = false;                    // … "window" with a duration, …
    bool takes_collisions = false;                // … or with "collision"
    bool needs_cam = false;
};
const std::vector<PanelType>& panel_types();
const PanelType& type_of(PanelKind kind);

}  // namespace beamcam::render
