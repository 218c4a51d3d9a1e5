// Memory and thread limits of the process, for library errors that do not name their cause.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace beamcam::render {

// Whether the process can allocate this many bytes at once.
bool has_memory(std::size_t bytes) noexcept;

// Whether there is a limit (ulimit -v, ulimit -d) with less than half of it left. Safe in signal handlers.
bool memory_is_short() noexcept;

// Whether it is so, or more than half of ulimit -v was in use at any time: other threads may have released memory since
// a library failed.
bool memory_was_short() noexcept;

// An error of a library that does not name its cause, while memory was short: "WHAT; perhaps there was not enough
// memory …".
struct PerhapsOutOfMemory : std::runtime_error {
    explicit PerhapsOutOfMemory(const std::string& what);
};

// "not enough memory; this process may use 512 MiB (ulimit -v) …"
std::string out_of_memory_message();

// Whether the process can start this many more threads.
bool can_start_threads(int count);

// From now on records when GLib aborts the process because it cannot start a thread.
void watch_threads_of_glib();

// Whether the process, or GLib before, could not start a thread. Safe in signal handlers.
bool threads_are_short() noexcept;

inline constexpr const char* kThreadRemedy =
    "close some programs, or raise the limits of processes and memory (ulimit -u, ulimit -v)";

}  // namespace beamcam::render
