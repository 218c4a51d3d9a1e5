#include "render/draw/markup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "render/draw/markup_signs.hpp"

namespace beamcam::render {
namespace {

// Upright in mathematics.
constexpr std::array<std::string_view, 11> kFunctions{"sin", "cos", "tan", "arcsin", "arccos", "arctan",
                                                      "exp", "ln",  "log", "min",    "max"};

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
        if (style.script == 0 && std::exchange(after_fraction_, false) && begins_factor(next_character(c, 0)))
            put("·", {});
        if (math_ && !upright_ && is_letter(c)) style.symbol = true;
        if (math_ && c == "-") c = "−";
        if (math_ && c == "'") c = "′";
        const bool joins = !runs_.empty() && style.dots == 0 && is_alike(runs_.back(), style);
        if (!joins) runs_.push_back(std::move(style));
        Run& run = runs_.back();
        run.text += c;
    }

    static bool is_alike(const Run& a, const Run& b) {
        return std::tie(a.symbol, a.script, a.dots, a.color) == std::tie(b.symbol, b.script, b.dots, b.color);
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

    static bool begins_factor(std::string_view c) { return is_letter(c) || is_digit(c) || c == "(" || c == "√"; }
    // Whether a fraction after this text needs a sign of multiplication.
    bool is_after_factor(int script) const {
        auto base = runs_.rbegin();
        while (script == 0 && base != runs_.rend() && base->script != 0) ++base;
        if (base == runs_.rend() || base->script != script) return false;
        const char* const end = base->text.data() + base->text.size();
        const std::string_view last = next_character(g_utf8_prev_char(end), 0);
        return is_letter(last) || is_digit(last) || last == ")";
    }

    // A fraction is a/b in one line, in parentheses before a script.
    void fraction(const Run& style) {
        if (std::exchange(after_fraction_, false) || is_after_factor(style.script))
            put("·", {.text = {}, .script = style.script});
        std::vector<Run> before = std::exchange(runs_, {});
        factor(style);
        put("/", style);
        factor(style);
        const std::vector<Run> inside = std::exchange(runs_, std::move(before));
        after_fraction_ = at_ >= text_.size() || (text_[at_] != '^' && text_[at_] != '_');
        add(inside, !after_fraction_, style);
    }

    void add(const std::vector<Run>& inside, bool in_parentheses, const Run& style) {
        if (in_parentheses) put("(", style);
        runs_.insert(runs_.end(), inside.begin(), inside.end());
        if (in_parentheses) put(")", style);
    }

    // Puts a part of a fraction, or what is under a root: in parentheses unless it is one symbol with its scripts, or
    // one number.
    void factor(const Run& style) {
        if (++depth_ > kDeepest) fail("fractions and roots can be nested at most six deep");
        std::vector<Run> before = std::exchange(runs_, {});
        group(style);
        const std::vector<Run> inside = std::exchange(runs_, std::move(before));
        --depth_;
        after_fraction_ = false;
        int symbols = 0;
        bool number = true, simple = true;
        for (const Run& run : inside)
            each_character(run.text, [&](std::string_view c, std::string_view) {
                const bool digit = is_digit(c) || c == ".";
                number = number && digit;
                simple = simple && (digit || is_letter(c));
                symbols += run.script == style.script;
            });
        add(inside, !(simple && (number || symbols <= 1)), style);
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
        if (name == "frac") {
            fraction(style);
            return true;
        }
        if (name == "sqrt") {
            put("√", style);
            factor(style);
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
        for (const SignPair& known : kLatexMath)
            if (known.second.substr(1) == name) {
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
    bool math_ = false, upright_ = false, after_fraction_ = false;
    std::vector<Run> runs_;
};

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

}  // namespace beamcam::render
