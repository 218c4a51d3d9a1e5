// Libraries that end the process when memory or threads are short.
#pragma once

namespace beamcam::output {

// GLib, Mesa and LLVM end the process when an allocation fails or a thread cannot start, or use the null pointer. Such
// an end becomes a message and this exit code, and temporary files are removed; other crashes stay what they are.
void install_crash_handlers(int exit_code);

}  // namespace beamcam::output
