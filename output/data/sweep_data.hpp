// A sweep as files: CSV and NPZ with one row a sample, NetCDF-4 as a grid. Points are asked for one by one, so that
// memory stays flat however many there are.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "output/data/point_store.hpp"
#include "output/files/target.hpp"

namespace beamcam::output {

struct SweepAxis {
    std::string name, unit;  // "cam.speed", "rad/s"
    std::vector<double> values;
};
struct SweepColumn {
    std::string name, unit, meaning;
};

// Points are numbered (row · first axis + value) · seeds + seed, rows being the values of the second axis.
struct SweepData {
    std::vector<SweepAxis> axes;  // one or two
    std::uint64_t seeds = 1;
    std::vector<SweepColumn> columns;                             // of the samples
    std::vector<std::string> classes;                             // names by their numbers
    std::vector<std::pair<std::string, std::string>> attributes;  // of a NetCDF file
    std::function<bool(std::uint64_t)> has;                       // whether the point is part of this file
    std::function<std::uint64_t(std::uint64_t)> rows;             // samples of the point
    std::function<StoredPoint(std::uint64_t)> read;

    std::uint64_t points() const;
    std::uint64_t rows_in_all() const;                     // of CSV and NPZ: a point without samples has one
    std::uint64_t most_rows() const;                       // samples of one point
    std::vector<double> place(std::uint64_t point) const;  // values of the axes
};

// By the name's ending: .csv, .npz or .nc. Throws IoError, UnsupportedOption.
void write_sweep(const Target& file, const SweepData& data);
void write_sweep_csv(std::ostream& out, const SweepData& data);

}  // namespace beamcam::output
