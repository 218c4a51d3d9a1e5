// The clock, and beside it exaggeration and playback speed. Sizes and places are the same for all frames.
#pragma once

#include <string>
#include <vector>

#include "render/film/panel.hpp"

namespace beamcam::render {

class ClockLine {
  public:
    enum class Brevity { words, abbreviated, numbers };  // of the texts beside the clock
    explicit ClockLine(const FilmContext& context);
    void draw(Canvas& canvas, int frame) const;

  private:
    struct Pill {
        std::string widest;  // text of all frames
        Color color;
        double width = 0;  // [px]
        bool states_speed = false;
    };
    void choose_sizes(Canvas& canvas);
    double measure(Canvas& canvas);  // widths of clock and pills, and the right end of the last pill [px]
    std::string words(const Pill& pill, int frame) const;
    TextStyle clock_style() const;
    TextStyle pill_style(const Pill& pill) const;

    const FilmContext& context_;
    std::vector<Pill> pills_;
    bool steady_ = true;  // one speed throughout
    Brevity brevity_ = Brevity::words;
    double size_ = 0;                     // of the clock [px]
    double letters_ = 0;                  // size of those in pills [px]
    double clock_width_ = 0, first_ = 0;  // of the widest time; left end of the first pill [px]
};

}  // namespace beamcam::render
