#include "render/plot/user_text.hpp"

#include <pango/pango.h>

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

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

FittedText fitted_text(const Canvas& canvas, std::string_view text, TextStyle style, double smaller, double room) {
    std::string line(text);
    std::ranges::replace(line, '\n', ' ');
    FittedText out{text_markup(line), style.size};
    const auto fits = [&](const std::string& markup) { return canvas.measure(markup, style).w <= room; };
    if (fits(out.markup)) return out;
    style.size = out.size = smaller;
    if (fits(out.markup)) return out;
    std::vector<std::string> begun{"…"};  // plain text is cut between letters, a formula is left out whole
    const auto add = [&](std::string_view markup) {
        const std::string before = begun.back().substr(0, begun.back().size() - std::string_view("…").size());
        begun.push_back(before + std::string(markup) + "…");
    };
    split(
        line,
        [&](const std::string& plain) {
            for (const char* c = plain.data(); c < plain.data() + plain.size(); c = g_utf8_next_char(c))
                add(escaped({c, std::size_t(g_utf8_next_char(c) - c)}));
        },
        [&](std::string_view formula) { add(text_markup(formula)); });
    out.cut = true;
    out.markup = *std::prev(std::ranges::partition_point(begun.begin() + 1, begun.end(), fits));
    return out;
}

}  // namespace beamcam::render
