// Where channels are largest and smallest: branch and bound over one step after another. Two values and a bound of how
// far the channel strays from the line between them (Variation) show whether an interval can exceed the best value so
// far; if so, it is halved until a parabola is as good as the channel. MODEL.md §12, (S59).
//
// Steps that may hold an extremum are kept, and searched when the run is over, the most promising first: by then the
// bounds of most of them are below the best value.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
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
    struct KeptStep {
        Phase phase;
        double from, to, t0, t1;
        long order;
        SegmentKind kind;
        std::vector<double> numbers;  // of the segment
    };
    struct Candidate {
        double high;  // bound of the channel, or of its negative
        std::shared_ptr<const KeptStep> step;
    };
    struct Candidates {
        std::vector<Candidate> steps;
        double promise = 0;  // the highest bound at which a costly channel was evaluated
    };

    bool contact_may_exceed(const std::vector<Extremum>& extrema);
    static bool less_promising(const Candidate& a, const Candidate& b);
    void offer_end(const SegmentInterval& s, std::size_t channel, Extremum& e);
    bool has_only_nodes(ChannelKind kind) const;
    bool offer_nodes(const SegmentInterval& s, const Lanes& nodes, Extremum& e);
    std::optional<ModalChannels::Range> range_within(const SegmentInterval& s, std::size_t channel, Extremum& e);
    ModalChannels::Range residual_range(const SegmentInterval& s, std::size_t channel);
    void collect(const SegmentInterval& s, std::size_t channel, const ModalChannels::Range& range,
                 std::shared_ptr<const KeptStep>& kept, Extremum& e);
    bool many_kept(std::size_t channel) const;
    std::shared_ptr<const KeptStep> keep(const SegmentInterval& s);
    void make_room(std::vector<Extremum>& extrema);
    void drop_beaten(const std::vector<Extremum>& extrema);
    void search_kept(std::vector<Extremum>& extrema);
    void search_most_promising(std::size_t channel, double sign, Extremum& e);
    bool search_candidate(std::size_t channel, double sign, const Candidate& candidate, Extremum& e);
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
    bool contact_known_ = true;         // in `last_`
    long incomplete_ = 0, halvings_left_ = kHalvingsOfRun, evaluations_ = 0;

    std::vector<std::array<Candidates, 2>> candidates_;  // of each channel: for its maximum, its minimum; in time
    std::vector<std::shared_ptr<const KeptStep>> kept_;  // all that candidates share
    long kept_steps_ = 0;
    std::size_t kept_numbers_ = 0, numbers_of_step_ = 0, drop_at_ = kNumbersPerDrop;
    std::map<SegmentKind, std::unique_ptr<StoredSegment>> stored_;
    const KeptStep* loaded_ = nullptr;
};

}  // namespace beamcam::sim
