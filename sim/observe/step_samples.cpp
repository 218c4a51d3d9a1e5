// Samples of a channel within a step, and how far it strays from the lines between them. MODEL.md §12, (S59).
#include <algorithm>

#include "sim/observe/constants.hpp"
#include "sim/observe/step_channels.hpp"

namespace beamcam::sim {
namespace {

StepChannels::Samples copied(const double* samples) {
    StepChannels::Samples values;
    std::copy_n(samples, values.size(), values.begin());
    return values;
}

// The contact at the samples of the interval, if `touch` has it there.
const TouchSamples* touch_at_samples(const TouchSamples* touch, const SegmentInterval& s) {
    return touch && touch->t[0] == s.from && touch->t[StepChannels::kSamples - 1] == s.to ? touch : nullptr;
}

}  // namespace

StepChannels::Samples StepChannels::sample(const SegmentInterval& s, Channel channel) {
    const TouchSamples* touch = touch_at_samples(modal_channels_.touch(), s);
    if (touch && channel.kind == ChannelKind::contact_force) return copied(touch->force);
    if (touch && channel.kind == ChannelKind::gap) return copied(touch->gap);
    if (touch && channel.kind == ChannelKind::friction_force) return copied(touch->friction);
    if (touch && channel.kind == ChannelKind::contact_x) return copied(touch->x);
    const bool is_balance = channel.kind == ChannelKind::energy_residual;
    if (is_balance && balance_) return *balance_;
    Samples values;
    Lanes nodes;
    const bool at_nodes =
        (channel.kind == ChannelKind::q || is_linear(channel.kind)) && modal_channels_.at_nodes(channel, nodes);
    for (std::size_t k = 0; k < kSamples; ++k) {
        const double t = sample_time(s, k);
        if (at_nodes && k > 0 && k <= kNodes) {
            values[k] = nodes[static_cast<int>(k) - 1];
        } else if (touch && probing_ && traits(channel.kind).needs_gap) {
            s.segment->value(t, y_.data());
            evaluator_.set(t, y_.data());
            evaluator_.set_gap(touch->gap[k], touch->force[k]);
            values[k] = evaluator_.value(channel);
        } else if (polynomial_) {
            values[k] = value_at(t, channel, polynomial_samples_[k]);
        } else {
            values[k] = value(s, channel, t);
        }
    }
    if (is_balance) balance_ = values;
    return values;
}

// The polynomial through the inner samples, its error at the ends, and the vibrations that it does not resolve.
Variation StepChannels::variation_by_nodes(const SegmentInterval& s, Channel channel, const Samples& values) const {
    const double h = s.to - s.from;
    Lanes nodes;
    for (int k = 0; k < kNodes; ++k) nodes[k] = values[static_cast<std::size_t>(k) + 1];
    Variation out;
    out.add_polynomial(nodes, h);
    out.add_missed(nodes, values[0], values[kSamples - 1], h);
    modal_channels_.add_unresolved(channel, out);
    return out;
}

// A polynomial through nodes also follows, much too steeply, vibrations that they do not resolve.
Variation StepChannels::closer_by_modes(const SegmentInterval& s, Channel channel, const Variation& by_nodes) const {
    Variation by_modes;
    const double length = kWidestNodeGap * (s.to - s.from);
    const bool closer =
        modal_channels_.vary_by_modes(channel, by_modes) && by_modes.strays(length) < by_nodes.strays(length);
    return closer ? by_modes : by_nodes;
}

Variation StepChannels::variation(const SegmentInterval& s, Channel channel, const Samples& values) const {
    const Variation by_nodes = variation_by_nodes(s, channel, values);
    return channel.kind == ChannelKind::q ? closer_by_modes(s, channel, by_nodes) : by_nodes;
}

Variation StepChannels::variation_of_estimate(const SegmentInterval& s, Channel channel, const Samples& values) const {
    return closer_by_modes(s, channel, variation_by_nodes(s, channel, values));
}

ModalChannels::Range StepChannels::sampled_range(const SegmentInterval& s, Channel channel) {
    const Samples values = sample(s, channel);
    const auto [low, high] = std::ranges::minmax(values);
    const double stray = variation(s, channel, values).strays(kWidestNodeGap * (s.to - s.from));
    return modal_channels_.within(channel.kind, {low - stray, high + stray});
}

}  // namespace beamcam::sim
