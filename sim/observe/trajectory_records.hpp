// The records of a stored trajectory: one list of numbers for each value, which both writer and reader follow.
#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "sim/dynamics/system.hpp"
#include "sim/observe/run_statistics.hpp"
#include "sim/observe/segment_interval.hpp"

namespace beamcam::sim {

// First number of every record; the second is the record's length, both included.
enum class RecordKind : int { begin = 1, interval, touch, release, resume, end };
inline constexpr std::size_t kRecordHead = 2;

// The numbers of one record, in the order in which they were written. Throws std::invalid_argument where they end.
class NumberReader {
  public:
    explicit NumberReader(std::span<const double> all) : left_(all) {}
    template <class T>
    void operator()(T& value) {
        const double number = take(1).front();
        if constexpr (std::is_same_v<T, bool>)
            value = number != 0;
        else if constexpr (std::is_floating_point_v<T>)
            value = number;
        else
            value = static_cast<T>(whole(number));
    }
    template <class T>
    T next() {
        T value;
        (*this)(value);
        return value;
    }
    std::span<const double> rest() { return take(left_.size()); }

  private:
    static long whole(double number) {
        if (!(std::fabs(number) < 9e15)) throw std::invalid_argument("a number of the trajectory is damaged");
        return static_cast<long>(number);
    }
    std::span<const double> take(std::size_t count) {
        if (count > left_.size()) throw std::invalid_argument("a record of the trajectory is too short");
        const std::span<const double> taken = left_.first(count);
        left_ = left_.subspan(count);
        return taken;
    }

    std::span<const double> left_;
};

template <class Archive>
void visit(Archive& a, Phase& p) {
    a(p.touching), a(p.held), a(p.approach), a(p.friction), a(p.gap_offset);
}

template <class Archive>
void visit(Archive& a, RunStatistics& s) {
    Counters& c = s.counters;
    Fallbacks& f = s.fallbacks;
    a(c.steps), a(c.rejected), a(c.rhs_evaluations), a(c.gap_evaluations), a(c.jacobians), a(s.floored), a(s.chatters);
    a(f.steps), a(f.handed_over), a(f.friction_changes), a(f.strikes), a(f.coarse), a(f.left_behind), a(f.unstable),
        a(f.gap), a(f.method);
}

template <class Archive>
void visit(Archive& a, ContactState& c) {
    a(c.x), a(c.at_end), a(c.normal.x), a(c.normal.y), a(c.tangent.x), a(c.tangent.y);
    a(c.gap), a(c.gap_rate), a(c.slip), a(c.force), a(c.friction), a(c.factor);
}

template <class Archive>
void visit(Archive& a, Apex& apex) {
    a(apex.t), a(apex.theta);
}

template <class Archive>
void visit(Archive& a, ZeroCrossing& zero) {
    a(zero.t), a(zero.theta_dot);
}

template <class Archive, class T>
void visit(Archive& a, std::optional<std::vector<T>>& list) {
    long count = list ? static_cast<long>(list->size()) : -1;
    a(count);
    if (count < 0) return list.reset();
    if (!list) list.emplace();
    for (long i = 0; i < count; ++i) {
        if (i == static_cast<long>(list->size())) list->emplace_back();
        visit(a, (*list)[static_cast<std::size_t>(i)]);
    }
}

template <class Archive>
void visit(Archive& a, SegmentSummary& s) {
    if (!s.impact) s.impact.emplace();
    bool has_peak = s.impact->force.has_value();
    double peak = s.impact->force.value_or(0);
    a(has_peak), a(peak);
    s.impact->force = has_peak ? std::optional(peak) : std::nullopt;
    a(s.impact->penetration), a(s.energy_scale), a(s.energy_residual_max), a(s.largest_elastic);
    visit(a, s.apexes);
    visit(a, s.theta_zero);
}

template <class T>
void put(std::vector<double>& out, T value) {
    const auto append = [&](auto number) { out.push_back(static_cast<double>(number)); };
    visit(append, value);
}
template <class T>
T read(NumberReader& in) {
    T value;
    visit(in, value);
    return value;
}

}  // namespace beamcam::sim
