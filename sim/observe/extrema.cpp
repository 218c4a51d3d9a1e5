#include "sim/observe/extrema.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/base/numerics.hpp"

namespace beamcam::sim {

namespace {

constexpr double kRefinedRise = 1e-5;  // of that: a rise between samples, which moves the extremum's instant

struct Best {
    double t, value;
    void offer(double at, double of) {
        if (of > value) *this = {at, of};
    }
};

// The parabolas through three neighbouring samples promise maxima of the channel times the sign. Those that may exceed
// the best value by more than `negligible` are found on the dense output, the most promising first.
void raise(StepSamples& step, const StepSamples::Series& series, Channel channel, double sign, double negligible,
           Best& best) {
    struct Promise {
        double value;
        std::size_t at;
    };
    const auto point = [&](std::size_t k) { return Vec2{series.t[k], sign * series.value[k]}; };
    std::vector<Promise> promises;
    for (std::size_t k = 1; k + 1 < series.t.size(); ++k)
        if (const auto top = vertex(point(k - 1), point(k), point(k + 1))) {
            const double rise = top->y - std::max({point(k - 1).y, point(k).y, point(k + 1).y});
            const double value = top->y + kParabolaError * rise;
            if (value > best.value + negligible) promises.push_back({value, k});
        }
    std::ranges::sort(promises, std::ranges::greater(), &Promise::value);
    const auto f = [&](double t) { return sign * step.value(channel, t); };
    for (const auto& [value, k] : promises) {
        if (!(value > best.value + negligible)) return;
        const Vec2 top = climb(f, point(k - 1), point(k), point(k + 1), best.value, negligible);
        best.offer(top.x, top.y);
    }
}

}  // namespace

void raise_extrema(StepSamples& step, const SegmentInterval& s, std::span<const Channel> channels,
                   std::span<Extremum> extrema) {
    if (channels.empty()) return;
    const auto negligible = [&](const Extremum& e) { return e.max > e.min ? kNegligibleRise * (e.max - e.min) : 0; };
    const auto needs_more = [&](std::size_t c, double low, double high, double stray) {
        const Extremum& e = extrema[c];
        return stray > negligible(e) && (high + stray > e.max || low - stray < e.min);
    };
    const auto see = [&](std::size_t c, double t, double value) {
        Extremum& e = extrema[c];
        if (value > e.max) e.max = value, e.t_max = t;
        if (value < e.min) e.min = value, e.t_min = t;
    };
    const auto all = step.sample(s, channels, needs_more, see);
    for (std::size_t c = 0; c < channels.size(); ++c) {
        Extremum& e = extrema[c];
        Best high{e.t_max, e.max}, low{e.t_min, -e.min};
        for (std::size_t k = 0; k < all[c].t.size(); ++k) {
            high.offer(all[c].t[k], all[c].value[k]);
            low.offer(all[c].t[k], -all[c].value[k]);
        }
        const double rise = kRefinedRise * negligible({-low.value, low.t, high.value, high.t});
        raise(step, all[c], channels[c], 1, rise, high);
        raise(step, all[c], channels[c], -1, rise, low);
        e = {-low.value, low.t, high.value, high.t};
    }
}

void raise_peaks(StepSamples& step, const SegmentInterval& s, Impact& impact) {
    constexpr std::array kChannelsOfContact{Channel{ChannelKind::contact_force}, Channel{ChannelKind::gap}};
    std::array peaks{Best{impact.t_peak.value_or(s.from), impact.force_peak.value_or(0)},
                     Best{s.from, impact.penetration_peak}};
    const auto all = step.sample(s, kChannelsOfContact, [&](std::size_t c, double low, double high, double stray) {
        return stray > kNegligibleRise * peaks[c].value && (c == 0 ? high : -low) + stray > peaks[c].value;
    });
    for (std::size_t c = 0; c < all.size(); ++c) {
        const double sign = c == 0 ? 1 : -1;
        for (std::size_t k = 0; k < all[c].t.size(); ++k) peaks[c].offer(all[c].t[k], sign * all[c].value[k]);
        raise(step, all[c], kChannelsOfContact[c], sign, kNegligibleRise * peaks[c].value, peaks[c]);
    }
    impact.force_peak = peaks[0].value, impact.t_peak = peaks[0].t;
    impact.penetration_peak = peaks[1].value;
}

}  // namespace beamcam::sim
