// Data on standard output: all of it, or an error in words.
#pragma once

#include <string_view>

namespace beamcam::output {

// Writes and flushes. Throws IoError when the reader has gone or the disk is full.
void print_data(std::string_view text);

// Ends what was written to std::cout. Throws IoError as print_data.
void flush_data();

}  // namespace beamcam::output
