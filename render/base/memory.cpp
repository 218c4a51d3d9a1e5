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

bool has_memory(std::size_t bytes) noexcept {
    void* room = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (room == MAP_FAILED) return false;
    munmap(room, bytes);
    return true;
}

bool memory_is_short() noexcept {
    const rlim_t most = limit();
    return most != RLIM_INFINITY && !has_memory(std::max<std::size_t>(most / 2, 64 * kMiB));
}

std::string memory_words() {
    const rlim_t most = limit();
    return "not enough memory" +
           (most == RLIM_INFINITY ? std::string()
                                  : "; this process may use " + std::to_string(most / kMiB) + " MiB (ulimit -v)") +
           "; choose a smaller size, fewer threads (-j 1), or give it more memory";
}

}  // namespace beamcam::render
