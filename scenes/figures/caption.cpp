#include "scenes/figures/caption.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "render/draw/markup.hpp"
#include "render/plot/lang.hpp"
#include "render/plot/ticks.hpp"
#include "scenes/figures/axis_labels.hpp"
#include "sim/beam/drive.hpp"

namespace beamcam::scenes {
namespace {

std::string degrees(double angle, int digits) { return number(angle * 180 / M_PI, digits) + "°"; }

}  // namespace

std::string model_name(sim::ModelKind model, Lang lang) { return render::in(lang, name(model)); }

std::string shapes_name(sim::Basis basis, Lang lang) {
    return basis == sim::Basis::cantilever ? phrase(lang, "cantilever", "悬臂梁") : phrase(lang, "hub–beam", "轮毂–梁");
}

namespace {

// A statement of a caption. `parts`: the same in pieces, for figures that vary one of its numbers.
struct Fact {
    Fact(std::string what, std::vector<std::string> pieces = {}) : text(std::move(what)), parts(std::move(pieces)) {}
    std::string text;
    std::vector<std::string> parts;
};
using Facts = std::vector<Fact>;

// The model exact has its own polynomials in every basis.
std::string shapes_fact(const sim::Problem& p, Lang lang) {
    const int count = p.beam.modes;
    if (p.beam.model == sim::ModelKind::exact)
        return phrase(lang, "{} polynomial{} of the section's angle", "截面转角的 {} 个多项式", count,
                      count == 1 ? "" : "s");
    return phrase(lang, "{} {} mode{}", "{} 个{}模态", count, shapes_name(resolved_basis(p), lang),
                  count == 1 ? "" : "s");
}

Facts model_facts(const sim::Problem& p, Lang lang, const Varied& varied) {
    if (p.beam.model == sim::ModelKind::rigid && !varied.model) return {phrase(lang, "rigid beam", "刚性梁")};
    Facts out;
    if (!varied.model) out.push_back(phrase(lang, "model {}", "{}", model_name(p.beam.model, lang)));
    if (!varied.modes) out.push_back(shapes_fact(p, lang));
    const std::vector<double>& ratios = p.beam.damping_ratio;
    if (p.beam.kelvin_voigt) {
        out.push_back(fmt::format("$η$ = {} s", number(*p.beam.kelvin_voigt, 3)));
    } else if (std::ranges::all_of(ratios, [](double z) { return z == 0; })) {
        out.push_back(phrase(lang, "no structural damping", "无结构阻尼"));
    } else {
        std::vector<std::string> all;
        for (const double z : ratios) all.push_back(number(z, 3));
        out.push_back(fmt::format("$ζ$ = {}", fmt::join(all, ", ")));
    }
    return out;
}

Fact drive_fact(const sim::Drive& drive, render::SpeedUnit unit, Lang lang) {
    struct Visitor {
        render::SpeedUnit unit;
        Lang lang;
        Fact operator()(const sim::FreeDrive&) const { return phrase(lang, "hub turns freely", "轮毂自由转动"); }
        Fact operator()(const sim::ConstantTorque& d) const {
            return {phrase(lang, "hub torque $τ$ = {} N m", "轮毂力矩 $τ$ = {} N m", number(d.value, 4)),
                    {phrase(lang, "constant hub torque", "恒定轮毂力矩")}};
        }
        Fact operator()(const sim::HarmonicTorque& d) const {
            return {phrase(lang, "hub torque $τ$ = {} N m sin(2π $t$ {} Hz + {})",
                           "轮毂力矩 $τ$ = {} N m sin(2π $t$ {} Hz + {})", number(d.amplitude, 4),
                           number(d.frequency, 4), degrees(d.phase, 4)),
                    {phrase(lang, "sinusoidal hub torque", "正弦轮毂力矩")}};
        }
        Fact operator()(const sim::TorqueTable& d) const {
            return phrase(lang, "hub torque from a table of {} instants", "轮毂力矩由 {} 个时刻的表给定", d.t.size());
        }
        Fact operator()(const sim::ConstantSpeed& d) const {
            if (d.speed == 0) return phrase(lang, "hub held", "轮毂固定");
            return {phrase(lang, "hub driven at $\\dot{{θ}}$ = {}", "轮毂以 $\\dot{{θ}}$ = {} 转动",
                           angular_speed_text(d.speed, unit)),
                    {phrase(lang, "hub driven at constant speed", "轮毂匀速转动")}};
        }
        Fact operator()(const sim::SpinUp& d) const {
            return {phrase(lang, "hub spun up to {} within {} s", "轮毂在 {1} s 内加速至 {0}",
                           angular_speed_text(d.speed, unit), number(d.duration, 4)),
                    {phrase(lang, "hub spun up", "轮毂加速转动")}};
        }
        Fact operator()(const sim::AngleTable& d) const {
            return phrase(lang, "hub angle from a table of {} instants", "轮毂转角由 {} 个时刻的表给定", d.t.size());
        }
    };
    return std::visit(Visitor{unit, lang}, drive);
}

Facts start_facts(const sim::Problem& p, render::SpeedUnit unit, Lang lang) {
    using Shape = sim::InitialShape;
    if (p.initial.shape == Shape::resting)
        return {phrase(lang, "resting on the cam at the start", "初始时静置于凸轮上")};
    const bool prescribed = sim::is_prescribed(p.hub.drive), rigid = p.beam.model == sim::ModelKind::rigid;
    const double angle = prescribed ? sim::DriveLaw(p.hub.drive, p.initial.angle).motion(0).angle : p.initial.angle;
    Facts out{fmt::format("$θ$(0) = {}", degrees(angle, 6))};
    const double rate = p.initial.angular_velocity;
    if (!prescribed)
        out.push_back(rate == 0 ? phrase(lang, "released at rest", "由静止释放")
                                : fmt::format("$\\dot{{θ}}$(0) = {}", angular_speed_text(rate, unit)));
    const bool given = !p.initial.q.empty() || !p.initial.q_dot.empty();
    if (given)
        out.push_back(phrase(lang, "in a given shape at the start", "初始为给定挠形"));
    else if (!rigid)
        out.push_back(p.initial.shape == Shape::straight
                          ? phrase(lang, "straight at the start", "初始为直梁")
                          : phrase(lang, "deflected by its weight at the start", "初始为自重静挠形"));
    return out;
}

Facts cam_facts(const sim::Cam& c, render::SpeedUnit unit, Lang lang) {
    Facts out{
        {fmt::format("$C$ = ({}, {}) m", number(c.centre.x, 4), number(c.centre.y, 4)),
         {fmt::format("$C_x$ = {} m", number(c.centre.x, 4)), fmt::format("$C_y$ = {} m", number(c.centre.y, 4))}},
        fmt::format("$R$ = {} m", number(c.radius, 4)),
        fmt::format("$e$ = {} m", number(c.eccentricity, 4)),
        fmt::format("$ψ_{{0}}$ = {}", degrees(c.phase, 4))};
    if (c.speed == 0)
        out.push_back(phrase(lang, "cam at rest", "凸轮静止"));
    else
        out.push_back(c.speed > 0
                          ? phrase(lang, "$ω$ = {} clockwise", "$ω$ = {}（顺时针）", angular_speed_text(c.speed, unit))
                          : phrase(lang, "$ω$ = {} (counter-clockwise)", "$ω$ = {}（逆时针）",
                                   angular_speed_text(c.speed, unit)));
    return out;
}

Fact friction_fact(const sim::Friction& friction, Lang lang) {
    if (const auto* c = std::get_if<sim::CoulombFriction>(&friction))
        return {fmt::format("$μ$ = {}", number(c->coefficient, 3)), {phrase(lang, "Coulomb friction", "库仑摩擦")}};
    if (const auto* s = std::get_if<sim::StickSlipFriction>(&friction))
        return {fmt::format("$μ$ = {} ({})", number(s->coefficient, 3), phrase(lang, "stick–slip", "黏滑")),
                {phrase(lang, "stick–slip friction", "黏滑摩擦")}};
    return phrase(lang, "no friction", "无摩擦");
}

Facts contact_facts(const sim::Problem& p, Lang lang) {
    Facts out;
    const std::string restitution = number(p.contact.restitution, 3);
    if (p.contact.model == sim::ContactModel::compliant) {
        const std::string stiffness = number(contact_stiffness(p), 4), exponent = number(p.contact.exponent, 3);
        out.push_back({fmt::format("$K$ = {} N m^{{−{}}}", stiffness, exponent),
                       {fmt::format("$K$ = {} N m^{{−$n$}}", stiffness), fmt::format("$n$ = {}", exponent)}});
        if (p.contact.damping == sim::DampingLaw::none)
            out.push_back(phrase(lang, "no dissipation in the contact", "接触无耗散"));
        else
            out.push_back({fmt::format("{} $c_{{\\r{{r}}}}$ = {}", name(p.contact.damping), restitution),
                           {name(p.contact.damping), fmt::format("$c_{{\\r{{r}}}}$ = {}", restitution)}});
    } else {
        out.push_back(phrase(lang, "impulsive contact ({})", "冲量接触（{}）", name(p.contact.law)));
        out.push_back(fmt::format("$c_{{\\r{{r}}}}$ = {}", restitution));
    }
    out.push_back(friction_fact(p.contact.friction, lang));
    const double d = contact_offset(p);
    out.push_back(d == 0 ? phrase(lang, "contact on the centre line", "接触发生在中心线上")
                         : phrase(lang, "contact face {} m off the centre line", "接触面距中心线 {} m", number(d, 4)));
    return out;
}

Facts beam_list(const Subject& of, const Varied& varied) {
    const auto& [p, units, lang, end] = of;
    const sim::Beam& b = p.beam;
    Facts out{fmt::format("$L$ = {} m", number(b.length, 4)), fmt::format("$A$ = {} m^{{2}}", number(b.area, 5)),
              fmt::format("$ρ$ = {} kg m^{{−3}}", number(b.density, 6))};
    if (b.model != sim::ModelKind::rigid || varied.model) {
        out.push_back(fmt::format("$I$ = {} m^{{4}}", number(b.second_moment, 5)));
        out.push_back(fmt::format("$E$ = {} Pa", number(b.youngs_modulus, 5)));
    }
    out.push_back(fmt::format("$g$ = {} m s^{{−2}}", number(p.gravity, 5)));
    out.push_back(fmt::format("$a$ = {} m", number(p.hub.radius, 4)));
    out.push_back(fmt::format("$I_{{\\r{{h}}}}$ = {} kg m^{{2}}", number(p.hub.inertia, 4)));
    out.push_back(drive_fact(p.hub.drive, units.speed, lang));
    for (const auto& more : {start_facts(p, units.speed, lang), model_facts(p, lang, varied)})
        out.insert(out.end(), more.begin(), more.end());
    return out;
}

Facts cam_list(const Subject& of, const Varied&) {
    if (!of.problem.cam) return {};
    Facts out = cam_facts(*of.problem.cam, of.units.speed, of.lang);
    for (Fact& fact : contact_facts(of.problem, of.lang)) out.push_back(std::move(fact));
    return out;
}

// The facts of the subject, or the parts of them, that the others share, separated by commas.
std::string shared(const Subject& of, const Varied& varied, Facts (*list)(const Subject&, const Varied&)) {
    std::vector<Facts> theirs;
    for (const sim::Problem& other : varied.others) theirs.push_back(list({other, of.units, of.lang}, varied));
    std::vector<std::string> out;
    for (const Fact& fact : list(of, varied)) {
        const auto all_have = [&](auto&& is_in) {
            return std::ranges::all_of(theirs, [&](const Facts& facts) { return std::ranges::any_of(facts, is_in); });
        };
        if (all_have([&](const Fact& other) { return other.text == fact.text; })) {
            out.push_back(fact.text);
            continue;
        }
        for (const std::string& part : fact.parts)
            if (all_have([&](const Fact& other) { return std::ranges::find(other.parts, part) != other.parts.end(); }))
                out.push_back(part);
    }
    return listed(out, of.lang);
}

// Equal in the digits that the paper prints.
bool as_printed(double value, double printed) { return std::abs(value - printed) <= 1e-4 * std::abs(printed); }

}  // namespace

std::string listed(const std::vector<std::string>& texts, Lang lang) {
    return fmt::format("{}", fmt::join(texts, phrase(lang, ", ", "，")));
}

std::string number(double value, int digits) {
    const std::string text = fmt::format("{:.{}g}", std::abs(value), digits);
    const std::string sign = value < 0 ? "−" : "";
    const std::size_t e = text.find('e');
    if (e == std::string::npos) return sign + text;
    const int exponent = std::stoi(text.substr(e + 1));
    const std::string power = render::power_of_ten(exponent);
    const std::string mantissa = text.substr(0, e);
    return sign + (mantissa == "1" ? power : mantissa + "×" + power);
}

std::string one_digit(double value) {
    const std::string text = fmt::format("{:.0e}", value);
    const std::size_t e = text.find('e');
    const std::string mantissa = text.substr(0, e), power = render::power_of_ten(std::stoi(text.substr(e + 1)));
    return mantissa == "1" ? power : mantissa + " × " + power;
}

std::string length_text(double metres) {
    return std::abs(metres) >= 0.01 || metres == 0 ? number(metres, 3) + " m" : render::quantity(metres, "m");
}

std::string angular_speed_text(double speed, render::SpeedUnit unit) {
    return with_unit(number(speed * render::factor_of(unit), 4), render::name_of(unit));
}

std::string grouped(double value, int decimals) {
    std::string text = render::fixed(value, decimals);
    const std::size_t point = text.find('.');
    if (point == std::string::npos) return text;
    std::string out = text.substr(0, point + 1);
    for (std::size_t i = point + 1; i < text.size(); ++i) {
        if (i > point + 1 && (i - point - 1) % 3 == 0) out += "\u2009";
        out += text[i];
    }
    return out;
}

std::string beam_facts(const Subject& of, const Varied& varied) {
    return phrase(of.lang, "Beam and hub: {}.", "梁与轮毂：{}。", shared(of, varied, beam_list));
}

std::string facts(const Subject& of, const Varied& varied) {
    const Lang lang = of.lang;
    if (!of.problem.cam) return beam_facts(of, varied);
    std::string text = beam_facts(of, varied) + phrase(lang, " ", "") +
                       phrase(lang, "Cam and contact: {}.", "凸轮与接触：{}。", shared(of, varied, cam_list));
    if (is_of_the_paper(of.problem) && std::ranges::all_of(varied.others, is_of_the_paper))
        text += phrase(lang,
                       " The paper prints neither $a$, $I_{\\r{h}}$, $e$, $ψ_{0}$ nor the constants of contact and "
                       "damping; these values are assumptions.",
                       "原文未给出 $a$、$I_{\\r{h}}$、$e$、$ψ_{0}$ 以及接触和阻尼常数，此处均为假定值。");
    return text;
}

// The paper does not print g; 9.81 m/s² reproduces its 0.37 s.
bool is_of_the_paper(const sim::Problem& p) {
    const sim::Beam& b = p.beam;
    const bool beam = b.length == 1 && as_printed(b.area, 7.2968e-5) && as_printed(b.second_moment, 8.2189e-9) &&
                      as_printed(b.density, 2766.7) && as_printed(b.youngs_modulus, 6.8952e10);
    const bool start = as_printed(p.initial.angle, M_PI / 4) && p.initial.angular_velocity == 0 &&
                       p.initial.shape == sim::InitialShape::straight && p.initial.q.empty() &&
                       p.initial.q_dot.empty() && as_printed(p.gravity, 9.81) &&
                       std::holds_alternative<sim::FreeDrive>(p.hub.drive);
    const bool cam = !p.cam || (p.cam->centre.x == 0.25 && p.cam->centre.y == 0 && as_printed(p.cam->radius, 0.1) &&
                                std::ranges::count(kPaperSpeeds, p.cam->speed) > 0);
    return beam && start && cam;
}

std::string accuracy(const Runs& runs, Lang lang) {
    if (runs.empty()) return phrase(lang, "Nothing is integrated for this figure.", "本图不需积分。");
    double rtol = 0, closure = 0;
    bool paper = false;
    for (const auto& [problem, result] : runs) {
        rtol = std::max(rtol, problem->solver.rtol);
        // The printed equation does not conserve energy, so its balance does not measure the integration.
        if (problem->beam.model == sim::ModelKind::paper)
            paper = true;
        else if (result->energy_scale > 0)
            closure = std::max(closure, result->energy_residual_max / result->energy_scale);
    }
    const std::string of = runs.size() == 1 ? "" : phrase(lang, " of each motion", "各运动的");
    const std::string but = paper ? phrase(lang, ", the model “paper” apart", "（论文模型除外）") : "";
    if (closure == 0) return phrase(lang, "Relative tolerance {}.", "相对容差 {}。", one_digit(rtol));
    return phrase(lang, "Relative tolerance {}; at the ends of steps the energy balance{} closes to {} of its scale{}.",
                  "相对容差 {}；{}能量平衡在各步末闭合到其尺度的 {}{}。", one_digit(rtol), of, one_digit(closure), but);
}

std::optional<sim::Problem> with_one_mode_fewer(const sim::Problem& problem) {
    if (problem.beam.model == sim::ModelKind::rigid) return std::nullopt;
    sim::Problem fewer = problem;
    const sim::Beam& beam = problem.beam;
    if (beam.modes > 1)
        set_shapes(fewer, beam.model, beam.basis, beam.modes - 1);
    else
        set_shapes(fewer, sim::ModelKind::rigid, beam.basis, beam.modes);
    return fewer;
}

int decimals_of(double error) {
    constexpr int kMost = 12;
    return error > 0 ? std::clamp(1 - static_cast<int>(std::floor(std::log10(error))), 0, kMost) : kMost;
}

Estimate estimate(const sim::Problem& problem, double value, std::optional<double> fewer) {
    // The errors of many steps add up to a few tolerances.
    const double integration = 10 * problem.solver.rtol * std::abs(value);
    if (problem.beam.model == sim::ModelKind::rigid) return {value, integration};
    constexpr double kUnknown = 0.05;  // of the value: one digit
    return {value, std::max(integration, fewer ? std::abs(value - *fewer) : kUnknown * std::abs(value))};
}

std::string supported(const Estimate& e) {
    constexpr int kMostDigits = 12;
    if (e.value == 0 || !std::isfinite(e.value)) return number(e.value, 1);
    const int leading = static_cast<int>(std::floor(std::log10(std::abs(e.value))));
    // The last digit is uncertain by one at most.
    const int last = e.error > 0 ? static_cast<int>(std::ceil(std::log10(e.error) - 1e-9)) : -kMostDigits;
    const int digits = std::clamp(leading - last + 1, 1, kMostDigits);
    const bool plain = leading >= -4 && leading < digits;
    return plain ? grouped(e.value, digits - 1 - leading) : number(e.value, digits);
}

std::string digits_stated(const sim::Problem& problem, Lang lang) {
    if (problem.beam.model == sim::ModelKind::rigid)
        return phrase(lang, "Numbers have the digits that the tolerance supports. ", "数值位数由容差确定。");
    return phrase(lang, "One shape function fewer changes the last digits by one at most. ",
                  "减少一个形函数时，数值末位至多改变 1。");
}

}  // namespace beamcam::scenes
