#include "sim/observe/extrema.hpp"

#include <algorithm>
#include <cmath>

#include "sim/observe/best_values.hpp"

namespace beamcam::sim {
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
    const bool contact = contact_may_exceed(extrema), follows = last_time_ == s.from && (contact_known_ || !contact);
    if (follows)
        std::swap(first_, last_);
    else
        step_.values(s, s.from, channels_, nullptr, contact, first_);
    step_.values(s, s.to, channels_, balance, contact, last_);
    last_time_ = s.to;
    contact_known_ = contact;
    std::shared_ptr<const KeptStep> kept;
    for (std::size_t c = 0; c < channels_.size(); ++c) {
        if (std::isnan(first_[c]) || std::isnan(last_[c])) continue;
        if (!follows && !traits(channels_[c].kind).estimated()) offer(extrema[c], s.from, first_[c]);
        offer_end(s, c, extrema[c]);
        if (const auto range = range_within(s, c, extrema[c])) collect(s, c, *range, kept, extrema[c]);
    }
    if (kept_numbers_ > drop_at_) make_room(extrema);
    if (kept_numbers_ > kMostKeptNumbers) search_kept(extrema);
}

// Whether a channel of the contact may exceed its best value in this step: far from the cam none does, and where the
// contact would be is not evaluated.
bool ExtremaFinder::contact_may_exceed(const std::vector<Extremum>& extrema) {
    if (step_.polynomial() || step_.system().phase().touching || !step_.system().has_cam()) return true;
    for (std::size_t c = 0; c < channels_.size(); ++c) {
        const ChannelKind kind = channels_[c].kind;
        if (traits(kind).follows_contact() && !is_beaten(step_.modes().flight_range(kind), kind, extrema[c]))
            return true;
    }
    return false;
}

// Most steps of a contact promise more than those before, until the next one. What the best values have beaten since
// goes, before it fills memory that would be new to the process. If that is little, the most promising step of each
// channel is searched: it beats many others.
void ExtremaFinder::make_room(std::vector<Extremum>& extrema) {
    const std::size_t before = kept_numbers_;
    drop_beaten(extrema);
    if (kept_numbers_ < before / 2) return;
    const Phase phase = step_.system().phase();
    loaded_ = nullptr;
    for (std::size_t c = 0; c < channels_.size(); ++c)
        for (const double sign : {1.0, -1.0}) {
            std::vector<Candidate>& steps = candidates_[c][sign > 0 ? 0 : 1].steps;
            if (steps.size() <= kMostPromising) continue;
            const auto first = std::ranges::max_element(steps, less_promising);
            const Candidate searched = *first;
            steps.erase(first);
            search_candidate(c, sign, searched, extrema[c]);
        }
    set_phase(phase);
    drop_beaten(extrema);
}

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
        const double high = bound(range, sign) - step_.modes().rounding(kind);
        if (high <= best_so_far(kind, sign, e).to_beat()) continue;
        const bool promising = high > kHigherPromise * candidates.promise;
        if (promising) candidates.promise = high;
        if (promising && traits(kind).separation) {
            offer(e, s.to, step_.value(s, channels_[c], s.to));
            if (is_beaten(range, kind, sign, e)) continue;
        }
        if (has_only_nodes(kind)) {
            if (promising) search_parts(s, channels_[c], sign, e);
            if (step_.balance()) continue;  // of both signs
        }
        if (!kept) kept = keep(s);
        if (kept->kind != SegmentKind::none)
            candidates.steps.push_back({high, kept});
        else
            search_parts(s, channels_[c], sign, e);
    }
}

