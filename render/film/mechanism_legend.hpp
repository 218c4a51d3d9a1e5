// The fixed texts of a mechanism panel: the names of motions in one row above it, if there are several, and in
// its lower corners the scale bar and the name of the marks of contact.
#pragma once

#include <string>
#include <vector>

#include "render/draw/canvas.hpp"

namespace beamcam::render {

struct MechanismView;
struct Projection;

class MechanismLegend {
  public:
    explicit MechanismLegend(const MechanismView& at);  // `at` must outlive it
    void draw(Canvas& canvas, const MechanismView& at) const;
    // Of all mechanisms of a picture, which have one scale. `view`: of a perspective, in which the bar lies on the
    // floor in the plane of the motion, as far as the panel reaches.
    void scale_bar(Canvas& canvas, const MechanismView& at, const Projection* view = nullptr) const;
    void name_contacts(Canvas& canvas) const;  // the marks on beam and cam
    bool cuts_names() const { return cuts_names_; }

  private:
    // This panel's motion, or all motions if they are drawn as ghosts; and data that are drawn as a beam.
    struct Entry {
        Color color;
        std::string name;  // plain text with formulas; once placed, markup
        double width = 6;  // of its line [design px]
        std::vector<double> dash = {};
    };
    void fit_names(const Canvas& canvas);
    void names(Canvas& canvas) const;

    const MechanismView& at_;
    std::vector<Entry> entries_;
    double size_ = 0;  // of the letters [px]
    bool cuts_names_ = false;
    bool has_bar_ = true;
};

}  // namespace beamcam::render
