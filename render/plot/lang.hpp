// The language of the texts of pictures.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace beamcam::render {

enum class Lang { en, zh };

// The Chinese of an English phrase of the table in lang.cpp; other text, such as a label of the user, as it is.
std::string_view translated(Lang lang, std::string_view english);

// The phrase in this language, with {} replaced by the values.
template <class... Values>
std::string phrase(Lang lang, std::string_view english, const Values&... values) {
    const std::string_view text = translated(lang, english);
    if constexpr (sizeof...(values) == 0)
        return std::string(text);
    else
        return fmt::format(fmt::runtime(text), values...);
}

}  // namespace beamcam::render
