// The legend box: in the plot if it has room, else above it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/plot/drawn_curve.hpp"
#include "render/plot/placement.hpp"

namespace beamcam::render::figure {

inline constexpr double kFewCells = 1.5;  // cells that a label may touch without counting as covering data

class LegendBox {
  public:
    LegendBox(const Panel& panel, const PlotStyle& style, PageCanvas& sheet);

    std::size_t entries() const { return entries_.size(); }
    bool place_inside(OccupancyGrid& taken);  // false: no room; from now on it is above the plot
    bool place_above(double width);           // false: its height changed, so lay out again
    void stand_at(Vec2 top_left) { box_->x = top_left.x, box_->y = top_left.y; }
    void forget() { box_.reset(); }
    void try_inside_again() { above_ = false; }
    bool is_above() const { return above_; }
    double width_above() const { return above_ ? entry_ : 0; }  // the least
    double height_above() const { return above_ ? height_ + style_.gap : 0; }
    void draw() const;

  private:
    struct Entry {
        std::string label;
        const Series* series;  // null: a block of a colour, or dots
        Color color;
        bool dots;
    };
    Box size(double width);
    void draw_sample(const Entry& entry, Vec2 left, double width) const;

    const Panel& panel_;
    const PlotStyle& style_;
    PageCanvas& sheet_;
    std::vector<Entry> entries_;
    bool above_ = false;
    double height_ = 0, entry_ = 0;  // above the plot; width of the widest entry
    std::vector<Vec2> places_;       // of the entries in the box
    std::optional<Box> box_;
};

}  // namespace beamcam::render::figure
