// Records one request of a motion while it is integrated: samples, poses, impacts, crossings, extrema and the energy
// balance. The result does not depend on other requests, nor on how far the run goes beyond this one.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "sim/observe/impacts.hpp"
#include "sim/observe/observer.hpp"
#include "sim/observe/run_statistics.hpp"
#include "sim/observe/samples.hpp"
#include "sim/observe/step_samples.hpp"

namespace beamcam::sim {

class Recorder final : public Observer {
  public:
    // `statistics` returns the counts of the run so far.
    Recorder(const System& system, const Request& request, std::function<RunStatistics()> statistics);
    Recorder(const Recorder&) = delete;  // its parts refer to each other
    Recorder& operator=(const Recorder&) = delete;

    double end() const override { return end_; }
    bool done() const override { return finished_; }
    void resume(double t, const std::vector<double>& y, const Phase& phase) override;
    void step(const SegmentInterval& s) override;
    void touch(double t, const std::vector<double>& y, const ContactState& contact) override;
    void release(double t, const std::vector<double>& y, const ContactState& contact) override {
        impacts_.release(t, y.data(), contact);
    }
    // Nothing follows (t, y).
    void finish(double t, const double* y);

    Result& result() { return result_; }

  private:
    void begin(const double* y);
    void record(const SegmentInterval& s);
    bool has_enough() const;  // events, where the request limits their number
    void take_states(const SegmentInterval& s);
    void find_bend(const SegmentInterval& s);  // of the present collision
    void record_balance(const SegmentInterval& s);
    void note_balance();

    const Request& request_;
    const std::function<RunStatistics()> statistics_;
    const double end_;
    Result result_;
    ChannelEvaluator evaluator_;
    StepSamples step_;
    SampleRecorder samples_;
    ImpactRecorder impacts_;
    Extremum bend_;  // of the tip's deflection since the last collision began
    std::vector<double> y_;
    std::optional<double> start_total_;  // of the energies at the start [J]; absent until it begins
    double largest_elastic_ = 0;         // bending energy [J]
    bool finished_ = false;
};

// The last instant of a request [s].
double end_of(const Request& request);

}  // namespace beamcam::sim
