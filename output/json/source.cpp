#include "output/json/source.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "output/files/text_safety.hpp"

namespace beamcam {
namespace {

bool is_continuation(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

std::size_t characters(std::string_view bytes) {
    return static_cast<std::size_t>(std::ranges::count_if(bytes, [](char c) { return !is_continuation(c); }));
}

// The first `count` characters.
std::string_view first_characters(std::string_view bytes, std::size_t count) {
    std::size_t i = 0;
    for (; i < bytes.size(); ++i)
        if (!is_continuation(bytes[i]) && count-- == 0) break;
    return bytes.substr(0, i);
}

// The line around `offset`, cut to the width of a terminal, and a caret below the position.
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
    return fmt::format("{} | {}{}{}{}\n{:>{}} | {:>{}}\n", number, head, output::one_line(before),
                       output::one_line(after), tail, "", number.size(), "^",
                       characters(head) + characters(before) + 1);
}

}  // namespace

Locator::Locator(std::string_view text)
    : text_(text), offset_(text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0) {}

LineColumn Locator::at(std::size_t offset) {
    for (; offset_ < std::min(offset, text_.size()); ++offset_) {
        if (text_[offset_] == '\n')
            at_ = {at_.line + 1, 1};
        else if (!is_continuation(text_[offset_]))
            ++at_.column;
    }
    return at_;
}

LineColumn locate(std::string_view text, std::size_t offset) { return Locator(text).at(offset); }

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
    std::ranges::stable_sort(messages, [](const Message& a, const Message& b) { return a.place < b.place; });
    std::string out;
    for (std::size_t i = 0; i < std::min(messages.size(), kMostDescribed); ++i) out += describe(sources, messages[i]);
    if (messages.size() > kMostDescribed) out += fmt::format("and {} more\n", messages.size() - kMostDescribed);
    return out;
}

std::string shortened(std::string_view text) {
    constexpr std::size_t kLongest = 60;  // characters
    std::string_view shown = first_characters(text, kLongest);
    return fmt::format("{}{}", output::one_line(shown), shown.size() < text.size() ? "…" : "");
}

std::string in_quotes(std::string_view text) { return fmt::format("\"{}\"", shortened(text)); }

}  // namespace beamcam
