// Where channels are largest and smallest: the best samples of each step (StepSamples), refined on its dense output.
// MODEL.md §12, (S59).
#pragma once

#include <vector>

#include "sim/observe/impacts.hpp"
#include "sim/observe/step_samples.hpp"

namespace beamcam::sim {

class ExtremaFinder {
  public:
    ExtremaFinder(const System& system, std::vector<Channel> channels);

    void set_phase(const Phase& phase) { step_.set_phase(phase); }
    void set_start_energy(double total) { step_.set_start_energy(total); }
    // Raises the maxima and lowers the minima, one of each a channel, to those within the step.
    void step(const SegmentInterval& s, std::vector<Extremum>& extrema);
    // Raises both to the largest normal force and penetration within the step.
    void contact_peaks(const SegmentInterval& s, ImpactPeaks& peaks);
    // For crossings (crossings.hpp).
    StepSamples& samples() { return step_; }

  private:
    struct Best;
    void raise(const StepSamples::Series& series, Channel channel, double sign, double negligible, Best& best);

    StepSamples step_;
    const std::vector<Channel> channels_;
};

}  // namespace beamcam::sim
