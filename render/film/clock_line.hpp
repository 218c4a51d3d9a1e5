// The clock, and beside it exaggeration, playback speed and, in a picture without a chart of the contact force, the
// largest forces so far, from time 0 on. Sizes and places are the same for all frames.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/film/force_curve.hpp"

namespace beamcam::render {

class ClockLine {
  public:
    explicit ClockLine(const FilmContext& context);
    void draw(Canvas& canvas, int frame) const;
    bool states_exaggeration() const;
    bool has_room() const { return has_room_; }  // for exaggeration and speed

  private:
    struct Pill {
        enum class Kind { exaggeration, speed, peak };
        Kind kind;
        std::string widest;  // markup of all frames
        Color color;
        int member = 0;    // of the peak
        double width = 0;  // [px]
    };
    double measure(const Canvas& canvas);  // widths of clock and pills, and the right end of the last pill [px]
    std::string words(const Pill& pill, int frame) const;
    TextStyle clock_style() const;
    TextStyle pill_style(const Pill& pill) const;

    const FilmContext& context_;
    std::optional<Peaks> peaks_;  // where pills show them
    std::vector<Pill> pills_;
    bool steady_ = true;  // one speed throughout
    bool has_room_ = true;
    double size_ = 0;                     // of the clock [px]
    double letters_ = 0;                  // size of those in pills [px]
    double clock_width_ = 0, first_ = 0;  // of the widest time; left end of the first pill [px]
};

}  // namespace beamcam::render
