// One collision in close-up, with its impacts.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenes/figures/recipes.hpp"

namespace beamcam::scenes {
namespace {

using render::Axis;
using render::figure::Figure;
using render::figure::Legend;
using render::figure::Panel;
using render::figure::Series;
using sim::ChannelKind;

std::string no_collision(const sim::Problem& problem, const sim::Result& result, int number, double end) {
    const auto count = std::ranges::count_if(result.collisions, [&](const auto& c) { return strikes(problem, c); });
    if (count == 0) return fmt::format("figure collision: nothing strikes the cam before {:g} s; raise time.end", end);
    return fmt::format("figure collision: collision {} does not occur: there are {} before {:g} s", number, count, end);
}

// "first", "second", "11th".
std::string ordinal(int number) {
    static constexpr const char* kFirst[] = {"first", "second", "third", "fourth", "fifth"};
    if (number <= std::ssize(kFirst)) return kFirst[number - 1];
    const int last = number % 10;
    const bool teen = number / 10 % 10 == 1;
    return std::to_string(number) + (teen || last > 3 || last == 0 ? "th" : last == 1 ? "st" : last == 2 ? "nd" : "rd");
}

// The collision in numbers, in the digits that one mode fewer leaves.
std::string collision_caption(const sim::Problem& problem, const sim::Collision& c, int which, const sim::Result* fewer,
                              Lang lang) {
    const bool en = lang == Lang::en;
    const sim::Collision* other = fewer ? collision_of(problem, *fewer, which) : nullptr;
    const auto told = [&](double value, std::optional<double> otherwise) {
        return supported(estimate(problem, value, otherwise));
    };
    std::string text = filled(
        en ? "The {} collision in close-up: normal force $F$ (left) and penetration $δ$ (right), which is "
             "negative where beam and cam are apart, from the first touch at $t_{{1}}$ = {} s. The collision "
             "has {} impact{} (shaded{})"
           : "{}碰撞的细部：法向力 $F$（左轴）与侵入量 $δ$（右轴，分离时为负），自首次接触 $t_{{1}}$ = {} s "
             "起。该碰撞包含 {} 次{}冲击（阴影{}）",
        en           ? ordinal(which)
        : which == 1 ? "首次"
                     : fmt::format("第 {} 次", which),
        told(c.t_start, other ? std::optional(other->t_start) : std::nullopt), c.count, en && c.count != 1 ? "s" : "",
        c.count == 1 ? ""
                     : filled(en ? "; less than {} s apart they are one collision" : "；间隔小于 {} s 者归为同一次碰撞",
                              number(sim::collision_gap(problem), 3)));
    if (c.force_peak)
        text += filled(en ? "; peak force {} N" : "；峰值力 {} N",
                       told(*c.force_peak, other ? other->force_peak : std::nullopt));
    text += filled(en ? "; energy lost {} J{}. " : "；能量损失 {} J{}。",
                   told(c.energy_lost, other ? std::optional(other->energy_lost) : std::nullopt),
                   c.t_end ? "" : (en ? "; it lasts longer than the figure" : "；至图末尚未结束"));
    return text + digits_stated(problem, lang);
}

// Force and penetration from the collision's first touch, in milliseconds.
struct CloseUp {
    const sim::Collision& collision;
    double from, to, end;  // [s]
    Series force, depth;   // depth: the penetration [µm]

