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
      kept_of_(channels_.size()) {}

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
    const bool follows = last_time_ == s.from;
    if (follows)
        std::swap(first_, last_);
    else
        step_.values(s, s.from, channels_, nullptr, first_);
    step_.values(s, s.to, channels_, balance, last_);
    last_time_ = s.to;
    candidates_.clear();
    for (std::size_t c = 0; c < channels_.size(); ++c) {
        if (std::isnan(first_[c]) || std::isnan(last_[c])) continue;
        if (!follows && !traits(channels_[c].kind).estimated()) offer(extrema[c], s.from, first_[c]);
        offer_end(s, c, extrema[c]);
        if (const auto range = range_within(s, c, extrema[c])) add_candidates(c, *range, extrema[c]);
    }
    if (!candidates_.empty()) keep(s, extrema);
    if (kept_numbers_ > drop_at_) drop_beaten(extrema);
    if (kept_numbers_ > kMostKeptNumbers) search_kept(extrema);
}

// Where the value is an estimate, the true one if the estimate is better.
void ExtremaFinder::offer_end(const SegmentInterval& s, std::size_t c, Extremum& e) {
    if (!traits(channels_[c].kind).estimated()) {
        offer(e, s.to, last_[c]);
    } else if (!traits(channels_[c].kind).separation && (last_[c] < e.min || last_[c] > e.max)) {
        offer(e, s.to, step_.value(s, channels_[c], s.to));
    }
}

// Bounds of the channel, from the cheapest on; nothing as soon as the best values beat them.
std::optional<ModalChannels::Range> ExtremaFinder::range_within(const SegmentInterval& s, std::size_t c, Extremum& e) {
    const Channel& channel = channels_[c];
    const ModalChannels& modes = step_.modes();
    if (step_.polynomial() && channel.kind == ChannelKind::energy_residual) return residual_range(s, c);
    if (step_.depends_on_bristle(channel.kind)) return sampled_range(s, channel, e);
    const bool errors = step_.errors_only(channel.kind);
    if (errors && traits(channel.kind).separation) offer(e, s.to, step_.value(s, channel, s.to));
    if (traits(channel.kind).monotone || errors) return std::nullopt;
    const bool of_modes = channel.kind == ChannelKind::q;
    if (of_modes && is_beaten(modes.mode_range(channel), channel.kind, e)) return std::nullopt;
    const ModalChannels::Range range = modes.range(channel, first_[c], last_[c]);
    if (is_beaten(range, channel.kind, e)) return std::nullopt;
    if (step_.polynomial() && !traits(channel.kind).separation) return sampled_range(s, channel, e);
    // Where bounds exclude too few steps, closer ones cost less than to search these.
    if (of_modes && kept_of_[c] > kManyKept)
        if (const auto by_crests = modes.crest_range(channel, first_[c], last_[c])) return by_crests;
    if (modes.is_mode(channel)) return range;  // which is as close as that from the nodes
    const ModalChannels::Range closer = modes.range_by_nodes(channel, first_[c], last_[c]).value_or(range);
    return ModalChannels::Range{std::max(range.low, closer.low), std::min(range.high, closer.high)};
}

// By the values at ten instants, which it offers.
ModalChannels::Range ExtremaFinder::sampled_range(const SegmentInterval& s, Channel channel, Extremum& e) {
    const Samples samples = step_.sample(s, channel);
    for (std::size_t k = 0; k < samples.size(); ++k) offer(e, sample_time(s, k), samples[k]);
    return step_.range(s, channel, samples);
}

// The dense output of a polynomial usually errs most in the middle of the step. Twice that is an estimate, no bound.
ModalChannels::Range ExtremaFinder::residual_range(const SegmentInterval& s, std::size_t c) {
    const auto [low, high] = std::minmax(first_[c], last_[c]);
    const double middle = step_.value(s, channels_[c], 0.5 * (s.from + s.to));
    const double stray = 2 * std::fabs(middle - 0.5 * (low + high));
    return {low - stray, high + stray};
}

void ExtremaFinder::add_candidates(std::size_t c, const ModalChannels::Range& range, const Extremum& e) {
    for (const double sign : {1.0, -1.0}) {
        const Candidate candidate{c, sign, bound(range, sign) - step_.modes().rounding(channels_[c].kind)};
        if (!is_beaten_by(e, candidate)) candidates_.push_back(candidate);
    }
}

