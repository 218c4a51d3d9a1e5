// What a series is drawn against: the time, the turns of the cam, its phase, the frequency or a channel.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/plot/figure.hpp"
#include "scenes/scene/scene.hpp"
#include "sim/run/simulate.hpp"

namespace beamcam::scenes {

class SeriesAbscissa {
  public:
    SeriesAbscissa(const SeriesKeys& keys, Lang lang);

    const std::optional<sim::Channel>& channel() const { return channel_; }  // absent: time, turns or frequency
    bool is_frequency() const { return against_ == "frequency"; }
    bool is_time() const { return against_ == "t" || is_turns(); }  // or turns, which grow with it

    // Of each row of a table whose last channel is drawn, in SI units or turns.
    std::vector<double> of(const sim::Table& table, const sim::Problem& problem) const;
    // Of each row of data; nothing where they do not hold it. The cam's law gives its angle.
    std::optional<std::vector<double>> of(const Measurement& data, const sim::Problem& problem) const;
    // Along the axis: 1 for seconds, the turns of the cam for turns.
    double per_second(const sim::Problem& problem) const;
    // Angles of the cam become phases of a turn; a line begins anew with each turn.
    void fold(render::figure::Series& curve) const;
    // One axis for all panels, with its label and unit.
    void share(render::figure::Figure& figure, const sim::Problem& problem) const;

  private:
    struct Extent {
        double largest = 0, low = 0, high = 0;  // largest: magnitude
    };
    Extent extent(const render::figure::Figure& figure) const;
    bool is_phase() const { return against_ == "phase"; }
    bool is_turns() const { return against_ == "turns"; }

    std::string against_;
    std::optional<double> low_, high_;
    Lang lang_;
    std::optional<sim::Channel> channel_;
};

}  // namespace beamcam::scenes
