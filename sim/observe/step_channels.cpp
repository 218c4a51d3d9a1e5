#include "sim/observe/step_channels.hpp"

#include <algorithm>
#include <cmath>

#include "sim/integrate/collocation.hpp"
#include "sim/observe/constants.hpp"

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

double sample_time(const SegmentInterval& s, std::size_t k) {
    if (k == 0) return s.from;
    if (k > kNodes) return s.to;
    return s.from + Collocation::get().c[static_cast<int>(k) - 1] * (s.to - s.from);
}

StepChannels::StepChannels(const System& system)
    : evaluator_(system),
      probe_(evaluator_.system(), true),
      basis_(evaluator_.system()),
      modal_channels_(evaluator_.system(), basis_),
      polynomial_bounds_(basis_),
      y_(static_cast<std::size_t>(system.size)) {
    for (Instant& sample : polynomial_samples_) sample.y = y_;
}

void StepChannels::set_phase(const Phase& phase) {
    evaluator_.set_phase(phase);
    bounded_from_ = -1;
    forget();
}

void StepChannels::forget() {
    instants_.clear();
    balance_.reset();
}

void StepChannels::begin(const SegmentInterval& s) {
    const Phase& phase = evaluator_.system().phase();
    probing_ = !(phase.touching && phase.held);
    bristled_ = phase.touching && evaluator_.system().has_bristle();
    if (segment_ != s.segment || segment_from_ != s.segment->t0 || segment_to_ != s.segment->t1) forget();
    segment_ = s.segment;
    segment_from_ = s.segment->t0;
    segment_to_ = s.segment->t1;
    if (bounded_from_ != s.from || bounded_to_ != s.to) {
        bounded_from_ = -1;  // those of the last interval hold no more
        bound(s);
    }
    bounded_from_ = s.from;
    bounded_to_ = s.to;
    search_again();
}

std::vector<SegmentInterval> StepChannels::parts(const SegmentInterval& s, Channel channel) const {
    return traits(channel.kind).by_samples() ? followed_parts(s) : fading_parts(s);
}

std::vector<SegmentInterval> StepChannels::followed_parts(const SegmentInterval& s) const {
    const double length = s.to - s.from, radians = length * kProductFrequency * modal_channels_.fastest();
    const auto count = polynomial_ ? 1 : static_cast<std::size_t>(std::max(1.0, std::ceil(radians / kFollowedRadians)));
    std::vector<SegmentInterval> out;
    double from = s.from;
    for (std::size_t k = 1; k <= count; ++k) {
        const double to = k < count ? s.from + length * (static_cast<double>(k) / static_cast<double>(count)) : s.to;
        out.push_back({s.segment, from, to, s.last && k == count});
        from = to;
    }
    return out;
}

std::vector<SegmentInterval> StepChannels::fading_parts(const SegmentInterval& s) const {
    const double length = s.to - s.from, fading = modal_channels_.fading();
    std::vector<SegmentInterval> out;
    double to = s.to, share = 1;
    for (bool first = false; !first; share *= kPartRatio) {
        first = !(fading * share * length > kFadedRadians) || !(s.from + kPartRatio * share * length > s.from);
        const double from = first ? s.from : s.from + kPartRatio * share * length;
        out.push_back({s.segment, from, to, s.last && to == s.to});
        to = from;
    }
    std::ranges::reverse(out);
    return out;
}

// Results must not depend on where the contact was searched before.
void StepChannels::search_again() {
    evaluator_.system().search_again();
    probe_.forget();
}

void StepChannels::bound(const SegmentInterval& s) {
    const Segment& segment = *s.segment;
    System& system = evaluator_.system();
    const ModalBounds* modes = segment.modal_bounds();
    polynomial_ = !modes;
    const double resting = kRestTolerances * system.problem().solver.atol;
    at_rest_ = modes && largest(modes->theta_dot) < resting;
    if (modes) {
        for (const Lanes& rate : modes->rate) at_rest_ = at_rest_ && largest(rate) < resting;
        const bool whole = s.from == segment.t0 && std::fabs(s.from + modes->h - s.to) <= kWholeStep * modes->h;
        modal_channels_.set({s.from, s.to, s.from - segment.t0, whole, modes, segment.bounds(), segment.touch()});
        return;
    }
    PolynomialBounds::States states;
    for (std::size_t k = 0; k < kSamples; ++k) {
        Instant& sample = polynomial_samples_[k];
        segment.value(sample_time(s, k), sample.y.data());
        states[k] = sample.y.data();
        sample.contact.reset();
        sample.energies.reset();
        sample.hub_acceleration.reset();
    }
    polynomial_bounds_.set(system, s.from, s.to, states);
    const bool touching = system.has_cam() && system.phase().touching;
    if (touching) sample_touch(s);
    modal_channels_.set({s.from, s.to, 0, true, &polynomial_bounds_.modes(), &polynomial_bounds_.motion(),
                         touching ? &polynomial_touch_ : nullptr});
}

