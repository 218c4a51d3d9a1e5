#include "scenes/outputs/demand.hpp"

namespace beamcam::scenes {

bool Demand::operator()() {
    const std::lock_guard lock(mutex_);
    const output::VideoStatistics now = film_.statistics();
    if (now.frames < (asked_ == 0 ? kFirst : asked_ + kWindow)) return false;
    const Clock::time_point time = Clock::now();
    const double passed = std::chrono::duration<double>(time - then_).count(), idle = now.idle_seconds - idle_;
    const bool first = asked_ == 0;
    asked_ = now.frames, idle_ = now.idle_seconds, then_ = time;
    return !first && idle > 0.5 * passed;
}

}  // namespace beamcam::scenes
