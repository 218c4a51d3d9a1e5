// Where channels are largest and smallest, and where the hub turns back: branch and bound over one step after another.
// Two values and a bound of how far the channel strays from the line between them (Variation) tell whether an interval
// can beat the best value so far; if so, it is halved until a parabola is as good as the channel. MODEL.md §12, (S59).
//
// Bounds come from the polynomial through ten values in a step and from the vibrations that it does not
// resolve (ModalChannels). Steps of many modes that may hold an extremum are kept, and searched when the run is over,
// the most promising first: by then most of them are beaten without a look.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "sim/integrate/gap_probe.hpp"
#include "sim/observe/channel_evaluator.hpp"
#include "sim/observe/modal_channels.hpp"
#include "sim/observe/segment_interval.hpp"

namespace beamcam::sim {

class ExtremaFinder {
  public:
    ExtremaFinder(const System& system, std::vector<Channel> channels);

    void set_phase(const Phase& phase);
    // The values at the start of the run, in the first phase.
    void begin(double start_energy, const double* y, std::vector<Extremum>& extrema);
    // Searches one step, or keeps it for `finish`.
    void step(const SegmentInterval& s, std::vector<Extremum>& extrema);
    void finish(std::vector<Extremum>& extrema);
    // Searches that ended before they were sure.
    long incomplete() const { return incomplete_; }
    // Raises the two to the largest normal force and penetration within the step.
    void contact_peaks(const SegmentInterval& s, std::optional<double>& force, double& penetration);
    // Appends maxima and zeros of θ, in the order of time.
    void turning_points(const SegmentInterval& s, std::vector<Apex>& apexes, std::vector<ZeroCrossing>& theta_zero);
    // Appends the instants at which the channel passes the level, in the order of time; `rises`: upwards.
    struct Crossing {
        double t;
        bool rises;
    };
    void crossings(const SegmentInterval& s, Channel channel, double level, std::vector<Crossing>& found);

  private:
    static constexpr std::size_t kSamples = kNodes + 2;  // the ends and the Gauss nodes
    using Values = std::array<double, kSamples>;
    // What a step is at its samples, each part worked out when it is first needed.
    struct StepSamples {
        std::vector<double> states;  // of one sample after the other
        std::array<std::optional<ContactState>, kSamples> contacts;
        std::vector<std::optional<Values>> values;  // of each channel
    };
    struct KeptStep {
        Phase phase;
        double from, to, t0, t1;
        long order;
        std::vector<double> numbers;
        mutable StepSamples samples;
    };
    struct Candidate {
        double high;  // bound of the channel, or of its negative
        std::shared_ptr<const KeptStep> step;
    };
    struct Candidates {
        std::vector<Candidate> steps;
        double promise = 0;  // the highest bound at which a costly channel was evaluated
    };
    static bool less_promising(const Candidate& a, const Candidate& b);

    double evaluate(const SegmentInterval& s, Channel channel, double t);
    double value_of_state(Channel channel, double t, std::optional<ContactState>& contact);
    void search_contact_again();
    void look_for_contact(double t);
    void evaluate_all(const SegmentInterval& s, double t, std::vector<double>& values);
    void offer_ends(const SegmentInterval& s, std::size_t channel, Extremum& e);
    template <class Beaten>
    std::optional<ModalChannels::Range> range_within(std::size_t channel, Beaten&& beaten) const;
    std::shared_ptr<const KeptStep> keep(const SegmentInterval& s);
    void search_kept(std::vector<Extremum>& extrema);
    void search_candidates(std::size_t channel, double sign, std::vector<Candidate>& candidates, Extremum& e);
    void search_now(const SegmentInterval& s, std::vector<Extremum>& extrema);
    void search(const SegmentInterval& s, Channel channel, double sign, const Values& values, Extremum& e);
    const TouchSamples* known_contact(const SegmentInterval& s) const;
    static Values copied(const double* samples);
    Values sample(const SegmentInterval& s, Channel channel);
    Values sample(const SegmentInterval& s, Channel channel, StepSamples& known);
    void place_sample(const SegmentInterval& s, std::size_t k, StepSamples& known);
    const Values& sample_kept(const KeptStep& step, const SegmentInterval& s, std::size_t channel);
    static bool hardly_exceeds(const Values& values, double sign, const Extremum& e);
    Variation variation(const SegmentInterval& s, Channel channel, const Values& values);
    bool set_bounds(const SegmentInterval& s);
    std::vector<SegmentInterval> parts(const SegmentInterval& s);
    double turn(double arc, double near);
    bool hub_samples(const SegmentInterval& s, Values& angles, Values& rates);
    template <class F, class Found>
    void each_sign_change(const SegmentInterval& s, Channel channel, double scale, const Values& values, F&& f,
                          Found&& found);
    template <class F, class Found>
    void each_sign_change(const SegmentInterval& s, Channel channel, double scale, F&& f, Found&& found);

    ChannelEvaluator evaluator_;
    GapProbe probe_;
    ModalChannels modal_channels_;
    std::vector<Channel> channels_;
    std::vector<double> y_, first_, last_;  // state; all channels at the ends of the step
    double last_time_ = -1;                 // of `last_`, while the phase lasts
    bool modal_ = false;                    // `modal_channels_` bounds the present step
    bool probing_ = false;                  // its contact is evaluated by `probe_`
    double bounded_from_ = -1;              // its start
    long incomplete_ = 0;

    std::vector<std::array<Candidates, 2>> candidates_;  // of each channel: for its maximum, its minimum
    std::size_t kept_numbers_ = 0;
    long kept_steps_ = 0;
    std::unique_ptr<StoredSegment> stored_;
    const KeptStep* loaded_ = nullptr;
};

}  // namespace beamcam::sim
