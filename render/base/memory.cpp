#include "render/base/memory.hpp"

#include <sys/mman.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstddef>

namespace beamcam::render {
namespace {

constexpr rlim_t kMiB = 1 << 20;

// Of the address space or of data, whichever is less [bytes].
rlim_t limit() noexcept {
    rlimit space = {RLIM_INFINITY, RLIM_INFINITY}, data = space;
    getrlimit(RLIMIT_AS, &space);
    getrlimit(RLIMIT_DATA, &data);
    return std::min(space.rlim_cur, data.rlim_cur);
}

}  // namespace

bool memory_is_short() noexcept {
    const rlim_t most = limit();
    if (most == RLIM_INFINITY) return false;
    const std::size_t half = std::max<std::size_t>(most / 2, 64 * kMiB);
    void* room = mmap(nullptr, half, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (room == MAP_FAILED) return true;
    munmap(room, half);
    return false;
}

std::string memory_words() {
    const rlim_t most = limit();
    return "not enough memory" +
           (most == RLIM_INFINITY ? std::string()
                                  : "; this process may use " + std::to_string(most / kMiB) + " MiB (ulimit -v)") +
           "; choose a smaller size, fewer threads (-j 1), or give it more memory";
}

}  // namespace beamcam::render
