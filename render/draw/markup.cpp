#include "render/draw/markup.hpp"

#include <fmt/format.h>
#include <glib.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace beamcam::render {
namespace {

using Pair = std::pair<std::string_view, std::string_view>;

// Greek letters and signs of mathematical text, and their LaTeX commands.
constexpr std::array kLatexMath{
    Pair{"α", "\\alpha"},   Pair{"β", "\\beta"},     Pair{"γ", "\\gamma"},   Pair{"δ", "\\delta"},
    Pair{"ε", "\\epsilon"}, Pair{"ζ", "\\zeta"},     Pair{"η", "\\eta"},     Pair{"θ", "\\theta"},
    Pair{"κ", "\\kappa"},   Pair{"λ", "\\lambda"},   Pair{"μ", "\\mu"},      Pair{"ν", "\\nu"},
    Pair{"ξ", "\\xi"},      Pair{"π", "\\pi"},       Pair{"ρ", "\\rho"},     Pair{"σ", "\\sigma"},
    Pair{"τ", "\\tau"},     Pair{"φ", "\\varphi"},   Pair{"χ", "\\chi"},     Pair{"ψ", "\\psi"},
    Pair{"ω", "\\omega"},   Pair{"Θ", "\\Theta"},    Pair{"Δ", "\\Delta"},   Pair{"Σ", "\\Sigma"},
    Pair{"Ω", "\\Omega"},   Pair{"×", "\\times "},   Pair{"·", "\\cdot "},   Pair{"−", "-"},
    Pair{"≥", "\\ge "},     Pair{"≤", "\\le "},      Pair{"≈", "\\approx "}, Pair{"√", "\\surd "},
    Pair{"∞", "\\infty "},  Pair{"°", "^{\\circ}"},  Pair{"±", "\\pm "},     Pair{"∫", "\\int "},
    Pair{"∑", "\\sum "},    Pair{"∂", "\\partial "}, Pair{"′", "'"},         Pair{"→", "\\to "},
    Pair{"²", "^{2}"},      Pair{"³", "^{3}"}};
constexpr std::array kLatexText{Pair{"–", "--"},
                                Pair{"—", "---"},
                                Pair{"\u00A0", "~"},
                                Pair{"\u2009", "\\,"},
                                Pair{"“", "``"},
                                Pair{"”", "''"},
                                Pair{"%", "\\%"},
                                Pair{"&", "\\&"},
                                Pair{"#", "\\#"},
                                Pair{"_", "\\_"},
                                Pair{"{", "\\{"},
                                Pair{"}", "\\}"},
                                Pair{"$", "\\$"},
                                Pair{"~", "\\textasciitilde{}"},
                                Pair{"^", "\\textasciicircum{}"},
                                Pair{"\\", "\\textbackslash{}"},
                                Pair{"…", "\\dots{}"},
                                Pair{"µ", "\\textmu{}"}};

// Upright in mathematics.
constexpr std::array<std::string_view, 11> kFunctions{"sin", "cos", "tan", "arcsin", "arccos", "arctan",
                                                      "exp", "ln",  "log", "min",    "max"};

std::string_view next_character(std::string_view text, std::size_t at) {
    return text.substr(at, std::size_t(g_utf8_next_char(&text[at]) - &text[at]));
}

std::string_view last_character(std::string_view text) {
    const char* const end = text.data() + text.size();
    const char* const at = g_utf8_prev_char(end);
    return {at, static_cast<std::size_t>(end - at)};
}

// ASCII and Greek letters, which are italic in mathematics.
bool is_letter(std::string_view c) {
    if (c.size() == 1) return (c[0] >= 'a' && c[0] <= 'z') || (c[0] >= 'A' && c[0] <= 'Z');
    if (c.size() != 2) return false;
    const unsigned code = (static_cast<unsigned char>(c[0]) & 31u) << 6 | (static_cast<unsigned char>(c[1]) & 63u);
    return code >= 0x391 && code <= 0x3C9;
}

class Parser {
  public:
    explicit Parser(std::string_view text) : text_(text) {}

    std::vector<Run> all() {
        sequence({}, false);
        if (math_) fail("a $ is never closed");
        return std::move(runs_);
    }

  private:
    [[noreturn]] void fail(const char* what) const {
        throw std::invalid_argument(fmt::format("label \"{}\": {}", text_, what));
    }

    bool take(std::string_view word) {
        if (!text_.substr(at_).starts_with(word)) return false;
        at_ += word.size();
        return true;
    }

