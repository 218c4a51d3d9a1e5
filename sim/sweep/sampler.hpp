// Samples of one motion, taken during the integration. The trajectory is not stored.
#pragma once

#include <array>
#include <optional>

#include "sim/observe/result.hpp"
#include "sim/observe/step_samples.hpp"
#include "sim/run/run.hpp"
#include "sim/sweep/sampling.hpp"

namespace beamcam::sim {

class Sampler final : public Observer {
  public:
    Sampler(const System& system, const Sampling& sampling);
    Sampler(const Sampler&) = delete;  // its parts refer to each other
    Sampler& operator=(const Sampler&) = delete;

    double end() const override { return span_.t_to(); }
    void resume(double t, const std::vector<double>& y, const Phase& phase) override;
    void step(const SegmentInterval& s) override;
    void touch(double t, const std::vector<double>& y, const ContactState& contact) override;
    void release(double t, const std::vector<double>& y, const ContactState& contact) override;
    bool done() const override { return motion_.over_the_top; }

    SampledMotion take();

  private:
    // The extremes of the time that is kept.
    struct Peaks {
        std::array<Extremum, 3> extrema;  // of the contact force, the stress and the gap
        double time = 0, touching = 0;    // [s]
        double contact = 0, longest = 0;  // the present contact and the longest one [s]
        MotionSample sample = {};         // at the largest force
    };
    void raise_peaks(const SegmentInterval& s);
    void finish_peaks();
    bool kept(double t) const { return t >= span_.t_from(); }
    MotionSample sample(double t, const double* y);
    void strobe(double t, const double* y);
    void strobes(const SegmentInterval& s);
    void sections(const SegmentInterval& s);
    void events(const SegmentInterval& s);
    struct Hub {
        double angle = 0, rate = 0;
    };
    Hub hub_at(double t, const double* y);
    bool points_away(const SegmentInterval& s, const Hub& before, const Hub& after);
    void evaluate(const SegmentInterval& s, double t);

    const Sampling& sampling_;
    SampleSpan span_;
    ChannelEvaluator evaluator_;
    System& system_;
    StepSamples step_;
    std::optional<Peaks> peaks_;
    SampledMotion motion_;
    std::vector<double> y_;
    Hub hub_;                             // at the end of the last step
    std::optional<MotionSample> impact_;  // of the present contact
    double section_phase_;                // fraction of a turn after the start: 0 … 1
    long next_strobe_, next_section_;
    long kept_impacts_ = 0;
    bool left_ = false;  // the beam left the cam since the last strobe
};

// Samples by a Run, for any model. `start`: initial state; null: that of the problem. The result reports failures.
SampledMotion sample_by_run(const Problem& problem, const Sampling& sampling, const InitialState* start,
                            const Progress& progress);

// The end of another motion as the initial state of this problem: a beam inside the cam is moved out of it, and one in
// sustained impulsive contact onto its surface.
InitialState carried(const Problem& problem, const InitialState& end);

}  // namespace beamcam::sim
