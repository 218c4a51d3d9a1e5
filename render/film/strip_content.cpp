#include "render/film/strip_content.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>

#include "render/film/close_up_readings.hpp"
#include "render/film/force_curve.hpp"
#include "render/plot/channel_label.hpp"

namespace beamcam::render {
namespace {

using sim::Channel;
using sim::ChannelKind;

constexpr double kRounding = 1e-15;  // of lengths, relative to the beam's: a few units in the last place
constexpr double kDotShare = 0.45;   // of the colour of the past that a dot of the future has

std::string symbol_of(Channel channel) {
    const sim::ChannelLabel& label = sim::row(channel.kind).label;
    const std::string below = subscript(channel);
    return fmt::format(fmt::runtime(label.rate ? "d${}$/d$t${}" : "${}${}"), label.symbol,
                       below.empty() ? below : "_{" + below + "}");
}

// The symbol in the colour of its curve, which replaces a legend.
std::string colored(const std::string& markup, Color color) {
    return fmt::format("\\color{{{}}}{{{}}}", hex(color), markup);
}

bool is_force(Channel c) { return c.kind == ChannelKind::contact_force; }
bool is_length(const FilmContext& context, Channel c) {
    return sim::unit(c, context.setup->problem) == std::string_view("m");
}

figure::Series curve_of(const FilmContext& context, int member, Channel channel) {
    if (is_force(channel)) return force_curve(context.motion(member), context.clock.span);
    figure::Series curve;
    const Motion& one = context.motion(member);
    const auto *t = column(one.chart, {ChannelKind::t, 0}), *v = column(one.chart, channel);
    if (t && v) curve.x = *t, curve.y = *v;
    for (double& value : curve.y) value *= context.shown_factor(channel);
    return curve;
}

// The rows from the last one before the interval to the first one after it.
std::span<const double> rows_within(const figure::Series& curve, Range time) {
    const auto first = std::ranges::upper_bound(curve.x, time.low), last = std::ranges::lower_bound(curve.x, time.high);
    const auto from = std::max<std::ptrdiff_t>(first - curve.x.begin() - 1, 0),
               to = std::min(last - curve.x.begin() + 1, std::ssize(curve.y));
    return std::span(curve.y).subspan(static_cast<std::size_t>(from),
                                      static_cast<std::size_t>(std::max(to - from, 0L)));
}

// The time that the chart shows in some frame.
Range shown_time(const FilmContext& context, const PanelSpec& spec) {
    const double first = context.clock.at(0), last = context.clock.at(context.frames() - 1);
    if (!spec.window) return context.clock.span;
    return {window_around(first, *spec.window).low, window_around(last, *spec.window).high};
}

// The axis of a film is that of all its windows.
Range range_of(const FilmContext& context, const PanelSpec& spec, const std::vector<figure::Series>& curves) {
    Extent all;
    const Channel channel = spec.channels.front();
    const auto see = [&](double v) { all.add({&v, 1}); };
    const Range time = shown_time(context, spec);
    for (const figure::Series& curve : curves)
        all.add(spec.window ? rows_within(curve, time) : std::span<const double>(curve.y));
    for (int m = 0; channel.kind == ChannelKind::theta && m < context.members(); ++m) {
        const Motion& one = context.motion(m);
        for (std::size_t k = 0; k < one.surveyed(); ++k)
            if (const sim::Pose& pose = one.surveyed(k); pose.t >= time.low && pose.t <= time.high)
                see(context.shown_factor(channel) * pose.theta);
    }
    const auto& [any, low, high] = all;
    if (is_force(channel)) return {0, any && high > 0 ? 1.3 * high : 1};  // the values of peaks are above them
    if (!any) return {0, 1};
    // The axis of a constant: ± a twentieth of it, of a radian, or of one unit. A length below the rounding of
    // positions is zero.
    const bool angle = channel.kind == ChannelKind::theta, length = is_length(context, channel);
    const double largest = std::max(std::abs(low), std::abs(high)),
                 zero = length ? kRounding * context.setup->problem.beam.length : 0;
    if (high - low <= (angle ? 1e-9 : std::max(1e-12 * largest, zero))) {
        const double share = 0.05, half = angle             ? share * context.shown_factor(channel)
                                          : largest <= zero ? share
                                                            : share * std::abs(low);
        return {low - half, high + half};
    }
    return {low, high};
}

// Colours distinguish several channels, or several motions.
Color curve_color(const FilmContext& context, Channel channel, std::size_t i, int member) {
    if (context.members() > 1) return context.member_color(member);
    if (channel.kind == ChannelKind::contact_force) return context.look.palette.contact;  // as its arrow
    return energy_color(context.look.palette, channel.kind).value_or(series_color(context.look.palette, i));
}

// The places of contact as dots, also of impulsive impacts, which last no time; returns the range of those that are
// shown.
Range add_places(const FilmContext& context, const Range& shown, ChartContent& c) {
    Extent places;
    const Palette& p = context.look.palette;
    for (int m = 0; m < context.members(); ++m) {
        const Color color = context.members() > 1 ? context.member_color(m) : p.contact;
        const auto add = [&](double t, const double& x) {
            if (t < c.time().low || t > c.time().high) return;
            if (t >= shown.low && t <= shown.high) places.add({&x, 1});
            c.panel.dots.push_back({t, x, color, p.tint(color, kDotShare)});
        };
        for (const TraceSample& s : context.samples[static_cast<std::size_t>(m)]) add(s.t, s.x);
        if (context.motion(m).problem.contact.model == sim::ContactModel::restitution)
            for (const sim::Impact& impact : context.motion(m).impacts) add(impact.t_start, impact.x);
    }
    const double length = context.setup->problem.beam.length;
    const double around = std::max(0.05 * (places.high - places.low), 2e-4 * length);
    return places.any ? Range{places.low - around, places.high + around} : Range{0, length};
}

}  // namespace

std::optional<Color> energy_color(const Palette& p, ChannelKind kind) {
    switch (kind) {
        case ChannelKind::energy_potential:
            return p.tint(p.motion, 0.45);
        case ChannelKind::energy_kinetic:
            return p.motion;
        case ChannelKind::energy_elastic:
            return p.tint(series_color(p, 4), 0.75);  // not that of a compared motion
        case ChannelKind::energy_spring:
            return p.tint(series_color(p, 5), 0.45);
        case ChannelKind::energy_contact:
            return p.contact;
        case ChannelKind::loss_structural:
        case ChannelKind::loss_hub:
        case ChannelKind::loss_contact:
        case ChannelKind::loss_friction:
            return p.tint(p.muted, 0.55);
        default:
            return {};
    }
}

// As points or a line, with a curve of their own for label and reading; extends the range of the values.
static void add_data(const FilmContext& context, const PanelSpec& spec, ChartContent& c, Range& values) {
    const Palette& p = context.look.palette;
    for (std::size_t k = 0; k < context.setup->data.size() && !spec.by_collision; ++k)
        for (const Channel channel : spec.channels) {
            const FilmData& data = context.setup->data[k];
            const std::vector<double>* column = data.find(channel);
            if (!column) continue;
            const Color color = context.data_color(k), faint = p.tint(color, 0.25);
            figure::Series curve{.label = context.data_labels[k] + ":", .color = color};
            curve.faint = faint;
            for (std::size_t i = 0; i < data.t.size(); ++i) {
                const double t = data.t[i], v = context.shown_factor(channel) * (*column)[i];
                if (t < c.time().low || t > c.time().high || std::isnan(v)) continue;
                values = {std::min(values.low, v), std::max(values.high, v)};
                if (data.line)
                    curve.add(t, v);
                else
                    c.panel.dots.push_back({t, v, color, faint});
            }
            c.panel.series.push_back(std::move(curve));
        }
}

// The friction force of stick–slip friction has its bounds beside it: ±μF, on which it slips, or ±μ_s F while it
// sticks, in shaded intervals. Returns their symbol for the heading.
static std::string add_sticking(const FilmContext& context, const PanelSpec& spec, ChartContent& c) {
    const auto* law = std::get_if<sim::StickSlipFriction>(&context.setup->problem.contact.friction);
    const sim::Table& chart = context.setup->chart;
    const auto *t = column(chart, {ChannelKind::t, 0}), *force = column(chart, {ChannelKind::contact_force, 0}),
               *friction = column(chart, {ChannelKind::friction_force, 0});
    if (!law || !t || !force || !friction || context.members() > 1 || spec.channels.size() > 1 ||
        spec.channels.front().kind != ChannelKind::friction_force)
        return {};
    const Palette& p = context.look.palette;
    const double static_coefficient = law->static_coefficient.value_or(law->coefficient);
    std::vector<double> bound;
    std::vector<figure::Span>& spans = c.panel.spans;
    for (std::size_t i = 0; i < t->size(); ++i) {
        const bool holds = sticks(context.setup->problem, (*force)[i], (*friction)[i]);
        bound.push_back((holds ? static_coefficient : law->coefficient) * (*force)[i]);
        if (!((*force)[i] > 0)) continue;
        const std::string name = context.look.translate(holds ? "sticks" : "slips");
        if (i == 0 || spans.empty() || spans.back().to != (*t)[i - 1] || spans.back().label != name)
            spans.push_back({(*t)[i], (*t)[i], name, p.motion.faded(holds ? 0.13 : 0)});
        spans.back().to = (*t)[i];
    }
    for (const double sign : {-1, 1}) {
        figure::Series curve{.color = p.muted};
        curve.faint = p.tint(p.muted, 0.25);
        curve.dash = FilmContext::dash_of(1);
        for (std::size_t i = 0; i < t->size(); ++i) curve.add((*t)[i], sign * bound[i]);
        c.panel.series.push_back(std::move(curve));
    }
    return ", " + colored(static_coefficient == law->coefficient ? "±$μF$" : "±$μF$, ±$μ$_{s}$F$", p.muted);
}

ChartContent blank_content(const FilmContext& context, const PanelSpec& spec, int member) {
    ChartContent c;
    c.window = spec.window;
    c.set_time(context.clock.span, context.clock.format.unit, std::string("$t$ / ") + context.clock.format.symbol);
    const auto mark = [&](int whose, figure::EventTick at) {
        for (const sim::Impact& i : context.motion(whose).impacts)
            if (i.t_start >= context.clock.span.low && i.t_start <= context.clock.span.high)
                at.x = i.t_start, c.panel.events.push_back(at);
    };
    if (member >= 0) {
        mark(member, {.color = context.look.palette.contact});
    } else {
        for (int m = 0; m < context.members(); ++m)
            mark(m, {.color = context.member_color(m), .lane = m, .lanes = context.members()});
    }
    return c;
}

double reading(const FilmContext& context, int member, int frame, Channel channel) {
    const sim::Pose& pose = context.pose(member, frame);
    if (channel.kind == ChannelKind::theta) return context.shown_factor(channel) * pose.theta;
    if (channel.kind == ChannelKind::theta_dot) return context.shown_factor(channel) * pose.theta_dot;
    if (is_force(channel)) return pose.nearest ? pose.nearest->force : kNan;
    if (channel.kind == ChannelKind::contact_x) return pose.nearest && pose.nearest->touching ? pose.nearest->x : kNan;
    const sim::Table& table = context.motion(member).chart;
    const auto *t = column(table, {ChannelKind::t, 0}), *v = column(table, channel);
    return t && v ? context.shown_factor(channel) * value_at(*t, *v, pose.t) : kNan;
}

std::vector<double> readings_of_data(const FilmContext& context, const PanelSpec& spec, double t) {
    std::vector<double> out;
    for (const FilmData& data : context.setup->data)
        for (const Channel channel : spec.channels)
            if (const std::vector<double>* values = data.find(channel))
                out.push_back(context.shown_factor(channel) * value_at(data.t, *values, t));
    return out;
}

ChartContent strip_content(const FilmContext& context, const PanelSpec& spec) {
    const Channel first = spec.channels.front();
    const Palette& p = context.look.palette;
    ChartContent c = blank_content(context, spec, context.members() > 1 ? -1 : 0);
    const bool single = spec.channels.size() == 1;
    const bool dotted = first.kind == ChannelKind::contact_x && !spec.by_collision;
    c.words = single ? heading(first.kind, context.setup->view.lang) : "";
    if (c.words.starts_with("Contact point on")) c.short_words = "Contact point ";
    std::string symbols, unit = context.shown_unit(first);
    for (std::size_t i = 0; i < spec.channels.size(); ++i) {
        std::string symbol = symbol_of(spec.channels[i]);
        if (!single && context.members() == 1)
            symbol = colored(symbol, readable(p, curve_color(context, spec.channels[i], i, 0)));
        symbols += fmt::format("{}{}", i > 0 ? ", " : "", symbol);
        for (int m = 0; m < context.members(); ++m) {
            figure::Series curve = dotted ? figure::Series{} : curve_of(context, m, spec.channels[i]);
            const bool contact = is_force(first) || first.kind == ChannelKind::contact_x;
            const bool alone = single && context.members() == 1;
            const Color color = alone && contact ? p.contact : curve_color(context, spec.channels[i], i, m);
            curve.color = color;
            curve.faint = alone ? (contact ? p.contact_faint : p.motion_faint) : p.tint(color, 0.25);
            curve.filled = single && is_force(first);
            if (context.members() > 1 && !context.names_in_panels())
                curve.label = context.labels[static_cast<std::size_t>(m)] + ":", c.names_first = true;  // "ω = 0: 12"
            else if (context.members() == 1 && !single)
                curve.label = symbol_of(spec.channels[i]);
            if (!is_force(first))
                curve.dash = FilmContext::dash_of(context.members() > 1 ? static_cast<std::size_t>(m) : i);
            c.panel.series.push_back(std::move(curve));
        }
    }
    if (const std::string limit = add_sticking(context, spec, c); !limit.empty())
        symbols = colored(symbols, readable(p, color_of(c.panel.series.front()))) + limit;
    if (shows_peaks(spec) || (spec.by_collision && single)) c.rows = static_cast<std::size_t>(context.members());
    Range values = range_of(context, spec, c.panel.series);
    if (single && dotted) values = add_places(context, shown_time(context, spec), c);
    add_data(context, spec, c, values);
    const bool of_contact = is_force(first) || first.kind == ChannelKind::contact_x;
    const auto is_value = [&](double v) { return is_force(first) ? v > 0 : !std::isnan(v); };
    const auto has_values = [&](const figure::Series& curve) { return std::ranges::any_of(curve.y, is_value); };
    if (of_contact && c.panel.dots.empty() && std::ranges::none_of(c.panel.series, has_values))
        c.instead = context.look.translate(c.panel.events.empty() ? "no contact" : "impulses only"), unit.clear(),
        values = {0, 1};
    if (is_force(first) && !unit.empty()) unit = context.scales.force_unit.symbol + unit;
    c.set_values(values, symbols, unit);
    if (is_force(first)) c.panel.y.unit = context.scales.force_unit.factor;
    return c;
}

}  // namespace beamcam::render
