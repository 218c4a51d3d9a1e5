// The fixed texts of a mechanism panel: the legend of motions, if there are several, and the scale bar.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/draw/canvas.hpp"
#include "render/draw/geometry.hpp"
#include "render/plot/placement.hpp"

namespace beamcam::render {

struct MechanismView;

class MechanismLegend {
  public:
    explicit MechanismLegend(const MechanismView& at) : at_(at) {}  // `at` must outlive it

    void place(OccupancyGrid room);  // in corners or along edges that no moving part reaches
    void draw(Canvas& canvas, const MechanismView& at) const;
    std::vector<Box> boxes() const;  // of the placed texts [px]

  private:
    // This panel's motion, or all motions if they are drawn as ghosts; and data that are drawn as a beam.
    struct Entry {
        Color color;
        std::string text;
        double width = 6;  // of its line [design px]
        std::vector<double> dash = {};
    };
    // Columns of names, and the size of everything in the legend.
    struct Form {
        int columns = 1;
        double size = 1;
    };
    std::vector<Entry> entries() const;
    void place_names(Canvas& canvas, OccupancyGrid& room);
    Vec2 size_of(Canvas& canvas, const Form& form) const;  // [px]
    double widest_name(Canvas& canvas, double size) const;
    double sample() const;
    bool has_label() const;
    bool has_bar() const;
    void scale_bar(Canvas& canvas, const MechanismView& at) const;
    void names(Canvas& canvas) const;
    double scale_length(const MechanismView& at) const;
    TextStyle label_style(double size) const;
    double gap() const;  // around texts [px]

    const MechanismView& at_;
    std::optional<Box> label_, bar_;
    Form form_;
};

}  // namespace beamcam::render
