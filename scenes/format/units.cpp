#include "scenes/format/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "output/json/source.hpp"
#include "scenes/format/absent.hpp"
#include "scenes/format/suggest.hpp"

namespace beamcam::scenes {
namespace {

using std::numbers::pi;

struct NamedUnit {
    std::string_view name;
    double factor;  // to SI, together with `decades`
    Dimension dimension;
    int decades;  // power of ten, separate so that "36.8 mm" is exactly the double 0.0368
    bool takes_prefix = false;
};

// A product of units: value · 10^decades.
struct Scaled {
    double value = 1;
    double decades = 0;
    Dimension dimension;
};

// Factors are exact by definition (SI brochure, 9th ed.; inch and pound: the 1959 yard and pound agreement).
constexpr NamedUnit kUnits[] = {
    {"m", 1, {1, 0, 0, 0}, 0, true},
    {"in", 0.0254, {1, 0, 0, 0}, 0},
    {"ft", 0.3048, {1, 0, 0, 0}, 0},
    {"g", 1, {0, 1, 0, 0}, -3, true},
    {"t", 1, {0, 1, 0, 0}, 3},
    {"lb", 0.45359237, {0, 1, 0, 0}, 0},
    {"s", 1, {0, 0, 1, 0}, 0, true},
    {"min", 60, {0, 0, 1, 0}, 0},
    {"h", 3600, {0, 0, 1, 0}, 0},
    {"Hz", 1, {0, 0, -1, 0}, 0, true},
    {"rad", 1, {0, 0, 0, 1}, 0, true},
    {"deg", pi / 180, {0, 0, 0, 1}, 0},
    {"°", pi / 180, {0, 0, 0, 1}, 0},
    {"rev", 2 * pi, {0, 0, 0, 1}, 0},
    {"turn", 2 * pi, {0, 0, 0, 1}, 0},
    {"turns", 2 * pi, {0, 0, 0, 1}, 0},
    {"rpm", 2 * pi / 60, {0, 0, -1, 1}, 0},
    {"N", 1, {1, 1, -2, 0}, 0, true},
    {"lbf", 4.4482216152605, {1, 1, -2, 0}, 0},
    {"Pa", 1, {-1, 1, -2, 0}, 0, true},
    {"bar", 1, {-1, 1, -2, 0}, 5},
    {"psi", 6894.757293168361, {-1, 1, -2, 0}, 0},
    {"J", 1, {2, 1, -2, 0}, 0, true},
    {"W", 1, {2, 1, -3, 0}, 0, true},
    {"%", 1, {}, -2},
};

struct Prefix {
    std::string_view name;
    int decades;
};
// Both code points of the micro sign (U+00B5, U+03BC) are in use.
constexpr Prefix kPrefixes[] = {{"n", -9}, {"u", -6}, {"µ", -6}, {"μ", -6}, {"m", -3},
                                {"c", -2}, {"d", -1}, {"k", 3},  {"M", 6},  {"G", 9}};

std::optional<Scaled> named(std::string_view symbol) {
    for (const NamedUnit& unit : kUnits)
        if (unit.name == symbol) return Scaled{unit.factor, double(unit.decades), unit.dimension};
    for (const NamedUnit& unit : kUnits)
        for (const Prefix& prefix : kPrefixes)
            if (unit.takes_prefix && symbol.size() == prefix.name.size() + unit.name.size() &&
                symbol.starts_with(prefix.name) && symbol.ends_with(unit.name))
                return Scaled{unit.factor, double(unit.decades + prefix.decades), unit.dimension};
    return std::nullopt;
}

// The units of one dimension, its SI unit last, such as "N m"; or all units.
std::vector<std::string> symbols_of(const Dimension* dimension) {
    std::vector<std::string> symbols;
    for (const NamedUnit& unit : kUnits) {
        if (dimension && !same(unit.dimension, *dimension)) continue;
        symbols.emplace_back(unit.name);
        if (!unit.takes_prefix) continue;
        for (const Prefix& prefix : kPrefixes)
            if (prefix.name[0] > 0) symbols.push_back(std::string(prefix.name) + std::string(unit.name));
    }
    if (dimension) symbols.push_back(si_unit(*dimension));
    return symbols;
}

void multiply(Scaled& q, const Scaled& factor, double exponent) {
    q.value *= exponent == 1 ? factor.value : exponent == -1 ? 1 / factor.value : std::pow(factor.value, exponent);
    q.decades += exponent * factor.decades;
    q.dimension.length += exponent * factor.dimension.length;
    q.dimension.mass += exponent * factor.dimension.mass;
    q.dimension.time += exponent * factor.dimension.time;
    q.dimension.angle += exponent * factor.dimension.angle;
}

// number · scale. Whole decades shift the decimal point of the text, which is exact, instead of a multiplication.
double scaled_number(std::string_view digits, double value, const Scaled& scale) {
    if (scale.decades != std::round(scale.decades)) return value * scale.value * std::pow(10.0, scale.decades);
    constexpr double kMostDecades = 1e6;  // far beyond any double
    if (std::abs(scale.decades) > kMostDecades) return std::numeric_limits<double>::infinity();
    const std::size_t e = digits.find_first_of("eE");
    long long exponent = 0;
    if (e != std::string_view::npos) {
        std::string_view written = digits.substr(e + 1);
        if (written.starts_with('+')) written.remove_prefix(1);
        std::from_chars(written.data(), written.data() + written.size(), exponent);
    }
    const std::string shifted =
        fmt::format("{}e{}", digits.substr(0, e), exponent + static_cast<long long>(scale.decades));
    if (std::from_chars(shifted.data(), shifted.data() + shifted.size(), value).ec != std::errc{})
        return std::numeric_limits<double>::infinity();
    return value * scale.value;
}

// Recursive descent over   unit = factor { [ "*" | "·" | "/" ] factor },  factor = ( symbol | "(" unit ")" ) [ exponent
// ].
class UnitParser {
  public:
    UnitParser(std::string_view text, const Dimension* expected) : rest_(text), expected_(expected) {}

