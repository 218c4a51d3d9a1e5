#include "render/plot/words.hpp"

#include <pango/pango.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

#include "render/base/error.hpp"
#include "render/draw/formula.hpp"
#include "render/plot/text.hpp"

namespace beamcam::render {
namespace {

using figure::Run;

// The formula that begins at this dollar, both dollars included; empty: none does.
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

std::optional<std::vector<Run>> read(std::string_view formula) {
    try {
        return figure::parse_markup(formula);
    } catch (const std::invalid_argument&) {
        return std::nullopt;
    }
}

std::string markup_of(const Canvas& canvas, const std::vector<Run>& runs) {
    std::string out;
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const Run& run = runs[i];
        const auto letters = [&](const Run& some) {
            std::string one = escape(canvas.drawable(some.text));
            if (some.symbol) one = math(one);
            if (some.bold) one = "<b>" + one + "</b>";
            return some.dots > 0 ? dotted(one, some.dots) : one;
        };
        if (!run.under.empty()) {
            out += fraction(markup_of(canvas, run.over), markup_of(canvas, run.under));
        } else if (!run.over.empty()) {
            out += root(markup_of(canvas, run.over));
        } else if (run.script == 0) {
            out += letters(run);
        } else {  // all scripts of one base
            std::string below, above;
            std::size_t end = i;
            for (; end < runs.size() && runs[end].script != 0; ++end)
                (runs[end].script < 0 ? below : above) += letters(runs[end]);
            out += scripts(below, above);
            i = end - 1;
        }
    }
    return out;
}

struct Piece {
    std::string text;  // without the spaces or the new line behind it
    std::string space;
    bool ends_line = false;
};

// What cannot be broken. A formula is to Unicode what a letter is.
std::vector<Piece> pieces(const std::string& text) {
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
        [&](std::string_view formula) { add("x", formula); });
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

std::string words(const Canvas& canvas, std::string_view text) {
    std::string out;
    const std::string between = needs_cjk(text) ? apart() : std::string();
    split(
        text, [&](const std::string& plain) { out += escape(canvas.drawable(plain)); },
        [&](std::string_view formula) {
            const auto runs = read(formula);
            out += between + (runs ? markup_of(canvas, *runs) : escape(canvas.drawable(formula))) + between;
        });
    return out;
}

std::string plain_words(std::string_view text) {
    std::string out;
    split(
        text, [&](const std::string& plain) { out += plain; },
        [&](std::string_view formula) { out += read(formula) ? figure::to_plain(formula) : std::string(formula); });
    return out;
}

std::string characters_without_font(std::string_view text) {
    const auto is_latin = [](char c) { return static_cast<unsigned char>(c) < 0x80; };
    if (std::ranges::all_of(text, is_latin)) return {};
    std::string out;
    try {
        const Fonts fonts(needs_cjk(text));
        Image scratch(1, 1);
        const Canvas canvas(scratch, fonts);
        for (const char* c = text.data(); c < text.data() + text.size(); c = g_utf8_next_char(c)) {
            const std::string one(c, std::size_t(g_utf8_next_char(c) - c));
            if (!is_latin(one[0]) && g_unichar_isprint(g_utf8_get_char(c)) && canvas.drawable(one).empty() &&
                out.find(one) == std::string::npos)
                out += (out.empty() ? "" : " ") + one;
        }
    } catch (const FontError&) {  // told by whoever draws
    }
    return out;
}

std::string problem_with_words(std::string_view text) {
    std::string out;
    split(
        text, [](const std::string&) {},
        [&](std::string_view formula) {
            try {
                figure::parse_markup(formula);
            } catch (const std::invalid_argument& error) {
                if (out.empty()) out = error.what();
            }
        });
    return out;
}

std::vector<std::string> wrapped(Canvas& canvas, std::string_view text, const TextStyle& style, std::size_t most) {
    TextStyle natural = style;
    natural.max_width = 0;
    const auto markup = [&](const std::string& line) { return words(canvas, line); };
    std::vector<std::string> lines;
    std::string line, space;
    const auto end_line = [&] {
        lines.push_back(markup(line));
        line.clear(), space.clear();
    };
    for (const Piece& piece : pieces(std::string(text))) {
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
