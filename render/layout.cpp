#include "render/layout.hpp"

#include <algorithm>
#include <cmath>

namespace beamcam::render {
namespace {

constexpr double kSmallest = 0.5;  // 16 design pixels of text are 8 px: the least that reads

Box whole(const Box& b) {
    const double x = std::round(b.x), y = std::round(b.y);
    return {x, y, std::max(1.0, std::round(b.right()) - x), std::max(1.0, std::round(b.bottom()) - y)};
}

// Stacks the panels into `area`, as many as keep a readable height.
void stack(Layout& out, const std::vector<PanelSpec>& specs, const Box& area) {
    const double u = out.unit, gap = 14 * u;
    const auto room = static_cast<std::size_t>(std::max(0.0, (area.h + gap) / (215 * u + gap)));
    const std::size_t n = std::min(specs.size(), room);
    for (std::size_t i = 0; i < n; ++i) {
        const double h = std::min(440 * u, (area.h - gap * static_cast<double>(n - 1)) / static_cast<double>(n));
        out.panels.push_back({specs[i], {area.x, area.y + (h + gap) * static_cast<double>(i), area.w, h}});
    }
}

// Side by side, as many as keep a readable width.
void spread(Layout& out, const std::vector<PanelSpec>& specs, const Box& area) {
    const double u = out.unit, gap = 30 * u;
    const auto room = static_cast<std::size_t>(std::max(0.0, (area.w + gap) / (400 * u + gap)));
    const std::size_t n = std::min(specs.size(), room);
    for (std::size_t i = 0; i < n; ++i) {
        const double w = (area.w - gap * static_cast<double>(n - 1)) / static_cast<double>(n);
        out.panels.push_back({specs[i], {area.x + (w + gap) * static_cast<double>(i), area.y, w, area.h}});
    }
}

// What stands around the panels, and the room that is left for them.
struct Frame {
    Layout out;
    double margin = 0, top = 0, bottom = 0, right = 0;
    bool wide = true;
};

Frame frame(int width, int height) {
    Frame f;
    Layout& out = f.out;
    f.wide = width >= 1.4 * height;
    out.unit =
        std::max(kSmallest, f.wide ? std::min(width / 1920.0, height / 1080.0) : std::min(width, height) / 1240.0);
    const double u = out.unit, w = width, h = height;
    const double margin = f.margin = std::min(64 * u, 0.04 * std::min(w, h) + 12 * u);
    f.top = margin * 0.8, f.bottom = h - margin * 0.7, f.right = w - margin;

    const bool has_title = w >= 320 * u && h >= 300 * u, has_parameters = w >= 560 * u && h >= 480 * u;
    const bool has_clock = w >= 230 * u && h >= 190 * u, has_scales = w >= (f.wide ? 1150 : 660) * u && h >= 600 * u;
    if (has_title) {
        out.title = Box{margin, f.top, w - 2 * margin, 54 * u};
        f.top += 54 * u;
    }
    if (has_parameters) {
        out.parameters = Box{margin, f.top, w - 2 * margin, 36 * u};
        f.top += 36 * u;
    }
    if (has_scales) {
        out.note = Box{margin, f.bottom - 26 * u, w - 2 * margin, 26 * u};
        f.bottom -= 34 * u;
    }
    const bool apart = has_scales && !f.wide;  // beside the clock they would leave it too little
    if (apart) {
        out.scales = Box{w - margin - 600 * u, f.bottom - 56 * u, 600 * u, 56 * u};
        f.bottom -= 64 * u;
    }
    if (has_clock) {
        out.clock = Box{margin, f.bottom - 56 * u, w - 2 * margin, 56 * u};
        f.bottom -= 56 * u;
    }
    if (has_scales && !apart) {
        out.scales = Box{w - margin - 600 * u, out.clock->y, 600 * u, 56 * u};
        out.clock->w = out.scales->x - 30 * u - out.clock->x;
    }
    if (has_title) f.top += 10 * u;
    if (has_clock) f.bottom -= 10 * u;
    return f;
}

// The children of a grid without those that would be too small to read, the last of them first: the others share
// their room.
std::vector<LayoutNode> those_that_fit(double unit, const LayoutNode& node, const Box& box) {
    const bool rows = node.kind == LayoutNode::Kind::rows;
    std::vector<LayoutNode> children = node.children;
    for (;;) {
        const double gap = (rows ? 14 : 30) * unit, n = static_cast<double>(children.size());
        const double room = (rows ? box.h : box.w) - gap * (n - 1);
        double shares = 0;
        for (const LayoutNode& child : children) shares += child.share;
        const auto narrow = std::find_if(children.rbegin(), children.rend(), [&](const LayoutNode& child) {
            if (child.kind != LayoutNode::Kind::panel) return false;
            const Vec2 least = smallest(child.panel.kind);
            return room * child.share / shares < (rows ? least.y : least.x) * unit;
        });
        if (narrow == children.rend() || children.size() == 1) return children;
        children.erase(std::next(narrow).base());
    }
}

void place_grid(Layout& out, const LayoutNode& node, const Box& box) {
    if (node.kind == LayoutNode::Kind::panel) {
        const Vec2 least = smallest(node.panel.kind);
        if (box.w >= least.x * out.unit && box.h >= least.y * out.unit) out.panels.push_back({node.panel, whole(box)});
        return;
    }
    const bool rows = node.kind == LayoutNode::Kind::rows;
    const std::vector<LayoutNode> children = those_that_fit(out.unit, node, box);
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

// One mechanism for each motion, in the direction that leaves each the better shape.
void place_mechanisms(Layout& out, const Box& box, int members) {
    LayoutNode grid{.kind = box.w > 1.5 * box.h ? LayoutNode::Kind::columns : LayoutNode::Kind::rows};
    for (int i = 0; i < members; ++i) grid.children.push_back({.panel = {.kind = PanelKind::mechanism, .member = i}});
    Layout parts;
    parts.unit = out.unit;
    if (members == 1)
        parts.panels.push_back({grid.children.front().panel, whole(box)});
    else
        place_grid(parts, grid, box);
    out.panels.insert(out.panels.begin(), parts.panels.begin(), parts.panels.end());
}

}  // namespace

const PanelSlot* Layout::first(PanelKind kind) const {
    const auto at = std::ranges::find_if(panels, [&](const PanelSlot& s) { return s.spec.kind == kind; });
    return at == panels.end() ? nullptr : &*at;
}

Box plot_area(const Box& box, double u) {
    return whole({box.x + 70 * u, box.y + 46 * u, box.w - 78 * u, box.h - 46 * u - 44 * u});
}

Vec2 smallest(PanelKind kind) {
    switch (kind) {
        case PanelKind::mechanism:
            return {16, 16};
        case PanelKind::strip:
        case PanelKind::energy:
            return {300, 150};
        case PanelKind::phase:
        case PanelKind::close_up:
        case PanelKind::traces:
            return {240, 170};
    }
    return {};
}

const char* name(PanelKind kind) {
    switch (kind) {
        case PanelKind::mechanism:
            return "mechanism";
        case PanelKind::strip:
            return "strip";
        case PanelKind::phase:
            return "phase";
        case PanelKind::energy:
            return "energy";
        case PanelKind::close_up:
            return "close-up";
        case PanelKind::traces:
            return "traces";
    }
    return "";
}

Layout layout(int width, int height, const std::vector<PanelSpec>& side, int members) {
    Frame f = frame(width, height);
    Layout& out = f.out;
    const double u = out.unit, w = width, h = height, margin = f.margin;
    double top = f.top, bottom = f.bottom, right = f.right;
    if (f.wide && w >= 1150 * u && h >= 480 * u && members < 3) {
        const double column = 540 * u, first = margin * 0.8;
        stack(out, side, {right - column, first, column, bottom - first - 6 * u});
        if (!out.panels.empty()) {
            right -= column + 40 * u;
            if (out.title) out.title->w = right - out.title->x;
            if (out.parameters) out.parameters->w = right - out.parameters->x;
        }
    } else if ((!f.wide || members >= 3) && w >= 420 * u && bottom - top >= 620 * u) {
        const double share = std::min(0.62 * (bottom - top), 3 * 330 * u);
        if (h > 1.35 * w) {
            const Box area{margin, bottom - share, right - margin, share};
            stack(out, side, area);
            if (!out.panels.empty()) bottom -= share - (area.bottom() - out.panels.back().box.bottom()) + 20 * u;
            const double spare = area.bottom() - (out.panels.empty() ? area.bottom() : out.panels.back().box.bottom());
            for (PanelSlot& slot : out.panels) slot.box.y += spare;
        } else {
            spread(out, side, {margin, bottom - 300 * u, right - margin, 300 * u});
            if (!out.panels.empty()) bottom -= 320 * u;
        }
    }
    Box room{margin, top, right - margin, bottom - top};
    if (room.w < 8 || room.h < 8) room = {0, 0, w, h};
    place_mechanisms(out, room, members);
    return std::move(f.out);
}

Layout layout(int width, int height, const LayoutNode& wanted) {
    Frame f = frame(width, height);
    LayoutNode grid = wanted;
    // What stands side by side in a wide picture stands one below the other in a tall one.
    if (grid.kind == LayoutNode::Kind::columns && height > 1.35 * width) {
        grid.kind = LayoutNode::Kind::rows;
        // Three panels above each other need more of the height than of the width.
        for (LayoutNode& child : grid.children)
            if (child.kind == LayoutNode::Kind::rows)
                child.share *= std::max(1.0, 0.7 * static_cast<double>(child.children.size()));
    }
    place_grid(f.out, grid, {f.margin, f.top, f.right - f.margin, f.bottom - f.top});
    // A picture too small for its grid shows what it can: the mechanism.
    if (f.out.panels.empty()) return layout(width, height, std::vector<PanelSpec>{});
    return std::move(f.out);
}

std::vector<PanelSpec> panels_of(const LayoutNode& grid) {
    if (grid.kind == LayoutNode::Kind::panel) return {grid.panel};
    std::vector<PanelSpec> out;
    for (const LayoutNode& child : grid.children)
        for (PanelSpec& spec : panels_of(child)) out.push_back(std::move(spec));
    return out;
}

std::vector<PanelSpec> left_out(int width, int height, const LayoutNode& wanted) {
    std::vector<PanelSpec> out = panels_of(wanted);
    for (const PanelSlot& slot : layout(width, height, wanted).panels)
        if (const auto shown = std::ranges::find(out, slot.spec); shown != out.end()) out.erase(shown);
    return out;
}

}  // namespace beamcam::render
