#include "render/plot/user_text.hpp"

#include <pango/pango.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "render/base/error.hpp"
#include "render/draw/markup.hpp"

namespace beamcam::render {
namespace {

// The formula that begins at this dollar, with both dollars; empty: none.
std::string_view formula_at(std::string_view text, std::size_t dollar) {
    for (std::size_t end = dollar + 1; end < text.size(); ++end) {
        if (text[end] == '\\')
            ++end;
        else if (text[end] == '$')
            return end == dollar + 1 ? std::string_view() : text.substr(dollar, end + 1 - dollar);
    }
    return {};
}

// Calls `plain` and `formula` with the pieces of a text in their order.
template <class Plain, class Formula>
void split(std::string_view text, const Plain& plain, const Formula& formula) {
    std::string before;
    const auto end_plain = [&] {
        if (!before.empty()) plain(std::exchange(before, {}));
    };
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '\\' && text.substr(i + 1).starts_with('$')) {
            before += text[++i];
        } else if (const auto some = text[i] == '$' ? formula_at(text, i) : std::string_view(); !some.empty()) {
            end_plain();
            formula(some);
            i += some.size() - 1;
        } else {
            before += text[i];
        }
    }
    end_plain();
}

// Why a formula cannot be parsed; empty: it can.
std::string problem_of(std::string_view formula) {
    try {
        parse_markup(formula);
        return {};
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
}

struct Piece {
    std::string text;  // without the spaces or the new line behind it
    std::string space;
    bool ends_line = false;
};

// A formula in parts that begin with a sign between spaces, outside of braces: "$a$", "$= b$", "$+ c$".
std::vector<std::string> parts_of(std::string_view formula) {
    std::vector<std::string> parts(1);
    int depth = 0;
    for (std::size_t i = 0; i < formula.size(); ++i) {
        const char c = formula[i];
        depth += c == '{' ? 1 : c == '}' ? -1 : 0;
        const bool sign = c == ' ' && i + 2 < formula.size() && formula[i + 2] == ' ' &&
                          std::string_view("=+-<>").find(formula[i + 1]) != std::string_view::npos;
        if (sign && depth == 0)
            parts.back() += '$', parts.emplace_back("$");
        else
            parts.back() += c;
    }
    return parts;
}

// Joins two texts; parts of one formula become one again.
std::string joined(const std::string& before, const std::string& space, const std::string& after) {
    const bool formula = before.ends_with('$') && !before.ends_with("\\$") && space == " " &&
                         std::ranges::any_of(std::array{"$= ", "$+ ", "$- ", "$< ", "$> "},
                                             [&](const char* sign) { return after.starts_with(sign); });
    return formula ? before.substr(0, before.size() - 1) + space + after.substr(1) : before + space + after;
}

// The unbreakable pieces. For Unicode a formula, or each of its parts, is one letter.
std::vector<Piece> pieces(const std::string& text, bool parts_of_formulas = false) {
    std::string letters;
    std::vector<std::string> meant;  // by each of them
    const auto add = [&](std::string_view one, std::string_view meaning) {
        letters += one;
        meant.emplace_back(meaning);
    };
    split(
        text,
        [&](const std::string& plain) {
            for (const char* c = plain.data(); c < plain.data() + plain.size(); c = g_utf8_next_char(c)) {
                const std::string_view one(c, std::size_t(g_utf8_next_char(c) - c));
                add(one, one == "$" ? "\\$" : one);
            }
        },
        [&](std::string_view formula) {
            std::vector<std::string> parts{std::string(formula)};
            if (parts_of_formulas && problem_of(formula).empty()) parts = parts_of(formula);
            for (std::size_t i = 0; i < parts.size(); ++i) {
                if (i > 0) add(" ", " ");
                add("x", parts[i]);
            }
        });
    std::vector<PangoLogAttr> at(meant.size() + 1);
    pango_get_log_attrs(letters.data(), static_cast<int>(letters.size()), -1, pango_language_from_string("en"),
                        at.data(), static_cast<int>(at.size()));
    std::vector<Piece> out(1);
    for (std::size_t i = 0; i < meant.size(); ++i) {
        if (i > 0 && at[i].is_line_break) out.emplace_back();
        Piece& piece = out.back();
        piece.ends_line = at[i + 1].is_mandatory_break && i + 1 < meant.size();
        if (meant[i] == " ") piece.space += ' ';
        if (meant[i] == " " || meant[i] == "\n") continue;
        piece.text += piece.space + meant[i];
        piece.space.clear();
    }
    return out;
}

}  // namespace

std::string text_markup(std::string_view text) {
    std::string out;
    split(
        text, [&](const std::string& plain) { out += escaped(plain); },
        [&](std::string_view formula) {
            out += problem_of(formula).empty() ? std::string(formula) : escaped(formula);
        });
    return out;
}

std::string characters_without_font(std::string_view text) {
    const auto is_latin = [](char c) { return static_cast<unsigned char>(c) < 0x80; };
    if (std::ranges::all_of(text, is_latin)) return {};
    std::string out;
    try {
        const Fonts fonts(needs_cjk(text));
        for (const char* c = text.data(); c < text.data() + text.size(); c = g_utf8_next_char(c)) {
            const std::string one(c, std::size_t(g_utf8_next_char(c) - c));
            if (!is_latin(one[0]) && g_unichar_isprint(g_utf8_get_char(c)) && drawable(fonts, one).empty() &&
                out.find(one) == std::string::npos)
                out += (out.empty() ? "" : " ") + one;
        }
    } catch (const FontError&) {  // drawing reports it
    }
    return out;
}

std::string markup_problem(std::string_view text) {
    std::string first;
    split(
        text, [](const std::string&) {},
        [&](std::string_view formula) {
            if (first.empty()) first = problem_of(formula);
        });
    return first;
}

std::vector<std::string> wrapped_lines(const Canvas& canvas, std::string_view text, const TextStyle& style,
                                       std::size_t most) {
    TextStyle natural = style;
    natural.max_width = 0;
    std::vector<std::string> lines;
    std::string line, space;
    const auto end_line = [&] {
        lines.push_back(text_markup(line));
        line.clear(), space.clear();
    };
    const auto is_wide = [&](const std::string& some) {
        return canvas.measure(text_markup(some), natural).w > style.max_width;
    };
    std::vector<Piece> all;
    for (const Piece& piece : pieces(std::string(text))) {
        all.push_back(piece);
        if (style.max_width <= 0 || !is_wide(piece.text)) continue;
        all.pop_back();  // a formula longer than a line
        for (const Piece& part : pieces(piece.text, true)) all.push_back(part);
        all.back().space = piece.space, all.back().ends_line = piece.ends_line;
    }
    for (const Piece& piece : all) {
        const std::string longer = joined(line, space, piece.text);
        const bool last = lines.size() + 1 == most;
        if (!last && !line.empty() && is_wide(longer)) {
            end_line();
            line = piece.text;
        } else {
            line = longer;
        }
        space = piece.space;
        if (piece.ends_line && lines.size() + 1 < most) end_line();
    }
    // An ellipsis cuts plain text where it is drawn, but no formula.
    const auto too_long = [&] { return style.max_width > 0 && line.find('$') != std::string::npos && is_wide(line); };
    for (std::vector<Piece> left = pieces(line, true); left.size() > 1 && too_long();) {
        left.pop_back();
        line.clear(), space.clear();
        for (const Piece& piece : left) line = joined(line, space, piece.text), space = piece.space;
        line += " …";
    }
    if (!line.empty()) end_line();
    return lines;
}

}  // namespace beamcam::render
