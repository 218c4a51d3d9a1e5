#include "scenes/figures/caption.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "output/json/tree.hpp"
#include "render/draw/markup.hpp"
#include "render/plot/ticks.hpp"
#include "scenes/figures/axis_labels.hpp"
#include "sim/problem/number_keys.hpp"

namespace beamcam::scenes {
namespace {

constexpr std::array kPaperSpeeds{0.0, 1.0, 5.0};  // of the cam in the paper's figure 6 [rad/s]

struct Parameters {
    const sim::Problem& problem;
    const render::Units& units;
    std::vector<std::string> differences = {};
};

// The value of a key in the text of a caption.
std::string caption_value(const Node& value, const std::string& path, const Parameters& of) {
    if (value.kind == Node::Kind::string) return render::escaped(value.text);
    if (value.kind == Node::Kind::number) {
        const auto key = sim::number_key(of.problem, path);
        const Measure shown = measure_of(key ? sim::si_unit(key->dimension) : "", std::abs(value.number), of.units);
        return value.number == 0 ? "0" : with_unit(number(shown.factor * value.number, 6), shown.unit);
    }
    if (value.kind != Node::Kind::array) return render::escaped(one_line(value));
    std::vector<std::string> items;
    for (const Node& item : value.items)
        items.push_back(caption_value(item, fmt::format("{}.{}", path, items.size()), of));
    return fmt::format("[{}]", fmt::join(items, ", "));
}

// Lists of more than four items, or of other items than numbers, have no value in a caption.
bool is_long(const Node& value) {
    return value.kind == Node::Kind::array &&
           (value.items.size() > 4 ||
            !std::ranges::all_of(value.items, [](const Node& item) { return item.kind == Node::Kind::number; }));
}

// "cam speed = 0", "no cam" or "own cam profile segments" of each key whose value is not that of `usual`, or zero if
// `usual` lacks it.
void add_differences(const Node& node, const Node* usual, const std::string& path, Parameters& out) {
    if (node.kind == Node::Kind::object) {
        for (const Member& member : node.members)
            add_differences(member.value, usual ? child(*usual, member.key) : nullptr,
                            path.empty() ? member.key : path + "." + member.key, out);
    } else if (usual ? one_line(node) != one_line(*usual) : node.kind != Node::Kind::number || node.number != 0) {
        const std::string words = words_of(path);
        out.differences.push_back(node.kind == Node::Kind::null ? "no " + words
                                  : is_long(node)               ? "own " + words
                                                  : fmt::format("{} = {}", words, caption_value(node, path, out)));
    }
}

Node caption_tree(const sim::Problem& problem) {
    Scene scene;
    scene.problem = problem;
    std::optional<double>& exponent = scene.problem.contact.exponent;
    exponent.reset();
    if (contact_exponent(problem) != contact_exponent(scene.problem)) exponent = contact_exponent(problem);
    if (problem.contact.offset) scene.problem.beam.depth.reset();  // it is only drawn
    std::vector<double>& damping = scene.problem.beam.damping_ratio;
    if (largest_magnitude(damping) == 0) damping.clear();
    return node_of(to_json(scene));
}

std::vector<std::string> differences(const sim::Problem& problem, const render::Units& units) {
    static const Node kUsual = caption_tree(sim::Problem{});
    Parameters out{problem, units};
    add_differences(caption_tree(problem), &kUsual, "", out);
    return out.differences;
}

// Equal in the digits that the paper prints.
bool as_printed(double value, double printed) { return std::abs(value - printed) <= 1e-4 * std::abs(printed); }

std::string caption_of(const std::vector<const sim::Problem*>& problems, const render::Units& units) {
    const std::string all = parameters(problems, units);
    if (!all.empty()) return fmt::format("Parameters: {}.", all);
    return problems.size() > 1 ? "All parameters that the motions share have their default values."
                               : "All parameters have their default values.";
}

bool has_paler_curves(const render::figure::Figure& figure) {
    return std::ranges::any_of(figure.panels, [](const render::figure::Panel& panel) {
        return std::ranges::any_of(panel.series, &render::figure::Series::faded);
    });
}

}  // namespace

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

int decimals_of(double error) {
    constexpr int kMost = 12;
    return error > 0 ? std::clamp(1 - static_cast<int>(std::floor(std::log10(error))), 0, kMost) : kMost;
}

std::string words_of(std::string key) {
    for (char& c : key)
        if (c == '.' || c == '_') c = ' ';
    return key;
}

std::string parameters(const std::vector<const sim::Problem*>& problems, const render::Units& units) {
    std::vector<std::string> shared = differences(*problems.front(), units);
    for (const sim::Problem* other : problems) {
        const std::vector<std::string> theirs = differences(*other, units);
        std::erase_if(shared, [&](const std::string& each) { return std::ranges::count(theirs, each) == 0; });
    }
    return fmt::format("{}", fmt::join(shared, ", "));
}

std::string accuracy(const Runs& runs) {
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
    if (closure == 0) return fmt::format("Relative tolerance {}.", one_digit(rtol));
    return fmt::format("Relative tolerance {}; at the ends of steps the energy balance{} closes to {} of its scale{}.",
                       one_digit(rtol), runs.size() == 1 ? "" : " of each motion", one_digit(closure),
                       paper ? ", the model “paper” apart" : "");
}

void add_caption(render::figure::Figure& figure, const Runs& runs, const render::Units& units) {
    std::vector<const sim::Problem*> problems;
    for (const auto& [problem, result] : runs) problems.push_back(problem);
    figure.caption = caption_of(problems, units);
    figure.accuracy = accuracy(runs);
    if (has_paler_curves(figure)) figure.accuracy += " Where curves are paler, $θ$ is not reproducible to 10^{−6} rad.";
}

void add_caption(render::figure::Figure& figure, const std::vector<sim::Problem>& problems,
                 const render::Units& units) {
    std::vector<const sim::Problem*> all;
    for (const sim::Problem& problem : problems) all.push_back(&problem);
    figure.caption = caption_of(all, units);
}

std::string title_with_panels(const std::string& title, const std::vector<render::figure::Panel>& panels) {
    std::vector<std::string> parts;
    for (const render::figure::Panel& panel : panels)
        if (!panel.letter.empty() && !panel.caption.empty())
            parts.push_back(fmt::format("({}) {}", panel.letter, panel.caption));
    return parts.empty() ? title : fmt::format("{}: {}", title, fmt::join(parts, "; "));
}

std::string whole_caption(const render::figure::Figure& figure) {
    std::string text = figure.title + ".";
    for (const std::string& sentence : {figure.caption, figure.accuracy})
        if (!sentence.empty()) text += " " + sentence;
    return text;
}

// The paper does not print g; 9.81 m/s² reproduces its 0.37 s.
bool is_of_the_paper(const sim::Problem& p) {
    const sim::Beam& b = p.beam;
    const auto [area, second_moment, c_max] = section_properties(b);
    const auto [density, youngs_modulus, poisson_ratio] = material_properties(b);
    const bool beam = b.length == 1 && as_printed(area, 7.2968e-5) && as_printed(second_moment, 8.2189e-9) &&
                      as_printed(density, 2766.7) && as_printed(youngs_modulus, 6.8952e10);
    const bool start = as_printed(p.initial.angle, M_PI / 4) && p.initial.angular_velocity == 0 &&
                       p.initial.shape == sim::InitialShape::straight && p.initial.q.empty() &&
                       p.initial.q_dot.empty() && as_printed(p.gravity, 9.81) &&
                       std::holds_alternative<sim::FreeDrive>(p.hub.drive);
    const bool cam = !p.cam || (p.cam->centre.x == 0.25 && p.cam->centre.y == 0 && as_printed(p.cam->radius, 0.1) &&
                                std::ranges::count(kPaperSpeeds, p.cam->speed) > 0);
    return beam && start && cam;
}

}  // namespace beamcam::scenes
