// The module: sweeps and tables as NetCDF-4 files.
#include <hdf5.h>
#include <netcdf.h>
#include <stdlib.h>

#include "output/data/netcdf/nc_file.hpp"
#include "output/data/netcdf_library.hpp"
#include "render/base/modules.hpp"

namespace beamcam::output {
namespace {

void write_columns(const NcFile& file, const ColumnTable& table) {
    int row = 0;
    file.need(nc_def_dim(file.id, "row", table.rows(), &row));
    std::vector<int> ids;
    for (const TableColumn& column : table.columns)
        ids.push_back(file.define_filled(column.name, NC_DOUBLE, {row}, column.unit, column.meaning));
    for (const auto& [name, value] : table.attributes) file.set(NC_GLOBAL, name.c_str(), value);
    file.need(nc_enddef(file.id));
    for (std::size_t c = 0; c < ids.size(); ++c)
        file.need(nc_put_var_double(file.id, ids[c], table.columns[c].values.data()));
}

class Library final : public NetcdfLibrary {
  public:
    // Before the first use of HDF5, which would refuse to open the file that AtomicFile holds locked, and which at exit
    // would close a file again that it could not write, and crash.
    Library() {
        setenv("HDF5_USE_FILE_LOCKING", "FALSE", 1);
        H5dont_atexit();
    }

    void write(const std::filesystem::path& file, const std::filesystem::path& named,
               const SweepData& data) const override {
        write_nc_sweep(file, named, data);
    }
    void write(const std::filesystem::path& file, const std::filesystem::path& named,
               const ColumnTable& table) const override {
        const std::shared_ptr<NcFile> made = NcFile::create(file, named);
        write_columns(*made, table);
        made->close();
    }
    std::string version() const override { return nc_inq_libvers(); }
};

const Library library;

}  // namespace
}  // namespace beamcam::output

BEAMCAM_MODULE(static_cast<const beamcam::output::NetcdfLibrary&>(beamcam::output::library))