    // nullopt if the text is not a unit; `problem` has the reason.
    std::optional<Scaled> parse() {
        Scaled q;
        if (!product(q)) return std::nullopt;
        skip_spaces();
        if (rest_.empty()) return q;
        reject(fmt::format("unexpected {} after the unit", in_quotes(rest_)));
        return std::nullopt;
    }
    const std::string& problem() const { return problem_; }

  private:
    bool reject(std::string problem) {
        if (problem_.empty()) problem_ = std::move(problem);
        return false;
    }
    void skip_spaces() {
        while (rest_.starts_with(' ')) rest_.remove_prefix(1);
    }
    bool take(std::string_view token) {
        if (!rest_.starts_with(token)) return false;
        rest_.remove_prefix(token.size());
        return true;
    }

    bool product(Scaled& q) {
        if (depth_ > 8) return reject("the unit has too many parentheses");
        if (!factor(q, 1)) return false;
        bool divided = false;
        while (true) {
            skip_spaces();
            if (rest_.empty() || rest_.front() == ')') return true;
            const bool divides = take("/");
            const bool dot = !divides && (take("*") || take("·") || take("⋅"));
            if (divided && !divides && !dot)
                return reject("a space after a division is ambiguous; write \"*\", \"/\" or parentheses");
            divided = divided || divides;
            skip_spaces();
            if (!factor(q, divides ? -1 : 1)) return false;
        }
    }

    bool factor(Scaled& q, double sign) {
        Scaled base;
        if (take("(")) {
            ++depth_;
            if (!product(base)) return false;
            --depth_;
            skip_spaces();
            if (!take(")")) return reject("a \")\" is missing in the unit");
        } else if (take("1")) {  // "1/s"
        } else if (!symbol(base)) {
            return false;
        }
        double power = 1;
        if (!exponent(power)) return false;
        multiply(q, base, sign * power);
        return true;
    }

