#include "render/film/layout.hpp"

#include <algorithm>
#include <cmath>

#include "render/film/picture_frame.hpp"

namespace beamcam::render {
namespace {

constexpr double kBetweenRows = 24, kBetweenColumns = 30;  // [design px]

bool is_tall(int width, int height) { return height > 1.35 * width; }

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

LayoutNode standard_grid(int width, int height, const std::vector<PanelSpec>& side, int members) {
    using enum LayoutNode::Kind;
    constexpr int kRowOfMechanisms = 3;                      // from this number on mechanisms have the whole width
    constexpr double kBesideCharts = 1.55, kAboveRow = 1.4;  // shares of the mechanisms
    const bool beside = is_wide(width, height) && members < kRowOfMechanisms, tall = is_tall(width, height);
    LayoutNode charts{.kind = beside || tall ? rows : columns};
    for (const PanelSpec& spec : side) charts.children.push_back({.panel = spec});
    const double above_charts = std::min(1.3, 2.6 / static_cast<double>(side.size()));
    const double share = beside ? kBesideCharts : tall ? above_charts : kAboveRow;
    // Cells of mechanisms are about as wide as high.
    const double part = side.empty() ? 1 : share / (share + 1),
                 shape = beside ? part * width / height : width / (part * height);
    const int lines = std::max(1, static_cast<int>(std::lround(std::sqrt(members / shape))));
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

Layout layout(int width, int height, const LayoutNode& user_grid, const Shown& shown) {
    PictureFrame f = picture_frame(width, height, shown);
    LayoutNode grid = user_grid;
    // Columns of a wide picture become rows in a portrait one.
    if (grid.kind == LayoutNode::Kind::columns && is_tall(width, height)) {
        grid.kind = LayoutNode::Kind::rows;
        // A stack of three panels needs a larger share of the height than of the width.
        for (LayoutNode& child : grid.children)
            if (child.kind == LayoutNode::Kind::rows)
                child.share *= std::max(1.0, 0.7 * static_cast<double>(child.children.size()));
    }
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
