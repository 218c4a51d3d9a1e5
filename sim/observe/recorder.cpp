#include "sim/observe/recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/dynamics/initial.hpp"
#include "sim/observe/crossings.hpp"
#include "sim/observe/extrema.hpp"
#include "sim/observe/warnings.hpp"

namespace beamcam::sim {

static constexpr Extremum kNoValue{std::numeric_limits<double>::infinity(), 0, -std::numeric_limits<double>::infinity(),
                                   0};

double end_of(const Request& request) {
    double end = request.end_time;
    const auto extend = [&](const std::vector<double>& times) {
        for (double t : times) end = std::max(end, t);
    };
    for (const TableRequest& table : request.tables) extend(table.times);
    for (const PoseRequest& poses : request.poses) extend(poses.times);
    for (const PointRequest& points : request.points) extend(points.times);
    extend(request.states);
    return end;
}

Recorder::Recorder(const System& system, const Request& request, std::function<RunStatistics()> statistics)
    : request_(request),
      statistics_(std::move(statistics)),
      end_(end_of(request)),
      evaluator_(system),
      step_(evaluator_),
      samples_(request, evaluator_, result_),
      impacts_(evaluator_, result_),
      y_(static_cast<std::size_t>(system.size)) {
    result_.states.resize(request.states.size());
    result_.extrema.assign(request.extrema.size(), kNoValue);
}

namespace {

// The end of a run that falls on an instant without a segment.
struct PointSegment final : Segment {
    PointSegment(double t, const std::vector<double>& state) : y(state) { t0 = t1 = t; }
    void value(double, double* out) const override { std::copy(y.begin(), y.end(), out); }
    const std::vector<double>& y;
};

}  // namespace

void Recorder::resume(double t, const std::vector<double>& y, const Phase& phase) {
    evaluator_.set_phase(phase);
    if (!start_total_) begin(y.data());
    if (end_ > t && !has_enough()) return;
    const PointSegment point(t, y);
    record({&point, t, t, true});
    finish(t, y.data());
}

void Recorder::begin(const double* y) {
    evaluator_.set(0, y);
    start_total_ = evaluator_.energy_balance().total();
    evaluator_.set_start_energy(*start_total_);
    const Problem& problem = evaluator_.system().problem();
    const double lever = problem.hub.radius + 0.5 * problem.beam.length;
    result_.energy_scale = std::fabs(problem.beam.line_density() * problem.beam.length * problem.gravity * lever);
    note_balance();
}

bool Recorder::has_enough() const {
    const std::optional<EventCounts>& enough = request_.enough;
    return enough && result_.impacts.size() >= enough->touches && impacts_.releases() >= enough->releases &&
           result_.collisions.size() >= enough->collisions;
}

void Recorder::step(const SegmentInterval& s) {
    record(s);
    if (!s.last) return;
    s.segment->value(s.to, y_.data());
    finish(s.to, y_.data());
}

void Recorder::record(const SegmentInterval& s) {
    const bool lasts = s.to > s.from;
    if (!lasts && !s.last) return;
    samples_.step(s);
    take_states(s);
    if (impacts_.open()) samples_.contact_step(s);
    record_balance(s);
    if (!lasts) return;
    if (request_.apexes) find_apexes(step_, s, result_.apexes);
    if (request_.zero_crossings) find_zero_crossings(step_, s, result_.theta_zero);
    if (request_.impact_peaks && impacts_.open()) raise_peaks(step_, s, *impacts_.open());
    raise_extrema(step_, s, request_.extrema, result_.extrema);
    if (request_.bends && !result_.collisions.empty()) find_bend(s);
}

void Recorder::take_states(const SegmentInterval& s) {
    for (std::size_t i = 0; i < request_.states.size(); ++i) {
        const double t = request_.states[i];
        if (result_.states[i] || s.ends_before(t)) continue;
        s.segment->value(std::max(t, s.from), y_.data());
        Problem& next = result_.states[i].emplace(continued(evaluator_.system(), t, y_));
        if (next.contact.approach_floor.policy == ApproachFloorPolicy::first_touch) impacts_.remember(t, next.initial);
    }
}

void Recorder::find_bend(const SegmentInterval& s) {
    if (evaluator_.system().coordinates() == 1) return;
    constexpr Channel kTip{ChannelKind::tip_deflection};
    raise_extrema(step_, s, {&kTip, 1}, {&bend_, 1});
    if (bend_.max > bend_.min) result_.collisions.back().t_bend = bend_.max >= -bend_.min ? bend_.t_max : bend_.t_min;
}

void Recorder::note_balance() {
    const System::EnergyBalance& balance = evaluator_.energy_balance();
    largest_elastic_ = std::max(largest_elastic_, balance.energies.elastic);
    result_.energy_scale = std::max({result_.energy_scale, balance.energies.kinetic, balance.energies.elastic});
    result_.energy_residual_max = std::max(result_.energy_residual_max, std::fabs(balance.total() - *start_total_));
}

// Where a step ends.
void Recorder::record_balance(const SegmentInterval& s) {
    s.segment->value(s.to, y_.data());
    evaluator_.set(s.to, y_.data());
    note_balance();
}

void Recorder::touch(double t, const std::vector<double>& y, const ContactState& contact) {
    const std::size_t before = result_.collisions.size();
    impacts_.touch(t, y.data(), contact);
    if (result_.collisions.size() > before) bend_ = kNoValue;
    samples_.begin_contact();
    if (request_.impact_peaks) return;
    Impact& impact = *impacts_.open();
    impact.force_peak.reset(), impact.t_peak.reset();
    impact.penetration_peak = kNan;
}

void Recorder::finish(double t, const double* y) {
    finished_ = true;
    samples_.finish();
    impacts_.finish(t, y);
    // Channels that are undefined all along have no extrema.
    for (Extremum& e : result_.extrema)
        if (e.min > e.max) e = {kNan, kNan, kNan, kNan};
    const Problem& problem = evaluator_.system().problem();
    result_.end_time = t;
    evaluator_.set(t, y);
    result_.end_theta = evaluator_.value({ChannelKind::theta, 0});
    const RunStatistics statistics = statistics_();
    result_.counters = statistics.counters;
    for (const auto& [by, steps] :
         {std::pair{statistics.method, statistics.counters.steps - statistics.fallbacks.steps},
          std::pair{statistics.fallbacks.method, statistics.fallbacks.steps}})
        if (steps > 0) result_.steps_by_method.emplace_back(by, steps);
    result_.beyond_model = bends_beyond(problem, largest_elastic_);
    result_.warnings = warnings(problem, result_, statistics, largest_elastic_);
    warn_of_missed_peaks(request_, result_);
    if (samples_.has_full_table())
        result_.warnings.push_back(fmt::format(
            "an adaptive table has reached its limit of {} rows between those at equal times: it does not follow the "
            "motion to its end; choose fewer channels, an earlier end, or a rate",
            kMostCurveRows));
}

}  // namespace beamcam::sim
