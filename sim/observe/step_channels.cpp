#include "sim/observe/step_channels.hpp"

#include <algorithm>
#include <cmath>

#include "sim/integrate/collocation.hpp"
#include "sim/observe/constants.hpp"

namespace beamcam::sim {
namespace {

// Of the state, all that the channel needs.
void evaluate_state(const SegmentInterval& s, ChannelKind kind, double t, double* y) {
    traits(kind).needs_vibration_work ? s.segment->value(t, y) : s.segment->value_without_vibration_work(t, y);
}

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
    polynomial_states_.fill(y_);
}

void StepChannels::set_phase(const Phase& phase) {
    evaluator_.set_phase(phase);
    bounded_from_ = -1;
}

void StepChannels::begin(const SegmentInterval& s) {
    const Phase& phase = evaluator_.system().phase();
    probing_ = !(phase.touching && phase.held);
    bristled_ = phase.touching && evaluator_.system().has_bristle();
    if (bounded_from_ != s.from || bounded_to_ != s.to) bound(s);
    bounded_from_ = s.from;
    bounded_to_ = s.to;
    search_again();
}

std::vector<SegmentInterval> StepChannels::parts(const SegmentInterval& s) const {
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
        modal_channels_.set({s.from, s.to, s.from - segment.t0, whole && !system.drive().prescribed(), modes,
                             segment.bounds(), segment.touch()});
        return;
    }
    for (std::size_t k = 0; k < kSamples; ++k) segment.value(sample_time(s, k), polynomial_states_[k].data());
    polynomial_bounds_.set(system, s.from, s.to, polynomial_states_.data());
    const bool touching = system.has_cam() && system.phase().touching;
    if (touching) sample_touch(s);
    modal_channels_.set({s.from, s.to, 0, true, &polynomial_bounds_.modes(), &polynomial_bounds_.motion(),
                         touching ? &polynomial_touch_ : nullptr});
}

void StepChannels::sample_touch(const SegmentInterval& s) {
    TouchSamples& touch = polynomial_touch_;
    search_again();
    for (std::size_t k = 0; k < kSamples; ++k) {
        y_ = polynomial_states_[k];
        touch.t[k] = sample_time(s, k);
        evaluator_.set(touch.t[k], y_.data());
        if (probing_) probe_contact(touch.t[k]);
        const ContactState& c = evaluator_.contact();
        polynomial_contacts_[k] = c;
        touch.gap[k] = c.gap;
        touch.gap_rate[k] = c.gap_rate;
        touch.force[k] = c.force;
        touch.friction[k] = c.friction;
        touch.x[k] = c.x;
    }
}

bool StepChannels::errors_only(ChannelKind kind) {
    const System& of = system();
    if (of.phase().held && traits(kind).zero_where_held) return true;
    return at_rest_ && (traits(kind).zero_at_rest || !of.has_cam() || of.problem().cam->speed == 0);
}

// The state of a prescribed hub is that of its drive, not the solution.
bool StepChannels::is_linear(ChannelKind kind) {
    return traits(kind).of_hub && !(polynomial_ && evaluator_.system().drive().prescribed());
}

// Geometry and forces, except in sustained contact: the probe costs less than a search of the whole beam.
void StepChannels::probe_contact(double t) {
    ContactState c = probe_.evaluate(t, y_.data(), false);
    const System& system = evaluator_.system();
    const Phase& phase = system.phase();
    if (phase.touching) {
        c.force = system.normal_law().force(-c.gap, -c.gap_rate, phase.approach);
        c.friction = system.friction().force(phase.friction, c.force, c.slip, system.bristle(y_.data()));
    }
    evaluator_.set_contact(c);
}

double StepChannels::value(const SegmentInterval& s, Channel channel, double t) {
    if (channel.kind == ChannelKind::q)
        return s.segment->coordinate(t, static_cast<std::size_t>(channel.index), y_.data());
    evaluate_state(s, channel.kind, t, y_.data());
    SampledState sampled;
    return value_of_state(channel, t, sampled);
}

