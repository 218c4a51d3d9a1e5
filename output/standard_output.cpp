#include "output/standard_output.hpp"

#include <cstdio>
#include <iostream>

#include "output/errors.hpp"

namespace beamcam::output {
namespace {

[[noreturn]] void fail() { throw IoError("cannot write to standard output; is the pipe closed or the disk full?"); }

}  // namespace

void print_data(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) fail();
}

void print_message(std::string_view text) noexcept {
    [[maybe_unused]] const std::size_t written = std::fwrite(text.data(), 1, text.size(), stderr);
}

void flush_data() {
    if (!std::cout.flush()) fail();
}

}  // namespace beamcam::output
