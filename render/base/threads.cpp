#include "render/base/threads.hpp"

#include <glib.h>
#include <pthread.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <latch>
#include <string_view>
#include <vector>

namespace beamcam::render {
namespace {

extern "C" void* wait_for_end(void* end) {
    static_cast<std::latch*>(end)->wait();
    return nullptr;
}

std::atomic<bool> glib_failed = false;

// GLib names the cause of its end in words alone.
GLogWriterOutput write_log(GLogLevelFlags level, const GLogField* fields, gsize count, gpointer) {
    for (gsize i = 0; i < count && (level & G_LOG_LEVEL_ERROR) != 0; ++i)
        if (fields[i].key == std::string_view("MESSAGE"))
            glib_failed = std::string_view(static_cast<const char*>(fields[i].value)).ends_with(g_strerror(EAGAIN));
    return g_log_writer_default(level, fields, count, nullptr);
}

}  // namespace

void watch_threads_of_glib() {
    [[maybe_unused]] static const bool once = (g_log_set_writer_func(write_log, nullptr, nullptr), true);
}

bool can_start_threads(int count) {
    constexpr std::size_t kStack = 64 * 1024;  // [bytes] Memory is no part of the question.
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
