#include "sim/observe/samples.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string_view>
#include <type_traits>

#include "sim/base/numerics.hpp"

namespace beamcam::sim {

namespace {

constexpr int kMostCurveHalvings = 8;  // of the piece between two rows
constexpr int kMostRowHalvings = 16;   // of the piece between two rows of an adaptive table
// Poses are taken within the first steps of a contact: after them a collision is over, and a lasting contact is slow.
constexpr int kContactPoseSteps = 4;

// Differences of each channel that are rounding, from the mass and length of the beam and the time of its fall.
// Infinite for channels that rows do not follow: the energy residual, and in a table of all channels those of single
// modes and the separation, which would take ten times as many rows.
std::vector<double> rounding_of(const std::vector<Channel>& channels, const Problem& problem) {
    const Beam& beam = problem.beam;
    const double g = problem.gravity == 0 ? kEarthGravity : std::fabs(problem.gravity);
    const SectionProperties section = section_properties(beam);
    const double length = beam.length, mass = beam.line_density() * length, rate = std::sqrt(g / length);
    const std::pair<std::string_view, double> sizes[] = {
        {"m", length},
        {"m/s", length * rate},
        {"m/s^2", g},
        {"rad", 1},
        {"rad/s", rate},
        {"N", mass * g},
        {"J", mass * g * length},
        {"N m", mass * g * length},
        {"W", mass * g * length * rate},
        {"Pa", mass * g * length * section.c_max / section.second_moment}};
    const bool all = channels.size() == all_channels(problem).size();
    std::vector<double> out;
    for (const Channel& channel : channels) {
        const bool followed = channel.kind != ChannelKind::energy_residual &&
                              !(all && (traits(channel.kind).of_mode || traits(channel.kind).accelerated));
        double size = followed ? 1 : std::numeric_limits<double>::infinity();
        for (const auto& [of, natural] : sizes)
            if (of == unit(channel, problem)) size *= natural;
        out.push_back(kNegligible * size);
    }
    return out;
}

std::pair<double, double> span_of(const TableRequest& table) {
    if (table.times.empty()) return {0, 0};
    const auto [first, last] = std::ranges::minmax(table.times);
    return {first, last};
}

}  // namespace

SampleRecorder::SampleRecorder(const Request& request, ChannelEvaluator& evaluator, Result& result)
    : request_(request),
      evaluator_(evaluator),
      result_(result),
      y_(static_cast<std::size_t>(evaluator.system().size)),
      contact_poses_(request.poses.size(), 0) {
    for (const TableRequest& table : request.tables) {
        table_cursors_.push_back(ascending(table.times));
        result_.tables.push_back({table.channels, {}});
        result_.tables.back().values.assign(table.channels.size(), std::vector<double>(table.times.size(), kNan));
        const std::vector<double> rounding = rounding_of(table.channels, evaluator.system().problem());
        refined_.push_back({{PlaneCurve(table.drawn, table.stray), kMostCurveHalvings},
                            {ChannelCurves(span_of(table), rounding, table.stray), kMostRowHalvings},
                            {},
                            std::vector<std::vector<double>>(table.channels.size())});
    }
    for (const PoseRequest& poses : request.poses) {
        pose_cursors_.push_back(ascending(poses.times));
        result_.poses.emplace_back(poses.times.size());
    }
    for (const PointRequest& points : request.points) {
        point_cursors_.push_back(ascending(points.times));
        result_.points.emplace_back(points.times.size());
    }
}

SampleRecorder::Cursor SampleRecorder::ascending(const std::vector<double>& times) {
    Cursor cursor;
    cursor.order.resize(times.size());
    std::iota(cursor.order.begin(), cursor.order.end(), std::size_t{0});
    std::ranges::stable_sort(cursor.order, {}, [&](std::size_t row) { return times[row]; });
    return cursor;
}

template <class F>
void SampleRecorder::sweep(const std::vector<double>& times, Cursor& cursor, const SegmentInterval& s, F&& visit) {
    for (; cursor.next < cursor.order.size(); ++cursor.next) {
        const std::size_t row = cursor.order[cursor.next];
        if (s.ends_before(times[row])) return;
        visit(times[row], row);
    }
}

void SampleRecorder::evaluate_at(const SegmentInterval& s, double t) {
    s.segment->value(std::max(t, s.from), y_.data());
    evaluator_.set(t, y_.data());
}

const std::vector<double>& SampleRecorder::row(const SegmentInterval& s, double t,
                                               const std::vector<Channel>& channels) {
    row_.clear();
    evaluate_at(s, t);
    for (const Channel channel : channels) row_.push_back(evaluator_.value(channel));
    return row_;
}

void SampleRecorder::step(const SegmentInterval& s) {
    std::vector<std::size_t> before;
    for (const Cursor& cursor : table_cursors_) before.push_back(cursor.next);
    for (std::size_t i = 0; i < request_.tables.size(); ++i) {
        const TableRequest& table = request_.tables[i];
        sweep(table.times, table_cursors_[i], s, [&](double t, std::size_t at) {
            const std::vector<double>& values = row(s, t, table.channels);
            for (std::size_t c = 0; c < values.size(); ++c) result_.tables[i].values[c][at] = values[c];
        });
    }
    refine_tables(s, before);
    for (std::size_t i = 0; i < request_.poses.size(); ++i)
        sweep(request_.poses[i].times, pose_cursors_[i], s, [&](double t, std::size_t row) { put_pose(s, t, i, row); });
    for (std::size_t i = 0; i < request_.points.size(); ++i) {
        const PointRequest& points = request_.points[i];
        sweep(points.times, point_cursors_[i], s, [&](double t, std::size_t row) {
            BeamPoint p;
            evaluate_at(s, t);
            evaluator_.model().point(points.x, p);
            result_.points[i][row] = p.r;
        });
    }
}

void SampleRecorder::refine_tables(const SegmentInterval& s, const std::vector<std::size_t>& before) {
    for (std::size_t i = 0; i < request_.tables.size(); ++i) {
        const TableRequest& table = request_.tables[i];
        if (table.times.empty()) continue;
        if (table.adaptive)
            refine_table(s, i, before[i], refined_[i].channels, [&](double t) {
                return ChannelPoint{t, row(s, t, table.channels)};
            });
        if (!table.curve) continue;
        const std::vector<Channel> curve{table.curve->first, table.curve->second};
        refine_table(s, i, before[i], refined_[i].curve, [&](double t) {
            const std::vector<double>& point = row(s, t, curve);
            return Vec2{point[0], point[1]};
        });
    }
}

// Between the times of the table and the ends of the interval, where the motion may jump: both ends are rows.
template <class Refiner, class At>
void SampleRecorder::refine_table(const SegmentInterval& s, std::size_t i, std::size_t before, Refiner& refiner,
                                  At&& at) {
    const TableRequest& table = request_.tables[i];
    const Cursor& cursor = table_cursors_[i];
    const double from = std::max(s.from, table.times[cursor.order.front()]),
                 to = std::min(s.to, table.times[cursor.order.back()]);
    if (!(to > from)) return;
    RefinedRows& rows = refined_[i];
    const auto put = [&](double t, const std::vector<double>& values) {
        rows.times.push_back(t);
        for (std::size_t c = 0; c < values.size(); ++c) rows.values[c].push_back(values[c]);
    };
    const auto keep = [&](double t, const typename Refiner::Point& point) {
        if constexpr (std::is_same_v<typename Refiner::Point, ChannelPoint>)
            put(t, point.values);
        else
            put(t, row(s, t, table.channels));
    };
    put(from, row(s, from, table.channels));
    double reached = from;
    for (std::size_t k = before; k <= cursor.next; ++k) {
        const double t = k < cursor.next ? std::clamp(table.times[cursor.order[k]], from, to) : to;
        if (!(t > reached)) continue;
        refiner.refine(reached, t, at, keep);
        reached = t;
    }
    put(to, row(s, to, table.channels));
}

void SampleRecorder::finish() {
    for (std::size_t i = 0; i < refined_.size(); ++i) {
        const RefinedRows& rows = refined_[i];
        if (rows.times.empty()) continue;
        std::vector<double> times = rows.times;
        std::vector<std::vector<double>> values = rows.values;
        Table& table = result_.tables[i];
        times.insert(times.end(), request_.tables[i].times.begin(), request_.tables[i].times.end());
        for (std::size_t c = 0; c < values.size(); ++c) {
            values[c].insert(values[c].end(), table.values[c].begin(), table.values[c].end());
            table.values[c].clear();
        }
        for (const std::size_t row : kept_rows(i, times, values))
            for (std::size_t c = 0; c < values.size(); ++c) table.values[c].push_back(values[c][row]);
    }
}

// The rows are in the order of time. An adaptive table keeps one row of each instant, or both sides of a jump.
std::vector<std::size_t> SampleRecorder::kept_rows(std::size_t i, const std::vector<double>& times,
                                                   const std::vector<std::vector<double>>& values) const {
    std::vector<std::size_t> order = ascending(times).order;
    if (!request_.tables[i].adaptive) return order;
    const auto point = [&](std::size_t row) {
        ChannelPoint out{times[row]};
        for (const std::vector<double>& channel : values) out.values.push_back(channel[row]);
        return out;
    };
    std::vector<std::size_t> kept;
    for (std::size_t first = 0, end = 0; first < order.size(); first = end) {
        while (end < order.size() && times[order[end]] == times[order[first]]) ++end;
        kept.push_back(order[first]);
        const ChannelPoint before = point(order[first]), after = point(order[end - 1]);
        if (refined_[i].channels.measure().strays(before, before, after, 0)) kept.push_back(order[end - 1]);
    }
    return kept;
}

bool SampleRecorder::has_full_table() const {
    return std::ranges::any_of(refined_, [](const RefinedRows& rows) { return rows.channels.is_full(); });
}

void SampleRecorder::put_pose(const SegmentInterval& s, double t, std::size_t i, std::size_t row) {
    evaluate_at(s, t);
    result_.poses[i].resize(std::max(result_.poses[i].size(), row + 1));
    result_.poses[i][row] = evaluator_.pose(request_.poses[i].stations);
}

// In the middle of the whole step, which is the same wherever the run ends.
void SampleRecorder::contact_step(const SegmentInterval& s) {
    if (contact_steps_ == kContactPoseSteps) return;
    const std::array instants{contact_steps_ == 0 ? s.from : kNan, 0.5 * (s.segment->t0 + s.segment->t1)};
    ++contact_steps_;
    for (std::size_t i = 0; i < request_.poses.size(); ++i) {
        const PoseRequest& poses = request_.poses[i];
        if (poses.times.empty()) continue;
        const double from = std::max(s.from, poses.times[pose_cursors_[i].order.front()]),
                     to = std::min(s.to, poses.times[pose_cursors_[i].order.back()]);
        for (const double t : instants) {
            if (!(t >= from && t <= to) || contact_poses_[i] == poses.contacts) continue;
            put_pose(s, t, i, poses.times.size() + contact_poses_[i]++);
        }
    }
}

}  // namespace beamcam::sim
