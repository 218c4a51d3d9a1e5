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
        std::string name;  // plain text with formulas
        double width = 6;  // of its line [design px]
        std::vector<double> dash = {};
    };
    // How the names are arranged: the number of columns; the size of everything; the lines of a name; whether each
    // column has its own place, or stands beside the others; whether long names are cut.
    struct Form {
        std::size_t columns = 1;
        double size = 1;
        std::size_t lines = 1;
        bool apart = false;
        bool cut = false;
    };
    struct Block {  // a column of names
        Box box;
        std::size_t first = 0, count = 0;
    };
    struct Placed {
        std::vector<Block> blocks;
        double covered = 1;  // share of the block that is covered most
    };
    std::vector<Entry> entries() const;
    void place_names(Canvas& canvas, OccupancyGrid& room);
    std::optional<Placed> placed(Canvas& canvas, OccupancyGrid room, const Form& form) const;
    std::vector<std::string> lines_of(Canvas& canvas, const std::string& name, const Form& form, double width) const;
    double line_height(double size) const;
    double widest_name(Canvas& canvas, const Form& form, std::size_t& lines) const;
    double sample() const;
    bool has_label() const;
    bool has_bar() const;
    void scale_bar(Canvas& canvas, const MechanismView& at) const;
    void names(Canvas& canvas) const;
    double scale_length(const MechanismView& at) const;
    TextStyle label_style(double size) const;
    double gap() const;  // around texts [px]

    const MechanismView& at_;
    std::vector<Block> blocks_;
    std::optional<Box> bar_;
    Form form_;
};

}  // namespace beamcam::render
