#include "sim/problem/dimension.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>
#include <utility>

namespace beamcam::sim {

bool same(const Dimension& a, const Dimension& b) {
    // Exponents are small decimals such as 1.5; 1e-9 covers their rounding.
    auto equal = [](double x, double y) { return std::abs(x - y) < 1e-9; };
    return equal(a.length, b.length) && equal(a.mass, b.mass) && equal(a.time, b.time) && equal(a.angle, b.angle);
}

std::string si_unit(const Dimension& d) {
    namespace dim = dimension;
    static constexpr std::pair<Dimension, std::string_view> kNames[] = {{dim::kNone, "1"},
                                                                        {dim::kPressure, "Pa"},
                                                                        {dim::kTorque, "N m"},
                                                                        {dim::kFrequency, "Hz"},
                                                                        {dim::kSpringStiffness, "N/m"},
                                                                        {dim::kTorsionStiffness, "N m/rad"},
                                                                        {dim::kTorsionDamping, "N m s/rad"}};
    for (const auto& [known, name] : kNames)
        if (same(d, known)) return std::string(name);
    if (d.mass == 1 && d.time == -2 && d.angle == 0 && d.length == 1) return "N";
    if (d.mass == 1 && d.time == -2 && d.angle == 0) return fmt::format("N/m^{:g}", 1 - d.length);
    std::string over, under;
    auto part = [](std::string& side, std::string_view symbol, double exponent) {
        if (!side.empty()) side += ' ';
        side += exponent == 1 ? std::string(symbol) : fmt::format("{}^{:g}", symbol, exponent);
    };
    const std::pair<std::string_view, double> bases[] = {
        {"kg", d.mass}, {"m", d.length}, {"rad", d.angle}, {"s", d.time}};
    for (const auto& [symbol, exponent] : bases) {
        if (exponent > 0) part(over, symbol, exponent);
        if (exponent < 0) part(under, symbol, -exponent);
    }
    if (under.empty()) return over;
    const bool several = under.find(' ') != std::string::npos;
    return fmt::format("{}/{}{}{}", over.empty() ? "1" : over, several ? "(" : "", under, several ? ")" : "");
}

}  // namespace beamcam::sim
