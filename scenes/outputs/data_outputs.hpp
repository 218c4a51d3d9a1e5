// Writes the outputs that hold numbers of the motion or of the sweep.
#pragma once

#include <string>

#include "output/data/sweep_data.hpp"
#include "output/files/target.hpp"
#include "scenes/plan/plan.hpp"

namespace beamcam::scenes {

// The inputs of a data file, and its target.
struct DataSource {
    const Scene& scene;
    const sim::Request& request;     // of the scene's motion, for data files
    const sim::Result& run;          // its result
    const output::FileTarget* file;  // null: standard output
    const output::SweepData* sweep;  // null unless the plan needs it
};

// Returns a description for the user: "1501 rows".
std::string write_data(const DataFile& data, const DataSource& from);

}  // namespace beamcam::scenes
