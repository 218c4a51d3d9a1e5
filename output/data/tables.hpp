// Tables as files: CSV for people and spreadsheets, NPZ for numpy, NetCDF-4 for those that say what they are.
#pragma once

#include <ostream>

#include "output/data/column_table.hpp"
#include "output/data/table_reader.hpp"
#include "output/files/errors.hpp"
#include "output/files/target.hpp"
#include "sim/observe/channels.hpp"

namespace beamcam::output {

// One header line, commas, 17 significant digits, "\n"; an undefined value is an empty cell.
// Throws IoError when the stream fails.
void write_csv(std::ostream& out, const sim::Table& table);
void write_csv(const Target& file, const sim::Table& table);

// numpy.load(file)["theta"]: one array of float64 per channel, NaN where undefined; a plain zip archive without
// compression. Throws UnsupportedOption beyond 4 GiB, which needs another format.
void write_npz(const Target& file, const sim::Table& table);

// By the name's ending, .csv or .npz. Throws UnsupportedOption for another.
void write_table(const Target& file, const sim::Table& table);
void write_table(const Target& file, const NamedTable& table);

// By the name's ending, .csv, .npz or .nc. Throws UnsupportedOption for another, IoError.
void write_table(const Target& file, const ColumnTable& table);

}  // namespace beamcam::output