    bool symbol(Scaled& q) {
        std::size_t n = 0;
        while (n < rest_.size()) {
            const char c = rest_[n];
            const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '%';
            if (letter) {
                ++n;
            } else if (rest_.substr(n).starts_with("°") || rest_.substr(n).starts_with("µ") ||
                       rest_.substr(n).starts_with("μ")) {
                n += 2;
            } else {
                break;
            }
        }
        const std::string_view text = rest_.substr(0, n);
        if (text.empty())
            return reject(rest_.empty() ? "the unit ends too early"
                                        : fmt::format("{} is not a unit", in_quotes(rest_)));
        const auto found = named(text);
        if (!found) {
            const std::string remedy = absent_unit(text);
            return reject(fmt::format("unknown unit {}{}", in_quotes(text),
                                      remedy.empty() ? suggestion(text, symbols_of(expected_)) : remedy));
        }
        q = *found;
        rest_.remove_prefix(n);
        return true;
    }

    // "^1.5", "^(3/2)", "²", "⁻¹", or digits right behind the symbol: "m2", "s-1".
    bool exponent(double& power) {
        if (take("^") || take("**")) {
            const bool parenthesis = take("(");
            if (!number(power)) return reject("a number is missing after \"^\" in the unit");
            double below = 1;
            if (parenthesis && take("/")) {
                if (!number(below) || below == 0) return reject("a number is missing after \"/\" in the exponent");
            }
            if (parenthesis && !take(")")) return reject("a \")\" is missing in the exponent of the unit");
            power /= below;
            return true;
        }
        if (!rest_.empty() && (is_digit(rest_[0]) || (rest_.size() > 1 && rest_[0] == '-' && is_digit(rest_[1]))))
            return number(power);
        return superscript(power);
    }

    static bool is_digit(char c) { return c >= '0' && c <= '9'; }

    bool number(double& value) {
        const auto [end, error] =
            std::from_chars(rest_.data(), rest_.data() + rest_.size(), value, std::chars_format::fixed);
        if (error == std::errc::invalid_argument) return false;
        if (error != std::errc{} || !(std::abs(value) <= kLargestExponent)) return too_large();
        rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
        return true;
    }

    bool superscript(double& power) {
        static constexpr std::array<std::string_view, 10> kDigits = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
        const bool minus = take("⁻");
        double value = 0;
        int count = 0;
        for (; count < 3; ++count) {
            const auto digit = std::ranges::find_if(kDigits, [&](auto each) { return take(each); });
            if (digit == kDigits.end()) break;
            value = 10 * value + static_cast<double>(digit - kDigits.begin());
        }
        if (count == 0) return !minus || reject("a number is missing after \"⁻\" in the unit");
        if (value > kLargestExponent) return too_large();
        power = minus ? -value : value;
        return true;
    }

    bool too_large() { return reject(fmt::format("an exponent in the unit is beyond ±{:g}", kLargestExponent)); }

    static constexpr double kLargestExponent = 12;
    std::string_view rest_;
    const Dimension* expected_;  // of the units that messages suggest
    std::string problem_;
    int depth_ = 0;
};

}  // namespace

QuantityText parse_quantity(std::string_view text, const Dimension* expected) {
    while (text.starts_with(' ')) text.remove_prefix(1);
    while (text.ends_with(' ')) text.remove_suffix(1);
    std::string_view digits = text;
    if (digits.starts_with('+') && !digits.starts_with("+-")) digits.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error == std::errc::result_out_of_range) return {std::nullopt, "the number is out of the range of a double"};
    if (error != std::errc{} || !std::isfinite(value))
        return {std::nullopt, text.find(':') == text.npos ? "it does not begin with a number"
                                                          : "it does not begin with a number, and events are names of "
                                                            "single instants (\"at\", \"from\", \"to\")"};
    std::string_view unit(end, static_cast<std::size_t>(digits.data() + digits.size() - end));
    while (unit.starts_with(' ')) unit.remove_prefix(1);
    if (unit.empty()) return {Quantity{value, {}}, {}};
    UnitParser parser(unit, expected);
    const auto scale = parser.parse();
    if (!scale) return {std::nullopt, parser.problem()};
    const std::string_view number(digits.data(), static_cast<std::size_t>(end - digits.data()));
    const Quantity quantity{scaled_number(number, value, *scale), scale->dimension};
    if (!std::isfinite(quantity.value)) return {std::nullopt, "the value is out of the range of a double"};
    return {quantity, {}};
}

}  // namespace beamcam::scenes
