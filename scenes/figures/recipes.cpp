#include "scenes/figures/recipes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "render/ticks.hpp"

namespace beamcam::scenes {
namespace {

const std::array kRecipes{&kSchematic, &kFreeFall, &kTipVibration,  &kDeflection, &kDistance,  &kAngle, &kSpeeds,
                          &kCollision, &kEnergy,   &kContactPlaces, &kPhase,      &kApexModes, &kModels};

const std::vector<Recipe>& table() {
    static const std::vector<Recipe> all = [] {
        std::vector<Recipe> made;
        for (const Recipe* recipe : kRecipes) made.push_back(*recipe);
        return made;
    }();
    return all;
}

// 2e-9 as "2 × 10^{−9}", 1e-8 as "10^{−8}".
std::string one_digit(double value) {
    const std::string text = fmt::format("{:.0e}", value);
    const std::string mantissa = text.substr(0, text.find('e'));
    const int exponent = std::stoi(text.substr(text.find('e') + 1));
    const std::string power = fmt::format("10^{{{}{}}}", exponent < 0 ? "−" : "", std::abs(exponent));
    return mantissa == "1" ? power : mantissa + " × " + power;
}

}  // namespace

std::span<const Recipe> recipes() { return table(); }

const Recipe* recipe_named(std::string_view name) {
    const auto it = std::find_if(table().begin(), table().end(), [&](const Recipe& r) { return name == r.name; });
    return it == table().end() ? nullptr : &*it;
}

std::optional<std::string> needs_cam(const Scene& scene) {
    if (scene.problem.cam) return std::nullopt;
    return "the scene has no cam (\"cam\": null); give it one";
}

std::optional<std::string> needs_free_hub(const Scene& scene) {
    if (!sim::is_prescribed(scene.problem.hub.drive)) return std::nullopt;
    return "the hub's motion is prescribed, so it cannot fall; set hub.drive to {\"type\": \"free\"}";
}

sim::Problem without_cam(sim::Problem problem) {
    problem.cam.reset();
    return problem;
}

sim::Problem rigid(sim::Problem problem) {
    problem.beam.model = sim::ModelKind::rigid;
    return problem;
}

std::string number(double value, int digits) {
    const std::string text = fmt::format("{:.{}g}", std::abs(value), digits);
    const std::string sign = value < 0 ? "−" : "";
    const std::size_t e = text.find('e');
    if (e == std::string::npos) return sign + text;
    const int exponent = std::stoi(text.substr(e + 1));
    const std::string power = fmt::format("10^{{{}{}}}", exponent < 0 ? "−" : "", std::abs(exponent));
    const std::string mantissa = text.substr(0, e);
    return sign + (mantissa == "1" ? power : mantissa + "×" + power);
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

std::vector<double> scaled(std::vector<double> values, double factor) {
    for (double& v : values) v *= factor;
    return values;
}

namespace {

std::string beam_words(const sim::Problem& p, Lang lang) {
    const bool en = lang == Lang::en;
    if (p.beam.model == sim::ModelKind::rigid) return en ? "rigid beam" : "刚性梁";
    return en ? fmt::format("model {}, {} {} mode{}", name(p.beam.model), p.beam.modes, name(resolved_basis(p)),
                            p.beam.modes == 1 ? "" : "s")
              : fmt::format("模型 {}，{} 阶 {} 模态", name(p.beam.model), p.beam.modes, name(resolved_basis(p)));
}

std::string damping_words(const sim::Problem& p, Lang lang) {
    const bool en = lang == Lang::en;
    if (p.beam.kelvin_voigt) return fmt::format("$η$ = {} s", number(*p.beam.kelvin_voigt, 3));
    const std::vector<double>& ratios = p.beam.damping_ratio;
    if (std::all_of(ratios.begin(), ratios.end(), [](double z) { return z == 0; }))
        return en ? "no structural damping" : "无结构阻尼";
    std::vector<std::string> all;
    for (const double z : ratios) all.push_back(number(z, 3));
    return fmt::format("$ζ$ = {}", fmt::join(all, ", "));
}

std::string friction_words(const sim::Problem& p, Lang lang) {
    const bool en = lang == Lang::en;
    if (const auto* c = std::get_if<sim::CoulombFriction>(&p.contact.friction))
        return fmt::format("$μ$ = {}", number(c->coefficient, 3));
    if (const auto* s = std::get_if<sim::StickSlipFriction>(&p.contact.friction))
        return fmt::format("$μ$ = {} ({})", number(s->coefficient, 3), en ? "stick–slip" : "黏滑");
    return en ? "no friction" : "无摩擦";
}

}  // namespace

std::string assumptions(const sim::Problem& p, Lang lang) {
    const bool en = lang == Lang::en;
    const sim::Beam& b = p.beam;
    std::vector<std::string> out{fmt::format("$L$ = {} m", number(b.length, 4)),
                                 fmt::format("$A$ = {} m^{{2}}", number(b.area, 5)),
                                 fmt::format("$I$ = {} m^{{4}}", number(b.second_moment, 5)),
                                 fmt::format("$ρ$ = {} kg m^{{−3}}", number(b.density, 6)),
                                 fmt::format("$E$ = {} Pa", number(b.youngs_modulus, 5)),
                                 fmt::format("$g$ = {} m s^{{−2}}", number(p.gravity, 5)),
                                 fmt::format("$θ$(0) = {}°", number(p.initial.angle * 180 / M_PI, 6)),
                                 fmt::format("$a$ = {} m", number(p.hub.radius, 4)),
                                 fmt::format("$I_{{\\r{{h}}}}$ = {} kg m^{{2}}", number(p.hub.inertia, 4)),
                                 beam_words(p, lang)};
    if (b.model != sim::ModelKind::rigid) out.push_back(damping_words(p, lang));
    return filled(en ? "Beam: {}." : "梁：{}。", fmt::join(out, en ? ", " : "，"));
}

std::string stated(const sim::Problem& p, Lang lang) {
    if (!p.cam) return assumptions(p, lang);
    const bool en = lang == Lang::en;
    const sim::Cam& c = *p.cam;
    std::vector<std::string> out{
        fmt::format("$C$ = ({}, {}) m", number(c.centre.x, 4), number(c.centre.y, 4)),
        fmt::format("$R$ = {} m", number(c.radius, 4)), fmt::format("$e$ = {} m", number(c.eccentricity, 4)),
        fmt::format("$ψ_{{0}}$ = {}°", number(c.phase * 180 / M_PI, 4)),
        filled(en ? "$ω$ = {} rad s^{{−1}} clockwise" : "$ω$ = {} rad s^{{−1}}（顺时针）", number(c.speed, 4))};
    if (p.contact.model == sim::ContactModel::compliant) {
        out.push_back(
            fmt::format("$K$ = {} N m^{{−{}}}", number(contact_stiffness(p), 4), number(p.contact.exponent, 3)));
        out.push_back(
            fmt::format("{} $c_{{\\r{{r}}}}$ = {}", name(p.contact.damping), number(p.contact.restitution, 3)));
    } else {
        out.push_back(
            filled(en ? "impulsive contact ({}), $c_{{\\r{{r}}}}$ = {}" : "冲量接触（{}），$c_{{\\r{{r}}}}$ = {}",
                   name(p.contact.law), number(p.contact.restitution, 3)));
    }
    out.push_back(friction_words(p, lang));
    const double d = contact_offset(p);
    out.push_back(d == 0 ? (en ? "contact on the centre line" : "接触发生在中心线上")
                         : filled(en ? "contact face {} m off the centre line" : "接触面距中心线 {} m", number(d, 4)));
    const std::string beam = assumptions(p, lang) + (en ? " " : "");
    return beam + filled(en ? "Cam and contact: {}. The paper prints neither $a$, $I_{{\\r{{h}}}}$, $e$, $ψ_{{0}}$ nor "
                              "the contact's and damping's constants; these values are assumptions."
                            : "凸轮与接触：{}。原文未给出 $a$、$I_{{\\r{{h}}}}$、$e$、$ψ_{{0}}$ "
                              "以及接触和阻尼常数，此处均为假定值。",
                         fmt::join(out, en ? ", " : "，"));
}

std::string accuracy(const std::vector<std::pair<const sim::Problem*, const sim::Result*>>& runs, Lang lang) {
    const bool en = lang == Lang::en;
    if (runs.empty()) return en ? "Nothing is integrated for this figure." : "本图不需积分。";
    double rtol = 0, closure = 0;
    bool paper = false;
    for (const auto& [problem, result] : runs) {
        rtol = std::max(rtol, problem->solver.rtol);
        // The printed equation conserves no energy; its ledger says nothing about the integration.
        if (problem->beam.model == sim::ModelKind::paper)
            paper = true;
        else if (result->energy_scale > 0)
            closure = std::max(closure, result->energy_residual_max / result->energy_scale);
    }
    const std::string but = paper ? (en ? ", the model “paper” apart" : "（模型 paper 除外）") : "";
    if (closure == 0) return filled(en ? "Relative tolerance {}." : "相对容差 {}。", one_digit(rtol));
    return filled(en ? "Relative tolerance {}; the energy ledger closes to {} of its scale{}."
                     : "相对容差 {}；能量账目闭合到其尺度的 {}{}。",
                  one_digit(rtol), one_digit(closure), but);
}

}  // namespace beamcam::scenes
