// Tables, poses and points of a request, filled step by step as the motion passes their times.
#pragma once

#include <vector>

#include "sim/observe/channel_evaluator.hpp"
#include "sim/observe/observer.hpp"
#include "sim/observe/refine.hpp"
#include "sim/observe/request.hpp"
#include "sim/observe/result.hpp"

namespace beamcam::sim {

class SampleRecorder {
  public:
    // All of them must outlive it.
    SampleRecorder(const Request& request, ChannelEvaluator& evaluator, Result& result);

    void step(const SegmentInterval& s);
    void begin_contact() { contact_steps_ = 0; }
    // A step in contact: poses at its start and middle, within the first steps.
    void contact_step(const SegmentInterval& s);
    // Merges the rows between the times of curves with those at the times.
    void finish();
    bool has_full_table() const;  // the rows of an adaptive table were too many

  private:
    struct Cursor {
        std::vector<std::size_t> order;  // indices of the times, ascending
        std::size_t next = 0;
    };
    static Cursor ascending(const std::vector<double>& times);
    void evaluate_at(const SegmentInterval& s, double t);
    // Valid until the next call.
    const std::vector<double>& row(const SegmentInterval& s, double t, const std::vector<Channel>& channels);
    void refine_tables(const SegmentInterval& s, const std::vector<std::size_t>& before);
    template <class Refiner, class At>
    void refine_table(const SegmentInterval& s, std::size_t table, std::size_t before, Refiner& refiner, At&& at);
    std::vector<std::size_t> kept_rows(std::size_t table, const std::vector<double>& times,
                                       const std::vector<std::vector<double>>& values) const;
    void put_pose(const SegmentInterval& s, double t, std::size_t request, std::size_t row);
    // Calls visit(t, row) for each of the times in the interval.
    template <class F>
    static void sweep(const std::vector<double>& times, Cursor& cursor, const SegmentInterval& s, F&& visit);

    const Request& request_;
    ChannelEvaluator& evaluator_;
    Result& result_;
    std::vector<double> y_, row_;
    std::vector<Cursor> table_cursors_, pose_cursors_, point_cursors_;
    struct RefinedRows {  // between the times of a table with a curve, or of an adaptive one
        PieceRefiner<PlaneCurve> curve;
        PieceRefiner<ChannelCurves> channels;
        std::vector<double> times;
        std::vector<std::vector<double>> values;  // by channel
    };
    std::vector<RefinedRows> refined_;        // of each table
    std::vector<std::size_t> contact_poses_;  // number taken so far, of each pose request
    int contact_steps_ = 0;                   // of the present contact, from which poses were taken
};

}  // namespace beamcam::sim
