// Contact from near: one collision with its sub-impacts, the energy ledger, and where on beam and cam contact happens.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "scenes/figures/recipes.hpp"

namespace beamcam::scenes {
namespace {

using render::figure::Axis;
using render::figure::Figure;
using render::figure::Legend;
using render::figure::Panel;
using render::figure::Scale;
using render::figure::Series;
using sim::ChannelKind;

// Rows over the scene: an impact lasts a few tenths of a millisecond.
int fine(double end) { return static_cast<int>(std::clamp(end / 2e-5, 4e4, 4e5)) + 1; }
constexpr double kRounding = 1e-12;  // of the energy scale
constexpr int kEnergyPoints = 8001;  // to begin with

// Counted from 1; null: there are fewer.
const sim::Collision* collision_of(const sim::Problem& problem, const sim::Result& result, int number) {
    for (const sim::Collision& each : result.collisions)
        if (strikes(problem, each) && --number == 0) return &each;
    return nullptr;
}
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
                              number(problem.contact.collision_gap, 3)));
    if (c.force_peak)
        text += filled(en ? "; peak force {} N" : "；峰值力 {} N",
                       told(*c.force_peak, other ? other->force_peak : std::nullopt));
    text += filled(en ? "; energy lost {} J{}. " : "；能量损失 {} J{}。",
                   told(c.energy_lost, other ? std::optional(other->energy_lost) : std::nullopt),
                   c.t_end ? "" : (en ? "; it lasts longer than the figure" : "；至图末尚未结束"));
    return text + digits_stated(problem, lang);
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
        studies.curve(study, {0, end, fine(end)}, {}, {ChannelKind::contact_force, 0}, {ChannelKind::gap});
    return [=, problem = scene.problem, number = how.collision](const Results& results) {
        const bool en = lang == Lang::en;
        const sim::Result& result = *results[study];
        const sim::Collision* c = collision_of(problem, result, number);
        if (!c) throw render::PictureError(no_collision(problem, result, number, end));
        const auto which = static_cast<int>(c - result.collisions.data());
        const double last = c->t_end.value_or(end), length = std::max(last - c->t_start, 1e-6);
        const double from = std::max(0.0, c->t_start - 0.08 * length), to = std::min(end, last + 0.08 * length);
        const sim::Table& t = result.tables[table];
        Series force, depth;
        force.label = en ? "force" : "接触力";
        depth.label = en ? "penetration" : "侵入量";
        const auto &time = column(t, ChannelKind::t), &n = column(t, ChannelKind::contact_force),
                   &gap = column(t, ChannelKind::gap);
        for (std::size_t i = 0; i < time.size(); ++i) {
            if (time[i] < from || time[i] > to) continue;
            force.x.push_back((time[i] - c->t_start) * 1e3);
            force.y.push_back(n[i]);
            depth.x.push_back((time[i] - c->t_start) * 1e3);
            depth.y.push_back(-gap[i] * 1e6);
        }
        // Rows that are coarser than an impact miss its peak, which lies next to the highest of them.
        const auto reach = [&](Series& curve, const sim::Impact& hit, double peak) {
            const double begin = (hit.t_start - c->t_start) * 1e3, over = (hit.t_end.value_or(end) - c->t_start) * 1e3;
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
        };
        for (const sim::Impact& hit : result.impacts) {
            if (hit.collision != which || hit.t_start > to) continue;
            if (hit.force_peak) reach(force, hit, *hit.force_peak);
            if (hit.penetration_peak > 0) reach(depth, hit, hit.penetration_peak * 1e6);
        }
        Figure figure;
        figure.name = "collision";
        figure.title = en ? "One collision in close-up" : "一次碰撞的细部";
        Panel panel;
        panel.legend = Legend::box;
        panel.x.label = "($t$ − $t_{1}$) / ms";
        panel.y.label = "$F$ / N";
        panel.right = Axis{.label = "$δ$ / µm"};
        depth.right = true;
        depth.look = 1;
        // Separated, the gap soon exceeds any penetration; the axis is the penetration's.
        double deepest = 0;
        for (const double v : depth.y)
            if (std::isfinite(v)) deepest = std::max(deepest, v);
        double strongest = 0;
        for (const double v : force.y)
            if (std::isfinite(v)) strongest = std::max(strongest, v);
        if (deepest > 0) panel.right->from = -0.25 * deepest, panel.right->to = 1.1 * deepest;
        if (strongest > 0) panel.y.from = -0.25 * strongest, panel.y.to = 1.1 * strongest;
        panel.rules.push_back({.at = 0});
        int count = 0;
        for (const sim::Impact& hit : result.impacts) {
            if (hit.collision != which) continue;
            ++count;
            panel.spans.push_back({.from = (hit.t_start - c->t_start) * 1e3,
                                   .to = (hit.t_end.value_or(end) - c->t_start) * 1e3,
                                   .label = (en ? "impact " : "冲击 ") + std::to_string(count)});
        }
        panel.series = {force, depth};
        figure.panels.push_back(std::move(panel));
        figure.aspect = 0.62;
        figure.caption =
            collision_caption(problem, *c, number, check ? results[*check] : nullptr, lang) + facts(problem, lang);
        figure.accuracy = accuracy({{&problem, &result}}, lang);
        return figure;
    };
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
        const bool en = lang == Lang::en;
        const sim::Result& result = *results[study];
        const sim::Table& t = result.tables[table];
        const std::vector<double>& time = column(t, ChannelKind::t);
        Figure figure;
        figure.name = "energy";
        figure.title = en ? "Energy balance" : "能量账目";
        Panel ledger, closure;
        closure.letter = "b";
        ledger.x.label = closure.x.label = "$t$ / s";
        for (Panel* panel : {&ledger, &closure}) panel->x.from = 0, panel->x.to = end;
        ledger.y.label = "$E$ / J";
        closure.y.label = "|$ΔE$| / J";
        closure.y.scale = Scale::logarithmic;
        ledger.legend = Legend::box;
        closure.legend = Legend::none;
        ledger.share = 2.2;
        int look = 0;
        const auto sum = [&](std::initializer_list<ChannelKind> kinds) {
            std::vector<double> total(time.size(), 0);
            for (const ChannelKind kind : kinds) {
                const std::vector<double>& v = column(t, kind);
                // Without a cam the contact's channels are empty; they add nothing.
                for (std::size_t i = 0; i < v.size(); ++i) total[i] += std::isfinite(v[i]) ? v[i] : 0;
            }
            return total;
        };
        std::vector<std::string> parts;
        const auto add = [&](Words words, std::vector<double> values, bool always) {
            const bool zero = std::all_of(values.begin(), values.end(), [](double v) { return v == 0; });
            if (zero && !always) return;
            Series s;
            s.label = words.in(lang);
            parts.push_back(s.label);
            s.look = look++;
            s.x = time;
            s.y = std::move(values);
            s.weight = 0.75;
            ledger.series.push_back(std::move(s));
        };
        using Kind = ChannelKind;
        add({"kinetic", "动能"}, sum({Kind::energy_kinetic}), true);
        add({"potential", "重力势能"}, sum({Kind::energy_potential}), true);
        add({"bending and contact", "弯曲与接触能"}, sum({Kind::energy_elastic, Kind::energy_contact}), false);
        add({"lost", "损失"}, sum({Kind::loss_structural, Kind::loss_contact, Kind::loss_friction}), false);
        add({"work done on it", "外功"}, sum({Kind::work_cam, Kind::work_drive}), false);
        std::vector<double> total =
            sum({Kind::energy_kinetic, Kind::energy_potential, Kind::energy_elastic, Kind::energy_contact,
                 Kind::loss_structural, Kind::loss_contact, Kind::loss_friction});
        const std::vector<double> work = sum({Kind::work_cam, Kind::work_drive});
        for (std::size_t i = 0; i < total.size(); ++i) total[i] -= work[i];
        Series s;
        s.label = en ? "sum − work" : "总和 − 外功";
        s.look = 6;
        s.solid = true;
        s.x = time;
        s.y = std::move(total);
        ledger.series.push_back(std::move(s));
        Series residual;
        residual.x = time;
        residual.weight = 0.75;
        // Below this it is rounding, another on every machine: the lower edge.
        const double floor = kRounding * result.energy_scale;
        double largest = 0;
        for (const double v : column(t, Kind::energy_residual)) {
            residual.y.push_back(std::max(std::abs(v), floor));
            largest = std::max(largest, residual.y.back());
        }
        if (floor > 0 && largest > 10 * floor) {
            ledger.letter = "a";
            closure.y.from = floor;
            closure.series = {residual};
            figure.panels = {ledger, closure};
        } else {
            figure.panels = {ledger};
        }
        figure.stack = true;
        figure.share_x = true;
        const bool both = figure.panels.size() > 1;
        figure.aspect = 1.05;
        const Words closure_words{
            "(b) Magnitude of the change of that balance, which the exact solution keeps at zero; what is below "
            "10^{−12} of the largest energy is rounding and lies on the lower edge. ",
            "(b) 该平衡变化量的绝对值，精确解中恒为零；小于最大能量 10^{−12} 的部分属舍入误差，画在下边缘。"};
        figure.caption = filled(en ? "Energy: {}{}; the black line is their balance. " : "能量：{}{}；黑线为其平衡。",
                                both ? "(a) " : "", fmt::format("{}", fmt::join(parts, en ? ", " : "、")));
        if (both) figure.caption += closure_words.in(lang);
        figure.caption += facts(problem, lang);
        figure.accuracy = accuracy({{&problem, &result}}, lang);
        return figure;
    };
}

