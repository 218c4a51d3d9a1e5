#include "scenes/figures/key_label.hpp"

#include <fmt/format.h>

#include <map>

#include "sim/problem/number_keys.hpp"

namespace beamcam::scenes {

std::string symbol_of(const std::string& name) {
    static const std::map<std::string, std::string> kSymbols{{"cam.speed", "$ω$"},
                                                             {"cam.eccentricity", "$e$"},
                                                             {"cam.radius", "$R$"},
                                                             {"contact.restitution", "$c_{\\r{r}}$"},
                                                             {"contact.stiffness", "$K$"},
                                                             {"gravity", "$g$"},
                                                             {"beam.length", "$L$"},
                                                             {"initial.angle", "$θ_{0}$"},
                                                             {"initial.angular_velocity", "$\\dot{θ}_{0}$"},
                                                             {"theta", "$θ$"},
                                                             {"theta_dot", "$\\dot{θ}$"},
                                                             {"v_n_before", "$v_{n}$ before impact"},
                                                             {"v_n_after", "$v_{n}$ after impact"},
                                                             {"contact_x", "$x_{\\r{c}}$"},
                                                             {"cam_phase", "cam phase"},
                                                             {"t", "$t$"}};
    if (const auto found = kSymbols.find(name); found != kSymbols.end()) return found->second;
    std::string escaped;
    for (const char c : name) escaped += c == '_' ? std::string("\\_") : std::string(1, c);
    return escaped;
}

std::string print_unit(const std::string& unit) {
    const std::size_t slash = unit.find('/');
    if (slash == std::string::npos) return unit;
    const std::string over = unit.substr(0, slash), under = unit.substr(slash + 1);
    const std::size_t power = under.find('^');
    const std::string below =
        fmt::format("{}^{{−{}}}", under.substr(0, power), power == std::string::npos ? "1" : under.substr(power + 1));
    return over == "1" ? below : fmt::format("({} {})", over, below);
}

std::string axis_label(const std::string& symbol, const std::string& unit) {
    if (unit.empty() || unit == "1") return symbol;
    return symbol.empty() ? print_unit(unit) : fmt::format("{} / {}", symbol, print_unit(unit));
}

std::string key_label(const std::string& key, const sim::Problem& problem) {
    if (const auto known = sim::number_key(problem, key)) return axis_label(symbol_of(key), si_unit(known->dimension));
    return symbol_of(key);
}

}  // namespace beamcam::scenes