    double after(double t) const { return (t - collision.t_start) * 1e3; }
};
CloseUp close_up(const sim::Collision& c, double end, const sim::Table& t, Lang lang) {
    const double last = c.t_end.value_or(end), length = std::max(last - c.t_start, 1e-6);
    CloseUp out{c, std::max(0.0, c.t_start - 0.08 * length), std::min(end, last + 0.08 * length), end, {}, {}};
    out.force.label = lang == Lang::en ? "force" : "接触力";
    out.depth.label = lang == Lang::en ? "penetration" : "侵入量";
    out.depth.right = true;
    out.depth.look = 1;
    const auto &time = column(t, ChannelKind::t), &n = column(t, ChannelKind::contact_force),
               &gap = column(t, ChannelKind::gap);
    for (std::size_t i = 0; i < time.size(); ++i) {
        if (time[i] < out.from || time[i] > out.to) continue;
        out.force.x.push_back(out.after(time[i]));
        out.force.y.push_back(n[i]);
        out.depth.x.push_back(out.after(time[i]));
        out.depth.y.push_back(-gap[i] * 1e6);
    }
    return out;
}

// Rows that are coarser than an impact miss its peak, which lies next to the highest of them.
void reach_peak(Series& curve, double begin, double over, double peak) {
    std::size_t best = curve.x.size();
    for (std::size_t i = 0; i < curve.x.size(); ++i)
        if (curve.x[i] >= begin && curve.x[i] <= over && (best == curve.x.size() || curve.y[i] > curve.y[best]))
            best = i;
    double at = (begin + over) / 2;
    if (best < curve.x.size()) {
        if (curve.y[best] >= 0.995 * peak) return;
        const bool after = best + 1 < curve.x.size() && (best == 0 || curve.y[best + 1] > curve.y[best - 1]);
        const std::size_t beside = after ? best + 1 : best == 0 ? 0 : best - 1;
        at = std::clamp((2 * curve.x[best] + curve.x[beside]) / 3, begin, over);
    }
    const auto place = std::ranges::upper_bound(curve.x, at) - curve.x.begin();
    curve.x.insert(curve.x.begin() + place, at);
    curve.y.insert(curve.y.begin() + place, peak);
}

void reach_peaks(CloseUp& shown, int which, const sim::Result& result) {
    for (const sim::Impact& hit : result.impacts) {
        if (hit.collision != which || hit.t_start > shown.to) continue;
        const double begin = shown.after(hit.t_start), over = shown.after(hit.t_end.value_or(shown.end));
        if (hit.force_peak) reach_peak(shown.force, begin, over, *hit.force_peak);
        if (hit.penetration_peak > 0) reach_peak(shown.depth, begin, over, hit.penetration_peak * 1e6);
    }
}

// Zero lies at one height of both. Separated, the gap soon exceeds any penetration: the axis is the penetration's.
void fit_axis(Axis& axis, const Series& curve) {
    double most = 0;
    for (const double v : curve.y)
        if (std::isfinite(v)) most = std::max(most, v);
    if (most > 0) axis.from = -0.25 * most, axis.to = 1.1 * most;
}

Panel close_up_panel(CloseUp shown, int which, const sim::Result& result, Lang lang) {
    Panel panel;
    panel.legend = Legend::box;
    panel.x.label = "($t$ − $t_{1}$) / ms";
    panel.y.label = "$F$ / N";
    panel.right = Axis{.label = "$δ$ / µm"};
    fit_axis(*panel.right, shown.depth);
    fit_axis(panel.y, shown.force);
    panel.rules.push_back({.at = 0});
    int count = 0;
    for (const sim::Impact& hit : result.impacts) {
        if (hit.collision != which) continue;
        ++count;
        panel.spans.push_back({.from = shown.after(hit.t_start),
                               .to = shown.after(hit.t_end.value_or(shown.end)),
                               .label = (lang == Lang::en ? "impact " : "冲击 ") + std::to_string(count)});
    }
    panel.series = {std::move(shown.force), std::move(shown.depth)};
    return panel;
}

FigureMaker prepare_collision(const Scene& scene, const FigureOutput& how, Studies& studies) {
    const Lang lang = how.lang;
    const double end = scene.end_time;
    const std::size_t study = studies.of(scene.problem, end, "collision");
    std::optional<std::size_t> check;
    if (const auto fewer = with_one_mode_fewer(scene.problem)) {
        check = studies.of(*fewer, end, "collision");
        studies.may_fail(*check);
    }
    const std::size_t table =
        studies.curve(study, {0, end, contact_rows(end)}, {}, {ChannelKind::contact_force, 0}, {ChannelKind::gap});
    return [=, problem = scene.problem, number = how.collision](const Results& results) {
        const sim::Result& result = *results[study];
        const sim::Collision* c = collision_of(problem, result, number);
        if (!c) throw render::PictureError(no_collision(problem, result, number, end));
        const auto which = static_cast<int>(c - result.collisions.data());
        CloseUp shown = close_up(*c, end, result.tables[table], lang);
        reach_peaks(shown, which, result);
        Figure figure;
        figure.name = "collision";
        figure.title = lang == Lang::en ? "One collision in close-up" : "一次碰撞的细部";
        figure.panels = {close_up_panel(std::move(shown), which, result, lang)};
        figure.aspect = 0.62;
        figure.caption =
            collision_caption(problem, *c, number, check ? results[*check] : nullptr, lang) + facts(problem, lang);
        figure.accuracy = accuracy({{&problem, &result}}, lang);
        return figure;
    };
}

std::optional<std::string> needs_force(const Scene& scene) {
    if (auto why = needs_cam(scene)) return why;
    if (scene.problem.contact.model == sim::ContactModel::compliant) return std::nullopt;
    return "contact by restitution has impulses but no force that lasts; set contact.model to \"compliant\"";
}

}  // namespace

const Recipe kCollision{"collision", {"One collision in close-up", "一次碰撞的细部"}, needs_force, prepare_collision};

}  // namespace beamcam::scenes
