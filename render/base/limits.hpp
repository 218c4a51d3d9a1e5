// The limit of memory, for errors of libraries that do not name their cause.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace beamcam::render {

// The smaller one of the limits of address space and data (ulimit -v, ulimit -d) [bytes]; none: there is no limit.
std::optional<std::size_t> memory_limit() noexcept;

// "not enough memory; this process may use 512 MiB (ulimit -v) …"
std::string out_of_memory_message();

}  // namespace beamcam::render
