// Text in XML and HTML.
#pragma once

#include <string>
#include <string_view>

namespace beamcam::scenes {

// Control characters, which XML cannot hold, are left out.
inline std::string escaped_for_xml(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else if (c == '>')
            out += "&gt;";
        else if (c == '"')
            out += "&quot;";
        else if (static_cast<unsigned char>(c) >= 0x20 || c == '\n')
            out.push_back(c);
    }
    return out;
}

}  // namespace beamcam::scenes
