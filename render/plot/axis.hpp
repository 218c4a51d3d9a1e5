// From numbers to places along an axis: the range shown, ticks at 1-2-5 steps with minor ones, labels.
//
// Any finite numbers will do, from 1e-300 to 1e300, constant ones too: what does not fit short labels is written as a
// common factor (×10⁶) or a common offset beside the axis.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace beamcam::render::figure {

enum class Scale { linear, logarithmic };

// As a figure asks for it.
struct Axis {
    std::string label = {};  // markup, "$θ$ / rad"
    Scale scale = Scale::linear;
    std::optional<double> from = {}, to = {};  // limits at the start and the end of the axis; may be reversed
    bool tight = false;                        // the data's own range, without air
    bool with_zero = false;                    // the range shown includes zero (linear)
    bool numbered = true;                      // labels at the ticks
    bool ticked = true;                        // else no ticks either
    bool counts = false;                       // whole numbers: no ticks between them (linear)
};

// Least and greatest finite value; for a logarithmic axis of the positive ones.
struct Extent {
    bool any = false;
    double low = 0, high = 0;
    void add(std::span<const double> values, Scale scale);
};

struct Tick {
    double at = 0;      // 0…1 along the axis
    std::string label;  // markup; empty: minor
    bool major = true;
};

class AxisMap {
  public:
    // `most`: labelled ticks that have room, >= 2. Throws PictureError when there is nothing to show: no finite value
    // and no limits, limits that are equal or, on a logarithmic axis, not positive. `what` names it in the message.
    AxisMap(const Axis& axis, const Extent& data, int most, const std::string& what);

    double place(double value) const;  // 0…1 within the range; NaN stays NaN, as does a value <= 0 on a log axis
    double low() const { return low_; }
    double high() const { return high_; }
    const std::vector<Tick>& ticks() const { return ticks_; }
    const std::string& common() const { return common_; }  // markup of factor and offset, or empty

  private:
    void linear(const Axis& axis, int most);
    void logarithmic(const Axis& axis, int most);

    bool log_ = false, reversed_ = false;
    double low_ = 0, high_ = 1;                 // of the data shown, low < high
    double unit_ = 1, offset_ = 0, scale_ = 1;  // place uses (v/unit − offset)·scale, which has an ordinary size
    double scaled_low_ = 0, scaled_high_ = 1;
    std::vector<Tick> ticks_;
    std::string common_;
};

}  // namespace beamcam::render::figure
