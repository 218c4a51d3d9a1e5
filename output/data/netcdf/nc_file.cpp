#include "output/data/netcdf/nc_file.hpp"

#include <fmt/format.h>
#include <netcdf.h>

#include <cerrno>

#include "output/files/errors.hpp"

namespace beamcam::output {

std::shared_ptr<NcFile> NcFile::create(const std::filesystem::path& file, const std::filesystem::path& named) {
    auto made = std::make_shared<NcFile>(named);
    errno = 0;
    made->need_written(nc_create(file.c_str(), NC_NETCDF4 | NC_CLOBBER, &made->id));
    return made;
}

std::shared_ptr<NcFile> NcFile::open(const std::filesystem::path& file) {
    auto found = std::make_shared<NcFile>(file);
    found->need(nc_open(file.c_str(), NC_NOWRITE, &found->id), "cannot be read");
    return found;
}

NcFile::~NcFile() {
    if (id >= 0) nc_close(id);
}

void NcFile::close() {
    const int closed = nc_close(id);
    id = -1;
    need_written(closed);
}

void NcFile::need(int status, const char* what) const {
    if (status != NC_NOERR) throw IoError(fmt::format("{}: {} ({})", named.string(), what, nc_strerror(status)));
}

void NcFile::need_written(int status) const {
    if (status == NC_EHDFERR && errno != 0) throw write_error(named, errno);
    need(status, "cannot be written");
}

int NcFile::variable(const std::string& name) const {
    int found = -1;
    need(nc_inq_varid(id, name.c_str(), &found));
    return found;
}

std::string NcFile::text(int variable, const char* attribute) const {
    std::size_t size = 0;
    if (nc_inq_attlen(id, variable, attribute, &size) != NC_NOERR) return "";
    std::string out(size, '\0');
    need(nc_get_att_text(id, variable, attribute, out.data()));
    return out;
}

void NcFile::set(int variable, const char* attribute, const std::string& value) const {
    need_written(nc_put_att_text(id, variable, attribute, value.size(), value.c_str()));
}

std::string udunits(const std::string& unit) {
    if (unit == "rad/s") return "rad s-1";
    if (unit == "m/s") return "m s-1";
    return unit;
}

std::string from_udunits(const std::string& unit) {
    for (const char* ours : {"rad/s", "m/s"})
        if (udunits(ours) == unit) return ours;
    return unit;
}

}  // namespace beamcam::output
