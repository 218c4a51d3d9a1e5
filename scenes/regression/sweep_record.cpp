// The comparison of a sweep with its record, point by point.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "scenes/regression/records.hpp"
#include "sim/base/counted.hpp"
#include "sim/sweep/attractor.hpp"

namespace beamcam::scenes {
namespace {

using sim::AttractorClass;

// ---- the points of a table and their samples ---------------------------------------------------

using SweepColumn = std::span<const double>;

bool same_number(double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); }

// The rows of a point's samples; a point without samples has one row, too.
struct PointRows {
    std::size_t begin = 0, end = 0;
    std::size_t size() const { return end - begin; }
};

class SweepTable {
  public:
    // Throws IoError if the table is not that of a sweep. The table must outlive it.
    explicit SweepTable(const output::ColumnTable& table);

    const std::vector<PointRows>& points() const { return points_; }
    // Columns of the samples, without those that grow with time.
    const std::vector<std::string>& values() const { return values_; }
    SweepColumn all(std::size_t value) const { return columns_[value]; }
    SweepColumn samples(const PointRows& point, std::size_t value) const {
        return columns_[value].subspan(point.begin, point.size());
    }
    sim::AttractorClass kind(const PointRows& point) const {
        return static_cast<sim::AttractorClass>(int(kinds_[point.begin]));
    }
    double at(const PointRows& point, const std::string& name) const { return column(name)[point.begin]; }
    std::string place(const PointRows& point) const;  // "cam.speed = 40, seed 0"
    bool same_rows(const PointRows& own, const SweepTable& other, const PointRows& its) const;

  private:
    const std::vector<double>& column(const std::string& name) const;

    const output::ColumnTable& table_;
    const SweepColumn kinds_;
    std::vector<PointRows> points_;
    std::vector<std::string> axes_, values_;
    std::vector<SweepColumn> columns_;  // of the values
};

SweepTable::SweepTable(const output::ColumnTable& table) : table_(table), kinds_(column("class")) {
    const std::vector<double>& sample = column("sample");
    for (std::size_t row = 0; row < sample.size(); ++row) {
        if (points_.empty() || !(sample[row] > 0)) points_.push_back({row, row});
        points_.back().end = row + (std::isnan(sample[row]) ? 0 : 1);
        if (!(kinds_[row] >= 0 && kinds_[row] < double(sim::names(sim::AttractorClass()).size())))
            throw output::IoError(fmt::format("the record of the sweep is damaged: there is no class {}", kinds_[row]));
    }
    const std::vector<std::string> names = table.names();
    axes_.assign(names.begin(), std::ranges::find(names, "seed"));
    for (auto name = std::ranges::find(names, "sample") + 1; name != names.end(); ++name)
        if (*name != "t" && *name != "cam_angle") values_.push_back(*name), columns_.emplace_back(column(*name));
}

std::string SweepTable::place(const PointRows& point) const {
    std::string text;
    for (const std::string& axis : axes_) text += fmt::format("{} = {:.9g}, ", axis, at(point, axis));
    return text + fmt::format("seed {:g}", at(point, "seed"));
}

bool SweepTable::same_rows(const PointRows& own, const SweepTable& other, const PointRows& its) const {
    if (own.size() != its.size()) return false;
    return std::ranges::all_of(table_.columns, [&](const output::TableColumn& each) {
        const std::size_t rows = std::max<std::size_t>(own.size(), 1);
        return std::ranges::equal(SweepColumn(each.values).subspan(own.begin, rows),
                                  SweepColumn(other.column(each.name)).subspan(its.begin, rows), same_number);
    });
}

const std::vector<double>& SweepTable::column(const std::string& name) const {
    if (const std::vector<double>* found = table_.find(name)) return *found;
    throw output::IoError(fmt::format("the record of the sweep is damaged: it has no column {}", name));
}

// ---- comparison ----------------------------------------------------------------------------------

constexpr std::size_t kMostOfOrbit = 500;  // compared samples of a periodic motion: its whole orbit
constexpr std::size_t kMostDifferences = 4;

bool has_period(AttractorClass kind) {
    return kind == AttractorClass::rest || kind == AttractorClass::following || kind == AttractorClass::periodic;
}

// Motions without period, settled or not, are one class: errors and small differences tell them apart.
bool is_same_class(AttractorClass a, AttractorClass b) {
    const auto is_irregular = [](AttractorClass kind) {
        return !has_period(kind) && kind != AttractorClass::over_the_top;
    };
    return a == b || (is_irregular(a) && is_irregular(b));
}

double largest_of(SweepColumn values) {
    double largest = 0;
    for (const double x : values)
        if (std::isfinite(x)) largest = std::max(largest, std::fabs(x));
    return largest > 0 ? largest : 1;
}

class SweepComparer {
  public:
    SweepComparer(const output::ColumnTable& expected, const output::ColumnTable& actual, const Tolerance& tolerance)
        : a_(expected), b_(actual), tolerance_(*tolerance.motion) {
        for (std::size_t c = 0; c < a_.values().size(); ++c)
            scales_.push_back(a_.values()[c] == "cam_phase" ? 1 : largest_of(a_.all(c)));
    }

