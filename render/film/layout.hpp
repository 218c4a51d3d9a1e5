// Where things stand in a film's frame, for any size: wide, square, tall, odd, tiny.
//
// Type and spacing scale with the frame but never below half of their full-size value, where text stops being
// readable; what then no longer fits is left out (panels first, then the lines of text) rather than overlapped.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "render/draw/geometry.hpp"
#include "render/film/view_extent.hpp"
#include "sim/observe/channels.hpp"

namespace beamcam::render {

// The kinds of panels, in the order of the reference. A new panel is a name in this list and one file, which defines
// its PanelType in a function of this name with "_panel" behind it.
#define BEAMCAM_PANELS(entry) entry(mechanism) entry(phase) entry(energy) entry(close_up) entry(traces) entry(strip)

#define BEAMCAM_PANEL_KIND(name) name,
enum class PanelKind { BEAMCAM_PANELS(BEAMCAM_PANEL_KIND) };
#undef BEAMCAM_PANEL_KIND

struct PanelSpec {
    PanelKind kind = PanelKind::mechanism;
    std::vector<sim::Channel> channels = {};  // of a strip: at least one, all of one unit
    std::optional<double> window = {};        // of a strip or the ledger: this much time [s]; absent: the whole film
    bool by_collision = false;                // of a strip: the time of one collision after the other
    int member = 0;                           // of the mechanism, the close-up, the ledger, the traces: which motion
    bool operator==(const PanelSpec&) const = default;
};

// A grid: a panel, or rows or columns of smaller grids that divide the room by their shares.
struct LayoutNode {
    enum class Kind { panel, rows, columns };
    Kind kind = Kind::panel;
    double share = 1;  // > 0, relative to its neighbours'
    PanelSpec panel = {};
    std::vector<LayoutNode> children = {};
};

// What stands around the panels, and the words within the mechanism. What is not shown leaves its room to the panels.
struct Shown {
    bool title = true, parameters = true, clock = true;
    bool legend = true;    // colour scales; what the picture exaggerates, how fast it runs
    bool accuracy = true;  // the line in the corner
    bool labels = true;    // angle, speed, force, scale bar
    bool logo = false;     // a picture in the clock's line
    double size = 1;       // of words, lines and marks, against those that suit the picture
    bool operator==(const Shown&) const = default;
};

struct PanelSlot {
    PanelSpec spec;
    Box box;  // title, labels and all; whole pixels
};

struct Layout {
    double unit = 1;           // [px] of one design pixel (1920×1080)
    double tick = 17;          // size of letters at axes and scales [px]
    std::optional<Box> title;  // line boxes; text stands on `baseline(box)`
    std::optional<Box> parameters;
    std::optional<Box> clock;   // with the pills; with these alone where the time is not shown
    std::optional<Box> scales;  // colour bars
    std::optional<Box> note;    // accuracy
    std::optional<Box> logo;    // beside the clock
    std::vector<PanelSlot> panels;

    const PanelSlot* first(PanelKind kind) const;
};

// Where the side panels of the standard arrangement stand: one above the other at the right, side by side below, or
// one above the other below.
enum class Arrangement { alone, column, row, stack };

// width, height >= 1. The standard arrangement: the mechanisms (one for each of `members` motions, or a single one
// with ghosts), and beside or below them as many of the `side` panels, the most important first, as stay readable:
// where that leaves the mechanisms the larger scale for their `extent`. Room that they do not need goes to the panels.
// The box of the parameters depends on size and `members` alone, so that what it holds is known before there is a
// motion.
Layout layout(int width, int height, const std::vector<PanelSpec>& side, int members = 1, const ViewExtent& extent = {},
              const Shown& shown = {});
// One of them; none where the picture is too small for it.
std::optional<Layout> arranged(Arrangement how, int width, int height, const std::vector<PanelSpec>& side, int members,
                               const ViewExtent& extent, const Shown& shown = {});
// Of the smallest mechanism [px/m]; 0 without one.
double scale_of(const Layout& layout, const ViewExtent& extent);
// The user's own grid; panels that come out too small to read are left out. In a tall picture the outermost columns
// become rows.
Layout layout(int width, int height, const LayoutNode& wanted, const Shown& shown = {});
// The panels of a grid in reading order; and those which come out too small.
std::vector<PanelSpec> panels_of(const LayoutNode& grid);
std::vector<PanelSpec> left_out(int width, int height, const LayoutNode& wanted, const Shown& shown = {});

// The axes within a plot's box: room for a heading, labels of size `tick` and the name of the time; whole pixels.
Box plot_area(const Box& box, double unit, double tick);

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
