// The channels within one step of the motion, at instants that follow its vibration: the ends and Gauss nodes of the
// step, and more between two of them where a channel varies by what the nodes do not resolve. Extrema and crossings are
// found in these samples. MODEL.md §12, (S59).
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "sim/base/lanes.hpp"
#include "sim/observe/channel_evaluator.hpp"
#include "sim/observe/observer.hpp"

namespace beamcam::sim {

class StepSamples {
  public:
    struct Series {
        std::vector<double> t, value;
    };
    // Whether a channel is sampled beyond the nodes in an interval at whose ends its smaller value is `low` and its
    // larger one `high`. The channel may exceed them by about `stray`.
    using NeedsMore = std::function<bool(std::size_t channel, double low, double high, double stray)>;
    // Receives every sample at the ends and nodes before it is decided whether more are needed.
    using See = std::function<void(std::size_t channel, double t, double value)>;

    explicit StepSamples(ChannelEvaluator& evaluator);  // must outlive it

    // One series for each channel, valid until the next call. The result does not depend on earlier steps.
    std::span<const Series> sample(const SegmentInterval& s, std::span<const Channel> channels,
                                   const NeedsMore& needs_more, const See& see = {});
    double value(Channel channel, double t);  // in the step that was sampled last

  private:
    static constexpr std::size_t kCount = kNodes + 2;  // both ends and the Gauss nodes
    using Instants = std::array<double, kCount>;
    Eigen::ArrayXd modal_energies(double t, bool whole);
    void find_parts();
    double fastest(const Instants& part);
    // The contact at the ends and nodes of the part where the step solved for it there.
    const TouchSamples* touch_at(const Instants& part) const;
    void sample_part(const Instants& part, const NeedsMore& needs_more, const See& see);
    void evaluate_nodes(const Instants& part, const NeedsMore& needs_more, const See& see);
    bool ends_suffice(const Instants& part, std::size_t channel, const NeedsMore& needs_more, const See& see);
    bool is_gap_in_flight(std::size_t channel) const;
    void place(double t);

    ChannelEvaluator& evaluator_;
    Eigen::MatrixXd to_modes_;  // the natural modes by the coordinates
    // Of each mode [1/s]: frequency without damping; the same, but 0 beyond critical damping; rate of the fastest
    // decay.
    Eigen::ArrayXd omega_, vibration_, decay_;
    SegmentInterval step_{};
    std::vector<Channel> channels_;  // that are sampled
    std::vector<Series> series_;
    struct Nodes {
        std::array<double, kCount> value;
        bool only_ends;
        double stray;
    };
    std::vector<Nodes> nodes_;  // of each channel in the present part
    std::vector<Instants> parts_;
    std::vector<std::size_t> sampled_;
    std::vector<double> y_;
};

}  // namespace beamcam::sim
