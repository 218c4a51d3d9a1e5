#include "sim/observe/recorder_set.hpp"

#include <algorithm>
#include <utility>

namespace beamcam::sim {

RecorderSet::RecorderSet(const System& system, std::span<const Request> requests)
    : y_(static_cast<std::size_t>(system.size)) {
    for (const Request& request : requests) {
        recorders_.emplace_back(system, request, requests.size() > 1 ? &shared_ : nullptr);
        end_ = std::max(end_, recorders_.back().end());
    }
}

bool RecorderSet::done() const { return std::ranges::all_of(recorders_, &Recorder::finished); }

template <class F>
void RecorderSet::each_unfinished(F&& visit) {
    for (Recorder& r : recorders_)
        if (!r.finished()) visit(r);
}

void RecorderSet::begin(const Phase& phase, const std::vector<double>& y) {
    for (Recorder& r : recorders_) r.begin(phase, y);
}

// The first recorder that takes the whole interval computes the summary for the others.
void RecorderSet::record(const Segment& segment, double from, double to, bool event,
                         const StatisticsSource& statistics) {
    const SegmentSummary* known = nullptr;
    shared_ = {};
    each_unfinished([&](Recorder& r) {
        if (r.end() < to || (r.end() == to && !event)) {
            r.record({&segment, from, r.end(), true});
            segment.value(r.end(), y_.data());
            r.finish(r.end(), y_.data(), statistics());
        } else {
            r.record({&segment, from, to, false}, known);
            if (!known) known = &r.summary();
        }
    });
}

void RecorderSet::touch(double t, const double* y, const ContactState& contact) {
    each_unfinished([&](Recorder& r) { r.touch(t, y, contact); });
}

void RecorderSet::release(double t, const double* y, const ContactState& contact) {
    each_unfinished([&](Recorder& r) { r.release(t, y, contact); });
}

namespace {

// The end of a run that falls on an instant without a segment.
struct PointSegment final : Segment {
    PointSegment(double t, const std::vector<double>& state) : y(state) { t0 = t1 = t; }
    void value(double, double* out) const override { std::copy(y.begin(), y.end(), out); }
    const std::vector<double>& y;
};

}  // namespace

void RecorderSet::resume(double t, const std::vector<double>& y, const Phase& phase,
                         const StatisticsSource& statistics) {
    shared_ = {};
    each_unfinished([&](Recorder& r) {
        r.set_phase(phase);
        if (r.end() > t && !r.has_enough()) return;
        const PointSegment point(t, y);
        r.record({&point, t, t, true});
        r.finish(t, y.data(), statistics());
    });
}

void RecorderSet::give_up(double t, const std::vector<double>& y, const StatisticsSource& statistics) {
    each_unfinished([&](Recorder& r) { r.finish(t, y.data(), statistics()); });
}

std::vector<Result> RecorderSet::results() {
    std::vector<Result> all;
    for (Recorder& r : recorders_) all.push_back(std::move(r.result()));
    return all;
}

}  // namespace beamcam::sim