void StepChannels::sample_touch(const SegmentInterval& s) {
    TouchSamples& touch = polynomial_touch_;
    search_again();
    for (std::size_t k = 0; k < kSamples; ++k) {
        y_ = polynomial_samples_[k].y;
        touch.t[k] = sample_time(s, k);
        evaluator_.set(touch.t[k], y_.data());
        if (probing_) probe_contact(touch.t[k]);
        const ContactState& c = evaluator_.contact();
        polynomial_samples_[k].contact = c;
        touch.gap[k] = c.gap;
        touch.gap_rate[k] = c.gap_rate;
        touch.force[k] = c.force;
        touch.friction[k] = c.friction;
        touch.x[k] = c.x;
    }
}

bool StepChannels::errors_only(ChannelKind kind) {
    const System& of = system();
    const bool held = of.phase().held;
    if (held && traits(kind).zero_where_held) return true;
    if (!at_rest_) return false;
    const bool driven =
        of.drive().has_torque() || of.drive().prescribed() || (of.has_cam() && of.problem().cam->speed != 0);
    return !driven || (traits(kind).zero_at_rest && (held || !traits(kind).separation));
}

// The state of a prescribed hub is that of its drive, not the solution.
bool StepChannels::is_linear(ChannelKind kind) {
    return traits(kind).of_hub && !(polynomial_ && evaluator_.system().drive().prescribed());
}

// Geometry and forces, except in sustained contact, by the probe, which costs less than a search of the whole beam.
void StepChannels::probe_contact(double t) {
    System& system = evaluator_.system();
    ContactState c = probe_.evaluate(t, y_.data(), false);
    const Phase& phase = system.phase();
    if (phase.touching) {
        c.force = system.normal_law().force(-c.gap, -c.gap_rate, phase.approach);
        c.friction = system.friction().force(phase.friction, c.force, c.slip, system.bristle(y_.data()));
    }
    evaluator_.set_contact(c);
}

// Without the work of vibration.
StepChannels::Instant& StepChannels::at(const SegmentInterval& s, double t) {
    if (instants_.size() > kMostSharedInstants) instants_.clear();
    Instant& instant = instants_[t];
    if (!instant.y.empty()) return instant;
    instant.y.resize(y_.size());
    s.segment->value_without_vibration_work(t, instant.y.data());
    return instant;
}

// The state of the beam without the hub's. Where the modes are the coordinates it costs little.
const double* StepChannels::beam(const SegmentInterval& s, double t) {
    if (!basis_.are_coordinates()) return at(s, t).y.data();
    s.segment->coordinates(t, y_.data());
    return y_.data();
}

double StepChannels::value(const SegmentInterval& s, Channel channel, double t) {
    if (channel.kind == ChannelKind::q && basis_.are_coordinates())  // one group of modes
        return s.segment->coordinate(t, static_cast<std::size_t>(channel.index), y_.data());
    if (traits(channel.kind).needs_vibration_work && !polynomial_) {
        Instant own;
        own.y.resize(y_.size());
        s.segment->value(t, own.y.data());
        return value_at(t, channel, own);
    }
    return value_at(t, channel, at(s, t));
}

double StepChannels::estimate(const SegmentInterval& s, Channel channel, double t) {
    if (traits(channel.kind).of_tip) return modal_channels_.tip(channel.kind, beam(s, t));
    if (modal_channels_.accelerated_by_modes())
        return modal_channels_.longest_arm() * modal_channels_.hub_acceleration(t, beam(s, t));
    Instant& shared = at(s, t);
    y_ = shared.y;
    evaluator_.set(t, y_.data());
    if (probing_ && evaluator_.system().phase().touching) share_contact(t, shared);
    return modal_channels_.longest_arm() * share_hub_acceleration(shared);
}