double StepChannels::estimate(const SegmentInterval& s, Channel channel, double t) {
    if (!traits(channel.kind).separation) {
        s.segment->beam(t, y_.data());
        return modal_channels_.tip(channel.kind, y_.data());
    }
    if (modal_channels_.accelerated_by_vibration()) {
        s.segment->beam(t, y_.data());
        return modal_channels_.longest_arm() * modal_channels_.hub_vibration(y_.data());
    }
    evaluate_state(s, channel.kind, t, y_.data());
    evaluator_.set(t, y_.data());
    if (probing_ && evaluator_.system().phase().touching) probe_contact(t);
    return modal_channels_.longest_arm() *
           evaluator_.hub_acceleration(evaluator_.system().phase().touching ? evaluator_.contact() : ContactState{});
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

// Of the state in `y_`; takes from `sampled` what is there, else computes and keeps them.
double StepChannels::value_of_state(Channel channel, double t, SampledState& sampled) {
    std::optional<ContactState>& contact = sampled.contact;
    if (is_linear(channel.kind)) return modal_channels_.hub(channel.kind, y_.data());
    evaluator_.set(t, y_.data());
    const System& system = evaluator_.system();
    const bool stored = traits(channel.kind).needs_gap && system.phase().touching;
    if (contact) {
        evaluator_.set_contact(*contact);
    } else if (probing_ && system.has_cam() && (stored || traits(channel.kind).needs_contact)) {
        probe_contact(t);
        contact = evaluator_.contact();
    }
    if (traits(channel.kind).of_beam_energy) {
        if (sampled.energies) evaluator_.set_energies(*sampled.energies);
        sampled.energies = evaluator_.energies();
    } else if (traits(channel.kind).separation) {
        if (sampled.hub_acceleration) evaluator_.set_hub_acceleration(*sampled.hub_acceleration);
        sampled.hub_acceleration = evaluator_.hub_acceleration(evaluator_.contact());
    }
    return evaluator_.value(channel);
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

StepChannels::Samples StepChannels::sample(const SegmentInterval& s, Channel channel, SampledStates& sampled) {
    const TouchSamples* touch = touch_at_samples(modal_channels_.touch(), s);
    if (touch && channel.kind == ChannelKind::contact_force) return copied(touch->force);
    if (touch && channel.kind == ChannelKind::gap) return copied(touch->gap);
    if (touch && channel.kind == ChannelKind::friction_force) return copied(touch->friction);
    if (touch && channel.kind == ChannelKind::contact_x) return copied(touch->x);
    const bool is_balance = channel.kind == ChannelKind::energy_residual;
    if (is_balance && sampled.balance) return *sampled.balance;
    Samples values;
    Lanes nodes;
    const bool at_nodes =
        (channel.kind == ChannelKind::q || is_linear(channel.kind)) && modal_channels_.at_nodes(channel, nodes);
    for (std::size_t k = 0; k < kSamples; ++k) {
        const double t = sample_time(s, k);
        if (at_nodes && k > 0 && k <= kNodes) {
            values[k] = nodes[static_cast<int>(k) - 1];
        } else if (channel.kind == ChannelKind::q) {
            values[k] = value(s, channel, t);
        } else {
            place_sample(s, channel.kind, k, sampled);
            if (touch && probing_ && traits(channel.kind).needs_gap) {
                evaluator_.set(t, y_.data());
                evaluator_.set_gap(touch->gap[k], touch->force[k]);
                values[k] = evaluator_.value(channel);
            } else {
                if (touch && polynomial_) sampled.states[k].contact = polynomial_contacts_[k];
                values[k] = value_of_state(channel, t, sampled.states[k]);
            }
        }
    }
    if (is_balance) sampled.balance = values;
    return values;
}

// Puts the state of the sample into `y_`. Those without the work of vibration are kept for other channels.
void StepChannels::place_sample(const SegmentInterval& s, ChannelKind kind, std::size_t k, SampledStates& sampled) {
    if (polynomial_) {
        y_ = polynomial_states_[k];
        return;
    }
    if (traits(kind).needs_vibration_work) return evaluate_state(s, kind, sample_time(s, k), y_.data());
    std::vector<double>& state = sampled.states[k].y;
    if (state.empty()) {
        state.resize(y_.size());
        evaluate_state(s, kind, sample_time(s, k), state.data());
    }
    y_ = state;
}

// The polynomial through the inner samples, its error at the ends, and the vibrations that it does not resolve.
Variation StepChannels::variation(const SegmentInterval& s, Channel channel, const Samples& values) const {
    const double h = s.to - s.from;
    Lanes nodes;
    for (int k = 0; k < kNodes; ++k) nodes[k] = values[static_cast<std::size_t>(k) + 1];
    Variation out;
    out.add_polynomial(nodes, h);
    out.add_missed(nodes, values[0], values[kSamples - 1], h);
    modal_channels_.add_unresolved(channel, out);
    return out;
}

ModalChannels::Range StepChannels::range(const SegmentInterval& s, Channel channel) {
    const double first = value(s, channel, s.from), last = value(s, channel, s.to);
    return modal_channels_.range(channel, first, last);
}

ModalChannels::Range StepChannels::sampled_range(const SegmentInterval& s, Channel channel, SampledStates& sampled) {
    const Samples values = sample(s, channel, sampled);
    const auto [low, high] = std::ranges::minmax(values);
    const double stray = variation(s, channel, values).strays(kWidestNodeGap * (s.to - s.from));
    return modal_channels_.within(channel.kind, {low - stray, high + stray});
}

}  // namespace beamcam::sim
