#include "output/data/netcdf_library.hpp"

#include "render/base/error.hpp"
#include "render/base/modules.hpp"

namespace beamcam::output {

const NetcdfLibrary& netcdf_library() {
    try {
        static const auto* const library = static_cast<const NetcdfLibrary*>(render::load_module("beamcam_netcdf.so"));
        return *library;
    } catch (const render::ModuleError& error) {
        throw render::MissingPart(std::string("NetCDF files need its library (Debian: libnetcdf19 or newer): ") +
                                  error.what());
    }
}

}  // namespace beamcam::output
