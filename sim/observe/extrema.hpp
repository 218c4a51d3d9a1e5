// Where channels are largest and smallest: branch and bound over one step after another. Two values and a bound of how
// far the channel strays from the line between them (Variation) show whether an interval can exceed the best value so
// far; if so, it is halved until a parabola is as good as the channel. MODEL.md §12, (S59).
//
// Steps that may hold an extremum are kept, and searched when the run is over: by then the bounds of most of them are
// below the best value.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "sim/observe/constants.hpp"
#include "sim/observe/step_channels.hpp"

namespace beamcam::sim {

struct BestValue;

class ExtremaFinder {
  public:
    using Poll = std::function<void()>;  // called now and then during a long search; may throw
    ExtremaFinder(const System& system, std::vector<Channel> channels, Poll poll = {});

    void set_phase(const Phase& phase);
    // The values at the start of the run, in the first phase.
    void begin(double start_energy, const double* y, std::vector<Extremum>& extrema);
    // Searches one step, or keeps it for `finish`. `balance`: the energy balance at its end, if it is available.
    void step(const SegmentInterval& s, const System::EnergyBalance* balance, std::vector<Extremum>& extrema);
    void finish(std::vector<Extremum>& extrema) { search_kept(extrema); }
    // Searches that ended before all intervals were decided.
    long incomplete() const { return incomplete_; }
    // Raises the two to the largest normal force and penetration within the step.
    void contact_peaks(const SegmentInterval& s, ImpactPeaks& peaks);
    // The step that is searched, for crossings (crossings.hpp).
    StepChannels& step_channels() { return step_; }

  private:
    using Samples = StepChannels::Samples;
    struct Candidate {
        std::size_t channel;
        double sign;  // of its maximum, or of its minimum
        double high;  // bound of the channel times the sign
    };
    struct KeptStep {
        Phase phase;
        double from, to, t0, t1;
        SegmentKind kind;
        std::vector<double> numbers;  // of the segment
        std::vector<Candidate> candidates;
    };

    void offer_end(const SegmentInterval& s, std::size_t channel, Extremum& e);
    std::optional<ModalChannels::Range> range_within(const SegmentInterval& s, std::size_t channel, Extremum& e);
    ModalChannels::Range sampled_range(const SegmentInterval& s, Channel channel, Extremum& e);
    ModalChannels::Range residual_range(const SegmentInterval& s, std::size_t channel);
    void add_candidates(std::size_t channel, const ModalChannels::Range& range, const Extremum& e);
    void keep(const SegmentInterval& s, std::vector<Extremum>& extrema);
    void search_kept(std::vector<Extremum>& extrema);
    void drop_beaten(const std::vector<Extremum>& extrema);
    void search_step(const KeptStep& step, std::span<const Candidate> candidates, std::vector<Extremum>& extrema);
    bool is_beaten_by(const Extremum& e, const Candidate& candidate) const;
    void search_parts(const SegmentInterval& s, Channel channel, double sign, Extremum& e);
    void search(const SegmentInterval& s, Channel channel, double sign, Extremum& e);
    bool estimate_is_beaten(const SegmentInterval& s, Channel channel, double sign, const Extremum& e);
    template <class F>
    bool climb_step(const F& f, const Variation& variation, const SegmentInterval& s, Channel channel,
                    const Samples& samples, BestValue& best);
    template <class F>
    void offer_corners(const F& arc, const SegmentInterval& s, const Samples& feet, BestValue& best);
    void search_arc(const SegmentInterval& s, double sign, Extremum& e);
    double rim();
    double unwrapped(double arc, double near);

    StepChannels step_;
    Poll poll_;
    std::vector<Channel> channels_;
    std::vector<double> first_, last_;  // all channels at the ends of the step
    double last_time_ = -1;             // of `last_`, while the phase lasts
    long incomplete_ = 0, halvings_left_ = kHalvingsOfRun, evaluations_ = 0;

    std::vector<Candidate> candidates_;  // in this step
    std::vector<std::size_t> kept_of_;   // steps of each channel that are kept
    std::vector<KeptStep> kept_;         // in time
    std::size_t kept_numbers_ = 0, numbers_of_step_ = 0, drop_at_ = kNumbersPerDrop;
    std::map<SegmentKind, std::unique_ptr<StoredSegment>> stored_;
};

}  // namespace beamcam::sim
