// Measured data of the scene's motion: columns of a file that correspond to channels.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "output/data/records.hpp"
#include "sim/observe/request.hpp"

namespace beamcam::scenes {

struct Measurement {
    enum class Drawn { automatic, points, line };

    std::string file, label;
    std::string time_column = "t";
    std::vector<std::pair<sim::Channel, std::string>> columns;  // names in the file
    std::vector<std::pair<std::string, std::string>> units;     // of columns: "deg"; default: those of the file, or SI
    double offset = 0;                                          // time of the motion at time 0 of the file [s]
    Drawn drawn = Drawn::automatic;

    // Content of the file in SI units and the motion's time; `values` in the order of `columns`.
    std::vector<double> times;
    std::vector<std::vector<double>> values;
    std::string digest;

    const std::vector<double>* find(sim::Channel channel) const;      // nullptr: not measured
    Measurement of(const std::vector<sim::Channel>& channels) const;  // only these columns
    Measurement within(double from, double to) const;                 // only the rows in between
    bool is_line(std::size_t rows) const;                             // for this number of rows
    // The motion at the times of the measurement.
    sim::TableRequest request() const;
};

// The agreement for each channel; `table` is the result of request(), and `result` has a horizon.
std::vector<output::Agreement> agreements(const Measurement& measurement, const sim::Table& table,
                                          const sim::Result& result);

}  // namespace beamcam::scenes
