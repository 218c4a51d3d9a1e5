#include "output/files/standard_output.hpp"

#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <cstdio>
#include <new>
#include <string>

#include "output/files/errors.hpp"
#include "output/files/interrupt.hpp"
#include "output/files/text_safety.hpp"

namespace beamcam::output {
namespace {

// A reader such as `head` that has ended is no error: the program ends as other programs do by SIGPIPE.
[[noreturn]] void fail() {
    pollfd out = {STDOUT_FILENO, POLLOUT, 0};
    if (poll(&out, 1, 0) == 1 && (out.revents & POLLERR) != 0) end_silently(128 + SIGPIPE);
    throw IoError("cannot write to standard output; is the disk full?");
}

}  // namespace

void print_data(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) fail();
}

void print_text(std::string_view text) { print_data(visible(text)); }
void print_json(std::string_view text) { print_data(escaped_json(text)); }

void write_message(std::string_view text) noexcept try {
    const std::string shown = visible(text);
    [[maybe_unused]] const std::size_t written = std::fwrite(shown.data(), 1, shown.size(), stderr);
} catch (const std::bad_alloc&) {
    std::fputs("beamcam: no memory for a message\n", stderr);
}

}  // namespace beamcam::output
