#include "sim/observe/extrema.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sim/base/numerics.hpp"
#include "sim/observe/constants.hpp"
#include "sim/observe/interval_search.hpp"

namespace beamcam::sim {
namespace {

double negligible(ChannelKind kind) {
    return kind == ChannelKind::energy_residual ? kNegligibleImbalance : kNegligibleRise;
}

BestValue best_so_far(ChannelKind kind, double sign, const Extremum& e) {
    return sign > 0 ? BestValue{sign, e.max, e.t_max, negligible(kind)}
                    : BestValue{sign, -e.min, e.t_min, negligible(kind)};
}

// What cannot be computed is no bound: candidates need an order.
double bound(const ModalChannels::Range& range, double sign) {
    const double high = sign > 0 ? range.high : -range.low;
    return std::isnan(high) ? std::numeric_limits<double>::infinity() : high;
}

bool is_beaten(const ModalChannels::Range& range, ChannelKind kind, double sign, const Extremum& e) {
    return bound(range, sign) <= best_so_far(kind, sign, e).to_beat();
}

bool is_beaten(const ModalChannels::Range& range, ChannelKind kind, const Extremum& e) {
    const double share = negligible(kind);
    return range.high <= e.max + share * std::fabs(e.max) && range.low >= e.min - share * std::fabs(e.min);
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

}  // namespace

ExtremaFinder::ExtremaFinder(const System& system, std::vector<Channel> channels, Poll poll)
    : step_(system),
      poll_(std::move(poll)),
      channels_(std::move(channels)),
      first_(channels_.size()),
      last_(channels_.size()),
      candidates_(channels_.size()) {}

void ExtremaFinder::set_phase(const Phase& phase) {
    step_.set_phase(phase);
    last_time_ = -1;
}

void ExtremaFinder::begin(double start_energy, const double* y, std::vector<Extremum>& extrema) {
    step_.set_start_energy(start_energy);
    step_.place(0, y);
    for (std::size_t c = 0; c < channels_.size(); ++c) offer(extrema[c], 0, step_.exact_value(channels_[c]));
}

void ExtremaFinder::step(const SegmentInterval& s, const System::EnergyBalance* balance,
                         std::vector<Extremum>& extrema) {
    if (channels_.empty()) return;
    halvings_left_ += kHalvingsPerStep;
    step_.begin(s);
    sampled_ = {};
    const bool follows = last_time_ == s.from;
    if (follows)
        std::swap(first_, last_);
    else
        step_.values(s, s.from, channels_, nullptr, first_);
    step_.values(s, s.to, channels_, balance, last_);
    last_time_ = s.to;
    std::shared_ptr<const KeptStep> kept;
    for (std::size_t c = 0; c < channels_.size(); ++c) {
        if (std::isnan(first_[c])) continue;
        if (!follows && !is_estimated(channels_[c].kind)) offer(extrema[c], s.from, first_[c]);
        offer_end(s, c, extrema[c]);
        if (const auto range = range_within(s, c, extrema[c])) collect(s, c, *range, kept, extrema[c]);
    }
    if (kept_numbers_ > drop_at_) drop_beaten(extrema);
    if (kept_numbers_ > kMostKeptNumbers) search_kept(extrema);
}

// Most steps of a contact promise more than those before, until the next one. What the best values have beaten since
// goes, before it fills memory that would be new to the process.
void ExtremaFinder::drop_beaten(const std::vector<Extremum>& extrema) {
    for (std::size_t c = 0; c < channels_.size(); ++c)
        for (const double sign : {1.0, -1.0}) {
            const double to_beat = best_so_far(channels_[c].kind, sign, extrema[c]).to_beat();
            std::erase_if(candidates_[c][sign > 0 ? 0 : 1].steps,
                          [&](const Candidate& candidate) { return candidate.high <= to_beat; });
        }
    std::erase_if(kept_, [](const auto& step) { return step.use_count() == 1; });
    kept_numbers_ = 0;
    for (const auto& step : kept_) kept_numbers_ += step->numbers.size();
    drop_at_ = kept_numbers_ + kNumbersPerDrop;
}

// The residual is an error: where the forcing is exact is enough.
bool ExtremaFinder::has_only_nodes(ChannelKind kind) const {
    return kind == ChannelKind::energy_residual && !step_.polynomial();
}

// Keeps the step if the channel may exceed its best value within; a step that cannot be kept is searched now.
void ExtremaFinder::collect(const SegmentInterval& s, std::size_t c, const ModalChannels::Range& range,
                            std::shared_ptr<const KeptStep>& kept, Extremum& e) {
    const ChannelKind kind = channels_[c].kind;
    for (const double sign : {1.0, -1.0}) {
        if (is_beaten(range, kind, sign, e)) continue;
        Candidates& candidates = candidates_[c][sign > 0 ? 0 : 1];
        const double high = bound(range, sign);
        const bool promising = high > kHigherPromise * candidates.promise;
        if (promising) candidates.promise = high;
        if (promising && is_separation(kind)) {
            offer(e, s.to, step_.value(s, channels_[c], s.to));
            if (is_beaten(range, kind, sign, e)) continue;
        }
        if (has_only_nodes(kind)) {
            if (promising) search_parts(s, channels_[c], sign, sampled_, e);
            if (sampled_.balance) continue;  // of both signs
        }
        if (!kept) kept = keep(s);
        if (kept->kind != SegmentKind::none)
            candidates.steps.push_back({high, kept});
        else
            search_parts(s, channels_[c], sign, sampled_, e);
    }
}

// Where the value is an estimate, the true one if the estimate is better.
void ExtremaFinder::offer_end(const SegmentInterval& s, std::size_t c, Extremum& e) {
    if (!is_estimated(channels_[c].kind)) {
        offer(e, s.to, last_[c]);
    } else if (!is_separation(channels_[c].kind) && (last_[c] < e.min || last_[c] > e.max)) {
        offer(e, s.to, step_.value(s, channels_[c], s.to));
    }
}

// The values at the nodes; whether one is better than the best so far.
bool ExtremaFinder::offer_nodes(const SegmentInterval& s, const Lanes& nodes, Extremum& e) {
    bool better = false;
    for (int k = 0; k < kNodes; ++k) {
        if (!(nodes[k] < e.min || nodes[k] > e.max)) continue;
        better = true;
        offer(e, sample_time(s, static_cast<std::size_t>(k) + 1), nodes[k]);
    }
    return better;
}

// Bounds of the channel, from the cheapest on; nothing as soon as the best values beat them. Offers the values at the
// nodes if they are known.
std::optional<ModalChannels::Range> ExtremaFinder::range_within(const SegmentInterval& s, std::size_t c, Extremum& e) {
    const Channel& channel = channels_[c];
    const ModalChannels& modes = step_.modes();
    if (step_.polynomial() && channel.kind == ChannelKind::energy_residual) return residual_range(s, c);
    if (step_.unlike_law(channel.kind)) return step_.sampled_range(s, channel, sampled_);
    if (is_monotone(channel.kind)) return std::nullopt;
    const bool mode = channel.kind == ChannelKind::q;  // whose bounds are as close as those from the nodes
    if (mode && is_beaten(modes.mode_range(channel), channel.kind, e)) return std::nullopt;
    const ModalChannels::Range range = modes.range(channel, first_[c], last_[c]);
    if (is_beaten(range, channel.kind, e)) return std::nullopt;
    Lanes nodes;
    if (modes.known_at_nodes(channel, nodes) && offer_nodes(s, nodes, e) && is_beaten(range, channel.kind, e))
        return std::nullopt;
    if (step_.polynomial() && !is_separation(channel.kind)) return step_.sampled_range(s, channel, sampled_);
    if (mode) return range;
    const ModalChannels::Range closer = modes.range_by_nodes(channel, first_[c], last_[c]).value_or(range);
    return ModalChannels::Range{std::max(range.low, closer.low), std::min(range.high, closer.high)};
}

// The dense output of a polynomial errs most in the middle of the step; twice that covers the rest.
ModalChannels::Range ExtremaFinder::residual_range(const SegmentInterval& s, std::size_t c) {
    const auto [low, high] = std::minmax(first_[c], last_[c]);
    const double middle = step_.value(s, channels_[c], 0.5 * (s.from + s.to));
    const double stray = 2 * std::fabs(middle - 0.5 * (low + high));
    return {low - stray, high + stray};
}

std::shared_ptr<const ExtremaFinder::KeptStep> ExtremaFinder::keep(const SegmentInterval& s) {
    auto step = std::make_shared<KeptStep>(KeptStep{
        step_.system().phase(), s.from, s.to, s.segment->t0, s.segment->t1, kept_steps_++, SegmentKind::none, {}, {}});
    step->numbers.reserve(numbers_of_step_);
    step->kind = s.segment->numbers(step->numbers);
    numbers_of_step_ = std::max(numbers_of_step_, step->numbers.size());
    kept_numbers_ += step->numbers.size();
    kept_.push_back(step);
    return step;
}

void ExtremaFinder::search_kept(std::vector<Extremum>& extrema) {
    const Phase phase = step_.system().phase();
    loaded_ = nullptr;
    for (std::size_t c = 0; c < channels_.size(); ++c)
        for (const double sign : {1.0, -1.0})
            search_candidates(c, sign, candidates_[c][sign > 0 ? 0 : 1].steps, extrema[c]);
    kept_.clear();
    kept_numbers_ = 0;
    drop_at_ = kNumbersPerDrop;
    set_phase(phase);
}

bool ExtremaFinder::less_promising(const Candidate& a, const Candidate& b) {
    return a.high != b.high ? a.high < b.high : a.step->order > b.step->order;
}

// The most promising first, until the rest is beaten.
void ExtremaFinder::search_candidates(std::size_t c, double sign, std::vector<Candidate>& candidates, Extremum& e) {
    std::ranges::make_heap(candidates, less_promising);
    for (; !candidates.empty(); candidates.pop_back()) {
        std::ranges::pop_heap(candidates, less_promising);
        const Candidate& candidate = candidates.back();
        if (candidate.high <= best_so_far(channels_[c].kind, sign, e).to_beat()) break;
        const KeptStep& step = *candidate.step;
        // The residual of a collocation step is searched for both signs at once.
        const bool nodes_only = step.kind == SegmentKind::exponential && step.sampled.balance;
        if (nodes_only && channels_[c].kind == ChannelKind::energy_residual) continue;
        std::unique_ptr<StoredSegment>& stored = stored_[step.kind];
        if (!stored) stored = make_stored_segment(step.kind, step_.system().problem());
        const SegmentInterval s{stored.get(), step.from, step.to, false};
        if (loaded_ != &step) {
            loaded_ = &step;
            stored->load(step.t0, step.t1, step.numbers);
            set_phase(step.phase);
            step_.begin(s);
        }
        try {
            search_parts(s, channels_[c], sign, step.sampled, e);
        } catch (const StepFailure&) {  // a run that failed, in the step before
            ++incomplete_;
        }
        if (poll_ && (evaluations_ += kNodes) % kEvaluationsPerPoll < kNodes) poll_();
    }
    candidates.clear();
}

void ExtremaFinder::search_parts(const SegmentInterval& s, Channel channel, double sign,
                                 StepChannels::SampledStates& sampled, Extremum& e) {
    step_.begin(s);  // as if nothing had been searched before
    const std::vector<SegmentInterval> parts = step_.parts(s);
    if (parts.size() == 1 || channel.kind == ChannelKind::energy_residual) return search(s, channel, sign, sampled, e);
    // Vibrations of which too little reaches the channel need no parts.
    if (is_beaten(step_.sampled_range(s, channel, sampled), channel.kind, sign, e)) return;
    for (const SegmentInterval& part : parts) {
        step_.begin(part);
        if (is_beaten(step_.range(part, channel), channel.kind, sign, e)) continue;
        step_.begin(part);
        StepChannels::SampledStates states;
        search(part, channel, sign, states, e);
    }
    step_.begin(s);
}

void ExtremaFinder::search(const SegmentInterval& s, Channel channel, double sign, StepChannels::SampledStates& sampled,
                           Extremum& e) {
    if (channel.kind == ChannelKind::contact_s) return search_arc(s, sign, sampled, e);
    const Samples samples = step_.sample(s, channel, sampled);
    if (has_only_nodes(channel.kind)) {
        for (std::size_t k = 0; k < samples.size(); ++k) offer(e, sample_time(s, k), samples[k]);
        return;
    }
    BestValue best = best_so_far(channel.kind, sign, e);
    const double before = best.value;
    climb_step([&](double t) { return step_.value(s, channel, t); }, s, channel, samples, best);
    if (best.value > before) offer(e, best.t, sign * best.value);
}

// Raises `best` to the largest value of f in the step.
template <class F>
void ExtremaFinder::climb_step(const F& f, const SegmentInterval& s, Channel channel, const Samples& samples,
                               BestValue& best) {
    const Variation variation = step_.variation(s, channel, samples);
    for (std::size_t k = 0; k < samples.size(); ++k) best.offer({sample_time(s, k), samples[k]});
    const auto [low, high] = std::ranges::minmax(samples);
    const double farthest = variation.strays(kWidestNodeGap * (s.to - s.from));
    if (std::max(best.sign * low, best.sign * high) + farthest <= best.to_beat()) return;
    const double radians = (s.to - s.from) * step_.system().highest_frequency();
    const double needed = std::min(kFewestHalvings + kHalvingsPerRadian * radians, kMostHalvings);
    const long allowed = std::min(halvings_left_, static_cast<long>(needed));
    best.intervals = allowed;
    const auto polled = [&](double t) {
        if (++evaluations_ % kEvaluationsPerPoll == 0 && poll_) poll_();
        return f(t);
    };
    for (std::size_t k = 0; k + 1 < samples.size(); ++k)
        climb(polled, variation, {sample_time(s, k), samples[k]}, {sample_time(s, k + 1), samples[k + 1]}, best);
    if (best.intervals < 0) ++incomplete_;
    halvings_left_ -= allowed - std::max(best.intervals, 0L);
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

void ExtremaFinder::search_arc(const SegmentInterval& s, double sign, StepChannels::SampledStates& sampled,
                               Extremum& e) {
    constexpr Channel kArc{ChannelKind::contact_s};
    Samples samples = step_.sample(s, kArc, sampled);
    const Samples feet = step_.sample(s, {ChannelKind::contact_x}, sampled);
    const double first = samples[0];
    const auto arc = [&](double t) { return unwrapped(step_.value(s, kArc, t), first); };
    for (double& value : samples) value = unwrapped(value, first);
    BestValue best = best_so_far(kArc.kind, sign, e);
    const double before = best.value;
    climb_step(arc, s, kArc, samples, best);
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
    StepChannels::SampledStates states;
    const auto raise = [&](ChannelKind kind, double sign, Extremum& e) {
        if (step_.modes().touch() && is_beaten(step_.modes().range({kind}, 0, 0), kind, sign, e)) return;
        search_parts(s, {kind}, sign, states, e);
    };
    if (step_.system().phase().touching) raise(ChannelKind::contact_force, 1, of_force);
    raise(ChannelKind::gap, -1, of_gap);
    peaks = {of_force.max, -of_gap.min};
}

}  // namespace beamcam::sim
