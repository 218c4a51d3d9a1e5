// Clean exit if a library ends the process for lack of memory or threads.
#pragma once

namespace beamcam::output {

// GLib, Mesa and LLVM abort, or dereference a null pointer, if an allocation fails or a thread cannot start. The
// handlers then print a message, remove temporary files and exit with this code. They leave other crashes unchanged.
void install_crash_handlers(int exit_code);

}  // namespace beamcam::output
