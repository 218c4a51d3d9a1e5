#include "scenes/files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace beamcam::scenes {
namespace {

std::string normal(std::string_view file) { return std::filesystem::path(file).lexically_normal().generic_string(); }

struct Pattern {
    std::string before, after;
};
Pattern split(std::string_view file) {
    const std::size_t begin = file.find('#'), end = file.find_last_of('#') + 1;
    return {std::string(file.substr(0, begin)), std::string(file.substr(end))};
}

bool matches(const Pattern& pattern, std::string_view file) {
    if (file.size() <= pattern.before.size() + pattern.after.size() || !file.starts_with(pattern.before) ||
        !file.ends_with(pattern.after))
        return false;
    const std::string_view digits =
        file.substr(pattern.before.size(), file.size() - pattern.before.size() - pattern.after.size());
    return std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
}

// Is `a` a directory on the way to `b`?
bool contains(const std::string& a, const std::string& b) { return b.starts_with(a + "/"); }

}  // namespace

std::string problem_with_file(std::string_view file) {
    if (file.empty()) return "the name is empty";
    if (std::any_of(file.begin(), file.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }))
        return "the name holds a control character";
    const std::filesystem::path path(file);
    if (path.is_absolute()) return "an absolute path; name it relative to the output directory, which -o chooses";
    for (const auto& part : path)
        if (part == "..")
            return "it leaves the output directory; write a path without \"..\", and choose the directory with -o";
    if (!path.has_filename() || path.filename() == ".") return "a directory; name a file";
    if (path.stem().empty() || path.filename().string().starts_with("."))
        return "the name is only an ending; put a name before it";
    // ext4, xfs and tmpfs end at 255 bytes; the temporary name beside it needs some of them.
    if (path.filename().string().size() > 200) return "the name is longer than 200 bytes; shorten it";
    return {};
}

bool is_numbered(std::string_view file) { return file.find('#') != std::string_view::npos; }

std::string problem_with_numbering(std::string_view file) {
    if (!is_numbered(file))
        return "a sequence needs a place for the frame number; write it as '#', for example \"fall-####.png\"";
    const std::size_t begin = file.find('#'), end = file.find_last_of('#') + 1;
    if (file.substr(begin, end - begin).find_first_not_of('#') != std::string_view::npos)
        return "the frame number stands in two places; write one run of '#'";
    if (file.find('/', begin) != std::string_view::npos)
        return "the frame number stands in a directory's name; write '#' in the file's own name";
    if (end - begin > 9) return "more than nine '#'; frame numbers are never that long";
    return {};
}

std::string numbered_file(std::string_view pattern, long number) {
    const auto width = static_cast<std::size_t>(std::count(pattern.begin(), pattern.end(), '#'));
    const Pattern parts = split(pattern);
    return fmt::format("{}{:0{}}{}", parts.before, number, width, parts.after);
}

std::optional<long> number_of(std::string_view pattern, std::string_view file) {
    const Pattern parts = split(pattern);
    if (!matches(parts, file)) return {};
    const std::string_view digits =
        file.substr(parts.before.size(), file.size() - parts.before.size() - parts.after.size());
    if (digits.size() > 9) return {};  // no frame has such a number
    long number = 0;
    for (const char digit : digits) number = 10 * number + (digit - '0');
    return numbered_file(pattern, number) == file ? std::optional(number) : std::nullopt;
}

bool may_collide(std::string_view first, std::string_view second) {
    const std::string a = normal(first), b = normal(second);
    if (is_numbered(a) && is_numbered(b)) return split(a).before == split(b).before && split(a).after == split(b).after;
    if (is_numbered(a)) return matches(split(a), b);
    if (is_numbered(b)) return matches(split(b), a);
    return a == b || contains(a, b) || contains(b, a);
}

}  // namespace beamcam::scenes