// The first collision alone, in which the place moves by less than its mark in the whole.
std::optional<render::figure::Inset> close_up(const sim::Collision& c, double end, const std::vector<double>& time,
                                              const std::vector<double>& force, const std::vector<double>& x,
                                              const Panel& whole, bool en) {
    Panel panel;
    panel.title = en ? "first collision" : "首次碰撞";
    panel.x.label = "($t$ − $t_{1}$) / ms";
    panel.x.tight = false;
    panel.legend = Legend::none;
    panel.color_bar = whole.color_bar;
    panel.color_bar->hidden = true;
    Series s;
    s.weight = 1.8;
    const double last = c.t_end.value_or(end);
    for (std::size_t i = 0; i < time.size(); ++i) {
        if (time[i] < c.t_start || time[i] > last) continue;
        const bool touching = force[i] > 0 && std::isfinite(x[i]);
        s.x.push_back((time[i] - c.t_start) * 1e3);
        s.y.push_back(touching ? x[i] * 1e3 : std::nan(""));
        s.value.push_back(touching ? force[i] : std::nan(""));
    }
    if (std::count_if(s.y.begin(), s.y.end(), [](double v) { return std::isfinite(v); }) < 2) return std::nullopt;
    panel.series = {std::move(s)};
    return render::figure::Inset{.panel = {std::move(panel)}, .width = 0.36, .height = 0.29};
}

