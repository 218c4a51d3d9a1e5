// Writing of tables: CSV for people and spreadsheets, NPZ for numpy, NetCDF-4 with units and meanings.
#pragma once

#include <ostream>

#include "output/data/column_table.hpp"
#include "output/data/table_reader.hpp"
#include "output/files/errors.hpp"
#include "output/files/target.hpp"
#include "sim/observe/channels.hpp"

namespace beamcam::output {

// One header line, commas, 17 significant digits, "\n"; an undefined value is an empty cell.
// Throws IoError if the stream fails.
void write_csv(std::ostream& out, const sim::Table& table);

// The ending decides: .csv or .npz; numpy.load(file)["theta"] gives one array of float64 per channel, NaN where
// undefined. Throws UnsupportedOption for other endings, and for .npz above 4 GiB.
void write_table(const Target& file, const sim::Table& table);
void write_table(const Target& file, const NamedTable& table);

// The ending decides: .csv, .npz or .nc. Throws UnsupportedOption for others, IoError.
void write_table(const Target& file, const ColumnTable& table);

}  // namespace beamcam::output
