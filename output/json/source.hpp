// The texts that a scene is read from, and messages that point into them. A scene has one file and any number of
// `--set` overrides; every value stores its source, so that a message names the place to change.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace beamcam {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // of UTF-8; it may precede a scene

// A scene file, or one override of the command line.
struct Source {
    std::string name;  // as the user typed it; of an override "--set beam.modes=3"
    std::string text;
    bool is_file = true;  // only messages of a file have line and column
};

struct SourcePosition {
    std::size_t source = 0;  // index into the sources; 0 is the file
    std::size_t offset = 0;  // byte in Source::text

    bool operator==(const SourcePosition&) const = default;
    // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 takes the 0 of the comparison for a pointer
    auto operator<=>(const SourcePosition&) const = default;
};

struct Message {
    SourcePosition place;
    std::string text;   // key, value, reason and remedy
    bool fatal = true;  // false: a warning
};

struct LineColumn {
    std::size_t line = 1, column = 1;  // from 1; a column is a character, not a byte
};
LineColumn locate(std::string_view text, std::size_t offset);
// Finds line and column of many increasing offsets in one pass over the text.
class Locator {
  public:
    explicit Locator(std::string_view text);
    LineColumn at(std::size_t offset);

  private:
    std::string_view text_;
    std::size_t offset_;
    LineColumn at_;
};

// `file:line:column: text`, then the line with a caret below the position.
std::string describe(const std::vector<Source>& sources, const Message& message);
// The messages in the order of their positions; beyond `kMostDescribed` only their number.
constexpr std::size_t kMostDescribed = 100;
std::string describe(const std::vector<Source>& sources, std::vector<Message> messages);

// A value for a message: in quotes, with visible control characters, shortened if long.
std::string in_quotes(std::string_view text);
// A shortened value without quotes, for numbers.
std::string shortened(std::string_view text);

}  // namespace beamcam
