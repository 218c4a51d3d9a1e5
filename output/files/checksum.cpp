#include "output/files/checksum.hpp"

#include <libdeflate.h>

namespace beamcam::output {

std::uint32_t crc32(std::uint32_t so_far, const void* data, std::size_t size) {
    return libdeflate_crc32(so_far, data, size);
}

}  // namespace beamcam::output
