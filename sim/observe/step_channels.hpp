// Channels within one step of a trajectory: their values at any instant, and a bound of how far they vary between
// samples. Searches for extrema and crossings are built on it. MODEL.md §12, (S59).
#pragma once

#include <array>
#include <optional>
#include <unordered_map>
#include <vector>

#include "sim/integrate/gap_probe.hpp"
#include "sim/observe/channel_evaluator.hpp"
#include "sim/observe/modal_channels.hpp"
#include "sim/observe/polynomial_bounds.hpp"
#include "sim/observe/segment_interval.hpp"

namespace beamcam::sim {

class StepChannels {
  public:
    static constexpr std::size_t kSamples = kNodes + 2;  // both ends and the Gauss nodes
    using Samples = std::array<double, kSamples>;
    explicit StepChannels(const System& system);
    void set_phase(const Phase& phase);
    void set_start_energy(double total) { evaluator_.set_start_energy(total); }

    // Every other call on a step follows this one.
    void begin(const SegmentInterval& s);
    // The parts in which the channel is searched. Where vibrations fade they grow in length from the start of the step;
    // a channel without bounds has those below; every other step is one part.
    std::vector<SegmentInterval> parts(const SegmentInterval& s, Channel channel) const;
    // Parts so short that a polynomial follows every channel.
    std::vector<SegmentInterval> followed_parts(const SegmentInterval& s) const;
    // The components of this step are polynomials in time; else they are oscillations, bounded mode by mode.
    bool polynomial() const { return polynomial_; }
    const ModalChannels& modes() const { return modal_channels_; }
    // In sustained impulsive contact the gap and the energy stored in it are zero but for errors: of rounding at the
    // ends of steps, of the dense output within. Rates of a beam at rest, in such contact accelerations, too, are zero
    // but for errors; if neither hub nor cam is driven, all channels are constant within a step.
    bool errors_only(ChannelKind kind);
    bool depends_on_bristle(ChannelKind kind) const {
        return bristled_ && (kind == ChannelKind::energy_contact || kind == ChannelKind::loss_contact ||
                             kind == ChannelKind::loss_friction);
    }

    double value(const SegmentInterval& s, Channel channel, double t);
    // All channels at t. Tip deflection, tip rate and separation are costly: the first two are estimated
    // (`ChannelTraits::estimated`), the last is zero. `balance`: the energy balance at t if it is available.
    void values(const SegmentInterval& s, double t, const std::vector<Channel>& channels,
                const System::EnergyBalance* balance, std::vector<double>& out);
    void place(double t, const double* y) { evaluator_.set(t, y); }
    // Of the state that was placed last.
    double exact_value(Channel channel) { return evaluator_.value(channel); }
    // An estimate of a costly channel: the channel times +1 or −1 is at most this, times the same, or zero if that is
    // more, plus ModalChannels::estimate_error.
    double estimate(const SegmentInterval& s, Channel channel, double t);
    Samples estimates(const SegmentInterval& s, Channel channel);
    Samples sample(const SegmentInterval& s, Channel channel);
    // How far the channel strays from the lines between neighbouring samples.
    Variation variation(const SegmentInterval& s, Channel channel, const Samples& values) const;
    // The same of q, or of `estimates`: of sums of modes.
    Variation variation_of_modes(const SegmentInterval& s, Channel channel, const Samples& values) const;
    // The mode that the channel is, or almost is, in closed form if it has one.
    std::optional<UndampedMode> undamped_mode(Channel channel) const { return modal_channels_.undamped_mode(channel); }
    // Bounds of the channel from its values at the ends; if it depends on a bristle, which no mode is, from samples.
    ModalChannels::Range range(const SegmentInterval& s, Channel channel);
    // The same from its samples.
    ModalChannels::Range range(const SegmentInterval& s, Channel channel, const Samples& values) const;

    System& system() { return evaluator_.system(); }

  private:
    // What channels share at an instant of a step, each computed when first needed.
    struct Instant {
        std::vector<double> y;  // without the work of vibration
        std::optional<ContactState> contact;
        std::optional<Energies> energies;
        std::optional<double> hub_acceleration;
    };
    std::vector<SegmentInterval> fading_parts(const SegmentInterval& s) const;
    Instant& at(const SegmentInterval& s, double t);
    const double* beam(const SegmentInterval& s, double t);
    Variation variation_by_nodes(const SegmentInterval& s, Channel channel, const Samples& values) const;
    double value_at(double t, Channel channel, Instant& shared);
    void share_contact(double t, Instant& shared);
    double share_hub_acceleration(Instant& shared);
    void forget();
    void search_again();
    void bound(const SegmentInterval& s);
    void sample_touch(const SegmentInterval& s);
    bool is_linear(ChannelKind kind);
    void probe_contact(double t);

    ChannelEvaluator evaluator_;
    GapProbe probe_;
    const ModeBasis basis_;
    ModalChannels modal_channels_;
    PolynomialBounds polynomial_bounds_;
    std::array<Instant, kSamples> polynomial_samples_;
    TouchSamples polynomial_touch_;
    const Segment* segment_ = nullptr;
    double segment_from_ = kNan, segment_to_ = kNan;
    std::unordered_map<double, Instant> instants_;  // of that segment
    std::optional<Samples> balance_;
    std::vector<double> y_;
    bool polynomial_ = false;
    bool probing_ = false;                        // the contact of this phase is evaluated by `probe_`
    bool bristled_ = false;                       // it has a bristle
    bool at_rest_ = false;                        // all rates at the nodes are errors
    double bounded_from_ = -1, bounded_to_ = -1;  // the interval of `modal_channels_`
};

double sample_time(const SegmentInterval& s, std::size_t k);

}  // namespace beamcam::sim