bool ExtremaFinder::is_beaten_by(const Extremum& e, const Candidate& candidate) const {
    return candidate.high <= best_so_far(channels_[candidate.channel].kind, candidate.sign, e).to_beat();
}

// A step that cannot be kept is searched now.
void ExtremaFinder::keep(const SegmentInterval& s, std::vector<Extremum>& extrema) {
    KeptStep step{step_.system().phase(), s.from, s.to, s.segment->t0, s.segment->t1, SegmentKind::none, {}, {}};
    step.numbers.reserve(numbers_of_step_);
    step.kind = s.segment->numbers(step.numbers);
    if (step.kind == SegmentKind::none) {
        for (const Candidate& candidate : candidates_)
            search_parts(s, channels_[candidate.channel], candidate.sign, extrema[candidate.channel]);
        return;
    }
    numbers_of_step_ = std::max(numbers_of_step_, step.numbers.size());
    kept_numbers_ += step.numbers.size();
    for (const Candidate& candidate : candidates_) ++kept_of_[candidate.channel];
    step.candidates = candidates_;
    kept_.push_back(std::move(step));
}

// Most steps of a contact promise more than those before, until the next one. What the best values have beaten since
// goes, before it fills memory that would be new to the process.
void ExtremaFinder::drop_beaten(const std::vector<Extremum>& extrema) {
    kept_numbers_ = 0;
    std::ranges::fill(kept_of_, 0);
    for (KeptStep& step : kept_) {
        std::erase_if(step.candidates, [&](const Candidate& of) { return is_beaten_by(extrema[of.channel], of); });
        if (!step.candidates.empty()) kept_numbers_ += step.numbers.size();
        for (const Candidate& candidate : step.candidates) ++kept_of_[candidate.channel];
    }
    std::erase_if(kept_, [](const KeptStep& step) { return step.candidates.empty(); });
    drop_at_ = kept_numbers_ + kNumbersPerDrop;
}

// The most promising step of each channel first: it beats many others.
void ExtremaFinder::search_kept(std::vector<Extremum>& extrema) {
    const Phase phase = step_.system().phase();
    std::vector<std::pair<const KeptStep*, const Candidate*>> most(2 * channels_.size());  // by channel and sign
    for (const KeptStep& step : kept_)
        for (const Candidate& candidate : step.candidates) {
            auto& best = most[2 * candidate.channel + (candidate.sign < 0)];
            if (!best.second || candidate.high > best.second->high) best = {&step, &candidate};
        }
    for (const auto& [step, candidate] : most)
        if (step) search_step(*step, {candidate, 1}, extrema);
    for (const KeptStep& step : kept_) search_step(step, step.candidates, extrema);
    kept_.clear();
    kept_numbers_ = 0;
    drop_at_ = kNumbersPerDrop;
    std::ranges::fill(kept_of_, 0);
    set_phase(phase);
}

// `kind` is not `none`.
static std::unique_ptr<StoredSegment> make_stored_segment(SegmentKind kind, const System& system) {
    if (kind == SegmentKind::rk8) return make_stored_rk8(system.size);
    if (kind == SegmentKind::taylor) return make_stored_taylor(system.size);
    return make_stored_exponential(system);
}

// Channels of a step share the states that they evaluate.
void ExtremaFinder::search_step(const KeptStep& step, std::span<const Candidate> candidates,
                                std::vector<Extremum>& extrema) {
    std::unique_ptr<StoredSegment>& stored = stored_[step.kind];
    if (!stored) stored = make_stored_segment(step.kind, step_.system());
    const SegmentInterval s{stored.get(), step.from, step.to, false};
    bool loaded = false;
    for (const Candidate& candidate : candidates) {
        Extremum& e = extrema[candidate.channel];
        if (is_beaten_by(e, candidate)) continue;
        if (!loaded) {
            stored->load(step.t0, step.t1, step.numbers);
            set_phase(step.phase);
            loaded = true;
        }
        try {
            search_parts(s, channels_[candidate.channel], candidate.sign, e);
        } catch (const StepFailure&) {  // a run that failed, in the step before
            ++incomplete_;
        }
        if (poll_ && (evaluations_ += kNodes) % kEvaluationsPerPoll < kNodes) poll_();
    }
}

}  // namespace beamcam::sim
