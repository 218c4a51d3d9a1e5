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
    static std::shared_ptr<NcFile> open(const std::filesystem::path& file);
    explicit NcFile(std::filesystem::path file) : named(std::move(file)) {}
    ~NcFile();
    NcFile(const NcFile&) = delete;
    NcFile& operator=(const NcFile&) = delete;

    void close();
    // Throws IoError unless the status is that of success.
    void need(int status, const char* what = "is not a sweep of beamcam") const;
    // The same while writing. HDF5 does not name the reason of its failure, but the system does.
    void need_written(int status) const;
    int variable(const std::string& name) const;
    std::string text(int variable, const char* attribute) const;  // empty: there is none
    void set(int variable, const char* attribute, const std::string& value) const;

    std::filesystem::path named;
    int id = -1;
};

constexpr int kDeflate = 1;        // higher levels take three times as long for a few per cent
constexpr int kMissingPoint = -1;  // class and sample count of a point that a file does not contain
constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

// "rad/s" and "rad s-1".
std::string udunits(const std::string& unit);
std::string from_udunits(const std::string& unit);

void write_nc_sweep(const std::filesystem::path& file, const std::filesystem::path& named, const SweepData& data);
SweepData open_nc_sweep(const std::filesystem::path& file);

}  // namespace beamcam::output
