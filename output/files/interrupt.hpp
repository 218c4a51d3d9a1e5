// Ctrl-C and friends. The first signal only raises a flag: the loops that simulate, draw and encode
// look at it, stop, and destructors remove what is half done. A second signal does not wait: the
// handler itself removes the registered temporary files and ends the program with code 130.
#pragma once

#include <filesystem>

namespace beamcam::output {

// SIGINT, SIGTERM, SIGHUP (unless ignored by the parent, as under nohup) raise the flag. SIGPIPE and
// SIGXFSZ are ignored, so that a closed pipe or a file-size limit is an error in words.
void install_handlers();
// Removes the temporary files of this process. Safe in signal handlers, which end the process then.
void unlink_temporaries() noexcept;

// True once a signal has come.
bool interrupted();

// A file that must not outlive an interrupted program, for as long as this object lives.
// There are 64 places; a file beyond them is still removed by its destructor, not by a second signal.
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
