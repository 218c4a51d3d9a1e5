#include "scenes/source.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace beamcam::scenes {
namespace {

bool is_continuation(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

std::size_t characters(std::string_view bytes) {
    return static_cast<std::size_t>(
        std::count_if(bytes.begin(), bytes.end(), [](char c) { return !is_continuation(c); }));
}

// The first `count` characters.
std::string_view first_characters(std::string_view bytes, std::size_t count) {
    std::size_t i = 0;
    for (; i < bytes.size(); ++i)
        if (!is_continuation(bytes[i]) && count-- == 0) break;
    return bytes.substr(0, i);
}

// How many bytes the UTF-8 character at the front takes; 0 when it is none.
std::size_t utf8_length(std::string_view text) {
    const auto c = static_cast<unsigned char>(text[0]);
    const std::size_t length = c < 0x80 ? 1 : c < 0xC2 ? 0 : c < 0xE0 ? 2 : c < 0xF0 ? 3 : c < 0xF5 ? 4 : 0;
    if (length == 0 || length > text.size()) return 0;
    for (std::size_t i = 1; i < length; ++i)
        if (!is_continuation(text[i])) return 0;
    return length;
}

// Tabs would move the caret, control characters would speak to the terminal, and bytes that are no
// text would spoil a log.
std::string printable(std::string_view bytes) {
    std::string out;
    while (!bytes.empty()) {
        const std::size_t length = utf8_length(bytes);
        const auto c = static_cast<unsigned char>(bytes[0]);
        if (length == 0)
            out += is_continuation(bytes[0]) ? "" : "?";
        else if (c < 0x20 || c == 0x7f)
            out += ' ';
        else
            out += bytes.substr(0, length);
        bytes.remove_prefix(std::max<std::size_t>(length, 1));
    }
    return out;
}

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

// The line that holds `offset`, cut to a window that fits a terminal, and a caret below the place.
std::string excerpt(std::string_view text, std::size_t offset) {
    constexpr std::size_t kBefore = 60, kWidth = 100;  // characters; a line of 120 columns with its margin
    offset = std::min(offset, text.size());
    std::size_t begin = offset == 0 ? 0 : text.rfind('\n', offset - 1);
    begin = (offset == 0 || begin == std::string_view::npos) ? 0 : begin + 1;
    std::size_t end = std::min(text.find('\n', offset), text.size());
    if (begin == 0 && text.starts_with(kByteOrderMark)) begin = std::min(kByteOrderMark.size(), offset);
    while (end > offset && text[end - 1] == '\r') --end;

    std::string_view before = text.substr(begin, offset - begin), after = text.substr(offset, end - offset);
    std::string head, tail;
    if (std::size_t count = characters(before); count > kBefore) {
        before.remove_prefix(first_characters(before, count - kBefore).size());
        head = "…";
    }
    if (std::string_view shown = first_characters(after, kWidth - kBefore); shown.size() < after.size()) {
        after = shown;
        tail = "…";
    }
    std::string number = fmt::format("{:5}", locate(text, offset).line);
    return fmt::format("{} | {}{}{}{}\n{:>{}} | {:>{}}\n", number, head, printable(before), printable(after), tail, "",
                       number.size(), "^", characters(head) + characters(before) + 1);
}

}  // namespace

LineColumn locate(std::string_view text, std::size_t offset) {
    offset = std::min(offset, text.size());
    std::string_view before = text.substr(0, offset);
    LineColumn at;
    at.line = 1 + static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n'));
    if (std::size_t newline = before.rfind('\n'); newline != std::string_view::npos)
        before.remove_prefix(newline + 1);
    else if (before.starts_with(kByteOrderMark))
        before.remove_prefix(kByteOrderMark.size());
    at.column = 1 + characters(before);
    return at;
}

std::string describe(const std::vector<Source>& sources, const Message& message) {
    const Source& source = sources.at(message.place.source);
    const char* label = message.fatal ? "" : "warning: ";
    if (!source.is_file) return fmt::format("{}: {}{}\n", source.name, label, message.text);
    const LineColumn at = locate(source.text, message.place.offset);
    std::string out = fmt::format("{}:{}:{}: {}{}\n", source.name, at.line, at.column, label, message.text);
    if (!source.text.empty()) out += excerpt(source.text, message.place.offset);
    return out;
}

std::string describe(const std::vector<Source>& sources, std::vector<Message> messages) {
    std::stable_sort(messages.begin(), messages.end(),
                     [](const Message& a, const Message& b) { return a.place < b.place; });
    constexpr std::size_t kMost = 100;  // that anybody reads
    std::string out;
    for (std::size_t i = 0; i < std::min(messages.size(), kMost); ++i) out += describe(sources, messages[i]);
    if (messages.size() > kMost) out += fmt::format("and {} more\n", messages.size() - kMost);
    return out;
}

std::string shortened(std::string_view text) {
    constexpr std::size_t kLongest = 60;  // characters
    std::string_view shown = first_characters(text, kLongest);
    return fmt::format("{}{}", printable(shown), shown.size() < text.size() ? "…" : "");
}

std::string in_quotes(std::string_view text) { return fmt::format("\"{}\"", shortened(text)); }

}  // namespace beamcam::scenes
