#include "render/draw/wrap.hpp"

#include <pango/pango.h>

namespace beamcam::render {
namespace {

struct Piece {
    std::string text;  // without the spaces or the new line behind it
    std::string space;
    bool ends_line = false;
};

// What cannot be broken.
std::vector<Piece> pieces(const std::string& plain) {
    const auto characters = static_cast<std::size_t>(g_utf8_strlen(plain.data(), static_cast<gssize>(plain.size())));
    std::vector<PangoLogAttr> at(characters + 1);
    pango_get_log_attrs(plain.data(), static_cast<int>(plain.size()), -1, pango_language_from_string("en"), at.data(),
                        static_cast<int>(at.size()));
    std::vector<Piece> out(1);
    const char* c = plain.data();
    for (std::size_t i = 0; i < characters; ++i, c = g_utf8_next_char(c)) {
        if (i > 0 && at[i].is_line_break) out.emplace_back();
        Piece& piece = out.back();
        piece.ends_line = at[i + 1].is_mandatory_break && i + 1 < characters;
        if (*c == ' ') piece.space += ' ';
        if (*c == ' ' || *c == '\n') continue;
        piece.text += piece.space + std::string(c, std::size_t(g_utf8_next_char(c) - c));
        piece.space.clear();
    }
    return out;
}

}  // namespace

std::vector<std::string> wrapped(Canvas& canvas, std::string_view plain, const TextStyle& style, std::size_t most) {
    TextStyle natural = style;
    natural.max_width = 0;
    const auto markup = [&](const std::string& line) { return escape(canvas.drawable(line)); };
    std::vector<std::string> lines;
    std::string line, space;
    const auto end_line = [&] {
        lines.push_back(markup(line));
        line.clear(), space.clear();
    };
    for (const Piece& piece : pieces(std::string(plain))) {
        const std::string longer = line + space + piece.text;
        const bool last = lines.size() + 1 == most;
        if (!last && !line.empty() && canvas.measure(markup(longer), natural).w > style.max_width) {
            end_line();
            line = piece.text;
        } else {
            line = longer;
        }
        space = piece.space;
        if (piece.ends_line && lines.size() + 1 < most) end_line();
    }
    if (!line.empty()) end_line();
    return lines;
}

}  // namespace beamcam::render
