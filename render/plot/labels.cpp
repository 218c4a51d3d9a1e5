#include "render/plot/labels.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <numbers>

#include "render/draw/markup.hpp"
#include "render/plot/ticks.hpp"

namespace beamcam::render {
namespace {

std::string equation(const char* symbol, const std::string& value) {
    return fmt::format("${}$\u2009=\u2009{}", symbol, value);
}

std::string contact_piece(const sim::Problem& problem, Lang lang) {
    if (problem.contact.model == sim::ContactModel::restitution)
        return phrase(lang, "impulses") + ", " +
               equation("c_{\\r{r}}", fmt::format("{:.3g}", problem.contact.restitution));
    const std::string k = equation("K", power_text(sim::contact_stiffness(problem)) +
                                            fmt::format("\u00A0N\u2009m^{{−{:.3g}}}", contact_exponent(problem)));
    if (problem.contact.damping == sim::DampingLaw::none) return k + ", " + phrase(lang, "elastic");
    return k + ", " + equation("c_{\\r{r}}", fmt::format("{:.3g}", problem.contact.restitution));
}

// Structural damping; empty: none.
std::string damping_piece(const sim::Beam& beam) {
    if (beam.model == sim::ModelKind::rigid) return {};
    if (beam.kelvin_voigt.value_or(0) > 0) return equation("η", quantity(*beam.kelvin_voigt, "s"));
    if (beam.damping_ratio.empty()) return {};
    const auto [least, most] = std::ranges::minmax(beam.damping_ratio);
    if (most == 0) return {};
    return equation("ζ", fmt::format("{:.3g}", least) + (most > least ? fmt::format(" … {:.3g}", most) : ""));
}

// "300 × 25 × 0.8 mm": lengths in the unit of the first.
std::string lengths_text(std::initializer_list<double> lengths) {
    const Prefix prefix = prefix_for(*lengths.begin());
    std::vector<std::string> numbers;
    for (const double each : lengths) numbers.push_back(fmt::format("{:.3g}", each / prefix.factor));
    return fmt::format("{}\u00A0{}m", fmt::join(numbers, "\u2009×\u2009"), prefix.symbol);
}

// Length and section; a rectangular beam is a product of three lengths.
std::string size_piece(const sim::Beam& beam) {
    std::string length = equation("L", quantity(beam.length, "m"));
    if (!beam.section) return length;
    if (const auto* s = std::get_if<sim::Rectangle>(&*beam.section))
        return lengths_text({beam.length, s->width, s->height});
    if (const auto* s = std::get_if<sim::Circle>(&*beam.section))
        return length + ", ⌀\u2009" + quantity(s->diameter, "m");
    if (const auto* s = std::get_if<sim::Tube>(&*beam.section))
        return length + ", ⌀\u2009" + lengths_text({s->diameter, s->wall});
    return length;
}

struct FrictionPiece {
    Lang lang;
    std::string operator()(const sim::NoFriction&) const { return phrase(lang, "frictionless"); }
    std::string operator()(const sim::CoulombFriction& f) const {
        return equation("μ", fmt::format("{:.3g}", f.coefficient));
    }
    std::string operator()(const sim::StickSlipFriction& f) const {
        std::string text = equation("μ", fmt::format("{:.3g}", f.coefficient));
        if (f.static_coefficient.value_or(f.coefficient) != f.coefficient)
            text += fmt::format(", $μ$_{{s}}\u2009=\u2009{:.3g}", *f.static_coefficient);
        return text + ", " + phrase(lang, "stick–slip");
    }
};

// The drive of the hub; empty: free.
struct DrivePiece {
    Lang lang;
    SpeedUnit unit;
    std::string operator()(const sim::FreeDrive&) const { return {}; }
    std::string operator()(const sim::ConstantTorque& d) const {
        return phrase(lang, "torque {}", quantity(d.value, "N\u2009m"));
    }
    std::string operator()(const sim::HarmonicTorque& d) const {
        return phrase(lang, "torque {}", "±" + quantity(std::abs(d.amplitude), "N\u2009m")) + ", " +
               quantity(d.frequency, "Hz");
    }
    std::string operator()(const sim::TorqueTable&) const { return phrase(lang, "torque by table"); }
    std::string operator()(const sim::ConstantSpeed& d) const {
        return d.speed == 0 ? phrase(lang, "hub held") : phrase(lang, "hub at {}", turning_speed(d.speed, unit));
    }
    std::string operator()(const sim::SpinUp& d) const {
        return phrase(lang, "hub to {} in {}", turning_speed(d.speed, unit), quantity(d.duration, "s"));
    }
    std::string operator()(const sim::AngleTable&) const { return phrase(lang, "hub by table"); }
};

}  // namespace

double factor_of(SpeedUnit unit) {
    return unit == SpeedUnit::rpm ? 30 / std::numbers::pi : unit == SpeedUnit::degrees ? 180 / std::numbers::pi : 1;
}

const char* name_of(SpeedUnit unit) {
    return unit == SpeedUnit::rpm ? "rpm" : unit == SpeedUnit::degrees ? "°/s" : "rad/s";
}

std::string turning_speed(double speed, SpeedUnit unit) {
    const double value = std::abs(speed * factor_of(unit));
    // Ordinary numbers need no prefix.
    if (factor_of(unit) == 1 && value != 0 && (value < 1e-3 || value >= 1e4)) return quantity(speed, "rad/s");
    std::string number = fmt::format("{:.3g}", value);
    if (number.find('e') != std::string::npos) number = fmt::format("{:.0f}", value);
    return (speed < 0 ? "−" : "") + number + (unit == SpeedUnit::degrees ? "" : "\u00A0") + name_of(unit);
}

std::string power_text(double value) {
    if (value == 0) return "0";
    const int exponent = static_cast<int>(std::floor(std::log10(std::abs(value))));
    if (exponent >= -2 && exponent <= 4) return fmt::format("{:.6g}", value);
    const std::string mantissa = fmt::format("{:.3g}", value / std::pow(10.0, exponent));
    return mantissa == "1" ? power_of_ten(exponent) : mantissa + "·" + power_of_ten(exponent);
}

std::vector<std::string> parameter_pieces(const sim::Problem& problem, Lang lang, SpeedUnit unit) {
    std::vector<std::string> out;
    out.push_back(size_piece(problem.beam));
    if (problem.beam.material) out.push_back(phrase(lang, sim::name(*problem.beam.material)));
    if (problem.cam) {
        if (!problem.cam->profile) {
            out.push_back(equation("R", quantity(problem.cam->radius, "m")));
            out.push_back(equation("e", quantity(problem.cam->eccentricity, "m")));
        }
        if (problem.cam->speed != 0) out.push_back(equation("ω", turning_speed(problem.cam->speed, unit)));
    }
    const bool rigid = problem.beam.model == sim::ModelKind::rigid;
    out.push_back(phrase(lang, rigid ? "rigid beam" : sim::name(problem.beam.model)));
    if (!rigid) out.push_back(phrase(lang, problem.beam.modes == 1 ? "{} mode" : "{} modes", problem.beam.modes));
    if (std::string damping = damping_piece(problem.beam); !damping.empty()) out.push_back(std::move(damping));
    if (problem.hub.radius != 0) out.push_back(equation("a", quantity(problem.hub.radius, "m")));
    if (problem.hub.inertia != 0)
        out.push_back(equation("I_{\\r{h}}", power_text(problem.hub.inertia) + "\u00A0kg\u2009m²"));
    if (std::string drive = std::visit(DrivePiece{lang, unit}, problem.hub.drive); !drive.empty())
        out.push_back(std::move(drive));
    if (problem.gravity == 0)
        out.push_back(phrase(lang, "no gravity"));
    else if (const double usual = sim::Problem{}.gravity; std::abs(problem.gravity - usual) > 1e-3 * usual)
        out.push_back(equation("g", power_text(problem.gravity) + "\u00A0m/s²"));
    if (problem.cam) {
        out.push_back(contact_piece(problem, lang));
        out.push_back(std::visit(FrictionPiece{lang}, problem.contact.friction));
        if (const double offset = sim::contact_offset(problem); offset > 0)
            out.push_back(phrase(lang, "face offset {}", quantity(offset, "m")));
    }
    return out;
}

static std::string without_spaces(const std::string& markup) {
    std::string text = to_plain(markup);
    for (const std::string_view space : {" ", "\u00A0", "\u2009"})
        for (std::size_t at = 0; (at = text.find(space, at)) != std::string::npos;) text.erase(at, space.size());
    return text;
}

std::vector<std::string> compared_pieces(const std::vector<const sim::Problem*>& problems,
                                         const std::vector<std::string>& labels, Lang lang, SpeedUnit unit) {
    std::vector<std::vector<std::string>> all;
    for (const sim::Problem* each : problems) all.push_back(parameter_pieces(*each, lang, unit));
    const auto is_common = [&](const std::string& piece) {
        return std::ranges::all_of(all, [&](const auto& its) { return std::ranges::count(its, piece) > 0; });
    };
    std::vector<std::string> out;
    std::ranges::copy_if(all.front(), std::back_inserter(out), is_common);
    for (std::size_t m = 0; m < all.size(); ++m) {
        std::vector<std::string> own;
        for (const std::string& piece : all[m]) {
            const std::string text = without_spaces(piece), value = text.substr(text.find('=') + 1),
                              label = without_spaces(labels[m]);
            const bool said = label.find(value) != std::string::npos || (label.size() > 2 && value.starts_with(label));
            if (!is_common(piece) && !said) own.push_back(piece);
        }
        if (!own.empty()) out.push_back(fmt::format("{}: {}", labels[m], fmt::join(own, ", ")));
    }
    return out;
}

// Up to rounding.
static bool same_speed(double one, double other) { return std::abs(one - other) <= 1e-6 * other; }

bool steady_speed(const std::vector<double>& speeds) {
    const double fastest = speeds.empty() ? 0 : std::ranges::max(speeds);
    return std::ranges::all_of(speeds, [&](double speed) { return speed == 0 || same_speed(speed, fastest); });
}

std::string speed_text(double speed, bool steady, Lang lang) {
    if (speed == 0) return phrase(lang, "frozen");
    if (std::abs(speed - 1) < (steady ? 0.005 : 0.05)) return {};
    const auto rounded = [](double value, int digits) {  // without an exponent
        const double unit = ten_to(static_cast<int>(std::floor(std::log10(value))) + 1 - digits);
        return std::round(value / unit) * unit;
    };
    if (speed > 1) return phrase(lang, "{} speed", fmt::format("{:.7g}×", rounded(speed, 2)));
    double slower = 1 / speed;
    const double whole = std::round(slower);
    if (same_speed(1 / whole, speed))
        slower = whole;
    else if (steady && speed < 0.01)
        slower = rounded(slower, 3);
    else if (steady)
        return phrase(lang, "{} speed", fmt::format("{:.3g}×", speed));
    else
        slower = slower < 2 ? 1.5 : round_down_125(slower);
    return phrase(lang, "{} speed", slower == 1.5 ? "2/3" : fmt::format("1/{:.7g}", slower));
}

std::string widest_speed_text(const std::vector<double>& speeds, Lang lang) {
    std::string widest;
    const bool steady = steady_speed(speeds);
    for (double speed : speeds)
        if (std::string text = speed_text(speed, steady, lang); text.size() > widest.size()) widest = std::move(text);
    return widest;
}

// A still shows a round instant with all its digits, that of an event with four.
static int decimals_of_still(double t) {
    constexpr int kMost = 6, kOfEvents = 4;
    for (int decimals = 1; decimals <= kMost; ++decimals) {
        const double scaled = t * std::pow(10.0, decimals);
        if (std::abs(scaled - std::round(scaled)) < 1e-6) return decimals;
    }
    return std::clamp(kOfEvents - 1 - static_cast<int>(std::floor(std::log10(std::abs(t)))), 0, kOfEvents);
}

// The last digit changes by about one a frame: of a second four decimals at most, 9 is a nanosecond.
static int decimals_of_frames(const std::vector<double>& times, double unit, double span) {
    // Steps of few frames are ignored, and those of rounding: the beginnings and ends of freezes.
    std::vector<double> steps;
    for (std::size_t i = 1; i < times.size(); ++i)
        if (times[i] - times[i - 1] > 1e-9 * span) steps.push_back(times[i] - times[i - 1]);
    const auto rare = static_cast<std::ptrdiff_t>(steps.size() / 20);
    std::ranges::nth_element(steps, steps.begin() + rare);
    const double step = steps[static_cast<std::size_t>(rare)];
    return std::clamp(static_cast<int>(-std::lround(std::log10(step / unit))), 1, unit == 1 ? 4 : 9);
}

TimeFormat time_format(const std::vector<double>& times, double latest) {
    TimeFormat out;
    const double span = std::max({std::abs(times.front()), std::abs(times.back()), std::abs(latest)});
    if (span > 0 && span < 0.2) {
        const Prefix p = prefix_for(span);
        static constexpr struct { const char *prefix, *symbol; } kUnits[] = {{"m", "ms"}, {"µ", "µs"}, {"n", "ns"}};
        for (const auto& u : kUnits)
            if (std::string(p.symbol) == u.prefix) out.unit = p.factor, out.symbol = u.symbol;
    }
    out.decimals = times.back() == times.front() ? decimals_of_still(times.front() / out.unit)
                                                 : decimals_of_frames(times, out.unit, span);
    return out;
}

std::string clock_text(const TimeFormat& format, double t) {
    return fmt::format("$t$\u2009=\u2009{}\u00A0{}", fixed(t / format.unit, format.decimals), format.symbol);
}

}  // namespace beamcam::render