    void put(std::string_view c, Run style) {
        if (math_ && !upright_ && is_letter(c)) style.symbol = true;
        if (math_ && c == "-") c = "−";
        if (math_ && c == "'") c = "′";
        const bool joins = !runs_.empty() && style.dots == 0 && is_alike(runs_.back(), style);
        if (!joins) runs_.push_back(std::move(style));
        Run& run = runs_.back();
        if (faint_ && run.faint_to == 0) run.faint_from = run.text.size();
        run.text += c;
        if (faint_) run.faint_to = run.text.size();
    }

    static bool is_alike(const Run& a, const Run& b) {
        return a.over.empty() && std::tie(a.symbol, a.bold, a.script, a.dots, a.color) ==
                                     std::tie(b.symbol, b.bold, b.script, b.dots, b.color);
    }

    // Parses until the end, or the closing brace of a group.
    void sequence(const Run& style, bool in_braces) {
        while (at_ < text_.size()) {
            if (in_braces && take("}")) return;
            item(style);
        }
        if (in_braces) fail("a brace is never closed");
    }

    void group(const Run& style) {
        if (take("{")) return sequence(style, true);
        if (at_ >= text_.size()) fail("something is missing at its end");
        if (text_[at_] == '\\') return item(style);
        one(style);
    }

    void one(const Run& style) {
        const std::string_view c = next_character(text_, at_);
        at_ += c.size();
        put(c, style);
    }

    std::vector<Run> inside() {
        if (++depth_ > kDeepest) fail("fractions and roots can be nested at most six deep");
        std::vector<Run> before = std::exchange(runs_, {});
        group({});
        --depth_;
        return std::exchange(runs_, std::move(before));
    }

    // Parses a LaTeX command after its backslash; false if there is none.
    bool command(const Run& style) {
        std::size_t end = at_;
        while (end < text_.size() && std::isalpha(static_cast<unsigned char>(text_[end]))) ++end;
        if (!math_ || end == at_) return false;
        const std::string_view name = text_.substr(at_, end - at_);
        at_ = end;
        // Skips the space that ends a command, unless a sign follows.
        const std::size_t next = std::min(text_.find_first_not_of(' ', at_), text_.size());
        const auto sign = [](char c) { return std::string_view("=<>+-").find(c) != std::string_view::npos || c < 0; };
        if (next == text_.size() || !sign(text_[next])) at_ = next;
        Run changed = style;
        if (name == "frac" || name == "sqrt") {
            changed.over = inside();
            if (name == "frac") changed.under = inside();
            runs_.push_back(std::move(changed));
            return true;
        }
        if (name == "mathrm" || name == "text") {
            upright([&] { group(changed); });
            return true;
        }
        if (name == "left" || name == "right") {  // the size of delimiters is that of the line
            take(".");
            return true;
        }
        if (std::ranges::find(kFunctions, name) != kFunctions.end()) {
            function(name, style);
            return true;
        }
        if (name == "dot" || name == "ddot") {
            changed.dots = name == "dot" ? 1 : 2;
            item(changed);
            return true;
        }
        for (const Pair& known : kLatexMath)
            if (known.second.starts_with('\\') && known.second.substr(1, known.second.find(' ') - 1) == name) {
                put(known.first, style);
                return true;
            }
        fail(fmt::format("\\{} is not among the commands that can be drawn", name).c_str());
    }

    template <class Parse>
    void upright(const Parse& parse) {
        const bool before = std::exchange(upright_, true);
        parse();
        upright_ = before;
    }

    // A thin space separates its name from an argument without parentheses.
    void function(std::string_view name, const Run& style) {
        upright([&] { put(name, style); });
        if (at_ < text_.size() && std::string_view("([{_^)$},.").find(text_[at_]) == std::string_view::npos &&
            !text_.substr(at_).starts_with("\\left"))
            put("\u2009", style);
    }

    // "0072b2}{": the part of a colour behind its sign, and the brace of its group.
    std::uint32_t color() {
        std::uint32_t value = 0;
        const char* const digits = text_.data() + at_;
        const std::size_t end = at_ + 6;
        if (end > text_.size() || std::from_chars(digits, digits + 6, value, 16).ptr != digits + 6)
            fail("a colour has six digits");
        at_ = end;
        if (!take("}{")) fail("a colour is followed by its text in braces");
        return value;
    }

