// Names of output files: which are allowed, which numbered ones they stand for, which collide.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace beamcam::scenes {

// Why `file` cannot be the name of an output below the output directory; empty when it can.
std::string problem_with_file(std::string_view file);

// Why `file` cannot name a sequence: it needs one run of '#' in its last part; empty when it can.
std::string problem_with_numbering(std::string_view file);
bool is_numbered(std::string_view file);

// "a-####.png" and 12 make "a-0012.png"; a number with more digits takes the room it needs.
std::string numbered_file(std::string_view pattern, long number);
// The number by which `file` is one of them; nothing when it is none.
std::optional<long> number_of(std::string_view pattern, std::string_view file);

// Could two outputs write the same path, or one a file where the other needs a directory?
bool may_collide(std::string_view a, std::string_view b);

}  // namespace beamcam::scenes
