// Text that a scene is read from, and messages that point into it.
//
// A scene has one file and any number of `--set` overrides; every value remembers which of them it
// came from, so that a message names the place the user can change.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace beamcam::scenes {

// A scene file, or one override of the command line.
struct Source {
    std::string name;     // as the user typed it; `--set beam.modes=3` for an override
    std::string text;     // as it stands in the file
    bool is_file = true;  // only a file has lines and columns
};

struct Place {
    std::size_t source = 0;  // index into the sources; 0 is the file
    std::size_t offset = 0;  // byte in Source::text

    bool operator==(const Place&) const = default;
    // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 takes the 0 of the comparison for a pointer
    auto operator<=>(const Place&) const = default;
};

struct Message {
    Place place;
    std::string text;   // what, which value, what to do
    bool fatal = true;  // false: a warning
};

struct LineColumn {
    std::size_t line = 1, column = 1;  // from 1; columns count characters, not bytes
};
LineColumn locate(std::string_view text, std::size_t offset);
// The same for many offsets that never decrease, in one pass over the text.
class Locator {
  public:
    explicit Locator(std::string_view text);
    LineColumn at(std::size_t offset);

  private:
    std::string_view text_;
    std::size_t offset_;
    LineColumn at_;
};

// `file:line:column: text`, then the line itself with a caret below the place.
std::string describe(const std::vector<Source>& sources, const Message& message);
// The messages in the order of their places, one after the other; beyond `kMostDescribed`, how many more there are.
constexpr std::size_t kMostDescribed = 100;  // that anybody reads
std::string describe(const std::vector<Source>& sources, std::vector<Message> messages);

// A value inside a message: quoted, control characters made visible, long text shortened.
std::string in_quotes(std::string_view text);
// The same without quotes, for numbers as they were written.
std::string shortened(std::string_view text);

}  // namespace beamcam::scenes
