#include "render/base/limits.hpp"

#include <fcntl.h>
#include <glib.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstddef>
#include <latch>
#include <string_view>
#include <vector>

namespace beamcam::render {
namespace {

constexpr rlim_t kMiB = 1 << 20;

// Limit of the address space or of data, whichever is smaller [bytes].
rlim_t limit() noexcept {
    rlimit space = {RLIM_INFINITY, RLIM_INFINITY}, data = space;
    getrlimit(RLIMIT_AS, &space);
    getrlimit(RLIMIT_DATA, &data);
    return std::min(space.rlim_cur, data.rlim_cur);
}

// The largest address space of this process until now [bytes]; 0 if unknown. Safe in signal handlers.
rlim_t largest_space() noexcept {
    std::array<char, 4096> text{};
    const int status = open("/proc/self/status", O_RDONLY | O_CLOEXEC);
    if (status < 0) return 0;
    const ssize_t size = read(status, text.data(), text.size());
    close(status);
    constexpr std::string_view kName = "VmPeak:";
    std::string_view rest(text.data(), size > 0 ? static_cast<std::size_t>(size) : 0);
    rest.remove_prefix(std::min(rest.find(kName), rest.size()));
    rest.remove_prefix(std::min(rest.find_first_of("0123456789"), rest.size()));
    rlim_t kilobytes = 0;
    std::from_chars(rest.data(), rest.data() + rest.size(), kilobytes);
    return kilobytes * 1024;
}

extern "C" void* wait_for_end(void* end) {
    static_cast<std::latch*>(end)->wait();
    return nullptr;
}

std::atomic<bool> glib_failed = false;

// GLib gives the cause of its abort only as text.
GLogWriterOutput write_log(GLogLevelFlags level, const GLogField* fields, gsize count, gpointer) {
    for (gsize i = 0; i < count && (level & G_LOG_LEVEL_ERROR) != 0; ++i)
        if (fields[i].key == std::string_view("MESSAGE"))
            glib_failed = std::string_view(static_cast<const char*>(fields[i].value)).ends_with(g_strerror(EAGAIN));
    return g_log_writer_default(level, fields, count, nullptr);
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

bool memory_was_short() noexcept {
    rlimit space = {};
    if (memory_is_short()) return true;
    return getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY && largest_space() > space.rlim_cur / 2;
}

std::string out_of_memory_message() {
    const rlim_t most = limit();
    return "not enough memory" +
           (most == RLIM_INFINITY ? std::string()
                                  : "; this process may use " + std::to_string(most / kMiB) + " MiB (ulimit -v)") +
           "; choose a smaller size, fewer threads (-j 1), or give it more memory";
}

PerhapsOutOfMemory::PerhapsOutOfMemory(const std::string& what)
    : std::runtime_error(what + "; perhaps there was " + out_of_memory_message()) {}

void watch_threads_of_glib() {
    [[maybe_unused]] static const bool once = (g_log_set_writer_func(write_log, nullptr, nullptr), true);
}

bool can_start_threads(int count) {
    constexpr std::size_t kStack = 64 * 1024;  // [bytes]; small, since only the number of threads matters
    std::latch end(1);
    std::vector<pthread_t> started;
    started.reserve(static_cast<std::size_t>(count));
    pthread_attr_t small;
    if (pthread_attr_init(&small) != 0) return false;
    pthread_attr_setstacksize(&small, kStack);
    for (pthread_t thread; count > 0 && pthread_create(&thread, &small, wait_for_end, &end) == 0; --count)
        started.push_back(thread);
    end.count_down();
    for (const pthread_t thread : started) pthread_join(thread, nullptr);
    pthread_attr_destroy(&small);
    return count == 0;
}

// A process counts as a thread does, and starts without the locks that a crashed thread may hold.
bool threads_are_short() noexcept {
    if (glib_failed) return true;
    const pid_t child = _Fork();
    if (child == 0) _exit(0);
    if (child < 0) return errno == EAGAIN;
    while (waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
    }
    return false;
}

}  // namespace beamcam::render
