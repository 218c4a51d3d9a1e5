#include "scenes/figures/axis_labels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "render/draw/markup.hpp"
#include "render/plot/ticks.hpp"
#include "scenes/figures/caption.hpp"

namespace beamcam::scenes {

std::string symbol_of(const std::string& name) {
    static const std::map<std::string, std::string> kSymbols{{"cam.speed", "$ω$"},
                                                             {"cam.eccentricity", "$e$"},
                                                             {"cam.radius", "$R$"},
                                                             {"contact.restitution", "$c_{\\r{r}}$"},
                                                             {"contact.stiffness", "$K$"},
                                                             {"gravity", "$g$"},
                                                             {"beam.length", "$L$"},
                                                             {"hub.drive.value", "$τ$"},
                                                             {"initial.angle", "$θ_{0}$"},
                                                             {"initial.angular_velocity", "$\\dot{θ}_{0}$"},
                                                             {"theta", "$θ$"},
                                                             {"theta_dot", "$\\dot{θ}$"},
                                                             {"v_n_before", "$v_{\\r{n}}$ before impact"},
                                                             {"v_n_after", "$v_{\\r{n}}$ after impact"},
                                                             {"contact_x", "$x_{\\r{c}}$"},
                                                             {"force_peak", "largest $F$"},
                                                             {"stress_peak", "largest $σ$"},
                                                             {"gap_peak", "largest $g$"},
                                                             {"rebound_peak", "fastest rebound"},
                                                             {"duration_peak", "longest contact"},
                                                             {"lift_share", "share without contact"},
                                                             {"cam_phase", "cam phase"},
                                                             {"t", "$t$"}};
    if (const auto found = kSymbols.find(name); found != kSymbols.end()) return found->second;
    return render::escaped(name);
}

std::string key_text(const std::string& key) {
    const std::string symbol = symbol_of(key), words = render::escaped(words_of(key));
    return symbol.starts_with('$') ? words + " " + symbol : words;
}

// "rad/s" becomes "rad s^{−1}", "kg m^2" "kg m^{2}".
static std::string print_unit(const std::string& unit) {
    const std::size_t slash = unit.find('/');
    std::string over = unit.substr(0, slash);
    if (const std::size_t power = over.find('^'); power != std::string::npos)
        over = fmt::format("{}^{{{}}}", over.substr(0, power), over.substr(power + 1));
    if (slash == std::string::npos) return over;
    const std::string under = unit.substr(slash + 1);
    const std::size_t power = under.find('^');
    return fmt::format("{}{}^{{−{}}}", over == "1" ? "" : over + " ", under.substr(0, power),
                       power == std::string::npos ? "1" : under.substr(power + 1));
}

std::string axis_label(const std::string& symbol, const std::string& unit) {
    if (unit.empty() || unit == "1") return symbol;
    std::string printed = print_unit(unit);
    if (printed.find(' ') != std::string::npos) printed = "(" + printed + ")";
    return symbol.empty() ? printed : fmt::format("{} / {}", symbol, printed);
}

std::string with_unit(const std::string& number, const std::string& unit) {
    if (unit.empty() || unit == "1") return number;
    return number + (unit.starts_with("°") ? "" : " ") + print_unit(unit);
}

std::string value_label(const std::string& symbol, double value, const std::string& unit) {
    return fmt::format("{} = {}", symbol, with_unit(fmt::format("{:g}", value), unit));
}

Measure measure_in(const render::Units& units, const std::string& si_unit) {
    const double factor = units.factor(si_unit);
    return {factor, factor == 1 ? si_unit : units.unit(si_unit)};
}

Measure measure_in(const AxisUnit& unit) {
    const bool degrees = unit.name == "deg" || unit.name.starts_with("deg/");
    return {1 / unit.si, degrees ? "°" + unit.name.substr(3) : unit.name};
}

Measure measure_of(const std::string& unit, double largest) {
    const auto is_unit = [&](const char* each) { return unit == each; };
    const bool prefixed = std::ranges::any_of(std::array{"m", "N", "J", "s", "Pa", "W"}, is_unit);
    const render::Prefix prefix = render::prefix_for(prefixed && largest > 0 && std::isfinite(largest) ? largest : 1);
    return {1 / prefix.factor, prefix.symbol + unit};
}

Measure measure_of(const std::string& unit, double largest, const render::Units& units) {
    const Measure shown = measure_in(units, unit);
    return shown.factor == 1 ? measure_of(unit, largest) : shown;
}

double largest_magnitude(const std::vector<double>& values) {
    double out = 0;
    for (const double v : values)
        if (std::isfinite(v)) out = std::max(out, std::abs(v));
    return out;
}

}  // namespace beamcam::scenes
