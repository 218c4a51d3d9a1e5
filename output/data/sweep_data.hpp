// Sweeps as files: CSV and NPZ with a row for each sample, NetCDF-4 as a grid; a part of a sweep as a file of points.
// Points are read one by one, so that few of their numbers are in memory.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "output/data/point_store.hpp"
#include "output/data/tables.hpp"
#include "output/files/target.hpp"

namespace beamcam::output {

struct SweepAxis {
    std::string name, unit;  // "cam.speed", "rad/s"
    std::vector<double> values;
};

// Points are numbered (row · first axis + value) · seeds + seed, rows being the values of the second axis.
struct SweepData {
    std::vector<SweepAxis> axes;  // one or two
    std::uint64_t seeds = 1;
    std::vector<TableColumn> columns;                             // of the samples
    std::vector<std::string> classes;                             // names, by number
    std::vector<std::pair<std::string, std::string>> attributes;  // of a NetCDF file
    PointHead head;                                               // of a part, and of the store of unfinished points
    std::function<bool(std::uint64_t)> has;                       // whether this file contains the point
    std::function<std::uint64_t(std::uint64_t)> rows;             // samples of the point
    std::function<StoredPoint(std::uint64_t)> read;

    std::uint64_t points() const;
    std::uint64_t rows_in_all() const;                     // of CSV and NPZ; a point without samples has one
    std::uint64_t most_rows() const;                       // samples of one point
    std::vector<double> place(std::uint64_t point) const;  // values of the axes
};

// Inline, because the NetCDF module uses them, too.
inline std::uint64_t SweepData::points() const {
    std::uint64_t all = seeds;
    for (const SweepAxis& axis : axes) all *= axis.values.size();
    return all;
}

inline std::uint64_t SweepData::rows_in_all() const {
    std::uint64_t all = 0;
    for (std::uint64_t k = 0; k < points(); ++k)
        if (has(k)) all += std::max<std::uint64_t>(rows(k), 1);
    return all;
}

inline std::uint64_t SweepData::most_rows() const {
    std::uint64_t most = 0;
    for (std::uint64_t k = 0; k < points(); ++k)
        if (has(k)) most = std::max(most, rows(k));
    return most;
}

inline std::vector<double> SweepData::place(std::uint64_t point) const {
    std::uint64_t rest = point / seeds;
    std::vector<double> values;
    for (const SweepAxis& axis : axes) {
        values.push_back(axis.values[rest % axis.values.size()]);
        rest /= axis.values.size();
    }
    return values;
}

// The ending of a file of points, which holds a part of a sweep.
inline constexpr const char* kPartEnding = ".points";

// The ending decides: .csv, .npz, .nc or .points. Throws IoError, UnsupportedOption, render::MissingPart.
void write_sweep(const FileTarget& file, const SweepData& data);
void write_sweep_csv(const TextSink& write, const SweepData& data);

}  // namespace beamcam::output
