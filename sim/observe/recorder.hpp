// What is recorded of a trajectory while it is integrated: samples, poses, impacts, crossings,
// extrema, the energy ledger. Each looks at accepted segments only and through its own System, so
// recording never changes a bit of the motion.
#pragma once

#include <memory>
#include <vector>

#include "sim/observe/channel_evaluator.hpp"
#include "sim/observe/refine.hpp"
#include "sim/observe/request.hpp"
#include "sim/observe/result.hpp"
#include "sim/observe/run_statistics.hpp"
#include "sim/observe/segment_interval.hpp"

namespace beamcam::sim {

class ExtremaFinder;

// Records for one request, until its own end.
class Recorder {
  public:
    Recorder(const System& system, const Request& request, double end);
    Recorder(Recorder&&) noexcept;
    ~Recorder();

    void begin(const Phase& phase, const std::vector<double>& y);
    void phase(const Phase& phase);
    void record(const SegmentInterval& s, SegmentSummary* made = nullptr);
    void record(const SegmentInterval& s, const SegmentSummary& known);  // not the last one
    void touch(double t, const double* y, const ContactState& contact);
    void release(double t, const double* y, const ContactState& contact);
    void finish(double t, const double* y, const RunStatistics& statistics);

    double end() const { return end_; }
    bool has_enough() const;  // events, where the request says how many
    Result& result() { return result_; }

  private:
    struct Cursor {
        std::vector<std::size_t> order;  // indices of the times, ascending
        std::size_t next = 0;
    };
    void evaluate_at(const SegmentInterval& s, double t);
    void sample_tables(const SegmentInterval& s);
    void refine_curves(const SegmentInterval& s, const std::vector<std::size_t>& before);
    void merge_refined();
    void sample(const SegmentInterval& s);
    void contact_peaks(const SegmentInterval& s);
    void contact_poses(const SegmentInterval& s);
    void ledger(const SegmentInterval& s);
    void note_balance();
    void settle(const double* y);
    TouchState touch_state(double t, const double* y, const ContactState& contact);
    template <class F>
    void sweep(const std::vector<double>& times, Cursor& cursor, const SegmentInterval& s, F&& visit);

    Problem problem_;
    const Request& request_;
    Result result_;
    ChannelEvaluator evaluator_;
    std::unique_ptr<ExtremaFinder> finder_;
    std::vector<double> y_;
    std::vector<Cursor> table_cursors_, pose_cursors_, point_cursors_;
    struct Refined {  // rows between the times of a table with a curve
        CurveRefiner refiner;
        std::vector<double> times;
        std::vector<std::vector<double>> values;  // by channel
    };
    std::vector<Refined> refined_;            // of each table
    std::vector<std::size_t> contact_poses_;  // of each pose request: how many there are
    int contact_steps_ = 0;                   // of the open impact, looked into for poses
    double end_ = 0, start_total_ = 0, largest_elastic_ = 0;
    bool impact_open_ = false;
    double lost_at_touch_ = 0, impulse_n_at_touch_ = 0, impulse_t_at_touch_ = 0;
};

}  // namespace beamcam::sim
