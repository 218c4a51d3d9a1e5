#include "sim/observe/extrema.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/base/numerics.hpp"

namespace beamcam::sim {

constexpr double kRefinedRise = 1e-5;  // of that: a rise between samples, which moves the extremum's instant

struct ExtremaFinder::Best {
    double t, value;
    void offer(double at, double of) {
        if (of > value) *this = {at, of};
    }
};

ExtremaFinder::ExtremaFinder(const System& system, std::vector<Channel> channels)
    : step_(system), channels_(std::move(channels)) {}

void ExtremaFinder::step(const SegmentInterval& s, std::vector<Extremum>& extrema) {
    if (channels_.empty()) return;
    const auto negligible = [&](const Extremum& e) { return e.max > e.min ? kNegligibleRise * (e.max - e.min) : 0; };
    step_.begin(s);
    const auto needs_more = [&](std::size_t c, double low, double high, double stray) {
        const Extremum& e = extrema[c];
        return stray > negligible(e) && (high + stray > e.max || low - stray < e.min);
    };
    const auto see = [&](std::size_t c, double t, double value) {
        Extremum& e = extrema[c];
        if (value > e.max) e.max = value, e.t_max = t;
        if (value < e.min) e.min = value, e.t_min = t;
    };
    const auto& all = step_.sample(channels_, needs_more, see);
    for (std::size_t c = 0; c < channels_.size(); ++c) {
        Extremum& e = extrema[c];
        Best high{e.t_max, e.max}, low{e.t_min, -e.min};
        for (std::size_t k = 0; k < all[c].t.size(); ++k) {
            high.offer(all[c].t[k], all[c].value[k]);
            low.offer(all[c].t[k], -all[c].value[k]);
        }
        const double rise = kRefinedRise * negligible({-low.value, low.t, high.value, high.t});
        raise(all[c], channels_[c], 1, rise, high);
        raise(all[c], channels_[c], -1, rise, low);
        e = {-low.value, low.t, high.value, high.t};
    }
}

void ExtremaFinder::contact_peaks(const SegmentInterval& s, ImpactPeaks& peaks) {
    constexpr std::array kChannelsOfContact{Channel{ChannelKind::contact_force}, Channel{ChannelKind::gap}};
    const std::array before{peaks.force.value_or(0), peaks.penetration};
    step_.begin(s);
    const auto& all = step_.sample(kChannelsOfContact, [&](std::size_t c, double low, double high, double stray) {
        return stray > kNegligibleRise * before[c] && (c == 0 ? high : -low) + stray > before[c];
    });
    for (std::size_t c = 0; c < all.size(); ++c) {
        const double sign = c == 0 ? 1 : -1;
        Best best{c == 0 ? peaks.t_force.value_or(s.from) : s.from, before[c]};
        for (std::size_t k = 0; k < all[c].t.size(); ++k) best.offer(all[c].t[k], sign * all[c].value[k]);
        raise(all[c], kChannelsOfContact[c], sign, kNegligibleRise * best.value, best);
        if (c == 0)
            peaks.force = best.value, peaks.t_force = best.t;
        else
            peaks.penetration = best.value;
    }
}

// The parabolas through three neighbouring samples promise maxima of the channel times the sign. Those that may exceed
// the best value by more than `negligible` are found on the dense output, the most promising first.
void ExtremaFinder::raise(const StepSamples::Series& series, Channel channel, double sign, double negligible,
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
    const auto f = [&](double t) { return sign * step_.value(channel, t); };
    for (const auto& [value, k] : promises) {
        if (!(value > best.value + negligible)) return;
        const Vec2 top = climb(f, point(k - 1), point(k), point(k + 1), best.value, negligible);
        best.offer(top.x, top.y);
    }
}

}  // namespace beamcam::sim