StepChannels::Samples StepChannels::estimates(const SegmentInterval& s, Channel channel) {
    Samples values;
    Lanes nodes;
    const bool at_nodes = modal_channels_.at_nodes(channel, nodes);
    for (std::size_t k = 0; k < kSamples; ++k)
        values[k] =
            at_nodes && k > 0 && k <= kNodes ? nodes[static_cast<int>(k) - 1] : estimate(s, channel, sample_time(s, k));
    return values;
}

// Takes from `shared` what is there, else computes and keeps it.
double StepChannels::value_at(double t, Channel channel, Instant& shared) {
    y_ = shared.y;
    if (channel.kind == ChannelKind::q) return y_[static_cast<std::size_t>(channel.index)];
    if (is_linear(channel.kind)) return modal_channels_.hub(channel.kind, y_.data());
    evaluator_.set(t, y_.data());
    const System& system = evaluator_.system();
    const bool stored = traits(channel.kind).needs_gap && system.phase().touching;
    if (shared.contact || (probing_ && system.has_cam() && (stored || traits(channel.kind).needs_contact)))
        share_contact(t, shared);
    if (traits(channel.kind).of_beam_energy) {
        if (shared.energies) evaluator_.set_energies(*shared.energies);
        shared.energies = evaluator_.energies();
    } else if (traits(channel.kind).separation) {
        share_hub_acceleration(shared);
    }
    return evaluator_.value(channel);
}

void StepChannels::share_contact(double t, Instant& shared) {
    if (shared.contact)
        evaluator_.set_contact(*shared.contact);
    else
        probe_contact(t);
    shared.contact = evaluator_.contact();
}

double StepChannels::share_hub_acceleration(Instant& shared) {
    if (shared.hub_acceleration) evaluator_.set_hub_acceleration(*shared.hub_acceleration);
    const bool touching = evaluator_.system().phase().touching;
    shared.hub_acceleration = evaluator_.hub_acceleration(touching ? evaluator_.contact() : ContactState{});
    return *shared.hub_acceleration;
}

void StepChannels::values(const SegmentInterval& s, double t, const std::vector<Channel>& channels,
                          const System::EnergyBalance* balance, std::vector<double>& out) {
    s.segment->value(t, y_.data());
    evaluator_.set(t, y_.data());
    if (probing_ && evaluator_.system().has_cam()) probe_contact(t);
    if (balance) evaluator_.set_energy_balance(*balance);
    for (std::size_t c = 0; c < channels.size(); ++c) {
        if (channels[c].kind == ChannelKind::q)
            out[c] = y_[static_cast<std::size_t>(channels[c].index)];
        else if (is_linear(channels[c].kind))
            out[c] = modal_channels_.hub(channels[c].kind, y_.data());
        else if (!traits(channels[c].kind).estimated())
            out[c] = evaluator_.value(channels[c]);
        else if (!traits(channels[c].kind).separation)
            out[c] = modal_channels_.tip(channels[c].kind, y_.data());
        else
            out[c] = evaluator_.system().has_cam() ? 0 : kNan;
    }
}

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

Variation StepChannels::variation(const SegmentInterval& s, Channel channel, const Samples& values) const {
    if (channel.kind == ChannelKind::q) return variation_of_modes(s, channel, values);
    return variation_by_nodes(s, channel, values);
}

// A polynomial through nodes also follows, much too steeply, vibrations that they do not resolve.
Variation StepChannels::variation_of_modes(const SegmentInterval& s, Channel channel, const Samples& values) const {
    const Variation by_nodes = variation_by_nodes(s, channel, values);
    Variation by_modes;
    const double length = kWidestNodeGap * (s.to - s.from);
    const bool closer =
        modal_channels_.vary_by_modes(channel, by_modes) && by_modes.strays(length) < by_nodes.strays(length);
    return closer ? by_modes : by_nodes;
}

ModalChannels::Range StepChannels::range(const SegmentInterval& s, Channel channel) {
    if (depends_on_bristle(channel.kind)) return range(s, channel, sample(s, channel));
    const double first = value(s, channel, s.from), last = value(s, channel, s.to);
    return modal_channels_.range(channel, first, last);
}

ModalChannels::Range StepChannels::range(const SegmentInterval& s, Channel channel, const Samples& values) const {
    const auto [low, high] = std::ranges::minmax(values);
    const double stray = variation(s, channel, values).strays(kWidestNodeGap * (s.to - s.from));
    return modal_channels_.within(channel.kind, {low - stray, high + stray});
}

}  // namespace beamcam::sim