// Impulses instead of forces: a point for each impact.
Figure impulsive_places(const sim::Problem& problem, const sim::Result& result, double end, Lang lang) {
    const bool en = lang == Lang::en;
    if (result.impacts.empty())
        throw render::PictureError(
            fmt::format("figure contact-places: nothing strikes the cam before {:g} s; raise time.end", end));
    Series s;
    s.line = false;
    s.every_point = true;
    for (const sim::Impact& hit : result.impacts) {
        s.x.push_back(hit.t_start);
        s.y.push_back(hit.x * 1e3);
        s.value.push_back(hit.impulse_n * 1e3);
    }
    Panel panel;
    panel.x.label = "$t$ / s";
    panel.x.from = 0;
    panel.x.to = end;
    panel.y.label = "$x_{\\r{c}}$ / mm";
    panel.legend = Legend::none;
    panel.color_bar = render::figure::ColorBar{
        .label = "$J$ / (mN s)", .from = 0, .to = *std::max_element(s.value.begin(), s.value.end())};
    panel.series = {std::move(s)};
    Figure figure;
    figure.name = "contact-places";
    figure.title = en ? "Contact point on the beam" : "梁上的接触点";
    figure.panels = {std::move(panel)};
    figure.caption =
        en ? "Place of the impacts on the beam, measured from its root, coloured by their normal impulse $J$. "
           : "各次冲击在梁上的位置（自根部量起），颜色表示法向冲量 $J$。";
    figure.caption += facts(problem, lang);
    figure.accuracy = accuracy({{&problem, &result}}, lang);
    return figure;
}

