// Can this process start threads? For errors whose cause a library hides.
#pragma once

#include <string>

namespace beamcam::render {

// Can the process start so many threads beside those that it has?
bool can_start_threads(int count);

// Notes from now on when GLib ends the process because a thread could not start.
void watch_threads_of_glib();

// Can the process start no thread, or could GLib start none? Safe in signal handlers.
bool threads_are_short() noexcept;

inline constexpr const char* kThreadRemedy =
    "close some programs, or raise the limits of processes and memory (ulimit -u, ulimit -v)";

}  // namespace beamcam::render
