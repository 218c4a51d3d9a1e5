// Reads the file of measured data into channels: in SI units, over the time of the motion.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "scenes/format/object_reader.hpp"
#include "scenes/scene/measurement.hpp"

namespace beamcam::scenes {

// The channels that can be measured, by name: all but the time and the coordinates of the model.
const std::vector<std::pair<std::string, sim::Channel>>& measurable_channels();

// Fills `times`, `values` and `digest`, and `columns` where the scene names none. `r` is the object with the
// keys of the data. Reports errors with line and column, and warns of angles that are joined at their jumps.
void read_measurement(ObjectReader& r, Measurement& m);

}  // namespace beamcam::scenes
