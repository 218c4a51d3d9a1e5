// Is memory running out? For errors whose cause a library hides.
#pragma once

#include <cstddef>
#include <string>

namespace beamcam::render {

// Can the process take so many bytes at once?
bool has_memory(std::size_t bytes) noexcept;

// Is there a limit (ulimit -v, ulimit -d), and less than half of it left? Safe in signal handlers.
bool memory_is_short() noexcept;

// "not enough memory; this process may use 512 MiB (ulimit -v) …"
std::string memory_words();

}  // namespace beamcam::render