    void item(const Run& style) {
        Run changed = style;
        const bool script_here = math_ || (at_ + 1 < text_.size() && text_[at_ + 1] == '{');
        if (take("$")) {
            math_ = !math_;
        } else if (script_here && take("_")) {
            changed.script = -1;
            group(changed);
        } else if (script_here && take("^")) {
            changed.script = 1;
            group(changed);
        } else if (take("\\dot{")) {
            changed.dots = 1;
            sequence(changed, true);
        } else if (take("\\ddot{")) {
            changed.dots = 2;
            sequence(changed, true);
        } else if (take("\\r{")) {
            upright([&] { sequence(changed, true); });
        } else if (take("\\b{")) {
            changed.bold = true;
            sequence(changed, true);
        } else if (!math_ && take("\\faint{")) {
            faint_ = true;
            sequence(changed, true);
            faint_ = false;
        } else if (!math_ && take("\\color{#")) {
            changed.color = color();
            sequence(changed, true);
        } else {
            if (text_[at_] == '\\' && at_ + 1 < text_.size()) {
                ++at_;
                if (command(style)) return;
                if (math_ && take(",")) return put("\u2009", style);
            }
            one(style);
        }
    }

    std::string_view text_;
    std::size_t at_ = 0;
    static constexpr int kDeepest = 6;  // deeper ones are too small to read
    int depth_ = 0;
    bool math_ = false, upright_ = false, faint_ = false;
    std::vector<Run> runs_;
};

template <std::size_t N>
const std::string_view* find(const std::array<Pair, N>& table, std::string_view c) {
    const auto it = std::find_if(table.begin(), table.end(), [&](const Pair& p) { return p.first == c; });
    return it == table.end() ? nullptr : &it->second;
}

// Calls visit(character, rest of the text) for each character.
template <class Visit>
void each_character(std::string_view text, const Visit& visit) {
    while (!text.empty()) {
        const std::string_view c = next_character(text, 0);
        text.remove_prefix(c.size());
        visit(c, text);
    }
}

std::string latex_math(std::string_view text) {
    std::string out;
    each_character(text, [&](std::string_view c, std::string_view rest) {
        const std::string_view* known = find(kLatexMath, c);
        out += known ? *known : c;
        // A letter after a command would belong to its name.
        if (known && known->size() > 1 && known->front() == '\\' && known->back() != ' ' && !rest.empty()) out += ' ';
    });
    return out;
}

std::string latex_text(std::string_view text) {
    std::string out;
    each_character(text, [&](std::string_view c, std::string_view) {
        if (const std::string_view* known = find(kLatexText, c))
            out += *known;
        else if (const std::string_view* sign = find(kLatexMath, c))
            out += fmt::format("${}$", *sign);
        else
            out += c;
    });
    return out;
}

std::string latex_of(const std::vector<Run>& runs);

// LaTeX within a formula.
std::string latex_part(const std::vector<Run>& runs) {
    std::string out = latex_of(runs);
    std::erase(out, '$');
    return out;
}

std::string latex_run(const Run& run) {
    if (!run.under.empty()) return fmt::format("$\\frac{{{}}}{{{}}}$", latex_part(run.over), latex_part(run.under));
    if (!run.over.empty()) return fmt::format("$\\sqrt{{{}}}$", latex_part(run.over));
    std::string body = run.symbol ? latex_math(run.text) : latex_text(run.text);
    if (run.script == 0) {
        if (!run.symbol) return run.bold ? fmt::format("\\textbf{{{}}}", body) : body;
        if (run.dots) body = fmt::format("\\{}{{{}}}", run.dots == 1 ? "dot" : "ddot", body);
        return fmt::format("${}$", body);
    }
    if (!run.symbol) body = fmt::format("\\mathrm{{{}}}", latex_math(run.text));
    return fmt::format("${}{{{}}}$", run.script < 0 ? "_" : "^", body);
}

std::string latex_of(const std::vector<Run>& runs) {
    std::string out;
    for (const Run& run : runs) {
        const std::string piece = latex_run(run);
        // Joins formulas: "$x$$_{c}$" would start a displayed equation.
        if (out.ends_with("$") && !out.ends_with("\\$") && piece.starts_with("$")) {
            out.pop_back();
            out += piece.substr(1);
        } else {
            out += piece;
        }
    }
    return out;
}

constexpr std::array kSuperscripts{Pair{"0", "⁰"}, Pair{"1", "¹"}, Pair{"2", "²"}, Pair{"3", "³"},
                                   Pair{"4", "⁴"}, Pair{"5", "⁵"}, Pair{"6", "⁶"}, Pair{"7", "⁷"},
                                   Pair{"8", "⁸"}, Pair{"9", "⁹"}, Pair{"−", "⁻"}, Pair{"+", "⁺"}};
constexpr std::array kSubscripts{Pair{"0", "₀"}, Pair{"1", "₁"}, Pair{"2", "₂"}, Pair{"3", "₃"}, Pair{"4", "₄"},
                                 Pair{"5", "₅"}, Pair{"6", "₆"}, Pair{"7", "₇"}, Pair{"8", "₈"}, Pair{"9", "₉"}};

// In small letters if Unicode has all of them; else after `sign`, in parentheses unless it is a word or a number.
template <std::size_t N>
std::string script_text(std::string_view text, const std::array<Pair, N>& small, const char* sign) {
    std::string out;
    bool all = true, word = true, number = true;
    each_character(text, [&](std::string_view c, std::string_view rest) {
        const std::string_view* known = find(small, c);
        all = all && known;
        if (known) out += *known;
        const bool digit = std::isdigit(static_cast<unsigned char>(c[0])),
                   first = rest.size() + c.size() == text.size();
        word = word && (digit || is_letter(c));
        number = number && (digit || c == "." || (first && c == "−"));
    });
    if (all) return out;
    return word || number ? fmt::format("{}{}", sign, text) : fmt::format("{}({})", sign, text);
}

}  // namespace

