#include "render/plot/ticks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace beamcam::render {
namespace {

constexpr double kRoundingSlack = 1e-9;  // relative: forgives the rounding of computed bounds

double times_ten_to(double mantissa, int n) { return n >= 0 ? mantissa * ten_to(n) : mantissa / ten_to(-n); }

}  // namespace

double ten_to(int n) { return n >= 0 ? std::pow(10.0, n) : 1 / std::pow(10.0, -n); }

double round_down_125(double value) {
    const int n = static_cast<int>(std::floor(std::log10(value))) + 1;
    for (int k = n; k > n - 4; --k)
        for (double m : {5.0, 2.0, 1.0})
            if (times_ten_to(m, k) <= value * (1 + kRoundingSlack)) return times_ten_to(m, k);
    return value;
}

double round_up_125(double value) {
    const int n = static_cast<int>(std::floor(std::log10(value))) - 1;
    for (int k = n; k < n + 4; ++k)
        for (double m : {1.0, 2.0, 5.0})
            if (times_ten_to(m, k) >= value * (1 - kRoundingSlack)) return times_ten_to(m, k);
    return value;
}

Ticks multiples(double step, double low, double high) {
    Ticks out{.step = step, .decimals = 0, .values = {}};
    const double first = std::ceil(low / step - kRoundingSlack), last = std::floor(high / step + kRoundingSlack);
    for (int i = 0; first + i <= last; ++i) out.values.push_back((first + i) * step + 0.0);
    out.decimals = decimals_of(step);
    return out;
}

int decimals_of(double step) { return std::max(0, -static_cast<int>(std::floor(std::log10(step) + kRoundingSlack))); }

Ticks ticks(double low, double high, int most) {
    for (double step = round_up_125((high - low) / most);; step = round_up_125(step * 1.5))
        if (Ticks out = multiples(step, low, high); std::cmp_less_equal(out.values.size(), most)) return out;
}

std::string fixed(double value, int decimals) {
    std::string text = fmt::format("{:.{}f}", std::abs(value), decimals);
    const bool zero = text.find_first_of("123456789") == std::string::npos;
    return (value < 0 && !zero ? "−" : "") + text;
}

Prefix prefix_for(double largest) {
    static constexpr std::array<Prefix, 9> kPrefixes{{{"G", 1e9},
                                                      {"M", 1e6},
                                                      {"k", 1e3},
                                                      {"", 1},
                                                      {"m", 1e-3},
                                                      {"µ", 1e-6},
                                                      {"n", 1e-9},
                                                      {"p", 1e-12},
                                                      {"f", 1e-15}}};
    if (!(largest > 0)) return {"", 1};
    for (Prefix p : kPrefixes)
        if (largest >= p.factor * (1 - kRoundingSlack)) return p;
    return kPrefixes.back();
}

std::string quantity(double value, const char* unit, int digits) {
    return quantity(value, prefix_for(std::abs(value)), unit, digits);
}

std::string quantity(double value, Prefix p, const char* unit, int digits) {
    std::string number = fmt::format("{:.{}g}", std::abs(value) / p.factor, digits);
    if (number.find('e') != std::string::npos) number = fmt::format("{:.0f}", std::abs(value) / p.factor);
    return (value < 0 ? "−" : "") + number + "\u00A0" + p.symbol + unit;
}

std::string reading(double value, Prefix p, const char* unit) {
    const double shown = std::abs(value) / p.factor;
    if (!(shown > 0)) return quantity(value, p, unit, 3);
    const int decimals = shown < 0.9995 ? 3 : shown < 9.995 ? 2 : shown < 99.95 ? 1 : 0;
    return fixed(value / p.factor, decimals) + "\u00A0" + p.symbol + unit;
}

}  // namespace beamcam::render
