// CRC-32 (ISO-HDLC, as in zlib), against accidental damage.
#pragma once

#include <cstddef>
#include <cstdint>

namespace beamcam::output {

// Continues from `so_far`, which is 0 at the start.
std::uint32_t crc32(std::uint32_t so_far, const void* data, std::size_t size);

}  // namespace beamcam::output