std::string power_of_ten(int exponent) {
    return fmt::format("10^{{{}{}}}", exponent < 0 ? "−" : "", std::abs(exponent));
}

std::string escaped(std::string_view plain) {
    std::string out;
    for (const char c : plain) {
        if (c == '$' || c == '_' || c == '^' || c == '\\') out += '\\';
        out += c;
    }
    return out;
}

std::string xml(std::string_view text) {
    std::string out;
    for (const char c : text) switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            default:
                out += c;
        }
    return out;
}

std::vector<Run> parse_markup(std::string_view markup) {
    if (markup.empty()) return {};
    if (markup.find_first_of("$_^\\") == std::string_view::npos) return {{.text = std::string(markup)}};
    return Parser(markup).all();
}

std::string to_latex(std::string_view markup) { return latex_of(parse_markup(markup)); }

static std::string plain_of(const std::vector<Run>& runs);

// A part of a fraction, or what a root covers: in parentheses unless it is one symbol with its scripts, or one number.
static std::string plain_part(const std::vector<Run>& runs) {
    const std::string text = plain_of(runs);
    int symbols = 0;
    bool number = true, simple = true;
    for (const Run& run : runs) {
        simple = simple && run.over.empty();
        each_character(run.text, [&](std::string_view c, std::string_view) {
            const bool digit = std::isdigit(static_cast<unsigned char>(c[0])) || c == ".";
            number = number && digit;
            simple = simple && (digit || is_letter(c));
            symbols += run.script == 0;
        });
    }
    return simple && (number || symbols <= 1) ? text : fmt::format("({})", text);
}

// Whether a fraction beside this text needs a sign of multiplication.
static bool is_factor(std::string_view character) {
    return is_letter(character) || character == ")" || character == "(" || character == "√" ||
           std::isdigit(static_cast<unsigned char>(character[0]));
}

static std::string plain_of(const std::vector<Run>& runs) {
    std::string out;
    bool after_fraction = false, after_factor = false;
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const Run& run = runs[i];
        if (run.script != 0) {  // belongs to what it follows
            std::string text = run.text;
            while (i + 1 < runs.size() && runs[i + 1].script == run.script) text += runs[++i].text;
            out += run.script > 0 ? script_text(text, kSuperscripts, "^") : script_text(text, kSubscripts, "_");
            continue;
        }
        const bool fraction = !run.under.empty();
        std::string text = run.text;
        if (fraction)
            text = plain_part(run.over) + "/" + plain_part(run.under);
        else if (!run.over.empty())
            text = "√" + plain_part(run.over);
        if (text.empty()) continue;
        if ((after_fraction && (fraction || is_factor(next_character(text, 0)))) || (fraction && after_factor))
            out += "·";
        out += text;
        if (run.dots > 0) out += run.dots == 1 ? "\u0307" : "\u0308";
        const std::string_view last = last_character(text);
        after_fraction = fraction;
        after_factor = is_factor(last) && last != "(";
    }
    return out;
}

std::string to_plain(std::string_view markup) { return plain_of(parse_markup(markup)); }

}  // namespace beamcam::render
