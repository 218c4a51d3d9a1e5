#include "render/base/limits.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>

namespace beamcam::render {

std::optional<std::size_t> memory_limit() noexcept {
    rlimit space = {RLIM_INFINITY, RLIM_INFINITY}, data = space;
    getrlimit(RLIMIT_AS, &space);
    getrlimit(RLIMIT_DATA, &data);
    const rlim_t least = std::min(space.rlim_cur, data.rlim_cur);
    return least == RLIM_INFINITY ? std::nullopt : std::optional<std::size_t>(least);
}

std::string out_of_memory_message() {
    const std::optional<std::size_t> limit = memory_limit();
    return fmt::format("not enough memory{}; choose a smaller size, fewer threads (-j 1), or give it more memory",
                       limit ? fmt::format("; this process may use {} MiB (ulimit -v)", *limit >> 20) : "");
}

}  // namespace beamcam::render
