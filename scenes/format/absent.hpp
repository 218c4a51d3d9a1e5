// One table (absent.cpp) holds the words that a user may expect in a scene or on the command line and that beamcam does
// not have, because the thing is not modelled or was withdrawn. The error of such a word ends with the sentence of the
// table. A word that exists is never looked up.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace beamcam::scenes {

// Each returns "; SENTENCE", or nothing for a word that the table does not have.
std::string absent_key(std::string_view path);  // "cam.lift"
// A value of a key, "method=exponential", a unit, a command, an option, or the ending of a file, ".eps".
std::string absent(std::string_view word);

// A part that is not modelled: the words in keys, and the sentence about it.
struct NotModelled {
    std::vector<std::string> words;
    std::string sentence;
};
std::vector<NotModelled> not_modelled();

}  // namespace beamcam::scenes
