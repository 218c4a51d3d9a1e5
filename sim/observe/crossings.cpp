#include "sim/observe/crossings.hpp"

#include <algorithm>
#include <cmath>

#include "sim/base/numerics.hpp"
#include "sim/observe/constants.hpp"
#include "sim/observe/interval_search.hpp"

namespace beamcam::sim {
namespace {

// Calls found(a, b) for every interval in which the channel passes the level once, with values above the level.
// Values below rounding of `scale` or of the samples have no sign.
template <class Found>
void each_sign_change(StepChannels& step, const SegmentInterval& s, Channel channel, double level, double scale,
                      Found&& found) {
    const auto above = [&](double t) { return step.value(s, channel, t) - level; };
    for (const SegmentInterval& part : step.parts(s, channel)) {
        step.begin(part);
        StepChannels::Samples values = step.sample(part, channel);
        double largest = scale;
        for (double& value : values) {
            value -= level;
            largest = std::max(largest, std::fabs(value));
        }
        // A start from rest is no crossing, whatever its rounding: no earlier step determines the sign.
        if (part.from == 0 && std::fabs(values[0]) <= kSignRounding * largest) values[0] = 0;
        const Variation variation = step.variation(part, channel, values);
        const auto [low, high] = std::ranges::minmax(values);
        if (std::max(low, -high) > variation.strays(kWidestNodeGap * (part.to - part.from))) continue;
        for (std::size_t k = 0; k + 1 < values.size(); ++k)
            sign_changes(above, variation, kSignRounding * largest, {sample_time(part, k), values[k]},
                         {sample_time(part, k + 1), values[k + 1]}, found);
    }
}

}  // namespace

void find_apexes(StepChannels& step, const SegmentInterval& s, std::vector<Apex>& found) {
    const MotionBounds* motion = s.segment->bounds();
    if (motion && (motion->rate_low > 0 || motion->rate_high < 0)) return;
    step.begin(s);
    const auto rate = [&](double t) { return step.value(s, {ChannelKind::theta_dot}, t); };
    const double scale = motion ? motion->theta_dot + motion->ripple_rate : 0;
    each_sign_change(step, s, {ChannelKind::theta_dot}, 0, scale, [&](const TimedValue& a, const TimedValue& b) {
        if (!(a.value > 0)) return;
        const double t = find_root(rate, a.t, b.t, a.value, b.value);
        found.push_back({t, step.value(s, {ChannelKind::theta}, t)});
    });
}

void find_zero_crossings(StepChannels& step, const SegmentInterval& s, std::vector<ZeroCrossing>& found) {
    const MotionBounds* motion = s.segment->bounds();
    if (motion && (motion->angle_low > 0 || motion->angle_high < 0)) return;
    std::vector<LevelCrossing> crossings;
    find_crossings(step, s, {ChannelKind::theta}, 0, crossings);
    for (const LevelCrossing& crossing : crossings)
        found.push_back({crossing.t, step.value(s, {ChannelKind::theta_dot}, crossing.t)});
}

void find_crossings(StepChannels& step, const SegmentInterval& s, Channel channel, double level,
                    std::vector<LevelCrossing>& found) {
    step.begin(s);
    const auto above = [&](double t) { return step.value(s, channel, t) - level; };
    // Below rounding of the hub's ripple θ has no sign.
    const MotionBounds* motion = s.segment->bounds();
    const double scale = motion && channel.kind == ChannelKind::theta ? motion->ripple : 0;
    each_sign_change(step, s, channel, level, std::max(scale, std::fabs(level)),
                     [&](const TimedValue& a, const TimedValue& b) {
                         if (a.value == 0) return;
                         found.push_back({find_root(above, a.t, b.t, a.value, b.value), a.value < 0});
                     });
}

}  // namespace beamcam::sim
