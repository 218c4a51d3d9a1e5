// Records one request of a motion while it is integrated: samples, poses, impacts, crossings, extrema and the energy
// balance. It evaluates accepted segments only, through its own System, so recording never changes a bit of the motion.
#pragma once

#include <memory>
#include <vector>

#include "sim/observe/impacts.hpp"
#include "sim/observe/run_statistics.hpp"
#include "sim/observe/samples.hpp"

namespace beamcam::sim {

class ExtremaFinder;

class Recorder {
  public:
    // `shared`: with the recorders of other requests.
    Recorder(const System& system, const Request& request, SharedSamples* shared);
    Recorder(const Recorder&) = delete;  // its parts refer to each other
    ~Recorder();
    Recorder& operator=(const Recorder&) = delete;

    void begin(const Phase& phase, const std::vector<double>& y);
    void set_phase(const Phase& phase);
    // `known`: the summary of the interval, if another recorder computed it. The interval is not the last one then.
    void record(const SegmentInterval& s, const SegmentSummary* known = nullptr);
    // Of the interval recorded last.
    const SegmentSummary& summary() const { return summary_; }
    void touch(double t, const double* y, const ContactState& contact);
    void release(double t, const double* y, const ContactState& contact) { impacts_.release(t, y, contact); }
    void finish(double t, const double* y, const RunStatistics& statistics);

    double end() const { return end_; }  // last instant of the request [s]
    bool finished() const { return finished_; }
    bool has_enough() const;  // events, where the request limits their number
    Result& result() { return result_; }

  private:
    void take_states(const SegmentInterval& s);
    void find_peaks(const SegmentInterval& s, const SegmentSummary* known);
    void find_bend(const SegmentInterval& s);  // of the present collision
    void find_events(const SegmentInterval& s, const SegmentSummary* known);
    void note_balance();
    void record_balance(const SegmentInterval& s);

    const Request& request_;
    const double end_;
    Result result_;
    ChannelEvaluator evaluator_;
    SampleRecorder samples_;
    ImpactRecorder impacts_;
    std::unique_ptr<ExtremaFinder> extrema_, bends_;  // bends_: null unless requested
    std::vector<Extremum> bend_;                      // of the tip's deflection since the last collision began
    SegmentSummary summary_;
    std::vector<double> y_;
    double start_total_ = 0;
    bool finished_ = false;
};

// The last instant of a request [s].
double end_of(const Request& request);

}  // namespace beamcam::sim
