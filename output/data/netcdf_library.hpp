// Interface of the module that links libnetcdf (beamcam_netcdf.so, from output/data/netcdf/): sweeps as
// NetCDF-4 files, which are written only. The module is loaded at its first use, because its libraries would add
// milliseconds to every start.
//
// A sweep has the dimensions second swept key, first swept key, "seed" and "sample"; fill values follow the last sample
// of a point. The same numbers give the same bytes.
#pragma once

#include <filesystem>

#include "output/data/sweep_data.hpp"

namespace beamcam::output {

class NetcdfLibrary {
  public:
    virtual ~NetcdfLibrary() = default;
    // `file` exists and is overwritten; messages call it `named`. Throws IoError.
    virtual void write(const std::filesystem::path& file, const std::filesystem::path& named,
                       const SweepData& data) const = 0;
};

// Throws render::MissingPart with every place that was searched.
const NetcdfLibrary& netcdf_library();

}  // namespace beamcam::output
