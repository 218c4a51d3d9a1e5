// The energy balance: what the parts are, what was lost and done, and how well the sum closes.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "scenes/figures/recipes.hpp"

namespace beamcam::scenes {
namespace {

using render::Scale;
using render::figure::Figure;
using render::figure::Legend;
using render::figure::Panel;
using render::figure::Series;
using sim::ChannelKind;

constexpr double kRounding = 1e-12;  // of the energy scale
constexpr int kEnergyPoints = 8001;  // to begin with

// One curve of the balance: the sum of some channels.
struct EnergyPart {
    Words words;
    std::vector<ChannelKind> kinds;
    bool always;  // even where it is zero throughout
};
const std::vector<EnergyPart>& energy_parts() {
    using Kind = ChannelKind;
    static const std::vector<EnergyPart> kParts{
        {{"kinetic", "动能"}, {Kind::energy_kinetic}, true},
        {{"potential", "重力势能"}, {Kind::energy_potential}, true},
        {{"bending and contact", "弯曲与接触能"}, {Kind::energy_elastic, Kind::energy_contact}, false},
        {{"lost", "损失"}, {Kind::loss_structural, Kind::loss_contact, Kind::loss_friction}, false},
        {{"work done on it", "外功"}, {Kind::work_cam, Kind::work_drive}, false}};
    return kParts;
}

// Without a cam the contact's channels are empty; they add nothing.
void add_channels(const sim::Table& t, const std::vector<ChannelKind>& kinds, std::vector<double>& sum) {
    for (const ChannelKind kind : kinds) {
        const std::vector<double>& v = column(t, kind);
        for (std::size_t i = 0; i < v.size(); ++i) sum[i] += std::isfinite(v[i]) ? v[i] : 0;
    }
}

Panel balance_panel(const sim::Table& t, Lang lang) {
    const std::vector<double>& time = column(t, ChannelKind::t);
    Panel panel;
    panel.y.label = "$E$ / J";
    panel.legend = Legend::box;
    panel.share = 2.2;
    std::vector<double> total(time.size(), 0), work(time.size(), 0);
    int look = 0;
    for (const EnergyPart& part : energy_parts()) {
        const bool is_work = &part == &energy_parts().back();
        add_channels(t, part.kinds, is_work ? work : total);
        std::vector<double> values(time.size(), 0);
        add_channels(t, part.kinds, values);
        if (!part.always && std::ranges::all_of(values, [](double v) { return v == 0; })) continue;
        Series& s = panel.series.emplace_back();
        s.label = part.words.in(lang);
        s.look = look++;
        s.x = time;
        s.y = std::move(values);
        s.weight = 0.75;
    }
    for (std::size_t i = 0; i < total.size(); ++i) total[i] -= work[i];
    Series& s = panel.series.emplace_back();
    s.label = lang == Lang::en ? "sum − work" : "总和 − 外功";
    s.look = 6;
    s.solid = true;
    s.x = time;
    s.y = std::move(total);
    return panel;
}

// Below `floor` it is rounding, another on every machine: the lower edge. Nothing where all of it is.
std::optional<Panel> closure_panel(const sim::Table& t, double floor) {
    Series residual;
    residual.x = column(t, ChannelKind::t);
    residual.weight = 0.75;
    double largest = 0;
    for (const double v : column(t, ChannelKind::energy_residual)) {
        residual.y.push_back(std::max(std::abs(v), floor));
        largest = std::max(largest, residual.y.back());
    }
    if (!(floor > 0 && largest > 10 * floor)) return std::nullopt;
    Panel panel;
    panel.letter = "b";
    panel.y.label = "|$ΔE$| / J";
    panel.y.scale = Scale::logarithmic;
    panel.y.from = floor;
    panel.legend = Legend::none;
    panel.series = {std::move(residual)};
    return panel;
}

std::string energy_caption(const Figure& figure, Lang lang) {
    const bool en = lang == Lang::en, both = figure.panels.size() > 1;
    std::vector<std::string> names;
    for (const Series& s : figure.panels.front().series) names.push_back(s.label);
    names.pop_back();  // the balance
    const Words closure{
        "(b) Magnitude of the change of that balance, which the exact solution keeps at zero; what is below "
        "10^{−12} of the largest energy is rounding and lies on the lower edge. ",
        "(b) 该平衡变化量的绝对值，精确解中恒为零；小于最大能量 10^{−12} 的部分属舍入误差，画在下边缘。"};
    return filled(en ? "Energy: {}{}; the black line is their balance. " : "能量：{}{}；黑线为其平衡。",
                  both ? "(a) " : "", fmt::format("{}", fmt::join(names, en ? ", " : "、"))) +
           (both ? closure.in(lang) : "");
}

FigureMaker prepare_energy(const Scene& scene, const FigureOutput& how, Studies& studies) {
    const Lang lang = how.lang;
    const double end = scene.end_time;
    const std::size_t study = studies.of(scene.problem, end, "energy");
    // The kinetic energy swings with whatever the beam does.
    const std::size_t table =
        studies.curve(study, {0, end, kEnergyPoints}, {}, {ChannelKind::energy_kinetic, 0},
                      {ChannelKind::energy_potential, ChannelKind::energy_elastic, ChannelKind::energy_contact,
                       ChannelKind::loss_structural, ChannelKind::loss_contact, ChannelKind::loss_friction,
                       ChannelKind::work_cam, ChannelKind::work_drive, ChannelKind::energy_residual});
    return [=, problem = scene.problem](const Results& results) {
        const sim::Result& result = *results[study];
        const sim::Table& t = result.tables[table];
        Figure figure;
        figure.name = "energy";
        figure.title = lang == Lang::en ? "Energy balance" : "能量账目";
        figure.panels = {balance_panel(t, lang)};
        if (auto closure = closure_panel(t, kRounding * result.energy_scale)) {
            figure.panels.front().letter = "a";
            figure.panels.push_back(std::move(*closure));
        }
        for (Panel& panel : figure.panels) panel.x.label = "$t$ / s", panel.x.from = 0, panel.x.to = end;
        figure.stack = figure.share_x = true;
        figure.aspect = 1.05;
        figure.caption = energy_caption(figure, lang) + facts(problem, lang);
        figure.accuracy = accuracy({{&problem, &result}}, lang);
        return figure;
    };
}

}  // namespace

const Recipe kEnergy{"energy", {"Energy balance", "能量账目"}, no_refusal, prepare_energy};

}  // namespace beamcam::scenes
