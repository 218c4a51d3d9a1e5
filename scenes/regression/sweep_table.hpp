// The record of a sweep as its points and their samples.
#pragma once

#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "output/data/tables.hpp"
#include "sim/sweep/attractor.hpp"

namespace beamcam::scenes {

using SweepColumn = std::span<const double>;

inline bool same_number(double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); }

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

}  // namespace beamcam::scenes
