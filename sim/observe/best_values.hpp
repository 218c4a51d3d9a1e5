// The best values of a channel so far, and whether bounds of it exceed them.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/observe/constants.hpp"
#include "sim/observe/interval_search.hpp"
#include "sim/observe/modal_channels.hpp"
#include "sim/observe/result.hpp"

namespace beamcam::sim {

// A negligible rise over the best value, and a rounding error of the channel.
inline double negligible(ChannelKind kind, double best, const Extremum& e) {
    const double share = kind == ChannelKind::energy_residual ? kNegligibleImbalance : kNegligibleRise;
    const double largest = e.min <= e.max ? std::max(std::fabs(e.min), std::fabs(e.max)) : 0;
    return std::max(share * std::fabs(best), kValueRounding * largest);
}

inline BestValue best_so_far(ChannelKind kind, double sign, const Extremum& e) {
    return sign > 0 ? BestValue{sign, e.max, e.t_max, negligible(kind, e.max, e)}
                    : BestValue{sign, -e.min, e.t_min, negligible(kind, e.min, e)};
}

// What cannot be computed is no bound: candidates need an order.
inline double bound(const ModalChannels::Range& range, double sign) {
    const double high = sign > 0 ? range.high : -range.low;
    return std::isnan(high) ? std::numeric_limits<double>::infinity() : high;
}

inline bool is_beaten(const ModalChannels::Range& range, ChannelKind kind, double sign, const Extremum& e) {
    return bound(range, sign) <= best_so_far(kind, sign, e).to_beat();
}

inline bool is_beaten(const ModalChannels::Range& range, ChannelKind kind, const Extremum& e) {
    return range.high <= e.max + negligible(kind, e.max, e) && range.low >= e.min - negligible(kind, e.min, e);
}

inline void offer(Extremum& e, double t, double value) {
    if (value < e.min) {
        e.min = value;
        e.t_min = t;
    }
    if (value > e.max) {
        e.max = value;
        e.t_max = t;
    }
}

}  // namespace beamcam::sim
