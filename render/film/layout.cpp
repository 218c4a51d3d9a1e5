#include "render/film/layout.hpp"

#include <algorithm>
#include <cmath>

namespace beamcam::render {
namespace {

constexpr double kSmallestUnit = 0.5;  // gaps do not become smaller in smaller pictures [px]
constexpr double kTightWords = 17;     // letters for which the margins of plots are stated below [design px]

Letters letters_of(double design_pixel) {
    const double words = std::max(kReadable, 24 * design_pixel);
    return {34 / 16.0 * words, 20 / 16.0 * words, words};
}

constexpr int kMostInColumn = 3;                           // mechanisms of a portrait picture
constexpr double kCaptionBand = 48;                        // height [design px]
constexpr double kBetweenRows = 24, kBetweenColumns = 30;  // [design px]

// Wide pictures have charts beside the mechanism.
bool is_wide(int width, int height) { return width >= 1.4 * height; }
bool is_tall(int width, int height) { return height > 1.35 * width; }

// The box in whole pixels, at least one in each direction.
Box whole(const Box& b) {
    const double x = std::round(b.x), y = std::round(b.y);
    return {x, y, std::max(1.0, std::round(b.right()) - x), std::max(1.0, std::round(b.bottom()) - y)};
}

// What surrounds the panels of a picture: title, parameters, notes, clock, scales and captions.
struct PictureFrame {
    Layout out;                                         // without panels
    double margin = 0, top = 0, bottom = 0, right = 0;  // of the space that is left for panels [px]
};

PictureFrame picture_frame(int width, int height, const Shown& shown) {
    PictureFrame f;
    Layout& out = f.out;
    const bool wide = is_wide(width, height);
    const double design_pixel = wide                     ? std::min(width / 1920.0, height / 1080.0)
                                : is_tall(width, height) ? width / 720.0  // it is seen smaller
                                                         : std::min(width, height) / 1080.0;
    out.letters = letters_of(shown.size * design_pixel);
    out.unit = shown.size * std::max(kSmallestUnit, (wide ? 1 : 1080 / 1240.0) * design_pixel);
    const double u = out.unit, w = width, h = height;
    const double margin = f.margin = std::min(64 * u, 0.04 * std::min(w, h) + 12 * u);
    f.top = margin * 0.8, f.bottom = h - margin * 0.7, f.right = w - margin;

    const bool has_title = shown.title && w >= 320 * u && h >= 300 * u,
               has_parameters = shown.parameters && w >= 560 * u && h >= 500;
    const bool has_clock = shown.labels && w >= 230 * u && h >= 190 * u;
    const bool is_large = w >= (wide ? 1200 : 820) * u && h >= 640 * u,
               has_scale = shown.labels && shown.moment && is_large;
    const double scale = std::max(250 * u, 14 * out.letters.words);  // width
    if (has_title) {
        out.title = Box{margin, f.top, w - 2 * margin, 64 * u};
        f.top += 64 * u;
    }
    if (has_parameters) {
        out.parameters =
            Box{margin, f.top, w - 2 * margin, (is_tall(width, height) ? 72 : 40) * u};  // two lines or one
        f.top += out.parameters->h;
    }
    if (shown.warning && is_large) {
        out.warning = Box{margin, f.bottom - 26 * u, w - 2 * margin, 26 * u};
        f.bottom -= 40 * u;
    }
    const bool apart = has_scale && w < 50 * out.letters.words;  // beside the clock there is not enough space
    if (apart) {
        out.scale = Box{w - margin - scale, f.bottom - 56 * u, scale, 56 * u};
        f.bottom -= 64 * u;
    }
    if (has_clock) {
        out.clock = Box{margin, f.bottom - 56 * u, w - 2 * margin, 56 * u};
        f.bottom -= 56 * u;
    }
    if (has_scale && !apart) {
        out.scale = Box{w - margin - scale, out.clock->y, scale, 56 * u};
        out.clock->w = out.scale->x - 30 * u - out.clock->x;
    }
    if (has_title || has_parameters) f.top += 0.8 * out.letters.words;
    if (has_clock) f.bottom -= 1.3 * out.letters.words;
    if (shown.captions && w >= 230 * u && h >= 190 * u) {
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
        const double gap = (rows ? kBetweenRows : kBetweenColumns) * unit, n = static_cast<double>(children.size());
        const double room = (rows ? box.h : box.w) - gap * (n - 1);
        double shares = 0;
        for (const LayoutNode& child : children) shares += child.share;
        const auto narrow = std::find_if(children.rbegin(), children.rend(), [&](const LayoutNode& child) {
            const double size = room * child.share / shares;
            Layout alone;
            alone.unit = unit;
            place_grid(alone, child, {0, 0, rows ? box.w : size, rows ? size : box.h});
            return child.kind != LayoutNode::Kind::empty && alone.panels.empty();
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
    if (node.kind == LayoutNode::Kind::empty) return;
    const bool rows = node.kind == LayoutNode::Kind::rows;
    const std::vector<LayoutNode> children = children_that_fit(out.unit, node, box);
    const double gap = (rows ? kBetweenRows : kBetweenColumns) * out.unit, n = static_cast<double>(children.size());
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

}  // namespace

const PanelSlot* Layout::first(PanelKind kind) const {
    const auto at = std::ranges::find_if(panels, [&](const PanelSlot& s) { return s.spec.kind == kind; });
    return at == panels.end() ? nullptr : &*at;
}

Box plot_area(const Box& box, double u, double words) {
    const double more = words - kTightWords * u, left = 70 * u + 2.4 * more, below = 44 * u + more;
    return whole({box.x + left, box.y + 46 * u, box.w - left - 8 * u, box.h - 46 * u - below});
}

LayoutNode standard_grid(int width, int height, const std::vector<PanelSpec>& side, int members) {
    using enum LayoutNode::Kind;
    constexpr int kRowOfMechanisms = 3;  // from this number on mechanisms have the whole width
    constexpr double kBesideCharts = 1.55, kAboveRow = 1.4, kRowAboveRow = 1.1;  // shares of the mechanisms
    const bool beside = is_wide(width, height) && members < kRowOfMechanisms, tall = is_tall(width, height);
    LayoutNode charts{.kind = beside || tall ? rows : columns};
    // A chart in which each motion has a row is higher than others.
    for (const PanelSpec& spec : side)
        charts.children.push_back(
            {.share = charts.kind == rows && shows_peaks(spec) ? 0.5 + 0.5 * members : 1, .panel = spec});
    const double above_charts = std::min(1.3, 2.6 / static_cast<double>(side.size()));
    const double share = beside                       ? kBesideCharts
                         : tall                       ? above_charts
                         : members < kRowOfMechanisms ? kAboveRow
                                                      : kRowAboveRow;
    // Cells of mechanisms are about as wide as high.
    const double part = side.empty() ? 1 : share / (share + 1),
                 shape = beside ? part * width / height : width / (part * height);
    const int lines = tall && members <= kMostInColumn
                          ? members
                          : std::max(1, static_cast<int>(std::lround(std::sqrt(members / shape))));
    const int across = (members + lines - 1) / lines;
    LayoutNode mechanisms{.kind = rows, .share = share};
    for (int first = 0; first < members; first += across) {
        LayoutNode& row = mechanisms.children.emplace_back(LayoutNode{.kind = columns});
        for (int m = first; m < first + across; ++m)
            row.children.push_back(m < members ? LayoutNode{.panel = {.kind = PanelKind::mechanism, .member = m}}
                                               : LayoutNode{.kind = empty});
    }
    LayoutNode grid{.kind = beside ? columns : rows, .children = {std::move(mechanisms)}};
    if (!side.empty()) grid.children.push_back(std::move(charts));
    return grid;
}

// In a portrait picture columns are rows, but not `cells` of mechanisms alone. A stack of three panels needs a larger
// share of the height than of the width.
static void stack(LayoutNode& node, bool cells) {
    using enum LayoutNode::Kind;
    const auto is_cell = [](const LayoutNode& child) {
        return child.kind == empty || (child.kind == panel && child.panel.kind == PanelKind::mechanism);
    };
    if (cells && std::ranges::all_of(node.children, is_cell)) return;
    for (LayoutNode& child : node.children) {
        stack(child, cells);
        if (node.kind == columns && child.kind == rows)
            child.share *= std::max(1.0, 0.7 * static_cast<double>(child.children.size()));
    }
    if (node.kind == columns) node.kind = rows;
}

Layout layout(int width, int height, const LayoutNode& user_grid, const Shown& shown) {
    PictureFrame f = picture_frame(width, height, shown);
    LayoutNode grid = user_grid;
    if (is_tall(width, height))
        stack(grid, std::ranges::count(panels_of(grid), PanelKind::mechanism, &PanelSpec::kind) > kMostInColumn);
    const Box room{f.margin, f.top, f.right - f.margin, f.bottom - f.top};
    place_grid(f.out, grid, room);
    // A picture too small for any panel of the grid shows the mechanism.
    if (f.out.panels.empty())
        f.out.panels.push_back({{.kind = PanelKind::mechanism},
                                whole(room.w < 8 || room.h < 8 ? Box{0, 0, double(width), double(height)} : room)});
    return std::move(f.out);
}

std::vector<PanelSpec> panels_of(const LayoutNode& grid) {
    if (grid.kind == LayoutNode::Kind::panel) return {grid.panel};
    std::vector<PanelSpec> out;
    for (const LayoutNode& child : grid.children)
        for (PanelSpec& spec : panels_of(child)) out.push_back(std::move(spec));
    return out;
}

std::vector<PanelSpec> omitted_panels(int width, int height, const LayoutNode& grid, const Shown& shown) {
    std::vector<PanelSpec> out = panels_of(grid);
    for (const PanelSlot& slot : layout(width, height, grid, shown).panels)
        if (const auto placed = std::ranges::find(out, slot.spec); placed != out.end()) out.erase(placed);
    return out;
}

}  // namespace beamcam::render
