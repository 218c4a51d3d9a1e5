// A NetCDF file, and the errors of libnetcdf as exceptions. https://docs.unidata.ucar.edu/netcdf-c
#pragma once

#include <filesystem>
#include <limits>
#include <memory>
#include <string>

#include "output/data/sweep_data.hpp"

namespace beamcam::output {

class NcFile {
  public:
    // Throw IoError. Messages call the file `named`.
    static std::shared_ptr<NcFile> create(const std::filesystem::path& file, const std::filesystem::path& named);
    explicit NcFile(std::filesystem::path file) : named(std::move(file)) {}
    ~NcFile();
    NcFile(const NcFile&) = delete;
    NcFile& operator=(const NcFile&) = delete;

    void close();
    // Throws IoError unless the status is that of success. HDF5 does not name the reason of its failure, but the system
    // does.
    void need(int status) const;
    // Defines a variable over these dimensions.
    int define(const std::string& name, int type, const std::vector<int>& dimensions, const std::string& unit,
               const std::string& meaning) const;
    // Defines a variable with a fill value for cells that are not written.
    int define_filled(const std::string& name, int type, const std::vector<int>& dimensions, const std::string& unit,
                      const std::string& meaning) const;
    void compress(int variable) const;
    void set(int variable, const char* attribute, const std::string& value) const;

    std::filesystem::path named;
    int id = -1;
};

constexpr int kMissingPoint = -1;  // class and sample count of a point that a file does not contain
constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

void write_nc_sweep(const std::filesystem::path& file, const std::filesystem::path& named, const SweepData& data);

}  // namespace beamcam::output
