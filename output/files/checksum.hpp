// CRC-32 (ISO-HDLC, as in zlib): tells damaged bytes from whole ones, guards against nobody.
#pragma once

#include <cstddef>
#include <cstdint>

namespace beamcam::output {

// Goes on from `so_far`, 0 at the start.
std::uint32_t crc32(std::uint32_t so_far, const void* data, std::size_t size);

}  // namespace beamcam::output