    MotionVerdict compare() const {
        if (const std::string why = another_sweep(); !why.empty())
            return {Verdict::different, {"it is another sweep: " + why}};
        bool identical = true;
        std::vector<std::string> differences;
        for (std::size_t k = 0; k < a_.points().size(); ++k) {
            const PointRows& a = a_.points()[k];
            if (a_.kind(a) == AttractorClass::unsettled || a_.same_rows(a, b_, b_.points()[k])) continue;
            identical = false;
            if (const std::string why = difference(a, b_.points()[k]); !why.empty())
                differences.push_back(fmt::format("{}: {}", a_.place(a), why));
        }
        if (identical) return {};
        if (differences.empty()) return {Verdict::equivalent, {"all points have the same class and orbit"}};
        const std::size_t more = differences.size() - std::min(differences.size(), kMostDifferences);
        differences.resize(differences.size() - more);
        if (more > 0) differences.push_back(fmt::format("and {} more points", more));
        return {Verdict::different, std::move(differences)};
    }

  private:
    std::string another_sweep() const {
        if (a_.values() != b_.values() || a_.points().size() != b_.points().size())
            return fmt::format("{} of {}, expected {} of {}", counted(b_.points().size(), "point"),
                               counted(b_.values().size(), "column"), a_.points().size(), a_.values().size());
        for (std::size_t k = 0; k < a_.points().size(); ++k)
            if (const std::string was = a_.place(a_.points()[k]), is = b_.place(b_.points()[k]); was != is)
                return fmt::format("{} is where {} was", is, was);
        return {};
    }

    // How the point differs; empty: it does not.
    std::string difference(const PointRows& a, const PointRows& b) const {
        const AttractorClass was = a_.kind(a), is = b_.kind(b);
        if (!is_same_class(was, is)) return fmt::format("{} became {}", name(was), name(is));
        if (!has_period(was)) return {};
        for (const char* what : {"period", "impacts_per_period"})
            if (!same_number(a_.at(a, what), b_.at(b, what)))
                return fmt::format("{} {:g} became {:g}", what, a_.at(a, what), b_.at(b, what));
        return difference_of_orbits(a, b, was == AttractorClass::rest);
    }

    std::string difference_of_orbits(const PointRows& a, const PointRows& b, bool rests) const {
        const Distance worst = std::max(farthest(a_, a, b_, b, rests), farthest(b_, b, a_, a, rests));
        if (worst.first <= tolerance_) return {};
        if (std::isinf(worst.first)) return "samples appeared or vanished";
        return fmt::format("{} moved by {:.2g} of its largest value", a_.values()[worst.second], worst.first);
    }

    using Distance = std::pair<double, std::size_t>;  // in multiples of the scale of a column, and the column

    // The largest distance of one of the last samples of a table from the nearest sample of the other.
    Distance farthest(const SweepTable& from, const PointRows& own, const SweepTable& to, const PointRows& its,
                      bool rests) const {
        const std::size_t n = own.size(), m = its.size();
        Distance most{0, 0};
        for (std::size_t i = n - std::min(n, kMostOfOrbit); i < n; ++i) {
            Distance nearest{INFINITY, 0};
            for (std::size_t k = m - std::min(m, kMostOfOrbit); k < m && nearest.first > most.first; ++k)
                nearest = std::min(nearest, distance(from, own, i, to, its, k, rests));
            most = std::max(most, nearest);
        }
        return most;
    }
    Distance distance(const SweepTable& from, const PointRows& own, std::size_t i, const SweepTable& to,
                      const PointRows& its, std::size_t k, bool rests) const {
        Distance most{0, 0};
        for (std::size_t c = 0; c < a_.values().size(); ++c) {
            if (rests && a_.values()[c] != "theta") continue;
            const double x = from.samples(own, c)[i], y = to.samples(its, c)[k];
            double step = same_number(x, y) ? 0 : std::isnan(x) || std::isnan(y) ? INFINITY : std::fabs(x - y);
            if (a_.values()[c] == "cam_phase" && step > 0.5) step = 1 - step;  // fractions of a turn
            most = std::max(most, {step / scales_[c], c});
        }
        return most;
    }

    const SweepTable a_, b_;
    const double tolerance_;
    std::vector<double> scales_;  // of the values
};

}  // namespace

MotionVerdict compare_sweeps(const output::ColumnTable& expected, const output::ColumnTable& actual,
                             const Tolerance& tolerance) {
    return SweepComparer(expected, actual, tolerance).compare();
}

}  // namespace beamcam::scenes
