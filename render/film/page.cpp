#include "render/film/page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>

#include "render/draw/markup.hpp"
#include "render/film/mechanism_labels.hpp"
#include "render/film/panel.hpp"
#include "render/gl/bodies.hpp"
#include "render/mechanism/cam_outline.hpp"
#include "render/mechanism/exaggeration.hpp"
#include "render/plot/labels.hpp"
#include "render/plot/user_text.hpp"

namespace beamcam::render {
namespace {

static_assert(std::endian::native == std::endian::little, "the page's numbers are little-endian");

constexpr std::size_t kStations = 25;  // of the stored polyline

// The stored data of one instant.
struct Instant {
    double t = 0, theta = 0, cam_angle = 0, force = 0;
    std::vector<Vec2> points;    // centre of the drawn section, root to tip; then the nearest point of the disc
    std::vector<double> moment;  // at the points of the beam, −1…1 of its scale; of a rigid beam none
};

Instant instant_of(const FilmContext& context, int frame, double depth, double& thickness) {
    const sim::Pose pose = context.pose(0, frame);
    const DrawnBeam beam = drawn_beam(context.motion(0).problem, pose, context.scales.exaggeration, depth);
    thickness = beam.high - beam.low;
    Instant out{pose.t, pose.theta, pose.cam_angle, pose.nearest ? pose.nearest->force : 0, {}, {}};
    const std::size_t last = beam.line.size() - 1, stations = std::min(kStations, last + 1);
    for (std::size_t i = 0; i < stations; ++i) {
        const std::size_t at = i * last / (stations - 1);
        out.points.push_back(beam.line[at] + beam.left[at] * ((beam.low + beam.high) / 2));
        if (context.scales.moment > 0 && at < pose.moment.size())
            out.moment.push_back(pose.moment[at] / context.scales.moment);
    }
    out.points.push_back(beam.contact ? beam.contact->on_disc : Vec2{});
    return out;
}

// Adds instants of zero force at the ends of contacts; interpolation between poses would show force outside contacts.
void add_ends_of_contacts(const FilmContext& context, std::vector<Instant>& all) {
    for (const sim::Impact& impact : context.motion(0).impacts)
        for (const std::optional<double> t : {std::optional(impact.t_start), impact.t_end}) {
            const auto after = std::ranges::lower_bound(all, t.value_or(all.back().t + 1), {}, &Instant::t);
            if (after == all.begin() || after == all.end() || after->t == *t) continue;
            const Instant &a = *std::prev(after), &b = *after;
            const double share = (*t - a.t) / (b.t - a.t);
            Instant end{*t,
                        a.theta + (b.theta - a.theta) * share,
                        a.cam_angle + (b.cam_angle - a.cam_angle) * share,
                        0,
                        a.points,
                        a.moment};
            for (std::size_t i = 0; i < end.points.size(); ++i) end.points[i] += (b.points[i] - a.points[i]) * share;
            for (std::size_t i = 0; i < end.moment.size(); ++i) end.moment[i] += (b.moment[i] - a.moment[i]) * share;
            all.insert(after, std::move(end));
        }
}

// Whether linear interpolation from `a` to `b` reproduces `between`.
bool reproduces(const Instant& a, const Instant& b, const Instant& between, double length, double largest_force) {
    const double share = (between.t - a.t) / (b.t - a.t);
    const auto off = [&](double x, double y, double z) { return std::abs(x + (y - x) * share - z); };
    if (off(a.theta, b.theta, between.theta) > kPageTolerance) return false;
    if (off(a.cam_angle, b.cam_angle, between.cam_angle) > kPageTolerance) return false;
    if ((a.force > 0) != (between.force > 0) || (b.force > 0) != (between.force > 0)) return false;
    if (off(a.force, b.force, between.force) > kPageForceTolerance * largest_force) return false;
    for (std::size_t i = 0; i < between.points.size(); ++i)
        if (norm(a.points[i] + (b.points[i] - a.points[i]) * share - between.points[i]) > kPageTolerance * length)
            return false;
    for (std::size_t i = 0; i < between.moment.size(); ++i)
        if (off(a.moment[i], b.moment[i], between.moment[i]) > kPageMomentTolerance) return false;
    return true;
}

// The instants to store: greedily the longest steps that reproduce all instants between.
std::vector<Instant> thinned_instants(std::vector<Instant> all, double length) {
    constexpr std::size_t kLongest = 200;
    const double force = std::ranges::max(all, {}, &Instant::force).force;
    std::vector<Instant> out{all.front()};
    for (std::size_t from = 0; from + 1 < all.size();) {
        std::size_t to = from + 1;
        const auto fits = [&](std::size_t end) {
            for (std::size_t i = from + 1; i < end; ++i)
                if (!reproduces(all[from], all[end], all[i], length, force)) return false;
            return true;
        };
        while (to + 1 < all.size() && to - from < kLongest && fits(to + 1)) ++to;
        out.push_back(all[to]);
        from = to;
    }
    return out;
}

template <class Number>
std::string base64(const std::vector<Number>& numbers) {
    gchar* text = g_base64_encode(reinterpret_cast<const guchar*>(numbers.data()), numbers.size() * sizeof(Number));
    std::string out = text;
    g_free(text);
    return out;
}

std::string css(const Color& c) { return '"' + hex(c) + '"'; }

constexpr int kOutline = 360;

// For each place of the outline: time of the first touch, and colour of the largest force.
std::string trace_json(const FilmContext& context) {
    const double length = cam_circumference(context.motion(0).problem);
    struct Place {
        double t = 0, at = 0, force = 0;
    };
    std::vector<Place> places;
    for (const TraceSample& s : context.samples.front()) {
        const double at = std::min<double>(kOutline - 1, std::floor(s.s / length * kOutline));
        const auto same = std::ranges::find(places, at, &Place::at);
        if (same == places.end())
            places.push_back({s.t, at, s.force});
        else
            same->force = std::max(same->force, s.force);
    }
    std::vector<std::string> out;
    for (const Place& p : places)
        out.push_back(fmt::format(
            "[{:.6g},{},{}]", p.t, p.at,
            css(force_color(context.look.palette, std::sqrt(std::min(1.0, p.force / context.scales.largest_force))))));
    return fmt::format("[{}]", fmt::join(out, ","));
}

std::string impacts_json(const FilmContext& context) {
    std::vector<std::string> out;
    for (const sim::Impact& i : context.motion(0).impacts)
        if (i.t_start >= context.clock.span.low && i.t_start <= context.clock.span.high)
            out.push_back(fmt::format("{:.9g}", i.t_start));
    return fmt::format("[{}]", fmt::join(out, ","));
}

std::string cam_json(const FilmContext& context) {
    const auto& cam = context.motion(0).problem.cam;
    if (!cam) return "null";
    const sim::Problem& problem = context.motion(0).problem;
    std::vector<std::string> outline;  // in the cam's frame, counter-clockwise
    for (const Vec2 p : cam_outline(problem, kOutline).points)
        outline.push_back(fmt::format("[{:.6g},{:.6g}]", p.x, p.y));
    return fmt::format(
        R"({{"centre":[{:.9g},{:.9g}],"reach":{:.9g},"eccentricity":{:.9g},"outline":[{}],"speed":{:.9g},"turning":{},"trace":{}}})",
        cam->centre.x, cam->centre.y, cam_reach(problem), cam->profile ? 0 : cam->eccentricity, fmt::join(outline, ","),
        cam->speed, json_text(" = " + turning_speed(cam->speed, context.setup->units.speed)), trace_json(context));
}

std::string numbers_json(const std::vector<Instant>& kept) {
    double largest = 0;
    for (const Instant& i : kept)
        for (const Vec2& p : i.points) largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
    const double quantum = largest / 32767;
    const double begin = kept.front().t, tick = (kept.back().t - begin) / 4294967295.0;
    std::vector<std::uint32_t> times;
    std::vector<float> angles;
    std::vector<std::int16_t> points;
    std::vector<std::int8_t> moments;
    for (const Instant& i : kept) {
        times.push_back(tick > 0 ? static_cast<std::uint32_t>(std::llround((i.t - begin) / tick)) : 0);
        for (const double value : {i.theta, i.cam_angle, i.force}) angles.push_back(static_cast<float>(value));
        for (const Vec2& p : i.points)
            for (const double value : {p.x, p.y})
                points.push_back(static_cast<std::int16_t>(std::lround(value / quantum)));
        for (const double share : i.moment)  // its root, as coloured
            moments.push_back(static_cast<std::int8_t>(
                std::lround(std::copysign(127 * std::sqrt(std::min(1.0, std::abs(share))), share))));
    }
    return fmt::format(
        R"("instants":{},"stations":{},"begin":{:.17g},"tick":{:.17g},"quantum":{:.17g},"times":"{}","values":"{}","points":"{}","moments":"{}")",
        kept.size(), kept.front().points.size() - 1, begin, tick, quantum, base64(times), base64(angles),
        base64(points), base64(moments));
}

// The scale of the moment's colours, as HTML.
std::string moment_scale(const FilmContext& context) {
    if (!(context.scales.moment > 0)) return {};
    const std::string top = quantity(context.scales.moment, "N\u2009m");
    std::vector<std::string> colors;
    for (const Color& color : context.look.palette.moment) colors.push_back(hex(color));
    return fmt::format("{}: −{} <i style=\"background: linear-gradient(90deg, {})\"></i> {}",
                       context.look.translate("bending moment (√ scale)"), top.substr(0, top.find("\u00A0")),
                       fmt::join(colors, ", "), top);
}

// The page with these texts in place of "@NAME@". One pass: a text that looks like a name stays as it is.
std::string filled(std::string_view page, const std::map<std::string_view, std::string>& texts) {
    std::string out;
    for (std::size_t at = 0; at < page.size();) {
        const std::size_t mark = page.find('@', at), end = page.find('@', std::min(mark, page.size() - 1) + 1);
        const auto text =
            end == std::string_view::npos ? texts.end() : texts.find(page.substr(mark + 1, end - mark - 1));
        const std::size_t kept = text == texts.end() && mark != std::string_view::npos ? mark + 1 : mark;
        out += page.substr(at, kept - at);
        if (mark == std::string_view::npos) break;
        at = mark + 1;
        if (text != texts.end()) out += text->second, at = end + 1;
    }
    return out;
}

// The drawn hub, which covers the corner of the beam's root [m].
double hub_of_page(const sim::Problem& problem) {
    return std::max({problem.hub.radius, root_radius(problem), 0.022 * problem.beam.length});
}

// Radius of the arc of θ: outside the hub and clear of the disc, unless there is no room between them.
double arc_radius(const sim::Problem& problem) {
    const double length = problem.beam.length, usual = std::max(0.14 * length, problem.hub.radius + 0.1 * length),
                 least = 2 * hub_of_page(problem);
    if (!problem.cam) return usual;
    const double before_cam = arc_before_cam(problem);
    return before_cam >= least ? std::min(usual, before_cam) : usual;
}

}  // namespace

// "</script>" would end a script element.
std::string json_text(std::string_view plain) {
    std::string out = "\"";
    for (const char c : plain)
        out += static_cast<unsigned char>(c) < 0x20 || c == '"' || c == '\\' || c == '<'
                   ? fmt::format("\\u{:04x}", static_cast<unsigned>(static_cast<unsigned char>(c)))
                   : std::string(1, c);
    return out + "\"";
}

std::string html_page(const FilmSetup& setup) {
    const FilmContext context(std::make_shared<const FilmSetup>(setup));
    const sim::Problem& problem = context.motion(0).problem;
    const double length = problem.beam.length, depth = std::max(beam_depth(problem.beam), 0.008 * length);
    double thickness = depth;
    std::vector<Instant> all;
    for (int k = 0; k < context.frames(); ++k) all.push_back(instant_of(context, k, depth, thickness));
    add_ends_of_contacts(context, all);
    const Palette& p = context.look.palette;
    const Materials body = materials(p);
    std::vector<std::string> moments;
    for (const Color& each : p.moment) moments.push_back(hex(each));
    const std::string colors = fmt::format(
        R"({{"paper":{},"ink":{},"muted":{},"faint":{},"grid":{},"motion":{},"contact":{},"cam":{},"hub":{},"pin":{},"bracket":{},"moment":["{}"]}})",
        css(p.paper), css(p.ink), css(p.muted), css(p.faint), css(p.grid), css(p.motion), css(p.contact), css(body.cam),
        css(body.housing), css(body.pin), css(body.bracket), fmt::join(moments, "\",\""));
    const std::string data = fmt::format(
        R"({{"title":{},"factor":{:.9g},"tolerance":{:.9g},"length":{:.9g},"thickness":{:.9g},"hub":{:.9g},"arc":{:.9g},"force":{:.9g},)"
        R"("degrees":{},"period":{:.9g},"colors":{},"cam":{},"impacts":{},{}}})",
        json_text(plain_text(setup.title)), context.scales.exaggeration, kPageTolerance * length, length, thickness,
        hub_of_page(problem), arc_radius(problem), context.scales.largest_force, setup.units.degrees,
        std::isfinite(context.scales.period) ? context.scales.period : 0, colors, cam_json(context),
        impacts_json(context), numbers_json(thinned_instants(std::move(all), length)));
    const Lang lang = setup.view.lang;
    const std::string parameters =
        fmt::format("{}", fmt::join(parameter_pieces(problem, lang, setup.units.speed), " · "));
    return filled(player_html(), {{"LANG", lang == Lang::en ? "en" : "zh"},
                                  {"MECHANISM", phrase(lang, "The mechanism")},
                                  {"INSTANT", phrase(lang, "Instant")},
                                  {"PLAY", phrase(lang, "Play")},
                                  {"PAUSE", phrase(lang, "Pause")},
                                  {"SPACE", phrase(lang, "Space")},
                                  {"SPEED", phrase(lang, "Speed")},
                                  {"ARROWS", phrase(lang, "Up and Down")},
                                  {"DEFLECTION", phrase(lang, "deflection")},
                                  {"SCALE", moment_scale(context)},
                                  {"PARAMETERS", to_html(parameters)},
                                  {"TITLE", setup.title.empty() ? "beamcam" : xml(plain_text(setup.title))},
                                  {"PAPER", hex(p.paper)},
                                  {"INK", hex(p.ink)},
                                  {"MUTED", hex(p.muted)},
                                  {"MOTION", hex(p.motion)},
                                  {"SCHEME", setup.view.theme == Theme::dark ? "dark" : "light"},
                                  {"DATA", data}});
}

}  // namespace beamcam::render
