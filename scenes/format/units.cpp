#include "scenes/format/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "output/files/numbers.hpp"
#include "output/json/tree.hpp"
#include "scenes/format/absent.hpp"
#include "scenes/format/suggest.hpp"

namespace beamcam::scenes {
namespace {

using std::numbers::pi;

struct NamedUnit {
    std::string_view name;
    double factor;  // to SI, together with `decades`
    Dimension dimension;
    int decades;             // power of ten, separate so that "36.8 mm" is exactly the double 0.0368
    int most_decades = -10;  // of its largest prefix: "MM" is no megametre, and "Grad" a German degree
};

// A product of units: value · 10^decades.
struct Scaled {
    double value = 1;
    double decades = 0;
    Dimension dimension;
};

// Factors are exact by definition (SI brochure, 9th ed.; inch and pound: the 1959 yard and pound agreement).
constexpr NamedUnit kUnits[] = {
    {"m", 1, {1, 0, 0, 0}, 0, 3},
    {"in", 0.0254, {1, 0, 0, 0}, 0},
    {"ft", 0.3048, {1, 0, 0, 0}, 0},
    {"g", 1, {0, 1, 0, 0}, -3, 3},
    {"t", 1, {0, 1, 0, 0}, 3},
    {"lb", 0.45359237, {0, 1, 0, 0}, 0},
    {"s", 1, {0, 0, 1, 0}, 0, 3},
    {"min", 60, {0, 0, 1, 0}, 0},
    {"h", 3600, {0, 0, 1, 0}, 0},
    {"Hz", 1, {0, 0, -1, 0}, 0, 9},
    {"rad", 1, {0, 0, 0, 1}, 0, -1},
    {"deg", pi / 180, {0, 0, 0, 1}, 0},
    {"°", pi / 180, {0, 0, 0, 1}, 0},
    {"rev", 2 * pi, {0, 0, 0, 1}, 0},
    {"turn", 2 * pi, {0, 0, 0, 1}, 0},
    {"turns", 2 * pi, {0, 0, 0, 1}, 0},
    {"rpm", 2 * pi / 60, {0, 0, -1, 1}, 0},
    {"N", 1, {1, 1, -2, 0}, 0, 9},
    {"lbf", 4.4482216152605, {1, 1, -2, 0}, 0},
    {"Pa", 1, {-1, 1, -2, 0}, 0, 9},
    {"bar", 1, {-1, 1, -2, 0}, 5},
    {"psi", 6894.757293168361, {-1, 1, -2, 0}, 0},
    {"J", 1, {2, 1, -2, 0}, 0, 9},
    {"W", 1, {2, 1, -3, 0}, 0, 9},
    {"%", 1, {}, -2},
};

struct Prefix {
    std::string_view name;
    int decades;
};
// Both code points of the micro sign (U+00B5, U+03BC) are in use.
constexpr Prefix kPrefixes[] = {{"n", -9}, {"u", -6}, {"µ", -6}, {"μ", -6}, {"m", -3},
                                {"c", -2}, {"d", -1}, {"k", 3},  {"M", 6},  {"G", 9}};

bool takes(const NamedUnit& unit, const Prefix& prefix) { return prefix.decades <= unit.most_decades; }

std::optional<Scaled> named(std::string_view symbol) {
    for (const NamedUnit& unit : kUnits)
        if (unit.name == symbol) return Scaled{unit.factor, double(unit.decades), unit.dimension};
    for (const NamedUnit& unit : kUnits)
        for (const Prefix& prefix : kPrefixes)
            if (takes(unit, prefix) && symbol.size() == prefix.name.size() + unit.name.size() &&
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
        for (const Prefix& prefix : kPrefixes)
            if (takes(unit, prefix) && prefix.name[0] > 0)
                symbols.push_back(std::string(prefix.name) + std::string(unit.name));
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

constexpr double kLargestExponent = 12;

// Other spellings of operators and exponents, as in copied texts: "mm²", "kg·m⁻³".
constexpr std::pair<const char*, const char*> kSpellings[] = {{"·", "*"}, {"⋅", "*"}, {"**", "^"}, {"⁻", "-"},
                                                              {"¹", "1"}, {"²", "2"}, {"³", "3"},  {"⁴", "4"}};

// A unit, or the reason why the text is none.
struct UnitText {
    std::optional<Scaled> unit;
    std::string problem;
};
UnitText no_unit(std::string problem) { return {std::nullopt, std::move(problem)}; }

// A symbol with its exponent: "N", "m^1.5", "s-1"; or "1", as in "1/s".
UnitText factor_in(std::string_view text, const Dimension* expected) {
    if (text.empty()) return no_unit("the unit ends too early");
    if (text == "1") return {Scaled{}, {}};
    const std::size_t end = std::min(text.find_first_of("^+-.0123456789"), text.size());
    const std::string_view symbol = text.substr(0, end);
    std::string_view exponent = text.substr(end);
    if (symbol.empty()) return no_unit(fmt::format("{} is not a unit", in_quotes(text)));
    const auto base = named(symbol);
    if (!base) {
        const std::string remedy = absent(symbol);
        return no_unit(fmt::format("unknown unit {}{}", in_quotes(symbol),
                                   remedy.empty() ? suggestion(symbol, symbols_of(expected)) : remedy));
    }
    Scaled factor;
    if (exponent.empty()) return {base, {}};
    if (exponent.starts_with('^')) exponent.remove_prefix(1);
    const auto power = output::number_in<double>(exponent);
    if (!power) return no_unit(fmt::format("{}: a number is missing in the exponent of the unit", in_quotes(text)));
    if (!(std::abs(*power) <= kLargestExponent))
        return no_unit(fmt::format("an exponent in the unit is beyond ±{:g}", kLargestExponent));
    multiply(factor, *base, *power);
    return {factor, {}};
}

// unit = factor { ( "*" | "/" | " " ) factor }
UnitText unit_in(std::string text, const Dimension* expected) {
    for (const auto& [other, usual] : kSpellings) replace_all(text, other, usual);
    Scaled product;
    std::string_view rest = text;
    for (bool divides = false, divided = false;;) {
        const std::size_t end = std::min(rest.find_first_of(" */"), rest.size());
        UnitText factor = factor_in(rest.substr(0, end), expected);
        if (!factor.unit) return factor;
        multiply(product, *factor.unit, divides ? -1 : 1);
        rest.remove_prefix(end);
        if (rest.empty()) return {product, {}};
        const std::string_view gap = rest.substr(0, rest.find_first_not_of(" */"));
        const auto signs = gap.size() - static_cast<std::size_t>(std::ranges::count(gap, ' '));
        if (signs > 1) return no_unit(fmt::format("{} stands where one sign belongs in the unit", in_quotes(gap)));
        divides = gap.find('/') != std::string_view::npos;
        if (divided && signs == 0) return no_unit("a space after a division is ambiguous; write \"*\" or \"/\"");
        divided = divided || divides;
        rest.remove_prefix(gap.size());
    }
}

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
    if (unit.starts_with(',')) return {std::nullopt, "the decimal sign is a point"};
    const UnitText scale = unit_in(std::string(unit), expected);
    if (!scale.unit) return {std::nullopt, scale.problem};
    const std::string_view number(digits.data(), static_cast<std::size_t>(end - digits.data()));
    const Quantity quantity{scaled_number(number, value, *scale.unit), scale.unit->dimension};
    if (!std::isfinite(quantity.value)) return {std::nullopt, "the value is out of the range of a double"};
    return {quantity, {}};
}

std::optional<double> factor_between(std::string_view unit, std::string_view other) {
    const auto of = [](std::string_view one) { return parse_quantity(fmt::format("1 {}", one)).quantity; };
    const auto from = of(unit), to = of(other);
    return from && to && same(from->dimension, to->dimension) ? std::optional(from->value / to->value) : std::nullopt;
}

}  // namespace beamcam::scenes
