// The scale of an axis of a plot: range, major ticks at 1-2-5 steps, minor ticks, labels.
//
// Any finite range is allowed, from 1e-300 to 1e300, also an empty one. Numbers too long for short labels get an SI
// prefix of the axis's unit, a common factor (×10⁶) or a common offset.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/plot/ticks.hpp"

namespace beamcam::render {

enum class Scale { linear, logarithmic };

// The requested axis.
struct Axis {
    std::string label = {};  // markup, "$θ$ / rad"; "$v$ / mm" may become "$v$ / nm"
    Scale scale = Scale::linear;
    std::optional<double> from = {}, to = {};  // limits at the start and the end of the axis; may be reversed
    bool tight = false;                        // exactly the range of the data, without a margin
    bool with_zero = false;                    // the range shown includes zero (linear)
    bool numbered = true;                      // labels at the ticks
    bool ticked = true;                        // else no ticks either
    bool counts = false;                       // integers: no ticks between them (linear)
    bool round_ends = false;                   // widened to multiples of the ticks' step (linear)
    bool short_numbers = false;                // a prefix for numbers of more than three digits or below 1
    bool keeps_unit = false;                   // the label's unit gets no other prefix
    bool grid = false;                         // in films: few numbers, and x has lines across the plot for ticks
    // The numbers are values in this unit, without prefix, factor or offset (linear); the first one that is written.
    std::optional<double> unit = {}, first_number = {};
};

// Least and greatest finite value; for a logarithmic axis of the positive ones.
struct Extent {
    bool any = false;
    double low = 0, high = 0;
    void add(std::span<const double> values, Scale scale = Scale::linear);
};

struct Tick {
    double at = 0;      // 0…1 along the axis
    std::string label;  // markup; empty: minor
    bool major = true;
};

class AxisMap {
  public:
    // `most`: labelled ticks that have room, >= 2. Throws PictureError without a finite value and limits, and for
    // limits that are equal or, on a logarithmic axis, not positive. `what`: the name of the axis in the message.
    AxisMap(const Axis& axis, const Extent& data, int most, const std::string& what);

    // 0…`length` within the range; NaN for NaN, and for a value <= 0 on a log axis.
    double place(double value, double length = 1) const;
    // A value in the numbers of the tick labels: (v/unit − offset)·scale. Ends and tick distance are in them, too.
    double tick_value(double value) const { return (value / unit_ - offset_) * scale_; }
    Range ends() const { return ends_; }
    double step() const { return step_; }
    const std::vector<Tick>& ticks() const { return ticks_; }
    const std::string& label() const { return label_; }    // in the unit of the numbers
    const std::string& common() const { return common_; }  // markup of factor and offset, or empty
    // The unit of the numbers; empty with a factor or an offset.
    std::string unit() const { return factor_ == 0 && offset_ == 0 ? told_unit_ : std::string(); }
    // Label, factor and offset in one: "(θ − 0.785 rad) / (10⁻⁶ rad)".
    std::string name() const;

  private:
    void linear(const Axis& axis, int most);
    int choose_powers(const Axis& axis, double order, bool offset);
    void add_linear_ticks(const Axis& axis, int most, bool whole);
    void logarithmic(const Axis& axis, int most);

    bool log_ = false, reversed_ = false;
    double low_ = 0, high_ = 1;                 // of the data shown, low < high
    double unit_ = 1, offset_ = 0, scale_ = 1;  // of `tick_value`
    Range ends_;
    double step_ = 1;
    std::vector<Tick> ticks_;
    std::string label_, symbol_, base_unit_, told_unit_, offset_text_, common_;
    int factor_ = 0;  // power of ten that the unit's prefix leaves
};

}  // namespace beamcam::render
