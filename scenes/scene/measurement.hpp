// Measured or foreign data of the scene's motion: columns of a file that are channels.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "output/data/agreement.hpp"
#include "sim/observe/request.hpp"

namespace beamcam::scenes {

struct Measurement {
    enum class Drawn { automatic, points, line };

    std::string file, label;
    std::string time_column = "t";
    std::vector<std::pair<sim::Channel, std::string>> columns;  // names in the file
    std::vector<std::pair<std::string, std::string>> units;     // of columns, "deg"; SI units where left out
    double offset = 0;                                          // the motion's time at the file's zero [s]
    Drawn drawn = Drawn::automatic;

    // Of the file, in SI units and the motion's time; `values` as `columns`.
    std::vector<double> times;
    std::vector<std::vector<double>> values;
    std::string digest;

    const std::vector<double>* find(sim::Channel channel) const;      // nullptr: it has none
    Measurement of(const std::vector<sim::Channel>& channels) const;  // these alone
    Measurement within(double from, double to) const;                 // the rows between these instants alone
    bool is_line(std::size_t rows) const;                             // that many of them; else points
    // Time and channels of the motion at its instants.
    sim::TableRequest request() const;
};

// Of each channel; `table` is of the measurement's request.
std::vector<output::Agreement> agreements(const Measurement& measurement, const sim::Table& table,
                                          const sim::Result& result);

}  // namespace beamcam::scenes
