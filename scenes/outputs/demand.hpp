// Whether a film's encoder wants for pictures: then another thread that draws them helps. One that is not wanted costs:
// it keeps a picture of its own, in which it has to draw what moved since the last one it drew.
#pragma once

#include <chrono>
#include <mutex>

#include "output/film/video.hpp"

namespace beamcam::scenes {

class Demand {
  public:
    explicit Demand(const output::VideoWriter& film) : film_(film) {}  // which outlives it

    // The encoder has been idle for most of the time since the last answer. Asked by several threads.
    bool operator()();

  private:
    // An encoder takes its first pictures without encoding any: it looks ahead. Then, windows of so many.
    static constexpr long kFirst = 48, kWindow = 16;
    using Clock = std::chrono::steady_clock;

    const output::VideoWriter& film_;
    std::mutex mutex_;
    long asked_ = 0;   // pictures encoded at the last answer; 0: none yet
    double idle_ = 0;  // until then [s]
    Clock::time_point then_;
};

}  // namespace beamcam::scenes
