#include "sim/observe/recorder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "sim/observe/constants.hpp"
#include "sim/observe/extrema.hpp"
#include "sim/observe/warnings.hpp"

namespace beamcam::sim {

Recorder::Recorder(const System& system, const Request& request, double end)
    : problem_(system.problem()),
      request_(request),
      evaluator_(system),
      finder_(std::make_unique<ExtremaFinder>(system, request.extrema)),
      y_(static_cast<std::size_t>(evaluator_.system().size)),
      end_(end) {
    const auto ordered = [](const std::vector<double>& times) {
        Cursor cursor;
        cursor.order.resize(times.size());
        std::iota(cursor.order.begin(), cursor.order.end(), std::size_t{0});
        std::stable_sort(cursor.order.begin(), cursor.order.end(),
                         [&](std::size_t a, std::size_t b) { return times[a] < times[b]; });
        return cursor;
    };
    for (const TableRequest& table : request.tables) {
        table_cursors_.push_back(ordered(table.times));
        Table out;
        out.channels = table.channels;
        out.values.assign(table.channels.size(), std::vector<double>(table.times.size(), kNan));
        result_.tables.push_back(std::move(out));
        refined_.push_back({{}, {}, std::vector<std::vector<double>>(table.channels.size())});
    }
    for (const PoseRequest& poses : request.poses) {
        pose_cursors_.push_back(ordered(poses.times));
        contact_poses_.push_back(0);
        result_.poses.emplace_back(poses.take ? 0 : poses.times.size());
    }
    for (const PointRequest& points : request.points) {
        point_cursors_.push_back(ordered(points.times));
        result_.points.emplace_back(points.times.size());
    }
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    result_.extrema.assign(request.extrema.size(), {kInfinity, 0, -kInfinity, 0});
}

Recorder::Recorder(Recorder&&) noexcept = default;
Recorder::~Recorder() = default;

void Recorder::begin(const Phase& first_phase, const std::vector<double>& y) {
    phase(first_phase);
    evaluator_.set(0, y.data());
    start_total_ = evaluator_.energy_balance().total();
    evaluator_.set_start_energy(start_total_);
    const double lever = problem_.hub.radius + 0.5 * problem_.beam.length;
    result_.energy_scale = std::fabs(problem_.beam.line_density() * problem_.beam.length * problem_.gravity * lever);
    finder_->begin(start_total_, y.data(), result_.extrema);
    note_balance();
}

bool Recorder::has_enough() const {
    const std::optional<EventCounts>& enough = request_.enough;
    const std::size_t touches = result_.impacts.size(), releases = touches - (impact_open_ ? 1 : 0);
    return enough && touches >= enough->touches && releases >= enough->releases &&
           result_.collisions.size() >= enough->collisions;
}

void Recorder::phase(const Phase& phase) {
    evaluator_.set_phase(phase);
    finder_->set_phase(phase);
}

template <class F>
void Recorder::sweep(const std::vector<double>& times, Cursor& cursor, const SegmentInterval& s, F&& visit) {
    while (cursor.next < cursor.order.size()) {
        const std::size_t row = cursor.order[cursor.next];
        const double t = times[row];
        if (s.ends_before(t)) return;
        evaluate_at(s, t);
        visit(row);
        ++cursor.next;
    }
}

void Recorder::evaluate_at(const SegmentInterval& s, double t) {
    s.segment->value(std::max(t, s.from), y_.data());
    evaluator_.set(t, y_.data());
    evaluator_.system().search_again();
}

// Charts and traces ask for the same instants: each is looked at once for all of them.
void Recorder::sample_tables(const SegmentInterval& s) {
    constexpr double kNone = std::numeric_limits<double>::infinity();
    const auto next = [&](std::size_t i) {
        const Cursor& cursor = table_cursors_[i];
        return cursor.next < cursor.order.size() ? request_.tables[i].times[cursor.order[cursor.next]] : kNone;
    };
    for (;;) {
        double t = kNone;
        for (std::size_t i = 0; i < request_.tables.size(); ++i) t = std::min(t, next(i));
        if (t == kNone || s.ends_before(t)) return;
        evaluate_at(s, t);
        for (std::size_t i = 0; i < request_.tables.size(); ++i) {
            const std::vector<Channel>& channels = request_.tables[i].channels;
            for (; next(i) == t; ++table_cursors_[i].next)
                for (std::size_t c = 0; c < channels.size(); ++c)
                    result_.tables[i].values[c][table_cursors_[i].order[table_cursors_[i].next]] =
                        evaluator_.value(channels[c]);
        }
    }
}

// Between the times of the tables and the ends of the interval, where the motion may jump: both ends are rows.
void Recorder::refine_curves(const SegmentInterval& s, const std::vector<std::size_t>& before) {
    for (std::size_t i = 0; i < request_.tables.size(); ++i) {
        const TableRequest& table = request_.tables[i];
        if (!table.curve || table.times.empty()) continue;
        const Cursor& cursor = table_cursors_[i];
        const double first = table.times[cursor.order.front()], last = table.times[cursor.order.back()];
        const double from = std::max(s.from, first), to = std::min(s.to, last);
        if (!(to > from)) continue;
        Refined& refined = refined_[i];
        const auto at = [&](double t) {
            evaluate_at(s, t);
            return Vec2{evaluator_.value(table.curve->first), evaluator_.value(table.curve->second)};
        };
        const auto keep = [&](double t) {
            evaluate_at(s, t);
            refined.times.push_back(t);
            for (std::size_t c = 0; c < table.channels.size(); ++c)
                refined.values[c].push_back(evaluator_.value(table.channels[c]));
        };
        keep(from);
        double reached = from;
        for (std::size_t k = before[i]; k <= cursor.next; ++k) {
            const double t = k < cursor.next ? std::clamp(table.times[cursor.order[k]], from, to) : to;
            if (!(t > reached)) continue;
            refined.refiner.refine(reached, t, table.stray, at, keep);
            reached = t;
        }
        keep(to);
    }
}

// The rows of the times and those between them, in the order of time.
void Recorder::merge_refined() {
    for (std::size_t i = 0; i < refined_.size(); ++i) {
        const Refined& refined = refined_[i];
        if (refined.times.empty()) continue;
        std::vector<double> times = request_.tables[i].times;
        times.insert(times.end(), refined.times.begin(), refined.times.end());
        std::vector<std::size_t> order(times.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::ranges::stable_sort(order, {}, [&](std::size_t row) { return times[row]; });
        Table& table = result_.tables[i];
        for (std::size_t c = 0; c < table.values.size(); ++c) {
            std::vector<double> all = table.values[c];
            all.insert(all.end(), refined.values[c].begin(), refined.values[c].end());
            for (std::size_t row = 0; row < order.size(); ++row) times[row] = all[order[row]];
            table.values[c] = times;
        }
    }
}

void Recorder::sample(const SegmentInterval& s) {
    std::vector<std::size_t> before;
    for (const Cursor& cursor : table_cursors_) before.push_back(cursor.next);
    sample_tables(s);
    refine_curves(s, before);
    for (std::size_t i = 0; i < request_.poses.size(); ++i) {
        const PoseRequest& poses = request_.poses[i];
        sweep(poses.times, pose_cursors_[i], s, [&](std::size_t row) {
            if (poses.take)
                poses.take(row, evaluator_.pose(poses.stations));
            else
                result_.poses[i][row] = evaluator_.pose(poses.stations);
        });
    }
    for (std::size_t i = 0; i < request_.points.size(); ++i) {
        const PointRequest& points = request_.points[i];
        sweep(points.times, point_cursors_[i], s, [&](std::size_t row) {
            BeamPoint p;
            evaluator_.system().model().point(points.x, p);
            result_.points[i][row] = p.r;
        });
    }
}

// In the middle of the whole step, which is the same wherever the run ends.
void Recorder::contact_poses(const SegmentInterval& s) {
    if (!impact_open_ || contact_steps_ == kContactPoseSteps) return;
    const std::array instants{contact_steps_ == 0 ? s.from : kNan, 0.5 * (s.segment->t0 + s.segment->t1)};
    ++contact_steps_;
    for (std::size_t i = 0; i < request_.poses.size(); ++i) {
        const PoseRequest& poses = request_.poses[i];
        if (poses.times.empty()) continue;
        const double from = poses.times[pose_cursors_[i].order.front()],
                     to = poses.times[pose_cursors_[i].order.back()];
        for (const double t : instants) {
            if (!(t >= std::max(s.from, from) && t <= std::min(s.to, to)) || contact_poses_[i] == poses.contacts)
                continue;
            evaluate_at(s, t);
            if (poses.take)
                poses.take(poses.times.size() + contact_poses_[i], evaluator_.pose(poses.stations));
            else
                result_.poses[i].push_back(evaluator_.pose(poses.stations));
            ++contact_poses_[i];
        }
    }
    evaluator_.system().search_again();
}

void Recorder::contact_peaks(const SegmentInterval& s) {
    if (!impact_open_) return;
    Impact& impact = result_.impacts.back();
    finder_->contact_peaks(s, impact.force_peak, impact.penetration_peak);
}

void Recorder::note_balance() {
    const System::EnergyBalance& energy_balance = evaluator_.energy_balance();
    largest_elastic_ = std::max(largest_elastic_, energy_balance.energies.elastic);
    result_.energy_scale =
        std::max({result_.energy_scale, energy_balance.energies.kinetic, energy_balance.energies.elastic});
    result_.energy_residual_max =
        std::max(result_.energy_residual_max, std::fabs(energy_balance.total() - start_total_));
}

// The energy balance where a step ends and, in contact, where only the dense output knows the force, inside it.
void Recorder::ledger(const SegmentInterval& s) {
    const TouchSamples* samples = s.segment->touch();
    for (const double share : {1.0 / 3, 2.0 / 3, 1.0}) {
        if (share < 1 && (!impact_open_ || samples)) continue;
        const double t = share < 1 ? s.from + share * (s.to - s.from) : s.to;
        s.segment->value(t, y_.data());
        evaluator_.set(t, y_.data());
        if (samples && t == s.segment->t1) evaluator_.set_gap(samples->gap[TouchSamples::kCount - 1]);
        note_balance();
    }
}

void Recorder::record(const SegmentInterval& s, SegmentSummary* made) {
    if (!(s.to > s.from) && !s.last) return;
    const std::size_t apexes = result_.apexes.size(), zeros = result_.theta_zero.size();
    // Each observer starts its search of the contact afresh, so that none sees what another looked at:
    // the last bits of a foot point depend on where its iteration began.
    sample(s);
    contact_poses(s);
    if (s.to > s.from) {
        if (request_.turning_points) finder_->turning_points(s, result_.apexes, result_.theta_zero);
        contact_peaks(s);
        finder_->step(s, result_.extrema);
    }
    evaluator_.system().search_again();
    ledger(s);
    if (!made) return;
    made->turning_points = request_.turning_points;
    made->apexes.assign(result_.apexes.begin() + static_cast<std::ptrdiff_t>(apexes), result_.apexes.end());
    made->theta_zero.assign(result_.theta_zero.begin() + static_cast<std::ptrdiff_t>(zeros), result_.theta_zero.end());
    if (impact_open_) {
        made->force_peak = result_.impacts.back().force_peak;
        made->penetration_peak = result_.impacts.back().penetration_peak;
    }
    made->energy_scale = result_.energy_scale;
    made->energy_residual_max = result_.energy_residual_max;
    made->largest_elastic = largest_elastic_;
}

void Recorder::record(const SegmentInterval& s, const SegmentSummary& known) {
    if (!(s.to > s.from)) return;
    sample(s);
    contact_poses(s);
    evaluator_.system().search_again();
    finder_->step(s, result_.extrema);
    if (request_.turning_points && known.turning_points) {
        result_.apexes.insert(result_.apexes.end(), known.apexes.begin(), known.apexes.end());
        result_.theta_zero.insert(result_.theta_zero.end(), known.theta_zero.begin(), known.theta_zero.end());
    } else if (request_.turning_points) {
        finder_->turning_points(s, result_.apexes, result_.theta_zero);
    }
    if (impact_open_) {
        result_.impacts.back().force_peak = known.force_peak;
        result_.impacts.back().penetration_peak = known.penetration_peak;
    }
    result_.energy_scale = known.energy_scale;
    result_.energy_residual_max = known.energy_residual_max;
    largest_elastic_ = known.largest_elastic;
}

TouchState Recorder::touch_state(double t, const double* y, const ContactState& c) {
    evaluator_.set(t, y);
    evaluator_.set_contact(c);
    TouchState out;
    out.theta = evaluator_.value({ChannelKind::theta, 0});
    out.theta_dot = evaluator_.value({ChannelKind::theta_dot, 0});
    out.contact_s = evaluator_.value({ChannelKind::contact_s, 0});
    const int count = problem_.beam.model == ModelKind::rigid ? 0 : problem_.beam.modes;
    for (int i = 1; i <= count; ++i) out.q.push_back(evaluator_.value({ChannelKind::q, i}));
    return out;
}

void Recorder::touch(double t, const double* y, const ContactState& c) {
    const double* ledger = y + evaluator_.system().controlled;
    impact_open_ = true;
    contact_steps_ = 0;
    lost_at_touch_ = ledger[kNormalWork] + ledger[kFrictionWork];
    impulse_n_at_touch_ = ledger[kImpulseN];
    impulse_t_at_touch_ = ledger[kImpulseT];
    Impact impact;
    impact.t_start = t;
    impact.x = c.x;
    impact.cam_angle = evaluator_.system().cam(t).angle;
    impact.v_n_before = c.gap_rate;
    impact.v_t_before = c.slip;
    impact.penetration_peak = std::max(0.0, -c.gap);
    impact.at_touch = touch_state(t, y, c);
    if (problem_.contact.model == ContactModel::compliant) impact.force_peak = c.force;
    std::vector<Collision>& collisions = result_.collisions;
    const bool joins = !collisions.empty() && t - collisions.back().t_end.value_or(t) < collision_gap(problem_);
    if (!joins) {
        Collision collision;
        collision.t_start = t;
        collision.x = c.x;
        collision.v_n_before = c.gap_rate;
        collisions.push_back(collision);
    }
    Collision& collision = collisions.back();
    ++collision.count;
    collision.t_end.reset();
    collision.v_n_after.reset();
    collision.restitution.reset();
    impact.collision = static_cast<int>(collisions.size()) - 1;
    result_.impacts.push_back(impact);
}

void Recorder::release(double t, const double* y, const ContactState& c) {
    Impact& impact = result_.impacts.back();
    impact.t_end = t;
    impact.duration = t - impact.t_start;
    impact.v_n_after = c.gap_rate;
    impact.v_t_after = c.slip;
    impact.at_release = touch_state(t, y, c);
    if (impact.v_n_before < 0) impact.restitution = -c.gap_rate / impact.v_n_before;
    settle(y);
    impact_open_ = false;
    Collision& collision = result_.collisions.back();
    collision.t_end = t;
    collision.v_n_after = c.gap_rate;
    if (collision.v_n_before < 0) collision.restitution = -c.gap_rate / collision.v_n_before;
}

// Impulses and losses of the open impact up to the state y.
void Recorder::settle(const double* y) {
    Impact& impact = result_.impacts.back();
    Collision& collision = result_.collisions.back();
    const double* ledger = y + evaluator_.system().controlled;
    impact.impulse_n = ledger[kImpulseN] - impulse_n_at_touch_;
    impact.impulse_t = ledger[kImpulseT] - impulse_t_at_touch_;
    impact.energy_lost = ledger[kNormalWork] + ledger[kFrictionWork] - lost_at_touch_;
    if (impact.force_peak) collision.force_peak = std::max(collision.force_peak.value_or(0), *impact.force_peak);
    collision.energy_lost += impact.energy_lost;
}

void Recorder::finish(double t, const double* y, const RunStatistics& statistics) {
    merge_refined();
    if (impact_open_) {
        evaluator_.set(t, y);
        settle(y);
        result_.impacts.back().energy_lost -= evaluator_.energy_balance().contact;  // what is stored is not lost
        result_.collisions.back().energy_lost -= evaluator_.energy_balance().contact;
    }
    finder_->finish(result_.extrema);
    // Channels that are undefined all along have no extrema.
    for (Extremum& e : result_.extrema)
        if (e.min > e.max) e = {kNan, kNan, kNan, kNan};
    result_.end_time = t;
    result_.counters = statistics.counters;
    const Method method = problem_.solver.method;
    for (const auto& [by, steps] : {std::pair{method == Method::automatic ? Method::exponential : method,
                                              statistics.counters.steps - statistics.fallbacks.steps},
                                    std::pair{statistics.fallbacks.method, statistics.fallbacks.steps}})
        if (steps > 0) result_.steps_by_method.emplace_back(by, steps);
    result_.beyond_model = bends_beyond(problem_, largest_elastic_);
    RunStatistics all = statistics;
    all.fallbacks.searches = finder_->incomplete();
    result_.warnings = warnings(problem_, result_, all, largest_elastic_);
}

}  // namespace beamcam::sim
