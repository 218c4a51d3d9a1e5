#include "output/data/netcdf/nc_file.hpp"

#include <fmt/format.h>
#include <netcdf.h>

#include <cerrno>

#include "output/files/errors.hpp"

namespace beamcam::output {

namespace {

// "rad s-1" of "rad/s".
std::string udunits(const std::string& unit) {
    if (unit == "rad/s") return "rad s-1";
    if (unit == "m/s") return "m s-1";
    return unit;
}

}  // namespace

std::shared_ptr<NcFile> NcFile::create(const std::filesystem::path& file, const std::filesystem::path& named) {
    auto made = std::make_shared<NcFile>(named);
    errno = 0;
    made->need(nc_create(file.c_str(), NC_NETCDF4 | NC_CLOBBER, &made->id));
    return made;
}

NcFile::~NcFile() {
    if (id >= 0) nc_close(id);
}

void NcFile::close() {
    const int closed = nc_close(id);
    id = -1;
    need(closed);
}

void NcFile::need(int status) const {
    if (status == NC_EHDFERR && errno != 0) throw write_error(named, errno);
    if (status != NC_NOERR)
        throw IoError(fmt::format("{}: cannot be written ({})", named.string(), nc_strerror(status)));
}

int NcFile::define(const std::string& name, int type, const std::vector<int>& dimensions, const std::string& unit,
                   const std::string& meaning) const {
    int variable = 0;
    need(nc_def_var(id, name.c_str(), type, static_cast<int>(dimensions.size()), dimensions.data(), &variable));
    set(variable, "units", udunits(unit));
    set(variable, "long_name", meaning);
    return variable;
}

int NcFile::define_filled(const std::string& name, int type, const std::vector<int>& dimensions,
                          const std::string& unit, const std::string& meaning) const {
    const int variable = define(name, type, dimensions, unit, meaning), number = kMissingPoint;
    const signed char byte = kMissingPoint;
    const void* fill = &kNoNumber;
    if (type == NC_INT) fill = &number;
    if (type == NC_BYTE) fill = &byte;
    need(nc_def_var_fill(id, variable, NC_FILL, fill));
    return variable;
}

void NcFile::compress(int variable) const {
    constexpr int kDeflate = 1;  // higher levels take three times as long for a few per cent
    need(nc_def_var_deflate(id, variable, 1, 1, kDeflate));
}

void NcFile::set(int variable, const char* attribute, const std::string& value) const {
    if (!value.empty()) need(nc_put_att_text(id, variable, attribute, value.size(), value.c_str()));
}

}  // namespace beamcam::output
