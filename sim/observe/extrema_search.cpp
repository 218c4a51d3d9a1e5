// The search of extrema within one step.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/base/numerics.hpp"
#include "sim/observe/best_values.hpp"
#include "sim/observe/extrema.hpp"

namespace beamcam::sim {

void ExtremaFinder::search_parts(const SegmentInterval& s, Channel channel, double sign, Extremum& e) {
    step_.begin(s);  // as if nothing had been searched before
    const std::vector<SegmentInterval> parts = step_.parts(s, channel);
    if (parts.size() == 1 || channel.kind == ChannelKind::energy_residual) return search(s, channel, sign, e);
    // Vibrations of which too little reaches the channel need no parts.
    if (!traits(channel.kind).by_samples() && is_beaten(sampled_range(s, channel, e), channel.kind, sign, e)) return;
    halvings_left_ -= static_cast<long>(parts.size()) - 1;
    if (halvings_left_ < 0) {
        ++incomplete_;
        return;
    }
    for (const SegmentInterval& part : parts) {
        if (poll_ && (evaluations_ += kNodes) % kEvaluationsPerPoll < kNodes) poll_();
        step_.begin(part);
        if (is_beaten(step_.range(part, channel), channel.kind, sign, e)) continue;
        step_.begin(part);
        search(part, channel, sign, e);
    }
    step_.begin(s);
}

void ExtremaFinder::search(const SegmentInterval& s, Channel channel, double sign, Extremum& e) {
    if (channel.kind == ChannelKind::contact_s) return search_arc(s, sign, e);
    if (traits(channel.kind).estimated() && estimate_is_beaten(s, channel, sign, e)) return;
    const Samples samples = step_.sample(s, channel);
    if (channel.kind == ChannelKind::energy_residual && !step_.polynomial()) {  // an error: its nodes are enough
        for (std::size_t k = 0; k < samples.size(); ++k) offer(e, sample_time(s, k), samples[k]);
        return;
    }
    BestValue best = best_so_far(channel.kind, sign, e);
    const double before = best.value;
    const auto value = [&](double t) { return step_.value(s, channel, t); };
    if (!climb_step(value, step_.variation(s, channel, samples), s, channel, samples, best)) ++incomplete_;
    if (best.value > before) offer(e, best.t, sign * best.value);
}

// The estimate of a costly channel, plus its error, excludes most steps.
bool ExtremaFinder::estimate_is_beaten(const SegmentInterval& s, Channel channel, double sign, const Extremum& e) {
    BestValue best = best_so_far(channel.kind, sign, e);
    const double error = step_.modes().estimate_error(channel), most = best.value - error;
    if (!(most > 0)) return false;
    best.value = most - best.left_out;
    const auto estimate = [&](double t) { return step_.estimate(s, channel, t); };
    const Samples samples = step_.estimates(s, channel);
    return climb_step(estimate, step_.variation_of_modes(s, channel, samples), s, channel, samples, best) &&
           best.value <= most;
}

// Raises `best` to the largest value of f in the step; false if the search ended before.
template <class F>
bool ExtremaFinder::climb_step(const F& f, const Variation& variation, const SegmentInterval& s, Channel channel,
                               const Samples& samples, BestValue& best) {
    best.left_out = std::max(best.left_out, step_.modes().rounding(channel.kind));
    for (std::size_t k = 0; k < samples.size(); ++k) best.offer({sample_time(s, k), samples[k]});
    const auto [low, high] = std::ranges::minmax(samples);
    const double farthest = variation.strays(kWidestNodeGap * (s.to - s.from));
    if (std::max(best.sign * low, best.sign * high) + farthest <= best.to_beat()) return true;
    const double radians = (s.to - s.from) * step_.system().highest_frequency();
    const double needed = std::min(kFewestHalvings + kHalvingsPerRadian * radians, kMostHalvings);
    const long allowed = std::min(halvings_left_, static_cast<long>(needed));
    best.intervals = allowed;
    const auto polled = [&](double t) {
        if (++evaluations_ % kEvaluationsPerPoll == 0 && poll_) poll_();
        return f(t);
    };
    if (const auto mode = step_.undamped_mode(channel))
        climb_crests(polled, variation, *mode, s.from, s.to, best);
    else
        for (std::size_t k = 0; k + 1 < samples.size(); ++k)
            climb(polled, variation, {sample_time(s, k), samples[k]}, {sample_time(s, k + 1), samples[k + 1]}, best);
    halvings_left_ -= allowed - std::max(best.intervals, 0L);
    return best.intervals >= 0;
}

double ExtremaFinder::rim() { return 2 * std::numbers::pi * step_.system().problem().cam->radius; }

// The arc on the disc jumps at a mark; without that jump, next to another.
double ExtremaFinder::unwrapped(double arc, double near) { return arc - rim() * std::round((arc - near) / rim()); }

// The arc has a corner where the foot of the contact reaches or leaves an end of the beam.
template <class F>
void ExtremaFinder::offer_corners(const F& arc, const SegmentInterval& s, const Samples& feet, BestValue& best) {
    const double length = step_.system().problem().beam.length;
    const auto at_end = [&](double x) { return !(x > 0 && x < length); };
    for (std::size_t k = 0; k + 1 < feet.size(); ++k) {
        const bool before = at_end(feet[k]);
        if (at_end(feet[k + 1]) == before) continue;
        double a = sample_time(s, k), b = sample_time(s, k + 1);
        for (double t = 0.5 * (a + b); t > a && t < b; t = 0.5 * (a + b))
            (at_end(step_.value(s, {ChannelKind::contact_x}, t)) == before ? a : b) = t;
        best.offer({a, arc(a)});
        best.offer({b, arc(b)});
    }
}

void ExtremaFinder::search_arc(const SegmentInterval& s, double sign, Extremum& e) {
    constexpr Channel kArc{ChannelKind::contact_s};
    Samples samples = step_.sample(s, kArc);
    const Samples feet = step_.sample(s, {ChannelKind::contact_x});
    const double first = samples[0];
    const auto arc = [&](double t) { return unwrapped(step_.value(s, kArc, t), first); };
    for (double& value : samples) value = unwrapped(value, first);
    BestValue best = best_so_far(kArc.kind, sign, e);
    const double before = best.value;
    if (!climb_step(arc, step_.variation(s, kArc, samples), s, kArc, samples, best)) ++incomplete_;
    offer_corners(arc, s, feet, best);
    if (!(best.value > before)) return;
    const double value = sign * best.value;
    if (value >= 0 && unwrapped(value, 0) != 0 && value < rim()) return offer(e, best.t, value);
    // It passes the mark, where it is as small and as large as it can be.
    const double mark = value < 0 ? 0 : rim();
    const double t =
        find_root([&](double at) { return arc(at) - mark; }, std::min(s.from, best.t), std::max(s.from, best.t));
    offer(e, t, 0);
    offer(e, t, std::nextafter(rim(), 0.0));
}

void ExtremaFinder::contact_peaks(const SegmentInterval& s, ImpactPeaks& peaks) {
    step_.begin(s);
    Extremum of_force{0, s.from, peaks.force.value_or(0), s.from}, of_gap{-peaks.penetration, s.from, 0, s.from};
    const auto raise = [&](ChannelKind kind, double sign, Extremum& e) {
        if (step_.modes().touch() && is_beaten(step_.modes().range({kind}, 0, 0), kind, sign, e)) return;
        search_parts(s, {kind}, sign, e);
    };
    if (step_.system().phase().touching) raise(ChannelKind::contact_force, 1, of_force);
    if (!step_.system().phase().held) raise(ChannelKind::gap, -1, of_gap);
    peaks = {of_force.max, -of_gap.min};
}

}  // namespace beamcam::sim
