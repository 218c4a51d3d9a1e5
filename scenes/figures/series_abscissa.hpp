// The x axis of a series: time, turns of the cam, phase of the cam, frequency or a channel.
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
    // Of each row of data; nothing if they do not hold it. The angle of the cam follows from its law.
    std::optional<std::vector<double>> of(const Measurement& data, const sim::Problem& problem) const;
    // The factor from seconds to the axis: 1, or the cam's turns per second.
    double per_second(const sim::Problem& problem) const;
    // Turns angles of the cam into phases of a turn; a line is broken at each turn.
    void fold(render::figure::Series& curve) const;
    // Gives all panels one axis, with its label and unit.
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
