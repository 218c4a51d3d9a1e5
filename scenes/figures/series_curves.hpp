// Values along the axes of a series: their units and their zero.
#pragma once

#include <string>
#include <vector>

#include "sim/run/simulate.hpp"

namespace beamcam::scenes {

// A quantity along an axis: its unit, with the prefix that suits its values.
struct Measure {
    double factor = 1;
    std::string unit;  // may be empty
};
Measure measure_of(const std::string& unit, double largest);

// Only differences of potential energy mean anything: its least value is the zero.
std::vector<double> above_zero(std::vector<double> values, sim::Channel channel);

bool has_values(const sim::Table& table);           // of its last channel
double largest(const std::vector<double>& values);  // magnitude; 0: there is no finite one

}  // namespace beamcam::scenes
