// The standard layout: mechanisms, and charts beside or below them.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "render/film/layout.hpp"
#include "render/film/picture_frame.hpp"

namespace beamcam::render {
namespace {

constexpr int kSeveral = 3;  // from this number on mechanisms get the whole width below the title
// Several mechanisms leave no space over in a very wide picture: charts get a fifth of it.
double panel_column(double w, double u, int members) {
    return std::max(kPanelColumn * u, members < kSeveral ? 0 : 0.2 * w);
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

// One arrangement in the making. The functions `add_…` place the side panels and take their space from the mechanisms;
// false if the picture is too small.
class ArrangedLayout {
  public:
    ArrangedLayout(int width, int height, const std::vector<PanelSpec>& side, int members, const ViewExtent& extent,
                   const Shown& shown)
        : w_(width),
          h_(height),
          side_(side),
          members_(members),
          extent_(extent),
          beside_(members < kSeveral),
          size_(shown.size),
          frame_(picture_frame(width, height, beside_, shown)),
          room_{frame_.margin, frame_.top, frame_.right - frame_.margin, frame_.bottom - frame_.top} {}

    std::optional<Layout> make(Arrangement how) && {
        if (how == Arrangement::column && !add_column()) return {};
        if (how == Arrangement::row && !add_row()) return {};
        if (how == Arrangement::stack && !add_stack()) return {};
        if (out_.panels.empty() && how != Arrangement::alone) return {};
        if (room_.w < 8 || room_.h < 8) room_ = {0, 0, w_, h_};
        place_mechanisms(out_, room_, members_, extent_);
        return std::move(out_);
    }

  private:
    bool add_column() {
        if (!has_column(w_, h_, u_)) return false;
        const double least = panel_column(w_, u_, members_), gap = 40 * u_;
        Box left = room_;
        left.w -= least + gap;
        const double column = least + for_panels(spare(left, members_, extent_, u_).x, widening(w_, u_));
        // In wide pictures, which lack height, the column starts beside the title.
        const double top = frame_.wide && beside_ ? frame_.margin * 0.8 : frame_.top;
        const double highest = (frame_.wide ? 440 : 660) / std::min(1.0, size_);
        const double bottom = out_.captions ? out_.captions->bottom() : frame_.bottom;
        stack(out_, side_, {frame_.right - column, top, column, bottom - top - 6 * u_}, highest);
        room_.w -= column + gap;
        if (out_.captions) out_.captions->w = room_.w;  // they are below the mechanism
        if (frame_.wide && beside_ && out_.title) out_.title->w = room_.right() - out_.title->x;
        return true;
    }

    bool add_row() {
        if (!has_room_below()) return false;
        Box above = room_;
        above.h -= 320 * u_;
        const double row = 300 * u_ + for_panels(spare(above, members_, extent_, u_).y, 140 * u_);
        spread(out_, side_, {room_.x, room_.bottom() - row, room_.w, row});
        room_.h -= row + 20 * u_;
        return true;
    }

    bool add_stack() {
        if (!has_room_below()) return false;
        const double lower = std::min(0.62 * room_.h, 3 * 330 * u_);
        stack(out_, side_, {room_.x, room_.bottom() - lower, room_.w, lower});
        if (out_.panels.empty()) return false;
        // As high as the number of panels needs, plus space that the mechanisms do not need.
        const auto n = static_cast<double>(out_.panels.size());
        double used = out_.panels.back().box.bottom() - out_.panels.front().box.y;
        Box above = room_;
        above.h -= used + 20 * u_;
        used +=
            for_panels(spare(above, members_, extent_, u_).y, std::max(0.0, n * 440 * u_ + (n - 1) * 14 * u_ - used));
        const std::vector<PanelSpec> fitting(side_.begin(), side_.begin() + std::ssize(out_.panels));
        out_.panels.clear();
        stack(out_, fitting, {room_.x, room_.bottom() - used, room_.w, used});
        room_.h -= used + 20 * u_;
        return true;
    }

    bool has_room_below() const { return w_ >= 420 * u_ && room_.h >= 620 * u_; }

    const double w_, h_;
    const std::vector<PanelSpec>& side_;
    const int members_;
    const ViewExtent& extent_;
    const bool beside_;  // charts may stand beside the header
    const double size_;  // of letters
    PictureFrame frame_;
    Layout& out_ = frame_.out;
    const double u_ = out_.unit;
    Box room_;  // of the mechanisms
};

}  // namespace

std::optional<Layout> arranged(Arrangement how, int width, int height, const std::vector<PanelSpec>& side, int members,
                               const ViewExtent& extent, const Shown& shown) {
    return ArrangedLayout(width, height, side, members, extent, shown).make(how);
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

}  // namespace beamcam::render
