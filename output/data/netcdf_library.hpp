// What the module that links libnetcdf offers (beamcam_netcdf.so, from output/data/netcdf/): sweeps and tables as
// NetCDF-4 files.
// It is loaded when first used: the libraries under it would cost every start some milliseconds.
//
// Layout of a sweep: dimensions are the second swept key, the first, "seed" and "sample"; what follows the last sample
// of a point is filled. Chunks hold whole points. Of a table: a variable for each column over the dimension "row". The
// same numbers make the same bytes.
#pragma once

#include <filesystem>
#include <string>

#include "output/data/column_table.hpp"
#include "output/data/sweep_data.hpp"

namespace beamcam::output {

class NetcdfLibrary {
  public:
    virtual ~NetcdfLibrary() = default;
    // `file` exists and is overwritten; messages call it `named`. Throws IoError.
    virtual void write(const std::filesystem::path& file, const std::filesystem::path& named,
                       const SweepData& data) const = 0;
    virtual void write(const std::filesystem::path& file, const std::filesystem::path& named,
                       const ColumnTable& table) const = 0;
    // The file stays open as long as the data live; points are read when they are asked for. Throws IoError.
    virtual SweepData open(const std::filesystem::path& file) const = 0;
    virtual std::string version() const = 0;
};

// Throws UnsupportedOption with every place that was searched.
const NetcdfLibrary& netcdf_library();

}  // namespace beamcam::output