// Where the value is an estimate, the true one if the estimate is better.
void ExtremaFinder::offer_end(const SegmentInterval& s, std::size_t c, Extremum& e) {
    if (!traits(channels_[c].kind).estimated()) {
        offer(e, s.to, last_[c]);
    } else if (!traits(channels_[c].kind).separation && (last_[c] < e.min || last_[c] > e.max)) {
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

// Where bounds exclude too few steps, closer ones cost less than to search these.
bool ExtremaFinder::many_kept(std::size_t c) const {
    return std::ranges::any_of(candidates_[c], [](const auto& of) { return of.steps.size() > kManyKept; });
}

// Bounds of the channel, from the cheapest on; nothing as soon as the best values beat them. Offers the values at the
// nodes if they are known.
std::optional<ModalChannels::Range> ExtremaFinder::range_within(const SegmentInterval& s, std::size_t c, Extremum& e) {
    const Channel& channel = channels_[c];
    const ModalChannels& modes = step_.modes();
    if (step_.polynomial() && channel.kind == ChannelKind::energy_residual) return residual_range(s, c);
    if (step_.depends_on_bristle(channel.kind)) return step_.sampled_range(s, channel);
    const bool errors = step_.errors_only(channel.kind);
    if (errors && traits(channel.kind).separation) offer(e, s.to, step_.value(s, channel, s.to));
    if (traits(channel.kind).monotone || errors) return std::nullopt;
    const bool of_modes = channel.kind == ChannelKind::q;
    if (of_modes && is_beaten(modes.mode_range(channel), channel.kind, e)) return std::nullopt;
    const ModalChannels::Range range = modes.range(channel, first_[c], last_[c]);
    if (is_beaten(range, channel.kind, e)) return std::nullopt;
    Lanes nodes;
    if (modes.known_at_nodes(channel, nodes) && offer_nodes(s, nodes, e) && is_beaten(range, channel.kind, e))
        return std::nullopt;
    if (step_.polynomial() && !traits(channel.kind).separation) return step_.sampled_range(s, channel);
    if (of_modes && many_kept(c))
        if (const auto by_crests = modes.crest_range(channel, first_[c], last_[c])) return by_crests;
    if (modes.is_mode(channel)) return range;  // which is as close as that from the nodes
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
        step_.system().phase(), s.from, s.to, s.segment->t0, s.segment->t1, kept_steps_++, SegmentKind::none, {}});
    step->numbers.reserve(numbers_of_step_);
    step->kind = s.segment->numbers(step->numbers);
    numbers_of_step_ = std::max(numbers_of_step_, step->numbers.size());
    kept_numbers_ += step->numbers.size();
    kept_.push_back(step);
    return step;
}

// The most promising steps first, until the rest is beaten. If that takes too many, the rest in time, where channels
// share what they evaluate.
void ExtremaFinder::search_kept(std::vector<Extremum>& extrema) {
    const Phase phase = step_.system().phase();
    loaded_ = nullptr;
    constexpr std::array kSigns{1.0, -1.0};
    for (std::size_t c = 0; c < channels_.size(); ++c)
        for (const double sign : kSigns) search_most_promising(c, sign, extrema[c]);
    for (const auto& step : kept_)
        for (std::size_t c = 0; c < channels_.size(); ++c)
            for (std::size_t i = 0; i < kSigns.size(); ++i) {
                std::vector<Candidate>& left = candidates_[c][i].steps;
                if (left.empty() || left.back().step != step) continue;
                search_candidate(c, kSigns[i], left.back(), extrema[c]);
                left.pop_back();
            }
    kept_.clear();
    kept_numbers_ = 0;
    drop_at_ = kNumbersPerDrop;
    set_phase(phase);
}

bool ExtremaFinder::less_promising(const Candidate& a, const Candidate& b) {
    return a.high != b.high ? a.high < b.high : a.step->order > b.step->order;
}

// Leaves candidates that are not beaten, the last first.
void ExtremaFinder::search_most_promising(std::size_t c, double sign, Extremum& e) {
    std::vector<Candidate>& candidates = candidates_[c][sign > 0 ? 0 : 1].steps;
    std::ranges::make_heap(candidates, less_promising);
    for (std::size_t searched = 0; !candidates.empty() && searched < kMostPromising; ++searched) {
        std::ranges::pop_heap(candidates, less_promising);
        if (!search_candidate(c, sign, candidates.back(), e)) candidates.clear();
        if (!candidates.empty()) candidates.pop_back();
    }
    std::ranges::sort(candidates, [](const auto& a, const auto& b) { return a.step->order > b.step->order; });
}

// False if it is beaten.
bool ExtremaFinder::search_candidate(std::size_t c, double sign, const Candidate& candidate, Extremum& e) {
    if (candidate.high <= best_so_far(channels_[c].kind, sign, e).to_beat()) return false;
    const KeptStep& step = *candidate.step;
    std::unique_ptr<StoredSegment>& stored = stored_[step.kind];
    if (!stored) stored = make_stored_segment(step.kind, step_.system());
    const SegmentInterval s{stored.get(), step.from, step.to, false};
    try {
        if (loaded_ != &step) {
            loaded_ = &step;
            stored->load(step.t0, step.t1, step.numbers);
            set_phase(step.phase);
            step_.begin(s);
        }
        // The residual of a collocation step is searched for both signs at once.
        const bool nodes_only =
            channels_[c].kind == ChannelKind::energy_residual && step.kind == SegmentKind::exponential;
        if (!nodes_only || !step_.balance()) search_parts(s, channels_[c], sign, e);
    } catch (const StepFailure&) {  // a run that failed, in the step before
        ++incomplete_;
    }
    if (poll_ && (evaluations_ += kNodes) % kEvaluationsPerPoll < kNodes) poll_();
    return true;
}

}  // namespace beamcam::sim
