// Signals. Interruption, such as by Ctrl-C: the first signal sets a flag; the loops that simulate, draw and encode
// check it and stop, and destructors remove unfinished files. At a second signal the handler removes the registered
// temporary files and ends the program with code 130.
#pragma once

#include <filesystem>

namespace beamcam::output {

// SIGINT, SIGTERM, SIGHUP (unless ignored by the parent, as under nohup) set the flag. SIGPIPE and SIGXFSZ are ignored:
// standard_output.cpp handles a pipe that is closed, and a file-size limit gives an error message.
void install_handlers();
// GLib, Mesa and LLVM abort, or dereference a null pointer, if an allocation fails or a thread cannot start. The
// handlers then print a message, remove temporary files and exit with this code: always at GLib's signal, at others
// only if the process has a limit of memory; otherwise they are crashes.
void install_crash_handlers(int exit_code);

// Removes the temporary files of this process, and ends it with this code and without a message.
[[noreturn]] void end_silently(int exit_code);

// True once a signal has come.
bool interrupted();

// A file that is removed if the program is interrupted while this object exists. There are 64 places; a second signal
// does not remove files beyond them.
class TemporaryName {
  public:
    explicit TemporaryName(const std::filesystem::path& absolute);
    ~TemporaryName();
    TemporaryName(const TemporaryName&) = delete;
    TemporaryName& operator=(const TemporaryName&) = delete;

  private:
    int slot_ = -1;
};

}  // namespace beamcam::output
