// Libraries that end the process when an allocation fails.
#pragma once

namespace beamcam::output {

// GLib, Mesa and LLVM end the process when an allocation fails, or use the null pointer. Where memory is limited
// (ulimit -v), such an end becomes a message and this exit code, and temporary files are removed; other crashes stay
// what they are.
void install_memory_handlers(int exit_code);

}  // namespace beamcam::output
