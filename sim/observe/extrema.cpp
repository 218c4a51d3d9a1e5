#include "sim/observe/extrema.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/base/numerics.hpp"
#include "sim/integrate/collocation.hpp"
#include "sim/observe/constants.hpp"
#include "sim/observe/crest_search.hpp"

namespace beamcam::sim {
namespace {

double negligible(ChannelKind kind) {
    return kind == ChannelKind::energy_residual ? kNegligibleImbalance : kNegligibleRise;
}

BestValue best_so_far(ChannelKind kind, double sign, const Extremum& e) {
    return sign > 0 ? BestValue{sign, e.max, e.t_max, negligible(kind)}
                    : BestValue{sign, -e.min, e.t_min, negligible(kind)};
}

void offer(Extremum& e, double t, double value) {
    if (value < e.min) {
        e.min = value;
        e.t_min = t;
    }
    if (value > e.max) {
        e.max = value;
        e.t_max = t;
    }
}

double sample_time(const SegmentInterval& s, std::size_t k) {
    if (k == 0) return s.from;
    if (k > kNodes) return s.to;
    return s.from + Collocation::get().c[static_cast<int>(k) - 1] * (s.to - s.from);
}

bool is_separation(ChannelKind kind) {
    return kind == ChannelKind::separation || kind == ChannelKind::separation_paper;
}

// Channels that cost much; at the ends of a step an estimate will do.
bool is_estimated(ChannelKind kind) {
    return kind == ChannelKind::tip_deflection || kind == ChannelKind::tip_rate || is_separation(kind);
}

bool is_of_hub(ChannelKind kind) { return kind == ChannelKind::theta || kind == ChannelKind::theta_dot; }

// While they touch.
bool needs_gap(ChannelKind kind) {
    return kind == ChannelKind::energy_contact || kind == ChannelKind::energy_residual ||
           kind == ChannelKind::loss_contact;
}

bool needs_contact(ChannelKind kind) {
    return kind == ChannelKind::gap || kind == ChannelKind::contact_x || kind == ChannelKind::contact_s ||
           kind == ChannelKind::contact_force || is_separation(kind);
}

}  // namespace

ExtremaFinder::ExtremaFinder(const System& system, std::vector<Channel> channels)
    : evaluator_(system),
      probe_(evaluator_.system(), true),
      modal_channels_(evaluator_.system()),
      channels_(std::move(channels)),
      y_(static_cast<std::size_t>(system.size)),
      first_(channels_.size()),
      last_(channels_.size()),
      candidates_(channels_.size()) {}

void ExtremaFinder::set_phase(const Phase& phase) {
    evaluator_.set_phase(phase);
    last_time_ = bounded_from_ = -1;
}

void ExtremaFinder::begin(double start_energy, const double* y, std::vector<Extremum>& extrema) {
    evaluator_.set_start_energy(start_energy);
    evaluator_.set(0, y);
    for (std::size_t c = 0; c < channels_.size(); ++c) offer(extrema[c], 0, evaluator_.value(channels_[c]));
}

// What is found must not depend on where the contact was looked for before.
void ExtremaFinder::search_contact_again() {
    evaluator_.system().search_again();
    probe_.forget();
}

// Geometry and normal force: the probe costs less than a search of the whole beam.
void ExtremaFinder::look_for_contact(double t) {
    ContactState c = probe_.evaluate(t, y_.data(), false);
    const System& system = evaluator_.system();
    if (system.phase().touching) c.force = system.normal_law().force(-c.gap, -c.gap_rate, system.phase().approach);
    evaluator_.set_contact(c);
}

double ExtremaFinder::evaluate(const SegmentInterval& s, Channel channel, double t) {
    if (channel.kind == ChannelKind::q)
        return s.segment->coordinate(t, static_cast<std::size_t>(channel.index), y_.data());
    s.segment->value(t, y_.data());
    std::optional<ContactState> contact;
    return value_of_state(channel, t, contact);
}

// Of the state in `y_`; `contact` is used where it is known, and kept where it is worked out.
double ExtremaFinder::value_of_state(Channel channel, double t, std::optional<ContactState>& contact) {
    if (modal_ && is_of_hub(channel.kind)) return modal_channels_.hub(channel.kind, y_.data());
    evaluator_.set(t, y_.data());
    const bool stored = needs_gap(channel.kind) && evaluator_.system().phase().touching;
    if (probing_ && evaluator_.system().has_cam() && (stored || needs_contact(channel.kind))) {
        if (contact)
            evaluator_.set_contact(*contact);
        else
            look_for_contact(t);
        contact = evaluator_.contact();
    }
    if (probing_ && stored) evaluator_.set_gap(contact->gap);
    return evaluator_.value(channel);
}

void ExtremaFinder::evaluate_all(const SegmentInterval& s, double t, std::vector<double>& values) {
    s.segment->value(t, y_.data());
    evaluator_.set(t, y_.data());
    if (modal_ && evaluator_.system().has_cam()) {
        const bool touching = evaluator_.system().phase().touching;
        if (!touching || evaluator_.system().friction().kinetic == 0) look_for_contact(t);
        if (touching) evaluator_.set_gap(evaluator_.contact().gap);
    }
    for (std::size_t c = 0; c < channels_.size(); ++c) {
        if (!modal_ || !is_estimated(channels_[c].kind))
            values[c] = evaluator_.value(channels_[c]);
        else if (!is_separation(channels_[c].kind))
            values[c] = modal_channels_.tip(channels_[c].kind, y_.data());
        else
            values[c] = evaluator_.system().has_cam() ? 0 : kNan;  // only bounded
    }
}

bool ExtremaFinder::set_bounds(const SegmentInterval& s) {
    if (bounded_from_ != s.from) modal_ = modal_channels_.set(*s.segment, s.from, s.to);
    bounded_from_ = s.from;
    probing_ = s.segment->bounds() != nullptr && (modal_ || s.segment->touch());
    search_contact_again();
    return modal_;
}

// The values at the ends of the step; where they are estimates, the true one at its end if it seems to be of use.
void ExtremaFinder::offer_ends(const SegmentInterval& s, std::size_t c, Extremum& e) {
    if (!is_estimated(channels_[c].kind)) {
        offer(e, s.from, first_[c]);
        offer(e, s.to, last_[c]);
    } else if (!is_separation(channels_[c].kind) && (last_[c] < e.min || last_[c] > e.max)) {
        offer(e, s.to, evaluator_.value(channels_[c]));
    }
}

// Bounds of the channel, from the cheapest on; nothing as soon as they are `beaten`.
template <class Beaten>
std::optional<ModalChannels::Range> ExtremaFinder::range_within(std::size_t c, Beaten&& beaten) const {
    const Channel& channel = channels_[c];
    const bool mode = channel.kind == ChannelKind::q;  // whose bounds are as close as those from the nodes
    if (mode && beaten(modal_channels_.mode_range(channel))) return std::nullopt;
    const ModalChannels::Range range = modal_channels_.range(channel, first_[c], last_[c]);
    if (beaten(range)) return std::nullopt;
    return mode ? range : modal_channels_.range_by_nodes(channel, first_[c], last_[c]).value_or(range);
}

void ExtremaFinder::step(const SegmentInterval& s, std::vector<Extremum>& extrema) {
    if (channels_.empty()) return;
    if (!set_bounds(s)) {
        last_time_ = -1;
        for (const SegmentInterval& part : parts(s)) search_now(part, extrema);
        return;
    }
    if (last_time_ == s.from)
        std::swap(first_, last_);
    else
        evaluate_all(s, s.from, first_);
    evaluate_all(s, s.to, last_);
    last_time_ = s.to;
    std::shared_ptr<const KeptStep> kept;
    for (std::size_t c = 0; c < channels_.size(); ++c) {
        if (std::isnan(first_[c])) continue;
        offer_ends(s, c, extrema[c]);
        const auto beaten = [&](const ModalChannels::Range& range, double sign) {
            return (sign > 0 ? range.high : -range.low) <= best_so_far(channels_[c].kind, sign, extrema[c]).to_beat();
        };
        const std::optional<ModalChannels::Range> range =
            range_within(c, [&](const ModalChannels::Range& r) { return beaten(r, 1) && beaten(r, -1); });
        if (!range) continue;
        for (const double sign : {1.0, -1.0}) {
            if (beaten(*range, sign)) continue;
            Candidates& candidates = candidates_[c][sign > 0 ? 0 : 1];
            const double high = sign > 0 ? range->high : -range->low;
            if (is_separation(channels_[c].kind) && high > kHigherPromise * candidates.promise) {
                candidates.promise = high;
                offer(extrema[c], s.to, evaluator_.value(channels_[c]));
                if (beaten(*range, sign)) continue;
            }
            if (!kept) kept = keep(s);
            candidates.steps.push_back({high, kept});
        }
    }
    if (kept_numbers_ > kMostKeptNumbers) search_kept(extrema);
}

std::shared_ptr<const ExtremaFinder::KeptStep> ExtremaFinder::keep(const SegmentInterval& s) {
    KeptStep step{evaluator_.system().phase(), s.from, s.to, s.segment->t0, s.segment->t1, kept_steps_++, {}, {}};
    s.segment->numbers(step.numbers);
    kept_numbers_ += step.numbers.size();
    return std::make_shared<const KeptStep>(std::move(step));
}

void ExtremaFinder::finish(std::vector<Extremum>& extrema) { search_kept(extrema); }

void ExtremaFinder::search_kept(std::vector<Extremum>& extrema) {
    const Phase phase = evaluator_.system().phase();
    loaded_ = nullptr;
    for (std::size_t c = 0; c < channels_.size(); ++c)
        for (const double sign : {1.0, -1.0})
            search_candidates(c, sign, candidates_[c][sign > 0 ? 0 : 1].steps, extrema[c]);
    kept_numbers_ = 0;
    set_phase(phase);
}

bool ExtremaFinder::less_promising(const Candidate& a, const Candidate& b) {
    return a.high != b.high ? a.high < b.high : a.step->order > b.step->order;
}

// The most promising first, until the rest is beaten.
void ExtremaFinder::search_candidates(std::size_t c, double sign, std::vector<Candidate>& candidates, Extremum& e) {
    if (!stored_ && !candidates.empty())
        stored_ = make_stored_segment(SegmentKind::exponential, evaluator_.system().problem());
    std::ranges::make_heap(candidates, less_promising);
    for (; !candidates.empty(); candidates.pop_back()) {
        std::ranges::pop_heap(candidates, less_promising);
        const Candidate& candidate = candidates.back();
        if (candidate.high <= best_so_far(channels_[c].kind, sign, e).to_beat()) break;
        const KeptStep& step = *candidate.step;
        const SegmentInterval s{stored_.get(), step.from, step.to, false};
        if (loaded_ != &step) {
            loaded_ = &step;
            stored_->load(step.t0, step.t1, step.numbers);
            set_phase(step.phase);
            set_bounds(s);
        }
        search(s, channels_[c], sign, sample_kept(step, s, c), e);
    }
    candidates.clear();
}

// Steps that span many periods of vibration without bounds of the modes, in parts that are polynomials as others are.
std::vector<SegmentInterval> ExtremaFinder::parts(const SegmentInterval& s) {
    if (modal_ || !s.segment->bounds()) return {s};
    const double wanted = std::ceil((s.to - s.from) * s.segment->bounds()->fastest / kFollowedRadians);
    const auto count = static_cast<long>(std::clamp(wanted, 1.0, kMostStepParts));
    if (wanted > kMostStepParts) ++incomplete_;
    std::vector<SegmentInterval> out;
    double from = s.from;
    for (long i = 1; i <= count; ++i) {
        const double share = static_cast<double>(i) / static_cast<double>(count);
        const double to = i == count ? s.to : s.from + (s.to - s.from) * share;
        out.push_back({s.segment, from, to, s.last && i == count});
        from = to;
    }
    return out;
}

// Of a step that resolves all vibration: all channels are sampled at once.
void ExtremaFinder::search_now(const SegmentInterval& s, std::vector<Extremum>& extrema) {
    std::vector<Values> values(channels_.size());
    for (std::size_t k = 0; k < kSamples; ++k) {
        evaluate_all(s, sample_time(s, k), last_);
        for (std::size_t c = 0; c < channels_.size(); ++c) values[c][k] = last_[c];
    }
    for (std::size_t c = 0; c < channels_.size(); ++c) {
        if (std::isnan(values[c][0])) continue;
        for (const double sign : {1.0, -1.0}) search(s, channels_[c], sign, values[c], extrema[c]);
    }
}

ExtremaFinder::Values ExtremaFinder::copied(const double* samples) {
    Values values;
    std::copy_n(samples, kSamples, values.begin());
    return values;
}

// What the step knows of its contact, if its instants are those of the samples.
const TouchSamples* ExtremaFinder::known_contact(const SegmentInterval& s) const {
    const TouchSamples* touch = s.segment->touch();
    return touch && touch->t[0] == s.from && touch->t[kSamples - 1] == s.to ? touch : nullptr;
}

ExtremaFinder::Values ExtremaFinder::sample(const SegmentInterval& s, Channel channel) {
    StepSamples nothing;
    return sample(s, channel, nothing);
}

// `known` has what earlier samples of the step left, and takes what these add.
ExtremaFinder::Values ExtremaFinder::sample(const SegmentInterval& s, Channel channel, StepSamples& known) {
    Values values;
    const TouchSamples* touch = known_contact(s);
    if (touch && channel.kind == ChannelKind::contact_force) return copied(touch->force);
    if (touch && channel.kind == ChannelKind::gap) return copied(touch->gap);
    if (touch && channel.kind == ChannelKind::contact_x) return copied(touch->x);
    Lanes nodes;
    const bool linear = channel.kind == ChannelKind::q || is_of_hub(channel.kind);
    const bool at_nodes = modal_ && linear && modal_channels_.at_nodes(channel, nodes);
    for (std::size_t k = 0; k < kSamples; ++k) {
        const double t = sample_time(s, k);
        if (at_nodes && k > 0 && k <= kNodes) {
            values[k] = nodes[static_cast<int>(k) - 1];
        } else if (channel.kind == ChannelKind::q) {
            values[k] = evaluate(s, channel, t);
        } else {
            place_sample(s, k, known);
            if (touch && needs_gap(channel.kind)) {
                evaluator_.set(t, y_.data());
                evaluator_.set_gap(touch->gap[k]);
                values[k] = evaluator_.value(channel);
            } else {
                values[k] = value_of_state(channel, t, known.contacts[k]);
            }
        }
    }
    return values;
}

// Puts the state into `y_`.
void ExtremaFinder::place_sample(const SegmentInterval& s, std::size_t k, StepSamples& known) {
    const std::size_t size = y_.size();
    if (known.states.empty()) {
        known.states.resize(kSamples * size);
        for (std::size_t j = 0; j < kSamples; ++j) s.segment->value(sample_time(s, j), known.states.data() + j * size);
    }
    std::copy_n(known.states.begin() + static_cast<std::ptrdiff_t>(k * size), size, y_.begin());
}

const ExtremaFinder::Values& ExtremaFinder::sample_kept(const KeptStep& step, const SegmentInterval& s, std::size_t c) {
    StepSamples& known = step.samples;
    known.values.resize(channels_.size());
    if (known.values[c]) return *known.values[c];
    if (!is_separation(channels_[c].kind)) return known.values[c].emplace(sample(s, channels_[c], known));
    // Both at once: their costly part is the same.
    for (const Channel& channel : channels_)
        if (is_separation(channel.kind)) known.values[static_cast<std::size_t>(&channel - channels_.data())].emplace();
    for (std::size_t k = 0; k < kSamples; ++k) {
        place_sample(s, k, known);
        double value = value_of_state(channels_[c], sample_time(s, k), known.contacts[k]);
        for (std::size_t other = 0; other < channels_.size(); ++other)
            if (is_separation(channels_[other].kind))
                (*known.values[other])[k] = other == c ? value : evaluator_.value(channels_[other]);
    }
    return *known.values[c];
}

// The polynomial through the inner samples, what it misses at the ends, and vibrations that it does not resolve.
Variation ExtremaFinder::variation(const SegmentInterval& s, Channel channel, const Values& values) {
    const double h = s.to - s.from;
    Lanes nodes;
    for (int k = 0; k < kNodes; ++k) nodes[k] = values[static_cast<std::size_t>(k) + 1];
    Variation out;
    out.add_polynomial(nodes, h);
    out.add_missed(nodes, values[0], values[kSamples - 1], h);
    if (modal_) modal_channels_.add_unresolved(channel, out);
    return out;
}

// The arc on the disc begins anew at a mark; without that jump, as it is next to another.
double ExtremaFinder::turn(double arc, double near) {
    const double around = 2 * std::numbers::pi * evaluator_.system().problem().cam->radius;
    return arc - around * std::round((arc - near) / around);
}

// The error of the energy balance within a step of the collocation is flat at the nodes, where nothing is missed of the
// forcing: it exceeds its values there by less than they span.
bool ExtremaFinder::hardly_exceeds(const Values& values, double sign, const Extremum& e) {
    const auto [low, high] = std::ranges::minmax(values);
    const double best = sign > 0 ? e.max : -e.min;
    return (sign > 0 ? high : -low) < best && (sign > 0 ? high : -low) + (high - low) <= best;
}

void ExtremaFinder::search(const SegmentInterval& s, Channel channel, double sign, const Values& sampled, Extremum& e) {
    const bool arc = channel.kind == ChannelKind::contact_s;
    const auto f = [&](double t) {
        const double value = evaluate(s, channel, t);
        return arc ? turn(value, sampled[0]) : value;
    };
    Values values = sampled;
    if (arc)
        for (double& value : values) value = turn(value, sampled[0]);
    if (channel.kind == ChannelKind::energy_residual && modal_) {
        for (std::size_t k = 0; k < kSamples; ++k) offer(e, sample_time(s, k), values[k]);
        if (hardly_exceeds(values, sign, e)) return;
    }
    const Variation strays = variation(s, channel, values);
    const double radians = (s.to - s.from) * evaluator_.system().highest_frequency();
    BestValue best = best_so_far(channel.kind, sign, e);
    const double before = best.value;
    best.intervals = static_cast<long>(std::min(kFewestHalvings + kHalvingsPerRadian * radians, kMostIntervals));
    for (std::size_t k = 0; k < kSamples; ++k) best.offer({sample_time(s, k), values[k]});
    for (std::size_t k = 0; k + 1 < kSamples; ++k)
        climb(f, strays, {sample_time(s, k), values[k]}, {sample_time(s, k + 1), values[k + 1]}, best);
    if (best.intervals < 0) ++incomplete_;
    if (!(best.value > before)) return;
    const double value = sign * best.value;
    if (!arc || (value >= 0 && turn(value, 0) != 0 &&
                 value < 2 * std::numbers::pi * evaluator_.system().problem().cam->radius)) {
        offer(e, best.t, value);
        return;
    }
    // It passes the mark, where it is as small and as large as it can be.
    const double around = 2 * std::numbers::pi * evaluator_.system().problem().cam->radius,
                 mark = value < 0 ? 0 : around;
    const auto past = [&](double t) { return f(t) - mark; };
    const double t = find_root(past, std::min(s.from, best.t), std::max(s.from, best.t));
    offer(e, t, 0);
    offer(e, t, std::nextafter(around, 0.0));
}

void ExtremaFinder::contact_peaks(const SegmentInterval& s, std::optional<double>& force, double& penetration) {
    const bool modal = set_bounds(s);
    Extremum of_force{0, s.from, force.value_or(0), s.from}, of_gap{-penetration, s.from, 0, s.from};
    const auto promises = [&](ChannelKind kind, double sign, const Extremum& e) {
        if (!modal) return true;
        const ModalChannels::Range range = modal_channels_.range({kind}, 0, 0);
        return !((sign > 0 ? range.high : -range.low) <= best_so_far(kind, sign, e).to_beat());
    };
    const auto look = [&](ChannelKind kind, double sign, Extremum& e) {
        if (!promises(kind, sign, e)) return;
        for (const SegmentInterval& part : parts(s)) search(part, {kind}, sign, sample(part, {kind}), e);
    };
    if (evaluator_.system().phase().touching) look(ChannelKind::contact_force, 1, of_force);
    look(ChannelKind::gap, -1, of_gap);
    force = of_force.max;
    penetration = -of_gap.min;
}

// ---- turning points -------------------------------------------------------------------------------

template <class F, class Found>
void ExtremaFinder::each_sign_change(const SegmentInterval& s, Channel channel, double scale, F&& f, Found&& found) {
    Values values;
    for (std::size_t k = 0; k < kSamples; ++k) values[k] = f(sample_time(s, k));
    each_sign_change(s, channel, scale, values, f, found);
}

template <class F, class Found>
void ExtremaFinder::each_sign_change(const SegmentInterval& s, Channel channel, double scale, const Values& values,
                                     F&& f, Found&& found) {
    for (const double value : values) scale = std::max(scale, std::fabs(value));
    const double rounding = kSignRounding * scale;
    const Variation strays = variation(s, channel, values);
    const auto [low, high] = std::ranges::minmax(values);
    if (std::max(low, -high) > strays.strays(kWidestNodeGap * (s.to - s.from))) return;
    for (std::size_t k = 0; k + 1 < kSamples; ++k)
        sign_changes(f, strays, rounding, {sample_time(s, k), values[k]}, {sample_time(s, k + 1), values[k + 1]},
                     found);
}

// Angle and rate of the hub, of a step that has them at its nodes.
bool ExtremaFinder::hub_samples(const SegmentInterval& s, Values& angles, Values& rates) {
    Lanes angle, rate;
    if (!modal_channels_.at_nodes({ChannelKind::theta}, angle)) return false;
    modal_channels_.at_nodes({ChannelKind::theta_dot}, rate);
    for (int k = 0; k < kNodes; ++k) {
        const auto sample = static_cast<std::size_t>(k) + 1;
        angles[sample] = angle[k];
        rates[sample] = rate[k];
    }
    for (const std::size_t end : {std::size_t{0}, kSamples - 1}) {
        s.segment->value(sample_time(s, end), y_.data());
        angles[end] = modal_channels_.hub(ChannelKind::theta, y_.data());
        rates[end] = modal_channels_.hub(ChannelKind::theta_dot, y_.data());
    }
    return true;
}

void ExtremaFinder::turning_points(const SegmentInterval& s, std::vector<Apex>& apexes,
                                   std::vector<ZeroCrossing>& theta_zero) {
    const MotionBounds* motion = s.segment->bounds();
    const bool may_turn = !motion || (motion->rate_low <= 0 && motion->rate_high >= 0),
               may_cross = !motion || (motion->angle_low <= 0 && motion->angle_high >= 0);
    if (!may_turn && !may_cross) return;
    set_bounds(s);
    const auto angle = [&](double t) { return evaluate(s, {ChannelKind::theta}, t); };
    const auto rate = [&](double t) { return evaluate(s, {ChannelKind::theta_dot}, t); };
    const auto apex = [&](const TimedValue& a, const TimedValue& b) {
        if (!(a.value > 0)) return;
        const double t = find_root(rate, a.t, b.t, a.value, b.value);
        apexes.push_back({t, angle(t)});
    };
    const auto zero = [&](const TimedValue& a, const TimedValue& b) {
        if (a.value == 0) return;
        const double t = find_root(angle, a.t, b.t, a.value, b.value);
        theta_zero.push_back({t, rate(t)});
    };
    if (Values angles, rates; modal_ && hub_samples(s, angles, rates)) {
        if (may_turn)
            each_sign_change(s, {ChannelKind::theta_dot}, motion->spin + motion->ripple_rate, rates, rate, apex);
        if (may_cross) each_sign_change(s, {ChannelKind::theta}, motion->ripple, angles, angle, zero);
        return;
    }
    for (const SegmentInterval& part : parts(s)) {
        if (may_turn)
            each_sign_change(part, {ChannelKind::theta_dot}, motion ? motion->spin + motion->ripple_rate : 0, rate,
                             apex);
        if (may_cross) each_sign_change(part, {ChannelKind::theta}, motion ? motion->ripple : 0, angle, zero);
    }
}

void ExtremaFinder::crossings(const SegmentInterval& s, Channel channel, double level, std::vector<Crossing>& found) {
    set_bounds(s);
    const auto above = [&](double t) { return evaluate(s, channel, t) - level; };
    for (const SegmentInterval& part : parts(s))
        each_sign_change(part, channel, std::fabs(level), above, [&](const TimedValue& a, const TimedValue& b) {
            if (a.value == 0) return;
            found.push_back({find_root(above, a.t, b.t, a.value, b.value), a.value < 0});
        });
}

}  // namespace beamcam::sim
