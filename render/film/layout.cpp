#include "render/film/layout.hpp"

#include <algorithm>
#include <cmath>

namespace beamcam::render {
namespace {

constexpr double kSmallestUnit = 0.5;  // 16 design pixels of text are 8 px, the smallest readable size
// Size of axis labels: a fiftieth of the picture's height is readable from the back of a lecture room.
constexpr double kTickShare = 0.0204, kLeastTick = 17, kMostTick = 26;  // of the shorter side; [design px]

Box whole(const Box& b) {
    const double x = std::round(b.x), y = std::round(b.y);
    return {x, y, std::max(1.0, std::round(b.right()) - x), std::max(1.0, std::round(b.bottom()) - y)};
}

// Stacks as many panels into `area` as keep a readable height, each at most `highest` [design px].
void stack(Layout& out, const std::vector<PanelSpec>& specs, const Box& area, double highest = 440) {
    const double u = out.unit, gap = 14 * u;
    const auto room = static_cast<std::size_t>(std::max(0.0, (area.h + gap) / (215 * u + gap)));
    const std::size_t n = std::min(specs.size(), room);
    for (std::size_t i = 0; i < n; ++i) {
        const double h = std::min(highest * u, (area.h - gap * static_cast<double>(n - 1)) / static_cast<double>(n));
        out.panels.push_back({specs[i], {area.x, area.y + (h + gap) * static_cast<double>(i), area.w, h}});
    }
}

// Places as many panels side by side as keep a readable width.
void spread(Layout& out, const std::vector<PanelSpec>& specs, const Box& area) {
    const double u = out.unit, gap = 30 * u;
    const auto room = static_cast<std::size_t>(std::max(0.0, (area.w + gap) / (400 * u + gap)));
    const std::size_t n = std::min(specs.size(), room);
    for (std::size_t i = 0; i < n; ++i) {
        const double w = (area.w - gap * static_cast<double>(n - 1)) / static_cast<double>(n);
        out.panels.push_back({specs[i], {area.x + (w + gap) * static_cast<double>(i), area.y, w, area.h}});
    }
}

constexpr double kScales = 560;       // width of two colour scales [design px]
constexpr double kCaptionBand = 75;   // height: two lines of captions [design px]
constexpr int kSeveral = 3;           // from this number on mechanisms get the whole width below the title
constexpr double kPanelColumn = 540;  // width of the column of panels beside the mechanism [design px]
// Several mechanisms leave no space over in a very wide picture: charts get a fifth of it.
double panel_column(double w, double u, int members) {
    return std::max(kPanelColumn * u, members < kSeveral ? 0 : 0.2 * w);
}
bool has_column(double w, double h, double u) { return w >= 1150 * u && h >= 480 * u; }
// The most by which the column may grow if the mechanism does not need the space [px].
double widening(double w, double u) {
    return std::clamp(w - 1600 * u, 0.0, 200 * u) +
           0.6 * std::max(0.0, w - 2200 * u);  // very wide pictures: wide charts instead of empty space
}

// The parts around the panels, and the space that is left for the panels.
struct Frame {
    Layout out;
    double margin = 0, top = 0, bottom = 0, right = 0;
    bool wide = true;
};

// `beside`: panels may stand beside the header, whose lines must be short enough.
Frame frame(int width, int height, bool beside, const Shown& shown) {
    Frame f;
    Layout& out = f.out;
    f.wide = width >= 1.4 * height;
    out.unit = shown.size * std::max(kSmallestUnit, f.wide ? std::min(width / 1920.0, height / 1080.0)
                                                           : std::min(width, height) / 1240.0);
    const double u = out.unit, w = width, h = height;
    out.tick = std::clamp(shown.size * kTickShare * std::min(w, h), kLeastTick * u, kMostTick * u);
    const double margin = f.margin = std::min(64 * u, 0.04 * std::min(w, h) + 12 * u);
    f.top = margin * 0.8, f.bottom = h - margin * 0.7, f.right = w - margin;

    const bool has_title = shown.title && w >= 320 * u && h >= 300 * u,
               has_parameters = shown.parameters && w >= 560 * u && h >= 480 * u;
    const bool has_clock = (shown.clock || shown.legend || shown.logo) && w >= 230 * u && h >= 190 * u;
    const bool is_large = w >= (f.wide ? 1150 : 660) * u && h >= 600 * u, has_scales = shown.legend && is_large;
    if (has_title) {
        out.title = Box{margin, f.top, w - 2 * margin, 54 * u};
        f.top += 54 * u;
    }
    if (has_parameters) {
        const double column = beside && f.wide && has_column(w, h, u) ? kPanelColumn * u + widening(w, u) + 40 * u : 0;
        out.parameters = Box{margin, f.top, w - 2 * margin - column, 36 * u};
        f.top += 36 * u;
    }
    if (shown.accuracy && is_large) {
        out.note = Box{margin, f.bottom - 26 * u, w - 2 * margin, 26 * u};
        f.bottom -= 34 * u;
    }
    const bool apart = has_scales && !f.wide;  // beside the clock there is not enough space
    if (apart) {
        out.scales = Box{w - margin - kScales * u, f.bottom - 56 * u, kScales * u, 56 * u};
        f.bottom -= 64 * u;
    }
    if (has_clock) {
        out.clock = Box{margin, f.bottom - 56 * u, w - 2 * margin, 56 * u};
        f.bottom -= 56 * u;
    }
    if (has_scales && !apart) {
        out.scales = Box{w - margin - kScales * u, out.clock->y, kScales * u, 56 * u};
        out.clock->w = out.scales->x - 30 * u - out.clock->x;
    }
    if (has_title || has_parameters) f.top += 10 * u;
    if (has_clock) f.bottom -= 10 * u;
    if (shown.captions) {
        out.captions = Box{margin, f.bottom - kCaptionBand * u, w - 2 * margin, kCaptionBand * u};
        f.bottom -= (kCaptionBand + 10) * u;
    }
    return f;
}

void place_grid(Layout& out, const LayoutNode& node, const Box& box);

// The children of a grid without those that are too small to read, removed from the last on; the others share the
// space.
std::vector<LayoutNode> children_that_fit(double unit, const LayoutNode& node, const Box& box) {
    const bool rows = node.kind == LayoutNode::Kind::rows;
    std::vector<LayoutNode> children = node.children;
    for (;;) {
        const double gap = (rows ? 14 : 30) * unit, n = static_cast<double>(children.size());
        const double room = (rows ? box.h : box.w) - gap * (n - 1);
        double shares = 0;
        for (const LayoutNode& child : children) shares += child.share;
        const auto narrow = std::find_if(children.rbegin(), children.rend(), [&](const LayoutNode& child) {
            const double size = room * child.share / shares;
            Layout alone;
            alone.unit = unit;
            place_grid(alone, child, {0, 0, rows ? box.w : size, rows ? size : box.h});
            return alone.panels.empty();
        });
        if (narrow == children.rend() || children.size() == 1) return children;
        children.erase(std::next(narrow).base());
    }
}

void place_grid(Layout& out, const LayoutNode& node, const Box& box) {
    if (node.kind == LayoutNode::Kind::panel) {
        const Vec2 least = type_of(node.panel.kind).smallest;
        if (box.w >= least.x * out.unit && box.h >= least.y * out.unit) out.panels.push_back({node.panel, whole(box)});
        return;
    }
    const bool rows = node.kind == LayoutNode::Kind::rows;
    const std::vector<LayoutNode> children = children_that_fit(out.unit, node, box);
    const double gap = (rows ? 14 : 30) * out.unit, n = static_cast<double>(children.size());
    const double room = (rows ? box.h : box.w) - gap * (n - 1);
    if (!(room > 0)) return;
    double shares = 0, at = rows ? box.y : box.x;
    for (const LayoutNode& child : children) shares += child.share;
    for (const LayoutNode& child : children) {
        const double size = room * child.share / shares;
        place_grid(out, child, rows ? Box{box.x, at, box.w, size} : Box{at, box.y, size, box.h});
        at += size + gap;
    }
}

// ---- the standard layout -----------------------------------------------------------------------

// Equal cells for mechanisms beside and above each other.
struct CellGrid {
    int columns = 1, rows = 1;
    double w = 0, h = 0;                               // whole pixels
    static constexpr double kAcross = 30, kDown = 14;  // gaps [design px]
};

CellGrid cells(const Box& box, int count, int columns, double u) {
    CellGrid out{columns, (count + columns - 1) / columns};
    out.w = std::floor((box.w - CellGrid::kAcross * u * (out.columns - 1)) / out.columns);
    out.h = std::floor((box.h - CellGrid::kDown * u * (out.rows - 1)) / out.rows);
    return out;
}

double scale_in(const CellGrid& c, const ViewExtent& extent, double u) {
    return extent.camera({0, 0, c.w, c.h}, u).scale;
}

// The grid of at most `count` cells that gives mechanisms the largest scale, or nearly so with fewer empty cells;
// reduces `count` to what fits.
CellGrid best_cells(const Box& box, int& count, const ViewExtent& extent, double u) {
    constexpr double kNearly = 0.9;
    const Vec2 least = type_of(PanelKind::mechanism).smallest * u;
    for (; count > 1; --count) {
        const auto empty = [&](const CellGrid& grid) { return grid.columns * grid.rows - count; };
        std::optional<CellGrid> best;
        for (int columns = count; columns >= 1; --columns) {
            const CellGrid one = cells(box, count, columns, u);
            if (one.w < least.x || one.h < least.y) continue;
            const double scale = scale_in(one, extent, u), before = best ? scale_in(*best, extent, u) : 0;
            const bool fuller = best && empty(one) < empty(*best) && scale > kNearly * before;
            const bool emptier = best && empty(one) > empty(*best) && scale < before / kNearly;
            if (fuller || (scale > before && !emptier)) best = one;
        }
        if (best) return *best;
    }
    return cells(box, 1, 1, u);
}

void place_mechanisms(Layout& out, const Box& box, int members, const ViewExtent& extent) {
    const double u = out.unit;
    if (members == 1) {
        out.panels.insert(out.panels.begin(), {{.kind = PanelKind::mechanism}, whole(box)});
        return;
    }
    const CellGrid c = best_cells(box, members, extent, u);
    std::vector<PanelSlot> slots;
    for (int i = 0; i < members; ++i) {
        const double x = box.x + (c.w + CellGrid::kAcross * u) * (i % c.columns),
                     y = box.y + (c.h + CellGrid::kDown * u) * std::floor(static_cast<double>(i) / c.columns);
        slots.push_back({{.kind = PanelKind::mechanism, .member = i},
                         {std::round(x), std::round(y), std::max(1.0, c.w), std::max(1.0, c.h)}});
    }
    out.panels.insert(out.panels.begin(), slots.begin(), slots.end());
}

// Width and height of the box that the mechanisms do not need [px].
Vec2 spare(const Box& box, int members, const ViewExtent& extent, double u) {
    const CellGrid c = best_cells(box, members, extent, u);
    const Vec2 used = extent.room({0, 0, c.w, c.h}, u);
    return {std::max(0.0, (c.w - used.x) * c.columns), std::max(0.0, (c.h - used.y) * c.rows)};
}

// From kSeveral on mechanisms get at least this share of the scale that they would have without charts.
constexpr double kKept = 0.6;

// The part of the unused space that panels get; the rest is for labels and arrows around the mechanism.
double for_panels(double spare, double most) { return std::min(0.6 * spare, most); }

}  // namespace

const PanelSlot* Layout::first(PanelKind kind) const {
    const auto at = std::ranges::find_if(panels, [&](const PanelSlot& s) { return s.spec.kind == kind; });
    return at == panels.end() ? nullptr : &*at;
}

Box plot_area(const Box& box, double u, double tick) {
    const double more = tick - kLeastTick * u, left = 70 * u + 2.4 * more, below = 44 * u + more;
    return whole({box.x + left, box.y + 46 * u, box.w - left - 8 * u, box.h - 46 * u - below});
}

std::optional<Layout> arranged(Arrangement how, int width, int height, const std::vector<PanelSpec>& side, int members,
                               const ViewExtent& extent, const Shown& shown) {
    const bool beside = members < kSeveral;
    Frame f = frame(width, height, beside, shown);
    Layout& out = f.out;
    const double u = out.unit, w = width, h = height;
    Box room{f.margin, f.top, f.right - f.margin, f.bottom - f.top};
    const double lower = std::min(0.62 * room.h, 3 * 330 * u);  // height of a stack
    switch (how) {
        case Arrangement::alone:
            break;
        case Arrangement::column: {
            if (!has_column(w, h, u)) return {};
            Box left = room;
            left.w -= panel_column(w, u, members) + 40 * u;
            const double column =
                panel_column(w, u, members) + for_panels(spare(left, members, extent, u).x, widening(w, u));
            // In wide pictures, which lack height, the column starts beside the title.
            const double top = f.wide && beside ? f.margin * 0.8 : f.top;
            const double highest = (f.wide ? 440 : 660) / std::min(1.0, shown.size);
            stack(out, side, {f.right - column, top, column, f.bottom - top - 6 * u}, highest);
            room.w -= column + 40 * u;
            if (f.wide && beside && out.title) out.title->w = room.right() - out.title->x;
            break;
        }
        case Arrangement::row: {
            if (w < 420 * u || room.h < 620 * u) return {};
            Box above = room;
            above.h -= 320 * u;
            const double row = 300 * u + for_panels(spare(above, members, extent, u).y, 140 * u);
            spread(out, side, {room.x, room.bottom() - row, room.w, row});
            room.h -= row + 20 * u;
            break;
        }
        case Arrangement::stack: {
            if (w < 420 * u || room.h < 620 * u) return {};
            stack(out, side, {room.x, room.bottom() - lower, room.w, lower});
            if (out.panels.empty()) return {};
            // As high as the number of panels needs, plus space that the mechanisms do not need.
            const double n = static_cast<double>(out.panels.size());
            double used = out.panels.back().box.bottom() - out.panels.front().box.y;
            Box above = room;
            above.h -= used + 20 * u;
            used +=
                for_panels(spare(above, members, extent, u).y, std::max(0.0, n * 440 * u + (n - 1) * 14 * u - used));
            const std::vector<PanelSpec> fitting(side.begin(), side.begin() + static_cast<std::ptrdiff_t>(n));
            out.panels.clear();
            stack(out, fitting, {room.x, room.bottom() - used, room.w, used});
            room.h -= used + 20 * u;
            break;
        }
    }
    if (out.panels.empty() && how != Arrangement::alone) return {};
    if (room.w < 8 || room.h < 8) room = {0, 0, w, h};
    place_mechanisms(out, room, members, extent);
    return std::move(f.out);
}

double scale_of(const Layout& layout, const ViewExtent& extent) {
    double least = 0;
    for (const PanelSlot& slot : layout.panels) {
        if (slot.spec.kind != PanelKind::mechanism) continue;
        const double scale = extent.camera(slot.box, layout.unit).scale;
        least = least > 0 ? std::min(least, scale) : scale;
    }
    return least;
}

Layout layout(int width, int height, const std::vector<PanelSpec>& side, int members, const ViewExtent& extent,
              const Shown& shown) {
    using enum Arrangement;
    const bool wide = width >= 1.4 * height, tall = height > 1.35 * width;
    std::optional<Layout> best;
    Layout without = *arranged(alone, width, height, side, members, extent, shown);
    const double least = members < kSeveral ? 0 : kKept * scale_of(without, extent);
    for (Arrangement how : wide   ? std::vector{column, row}
                           : tall ? std::vector{stack, column}
                                  : std::vector{row, column}) {
        std::optional<Layout> one = arranged(how, width, height, side, members, extent, shown);
        if (!one || scale_of(*one, extent) < least) continue;
        if (!best || scale_of(*one, extent) > scale_of(*best, extent)) best = std::move(one);
    }
    return best ? *std::move(best) : without;
}

Layout layout(int width, int height, const LayoutNode& user_grid, const Shown& shown) {
    Frame f = frame(width, height, false, shown);
    LayoutNode grid = user_grid;
    // Columns of a wide picture become rows in a portrait one.
    if (grid.kind == LayoutNode::Kind::columns && height > 1.35 * width) {
        grid.kind = LayoutNode::Kind::rows;
        // A stack of three panels needs a larger share of the height than of the width.
        for (LayoutNode& child : grid.children)
            if (child.kind == LayoutNode::Kind::rows)
                child.share *= std::max(1.0, 0.7 * static_cast<double>(child.children.size()));
    }
    place_grid(f.out, grid, {f.margin, f.top, f.right - f.margin, f.bottom - f.top});
    // A picture too small for any panel of the grid shows the mechanism.
    if (f.out.panels.empty()) return layout(width, height, std::vector<PanelSpec>{}, 1, {}, shown);
    return std::move(f.out);
}

std::vector<PanelSpec> panels_of(const LayoutNode& grid) {
    if (grid.kind == LayoutNode::Kind::panel) return {grid.panel};
    std::vector<PanelSpec> out;
    for (const LayoutNode& child : grid.children)
        for (PanelSpec& spec : panels_of(child)) out.push_back(std::move(spec));
    return out;
}

std::vector<PanelSpec> omitted_panels(int width, int height, const LayoutNode& user_grid, const Shown& shown) {
    std::vector<PanelSpec> out = panels_of(user_grid);
    for (const PanelSlot& slot : layout(width, height, user_grid, shown).panels)
        if (const auto placed = std::ranges::find(out, slot.spec); placed != out.end()) out.erase(placed);
    return out;
}

}  // namespace beamcam::render
