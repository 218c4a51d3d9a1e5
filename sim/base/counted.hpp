// A count with its noun: "1 impact", "2 impacts".
#pragma once

#include <string>
#include <string_view>

namespace beamcam {

inline std::string counted(long long n, std::string_view noun) {
    return std::to_string(n) + ' ' + std::string(noun) + (n == 1 ? "" : "s");
}

}  // namespace beamcam
