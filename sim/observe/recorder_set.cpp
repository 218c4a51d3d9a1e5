#include "sim/observe/recorder_set.hpp"

#include <algorithm>
#include <utility>

namespace beamcam::sim {

double end_of(const Request& request) {
    double end = request.end_time;
    const auto extend = [&](const std::vector<double>& times) {
        for (double t : times) end = std::max(end, t);
    };
    for (const TableRequest& table : request.tables) extend(table.times);
    for (const PoseRequest& poses : request.poses) extend(poses.times);
    for (const PointRequest& points : request.points) extend(points.times);
    return end;
}

RecorderSet::RecorderSet(const System& system, std::span<const Request> requests) : done_(requests.size(), 0) {
    recorders_.reserve(requests.size());
    for (const Request& request : requests) {
        recorders_.emplace_back(system, request, end_of(request));
        end_ = std::max(end_, recorders_.back().end());
    }
}

bool RecorderSet::done() const {
    return std::ranges::all_of(done_, [](char done) { return done != 0; });
}

void RecorderSet::begin(const Phase& phase, const std::vector<double>& y) {
    y_.resize(y.size());
    for (Recorder& r : recorders_) r.begin(phase, y);
}

void RecorderSet::finish(Recorder& recorder, double t, const double* y, const StatisticsSource& statistics) {
    recorder.finish(t, y, statistics());
    done_[static_cast<std::size_t>(&recorder - recorders_.data())] = 1;
}

const SegmentSummary* RecorderSet::record(const Segment& segment, double from, double to, bool event,
                                          const StatisticsSource& statistics, const SegmentSummary* known) {
    for (Recorder& r : recorders_) {
        if (!is_recording(r)) continue;
        const bool ends = r.end() < to || (r.end() == to && !event);
        if (ends) {
            r.record({&segment, from, r.end(), true});
            segment.value(r.end(), y_.data());
            finish(r, r.end(), y_.data(), statistics);
        } else if (known) {
            r.record({&segment, from, to, false}, *known);
        } else {
            r.record({&segment, from, to, false}, &summary_);
            known = &summary_;
        }
    }
    return known;
}

void RecorderSet::touch(double t, const double* y, const ContactState& contact) {
    for (Recorder& r : recorders_)
        if (is_recording(r)) r.touch(t, y, contact);
}

void RecorderSet::release(double t, const double* y, const ContactState& contact) {
    for (Recorder& r : recorders_)
        if (is_recording(r)) r.release(t, y, contact);
}

namespace {

// The end of a run that falls on an instant without a segment of its own.
struct PointSegment final : Segment {
    PointSegment(double t, const std::vector<double>& state) : y(state) { t0 = t1 = t; }
    void value(double, double* out) const override { std::copy(y.begin(), y.end(), out); }
    const std::vector<double>& y;
};

}  // namespace

void RecorderSet::resume(double t, const std::vector<double>& y, const Phase& phase,
                         const StatisticsSource& statistics) {
    for (Recorder& r : recorders_) {
        if (!is_recording(r)) continue;
        r.phase(phase);
        if (r.end() > t && !r.has_enough()) continue;
        const PointSegment point(t, y);
        r.record({&point, t, t, true});
        finish(r, t, y.data(), statistics);
    }
}

void RecorderSet::give_up(double t, const std::vector<double>& y, const StatisticsSource& statistics) {
    for (Recorder& r : recorders_)
        if (is_recording(r)) finish(r, t, y.data(), statistics);
}

std::vector<Result> RecorderSet::results() {
    std::vector<Result> all;
    for (Recorder& r : recorders_) all.push_back(std::move(r.result()));
    return all;
}

}  // namespace beamcam::sim
