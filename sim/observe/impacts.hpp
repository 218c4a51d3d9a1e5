// Impacts and collisions of a motion, from its touches and releases.
#pragma once

#include "sim/observe/channel_evaluator.hpp"
#include "sim/observe/result.hpp"

namespace beamcam::sim {

class ImpactRecorder {
  public:
    ImpactRecorder(ChannelEvaluator& evaluator, Result& result) : evaluator_(evaluator), result_(result) {}

    void touch(double t, const double* y, const ContactState& contact);
    void release(double t, const double* y, const ContactState& contact);
    // Adds the present collision to the contact of a motion that continues this one from `t` [s].
    void remember(double t, Initial& initial) const;
    // The run ends at (t, y).
    void finish(double t, const double* y);
    // The impact that is not released yet; null in flight.
    Impact* open() { return open_ ? &result_.impacts.back() : nullptr; }
    std::size_t releases() const { return result_.impacts.size() - (open_ ? 1 : 0); }

  private:
    Collision& collision_of(double t, const ContactState& contact);
    TouchState touch_state(double t, const double* y, const ContactState& contact);
    void settle(const double* y);

    ChannelEvaluator& evaluator_;
    Result& result_;
    bool open_ = false;
    double lost_at_touch_ = 0, impulse_n_at_touch_ = 0, impulse_t_at_touch_ = 0;
};

}  // namespace beamcam::sim
