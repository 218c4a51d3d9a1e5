// One collision in close-up, with its impacts.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenes/figures/axis_labels.hpp"
#include "scenes/figures/figure_types.hpp"

namespace beamcam::scenes {
namespace {

using render::Axis;

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
std::string collision_caption(const Subject& subject, const sim::Collision& c, int which, const sim::Result* fewer) {
    const auto& [problem, units, lang, end] = subject;
    const sim::Collision* other = fewer ? collision_of(problem, *fewer, which) : nullptr;
    const auto digits = [&](double value, std::optional<double> otherwise) {
        return supported(estimate(subject.problem, value, otherwise));
    };
    std::string text = phrase(
        lang,
        "The {} collision in close-up: normal force $F$ (left) and penetration $δ$ (right), which is negative where "
        "beam and cam are apart, from the first touch at $t_{{1}}$ = {} s. The collision has {} impact{} (shaded{})",
        "{}碰撞的细部：法向力 $F$（左轴）与侵入量 $δ$（右轴，分离时为负），自首次接触 $t_{{1}}$ = {} s 起。该碰撞包含 "
        "{} "
        "次{}冲击（阴影{}）",
        lang == Lang::en ? ordinal(which)
        : which == 1     ? "首次"
                         : fmt::format("第 {} 次", which),
        digits(c.t_start, other ? std::optional(other->t_start) : std::nullopt), c.count,
        lang == Lang::en && c.count != 1 ? "s" : "",
        c.count == 1 ? ""
                     : phrase(lang, "; impacts less than {} s apart count as one collision",
                              "；间隔小于 {} s 者归为同一次碰撞", number(sim::collision_gap(problem), 3)));
    if (c.force_peak)
        text += phrase(lang, "; peak force {} N", "；峰值力 {} N",
                       digits(*c.force_peak, other ? other->force_peak : std::nullopt));
    text += phrase(lang, "; energy lost {} J{}. ", "；能量损失 {} J{}。",
                   digits(c.energy_lost, other ? std::optional(other->energy_lost) : std::nullopt),
                   c.t_end ? "" : phrase(lang, "; it lasts longer than the figure", "；至图末尚未结束"));
    return text + digits_stated(problem, lang) + facts(subject);
}

// Force and penetration from the collision's first touch, in units that suit them.
struct CloseUp {
    const sim::Collision& collision;
    double from, to, end;  // [s]
    Measure time, length;
    Series force, depth;  // depth: the penetration

    double after(double t) const { return (t - collision.t_start) * time.factor; }
};
CloseUp close_up(const sim::Collision& c, double end, const sim::Table& t, double deepest, Lang lang) {
    const double last = c.t_end.value_or(end), length = std::max(last - c.t_start, 1e-6);
    CloseUp out{c,
                std::max(0.0, c.t_start - 0.08 * length),
                std::min(end, last + 0.08 * length),
                end,
                measure_of("s", length),
                measure_of("m", deepest),
                {.label = phrase(lang, "force", "接触力")},
                {.label = phrase(lang, "penetration", "侵入量"), .look = 1, .right = true}};
    const auto &time = column(t, ChannelKind::t), &n = column(t, ChannelKind::contact_force),
               &gap = column(t, ChannelKind::gap);
    for (std::size_t i = 0; i < time.size(); ++i) {
        if (time[i] < out.from || time[i] > out.to) continue;
        out.force.add(out.after(time[i]), n[i]);
        out.depth.add(out.after(time[i]), -gap[i] * out.length.factor);
    }
    return out;
}

// Adds the peak, which rows coarser than the impact miss, beside the highest of them.
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

// Of the impacts of a collision [m].
double deepest(const sim::Result& result, int collision) {
    double most = 0;
    for (const sim::Impact& hit : result.impacts)
        if (hit.collision == collision) most = std::max(most, hit.penetration_peak);
    return most;
}

void reach_peaks(CloseUp& shown, int which, const sim::Result& result) {
    for (const sim::Impact& hit : result.impacts) {
        if (hit.collision != which || hit.t_start > shown.to) continue;
        const double begin = shown.after(hit.t_start), over = shown.after(hit.t_end.value_or(shown.end));
        if (hit.force_peak) reach_peak(shown.force, begin, over, *hit.force_peak);
        if (hit.penetration_peak > 0) reach_peak(shown.depth, begin, over, hit.penetration_peak * shown.length.factor);
    }
}

// Both axes have their zero at the same height. The limits follow the penetration, which a gap soon exceeds.
Axis close_up_axis(std::string label, const Series& curve) {
    double most = 0;
    for (const double v : curve.y)
        if (std::isfinite(v)) most = std::max(most, v);
    Axis axis{.label = std::move(label)};
    if (most > 0) axis.from = -0.25 * most, axis.to = 1.1 * most;
    return axis;
}

Panel close_up_panel(CloseUp shown, int which, const sim::Result& result, Lang lang) {
    Panel panel{.x = {.label = axis_label("($t$ − $t_{1}$)", shown.time.unit), .tight = true},
                .y = close_up_axis("$F$ / N", shown.force),
                .right = close_up_axis(axis_label("$δ$", shown.length.unit), shown.depth),
                .rules = {{.at = 0}},
                .legend = Legend::box};
    for (const sim::Impact& hit : result.impacts)
        if (hit.collision == which)
            panel.spans.push_back({shown.after(hit.t_start), shown.after(hit.t_end.value_or(shown.end)),
                                   phrase(lang, "impact {}", "冲击 {}", panel.spans.size() + 1)});
    panel.series = {std::move(shown.force), std::move(shown.depth)};
    return panel;
}

FigureDrawing prepare_collision(const Scene& scene, const FigureOutput& how, Studies& studies) {
    const std::size_t study = studies.of(scene.problem, scene.end_time);
    const auto fewer = study_with_one_mode_fewer(scene.problem, scene.end_time, studies);
    if (fewer) studies.stop_after(*fewer, {.collisions = static_cast<std::size_t>(how.collision) + 1});
    const std::size_t table = studies.curve(study, {0, scene.end_time, contact_rows(scene.end_time)}, {},
                                            {ChannelKind::contact_force, 0}, {sim::Channel{ChannelKind::gap}});
    return [=, number = how.collision](const Subject& subject, const Results& results) -> Figure {
        const auto& [problem, units, lang, end] = subject;
        const sim::Result& result = *results[study];
        const sim::Collision* c = collision_of(problem, result, number);
        if (!c) throw render::PictureError(no_collision(problem, result, number, end));
        const auto which = static_cast<int>(c - result.collisions.data());
        CloseUp shown = close_up(*c, end, result.tables[table], deepest(result, which), lang);
        reach_peaks(shown, which, result);
        return {.panels = {close_up_panel(std::move(shown), which, result, lang)},
                .aspect = 0.62,
                .caption = collision_caption(subject, *c, number, results.find(fewer)),
                .accuracy = accuracy({{&problem, &result}}, lang)};
    };
}

std::optional<std::string> needs_force(const Scene& scene) {
    if (auto why = needs_cam(scene)) return why;
    if (scene.problem.contact.model == sim::ContactModel::compliant) return std::nullopt;
    return "contact by restitution has impulses but no force that lasts; set contact.model to \"compliant\"";
}

}  // namespace

extern const FigureType kCollision{.name = "collision",
                                   .title = {"One collision in close-up", "一次碰撞的细部"},
                                   .refusal = needs_force,
                                   .maker = prepare_collision,
                                   .keys = {"collision"}};

}  // namespace beamcam::scenes
