// The module: sweeps and tables as NetCDF-4 files.
#include <netcdf.h>

#include "output/data/netcdf/chunk_file.hpp"
#include "output/data/netcdf/nc_file.hpp"
#include "output/data/netcdf_library.hpp"
#include "render/base/modules.hpp"

namespace beamcam::output {
namespace {

void write_columns(const NcFile& file, const ColumnTable& table) {
    const auto need = [&file](int status) { file.need_written(status); };
    int row = 0;
    need(nc_def_dim(file.id, "row", table.rows(), &row));
    std::vector<int> ids;
    for (const TableColumn& column : table.columns) {
        ids.push_back(0);
        need(nc_def_var(file.id, column.name.c_str(), NC_DOUBLE, 1, &row, &ids.back()));
        need(nc_def_var_fill(file.id, ids.back(), NC_FILL, &kNoNumber));
        need(nc_def_var_deflate(file.id, ids.back(), 1, 1, kDeflate));
        file.set(ids.back(), "units", udunits(column.unit));
        file.set(ids.back(), "long_name", column.meaning);
    }
    for (const auto& [name, value] : table.attributes) file.set(NC_GLOBAL, name.c_str(), value);
    need(nc_enddef(file.id));
    for (std::size_t c = 0; c < ids.size(); ++c)
        need(nc_put_var_double(file.id, ids[c], table.columns[c].values.data()));
}

std::optional<ColumnTable> read_columns(const NcFile& file) {
    int row = 0, variables = 0;
    std::size_t rows = 0;
    if (nc_inq_dimid(file.id, "row", &row) != NC_NOERR) return std::nullopt;
    const auto need = [&file](int status) { file.need(status, "is not a table of beamcam"); };
    need(nc_inq_dimlen(file.id, row, &rows));
    need(nc_inq_nvars(file.id, &variables));
    ColumnTable table;
    for (int v = 0; v < variables; ++v) {
        char name[NC_MAX_NAME + 1];
        int dimensions[NC_MAX_VAR_DIMS], count = 0;
        need(nc_inq_var(file.id, v, name, nullptr, &count, dimensions, nullptr));
        if (count != 1 || dimensions[0] != row) continue;
        table.columns.push_back(
            {name, from_udunits(file.text(v, "units")), file.text(v, "long_name"), std::vector<double>(rows)});
        need(nc_get_var_double(file.id, v, table.columns.back().values.data()));
    }
    return table;
}

class Library final : public NetcdfLibrary {
  public:
    Library() { leave_files_at_exit(); }

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
    std::optional<ColumnTable> read_table(const std::filesystem::path& file) const override {
        return read_columns(*NcFile::open(file));
    }
    SweepData open(const std::filesystem::path& file) const override { return open_nc_sweep(file); }
    std::string version() const override { return nc_inq_libvers(); }
};

const Library library;

}  // namespace
}  // namespace beamcam::output

BEAMCAM_MODULE(static_cast<const beamcam::output::NetcdfLibrary&>(beamcam::output::library))
