// A count with its noun: "1 impact", "2 impacts", "3 entries".
#pragma once

#include <concepts>
#include <string>
#include <string_view>

namespace beamcam {

template <std::integral Number>
std::string counted(Number n, std::string_view noun) {
    std::string text = std::to_string(n) + ' ' + std::string(noun);
    if (n == 1) return text;
    if (text.ends_with('y')) text.replace(text.size() - 1, 1, "ie");
    return text + 's';
}

}  // namespace beamcam
