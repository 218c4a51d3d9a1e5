#include "output/json/characters.hpp"

#include <fmt/format.h>
#include <glib.h>

namespace beamcam {

std::optional<Message> encoding_problem(std::string_view text, std::size_t source, std::size_t largest) {
    const auto message = [&](std::size_t offset, std::string problem) {
        return Message{{source, offset}, std::move(problem), true};
    };
    if (text.size() > largest)
        return message(0, fmt::format("the file has {} bytes, but a scene has at most {}; name the scene file",
                                      text.size(), largest));
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
        return message(0, "the file is UTF-16; save it as UTF-8");
    if (const std::size_t nul = text.find('\0'); nul != std::string_view::npos)
        return message(nul, "a NUL byte; the file is not text, or it is damaged: save it as UTF-8 text");
    const char* bad = nullptr;
    if (g_utf8_validate_len(text.data(), text.size(), &bad)) return std::nullopt;
    return message(static_cast<std::size_t>(bad - text.data()),
                   fmt::format("byte 0x{:02x} is not UTF-8; save the file as UTF-8",
                               static_cast<unsigned>(static_cast<unsigned char>(*bad))));
}

std::string_view first_word(std::string_view text) {
    std::size_t end = 0;
    while (end < text.size() &&
           (g_ascii_isalnum(text[end]) || std::string_view("_-+.").find(text[end]) != std::string_view::npos))
        ++end;
    return text.substr(0, end);
}

bool is_number_of_json(std::string_view word) {
    std::size_t i = 0;
    const auto digits = [&] {
        const std::size_t begin = i;
        while (i < word.size() && g_ascii_isdigit(word[i])) ++i;
        return i - begin;
    };
    const auto accept = [&](std::string_view any) {
        const bool found = i < word.size() && any.find(word[i]) != std::string_view::npos;
        i += found ? 1 : 0;
        return found;
    };
    accept("-");
    const std::size_t first = i, whole = digits();
    if (whole == 0 || (whole > 1 && word[first] == '0')) return false;
    if (accept(".") && digits() == 0) return false;
    if (accept("eE")) {
        accept("+-");
        if (digits() == 0) return false;
    }
    return i == word.size();
}

}  // namespace beamcam