FigureMaker prepare_places(const Scene& scene, const FigureOutput& how, Studies& studies) {
    const Lang lang = how.lang;
    const double end = scene.end_time;
    const std::size_t study = studies.of(scene.problem, end, "contact-places");
    if (scene.problem.contact.model != sim::ContactModel::compliant)
        return [=, problem = scene.problem](const Results& results) {
            return impulsive_places(problem, *results[study], end, lang);
        };
    const std::size_t table =
        studies.table(study, {0, end, fine(end)},
                      {ChannelKind::t, ChannelKind::contact_force, ChannelKind::contact_x, ChannelKind::contact_s});
    return [=, problem = scene.problem](const Results& results) {
        const bool en = lang == Lang::en;
        const sim::Result& result = *results[study];
        const sim::Table& t = result.tables[table];
        const auto &time = column(t, ChannelKind::t), &n = column(t, ChannelKind::contact_force),
                   &x = column(t, ChannelKind::contact_x), &s = column(t, ChannelKind::contact_s);
        Figure figure;
        figure.name = "contact-places";
        figure.title = en ? "Contact point on beam and cam" : "梁与凸轮上的接触点";
        Series on_beam, on_cam;
        on_beam.line = on_cam.line = false;
        on_beam.every_point = on_cam.every_point = true;
        double strongest = 0;
        for (std::size_t i = 0; i < time.size(); ++i) {
            if (!(n[i] > 0) || !std::isfinite(x[i] + s[i])) continue;
            on_beam.x.push_back(time[i]);
            on_cam.x.push_back(time[i]);
            on_beam.y.push_back(x[i] * 1e3);
            on_cam.y.push_back(s[i] / problem.cam->radius * 180 / M_PI);
            on_beam.value.push_back(n[i]);
            strongest = std::max(strongest, n[i]);
        }
        if (on_beam.x.empty())
            throw render::PictureError(fmt::format(
                "figure contact-places: the beam does not touch the cam before {:g} s; raise time.end", end));
        on_cam.value = on_beam.value;
        // Strong contacts are drawn last, on top.
        for (Series* series : {&on_beam, &on_cam}) {
            std::vector<std::size_t> order(series->x.size());
            for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
            std::stable_sort(order.begin(), order.end(),
                             [&](std::size_t a, std::size_t b) { return series->value[a] < series->value[b]; });
            Series sorted = *series;
            for (std::size_t i = 0; i < order.size(); ++i) {
                sorted.x[i] = series->x[order[i]];
                sorted.y[i] = series->y[order[i]];
                sorted.value[i] = series->value[order[i]];
            }
            *series = std::move(sorted);
        }
        Panel beam, cam;
        beam.letter = "a";
        cam.letter = "b";
        beam.title = en ? "on the beam" : "梁上";
        cam.title = en ? "on the cam" : "凸轮上";
        beam.x.label = cam.x.label = "$t$ / s";
        beam.y.label = "$x_{\\r{c}}$ / mm";
        cam.y.label = "$s_{\\r{c}}$/$R$ / °";
        for (Panel* panel : {&beam, &cam}) {
            panel->x.from = 0;
            panel->x.to = end;
            panel->legend = Legend::none;
            panel->color_bar = render::figure::ColorBar{.label = "$F$ / N", .from = 0, .to = strongest};
        }
        beam.series = {on_beam};
        cam.series = {on_cam};
        if (const sim::Collision* first = collision_of(problem, result, 1))
            if (auto inset = close_up(*first, end, time, n, x, beam, en)) beam.insets = {std::move(*inset)};
        figure.panels = {beam, cam};
        figure.stack = true;
        figure.share_x = true;
        figure.aspect = 1.1;
        figure.caption = en ? "Contact point (a) on the beam, measured from its root, and (b) on the cam, as the angle "
                              "from the mark "
                              "of the disc (the ray from $C$ to $B$), coloured by the normal force. "
                            : "接触点 (a) 在梁上（自根部量起）和 (b) 在凸轮上（自圆盘标记，即射线 $C$$B$ "
                              "起的角度）的位置，颜色表示法向力。";
        figure.caption += facts(problem, lang);
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
const Recipe kEnergy{"energy", {"Energy balance", "能量账目"}, no_refusal, prepare_energy};
const Recipe kContactPlaces{
    "contact-places", {"Contact point on beam and cam", "梁与凸轮上的接触点"}, needs_cam, prepare_places};

}  // namespace beamcam::scenes
