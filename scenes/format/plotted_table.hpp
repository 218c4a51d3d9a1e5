// Reads the columns of the figure "table" from their file.
#pragma once

#include "scenes/format/object_reader.hpp"
#include "scenes/scene/outputs.hpp"

namespace beamcam::scenes {

// Fills `columns` and `digest`. `r` is the object with the keys of the table. Reports a missing column with those that
// the file has, and a unit that the column cannot have.
void read_plotted_table(ObjectReader& r, PlottedTable& table);

}  // namespace beamcam::scenes
