// A strip chart: axes, faint curves of what is to come, the curves so far, a cursor. Over the whole film's time, or
// over a window of time that moves with the instant.
//
// Curves are reduced to what the pixels can show (first, least, most, last of each column), so drawing costs the
// same for any number of rows. Over the whole film, what lies before the cursor is a kept layer shown up to a few
// columns before the cursor's, and those columns are drawn from the rows until the instant: no row after it is ever
// drawn as past, and any frame in any order gives the same pixels.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/draw/canvas.hpp"
#include "render/draw/geometry.hpp"
#include "render/plot/ticks.hpp"

namespace beamcam::render {

// An axis of values with round ends and a mark at every multiple of one step: the outermost marks carry labels.
// Labels are (value − offset)/scale, so that small, large and nearly equal values all get short ones; the name says
// what was done to them. `unit` "", "rad", "rad/s", "°" and "°/s" get powers of ten, others SI prefixes.
class RoundAxis {
  public:
    RoundAxis() = default;
    RoundAxis(double low, double high, std::string unit, int most);  // low < high; most >= 2: marks

    std::string name(const std::string& symbol) const;  // markup: "θ − 0.785 / 10⁻⁶ rad"
    double scaled(double value) const { return (value - offset_) / scale_; }
    // How far along an axis of this length it stands.
    double along(double length, double value) const {
        return length * (scaled(value) - ends_.low) / (ends_.high - ends_.low);
    }
    const Ticks& marks() const { return marks_; }  // scaled
    double value(double mark) const { return mark * scale_ + offset_; }
    Range ends() const { return ends_; }  // scaled

  private:
    bool by_prefix() const { return !unit_.empty() && unit_ != "rad" && unit_ != "rad/s" && !unit_.starts_with("°"); }
    std::string unit_;
    double offset_ = 0, scale_ = 1;
    Range ends_;
    Ticks marks_;
};
// A line across the plot at every mark, its label at the left. `unit`: [px] of a design pixel;
// `tick`: size of the labels [px].
void draw_levels(Canvas& canvas, const Palette& palette, const RoundAxis& axis, const Box& plot, double unit,
                 double tick);

struct Curve {
    std::vector<double> t, v;  // [s], SI units; may be empty
    Color color, faint;
    std::string label = {};  // markup; told beside the reading
    std::vector<double> dash = {};
    std::vector<Range> pale_within = {};  // in order; its past is drawn there in `pale` [s]
    Color pale = {};
};
struct ChartDot {
    double t = 0, value = 0;
    Color color, faint;  // faint: still to come
};
// The instant of an impact: a tick at the time axis, in one of the lanes above each other.
struct ChartMark {
    double t = 0;  // [s]
    Color color;
    int lane = 0, lanes = 1;
};
// Areas between two curves of the same instants, one upon the other.
struct Band {
    std::vector<double> low, high;
    Color color;
};

struct ChartContent {
    std::string words;             // before the symbol, left out where there is no room: "Hub angle "
    std::string symbol;            // markup: θ; may be empty
    std::string unit;              // "rad", "N", "" for none
    Range value;                   // to be shown; the axis is widened to round ends
    Range time;                    // of the film [s]
    std::optional<double> window;  // [s]
    double time_unit = 1;          // [s]
    // The readings are told in this unit by themselves, as labels beside the mechanism tell them; empty: in the axis's.
    std::string reading_unit = {};
    std::string time_label;    // markup, "t / s"
    std::string instead = {};  // in place of the axis of values, where there is none to be shown: "no contact"
    std::vector<Curve> curves;
    std::vector<double> band_times;  // [s]
    std::vector<Band> bands;
    bool filled = false;  // area under the first curve down to zero
    std::vector<ChartDot> dots;
    std::vector<ChartMark> marks;
};

class Chart {
  public:
    Chart(ChartContent content, Box box, Box plot, double unit, double tick);

    void draw_ground(Canvas& canvas, const Palette& palette) const;  // axes, labels, what is to come
    // All curves as past, of which columns up to `past_column` may be shown; as large as `past_box`. Empty with a
    // window.
    Image past(const Fonts& fonts) const;
    Box past_box() const;
    // The first column that is not past yet at t: what lies after t may reach into it by the width of its stroke.
    int past_column(double t) const;
    // What moves: the curves' last columns until t, with a window all of them. `readings`: of each curve where the
    // cursor stands; NaN: none.
    void draw_moving(Canvas& canvas, const Palette& palette, double t, std::span<const double> readings) const;
    Range time() const { return c_.time; }
    bool windowed() const { return c_.window.has_value(); }

  private:
    struct View;  // the time axis as it stands at an instant
    View whole() const;
    View around(double t) const;
    void draw_time_axis(Canvas& canvas, const Palette& palette, const View& view) const;
    void draw_heading(Canvas& canvas, const Palette& palette) const;
    int cursor_column(const View& view, double t) const;
    std::string told(double value) const;                                 // as a reading
    double widest_reading(Canvas& canvas, const TextStyle& style) const;  // [px]
    Pen pen(const Curve& curve, Color color, double width) const;
    // Rows between two instants, drawn as past or as still to come.
    void draw_curves(Canvas& canvas, const View& view, Range rows, bool past, Vec2 shift) const;
    void draw_bands(Canvas& canvas, const View& view, Range rows, bool past, Vec2 shift) const;
    void draw_pale_past(Canvas& canvas, const View& view, Range rows, const Curve& curve, Vec2 shift) const;
    void draw_readings(Canvas& canvas, const Palette& palette, std::span<const double> readings) const;
    double reading_width(Canvas& canvas, bool named) const;  // of all readings together [px]
    double y(double v) const;
    ChartContent c_;
    Box box_, plot_;
    double unit_, tick_;
    RoundAxis axis_;
    int digits_ = 0;  // decimals of the reading
};

}  // namespace beamcam::render
