#include "render/film/panel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "render/base/error.hpp"
#include "render/mechanism/exaggeration.hpp"
#include "render/plot/ticks.hpp"
#include "render/plot/user_text.hpp"
#include "sim/beam/modes.hpp"
#include "sim/cam/motion_law.hpp"

namespace beamcam::render {
namespace {

using sim::Channel;
using sim::ChannelKind;
using sim::Pose;

// A deflection with more periods than a chart can show, of a fifth of its range or more, has a window of some of them.
std::optional<double> window_of(const sim::Table& chart, const std::vector<Channel>& channels) {
    constexpr int kMost = 30, kShown = 8;
    const auto *t = column(chart, {ChannelKind::t, 0}), *v = column(chart, {ChannelKind::tip_deflection, 0});
    if (!t || !v || v->empty() || channels != std::vector<Channel>{{ChannelKind::tip_deflection, 0}}) return {};
    const auto [least, most] = std::ranges::minmax(*v);
    const double step = 0.2 * (most - least);
    int periods = 0;
    bool rises = true;
    for (double turn = v->front(); const double now : *v) {  // the last extremum
        turn = rises ? std::max(turn, now) : std::min(turn, now);
        if (rises ? now >= turn - step : now <= turn + step) continue;
        periods += rises;
        rises = !rises, turn = now;
    }
    return periods > kMost ? std::optional(kShown * (t->back() - t->front()) / periods) : std::nullopt;
}

std::vector<PanelSpec> standard(const FilmSetup& setup) {
    const Motion* shown = &setup;  // a motion with a cam, if there is one
    double touch = first_touch(setup);
    for (const Motion& other : setup.others) {
        if (!shown->problem.cam) shown = &other;
        touch = std::min(touch, first_touch(other));
    }
    const bool touched = touch <= setup.time(setup.frames() - 1);
    // A still of an instant in contact shows that collision, as slow motion does.
    const bool still = setup.frames() == 1, in_contact = setup.pose(0).nearest && setup.pose(0).nearest->touching;
    std::vector<PanelSpec> specs =
        standard_panels(shown->problem, setup.by_collision || (still && setup.others.empty() && in_contact));
    for (PanelSpec& s : specs) s.window = window_of(setup.chart, s.channels);
    // Panels without data are removed.
    std::erase_if(specs, [&](const PanelSpec& s) {
        if (s.kind == PanelKind::close_up) return !setup.others.empty() || !touched || (still && !in_contact);
        const ChannelKind kind = s.channels.front().kind;
        return (kind == ChannelKind::tip_deflection && !column(setup.chart, s.channels.front())) ||
               (kind == ChannelKind::contact_force && !touched);
    });
    if (setup.view.shot.zoom > 1 && setup.others.empty()) specs.insert(specs.begin(), {.kind = PanelKind::overview});
    return specs;
}

}  // namespace

std::vector<PanelSpec> standard_panels(const sim::Problem& problem, bool slow_motion) {
    const auto strip = [](ChannelKind kind) { return PanelSpec{.kind = PanelKind::strip, .channels = {{kind, 0}}}; };
    // The angle of a hub that does not turn is no motion.
    const auto* driven = std::get_if<sim::ConstantSpeed>(&problem.hub.drive);
    const bool held = driven && driven->speed == 0;
    const PanelSpec motion = strip(held ? ChannelKind::tip_deflection : ChannelKind::theta);
    if (!problem.cam) return held ? std::vector{motion} : std::vector{motion, strip(ChannelKind::tip_deflection)};
    // Impulses have no force that a chart could show.
    const bool impulses = problem.contact.model == sim::ContactModel::restitution;
    PanelSpec contact = strip(impulses ? ChannelKind::gap : ChannelKind::contact_force);
    contact.by_collision = slow_motion && !impulses;
    if (slow_motion) return {motion, contact, {.kind = PanelKind::close_up}};
    return {motion, contact};
}

std::vector<Channel> chart_channels(const std::vector<PanelSpec>& panels) {
    std::vector<Channel> out{{ChannelKind::t, 0}};
    const auto add = [&](Channel c) {
        if (std::ranges::find(out, c) == out.end()) out.push_back(c);
    };
    for (const PanelSpec& panel : panels) {
        for (Channel c : panel.channels) {
            add(c);
            if (c.kind == ChannelKind::friction_force) add({ChannelKind::contact_force, 0});  // limits it
        }
        for (ChannelKind kind : type_of(panel.kind).channels) add({kind, 0});
    }
    return out;
}

// ---- the registry of panels ----------------------------------------------------------------------

#define BEAMCAM_PANEL_TYPE(name) PanelType name##_panel();
BEAMCAM_PANELS(BEAMCAM_PANEL_TYPE)
#undef BEAMCAM_PANEL_TYPE

const std::vector<PanelType>& panel_types() {
#define BEAMCAM_PANEL_TYPE(name) name##_panel(),
    static const std::vector<PanelType> types{BEAMCAM_PANELS(BEAMCAM_PANEL_TYPE)};
#undef BEAMCAM_PANEL_TYPE
    return types;
}

const PanelType& type_of(PanelKind kind) { return *std::ranges::find(panel_types(), kind, &PanelType::kind); }

// ---- what panels share -------------------------------------------------------------------------

FilmContext::FilmContext(std::shared_ptr<const FilmSetup> s) : setup(std::move(s)) {
    check();
    for (int m = 0; m < members(); ++m) {
        samples.push_back(contact_samples(motion(m).trace, motion(m).impacts));
        labels.push_back(text_markup(motion(m).label));
    }
    for (const FilmData& each : setup->data) data_labels.push_back(text_markup(each.label));
    choose_look();
    read_clock();
    choose_scales();
    place_panels();
    fonts = std::make_unique<const Fonts>(look.cjk);
    ++counts->font_sets;
}

void FilmContext::choose_look() {
    look.palette = render::palette(setup->view.theme);
    if (setup->view.paper) look.palette = on_paper(look.palette, rgb(*setup->view.paper));
    if (setup->view.transparent) look.palette = look.palette.without_paper();
    look.lang = setup->view.lang;
    std::string written = setup->title + setup->warning;
    for (const Callout& c : setup->callouts) written += c.text;
    for (int m = 0; m < members(); ++m) written += motion(m).label;
    for (const FilmData& each : setup->data) written += each.label;
    look.cjk = look.lang == Lang::zh || needs_cjk(written);
}

void FilmContext::read_clock() {
    for (std::size_t k = 0; k < setup->frames(); ++k) {
        clock.times.push_back(setup->time(k));
        clock.moved.push_back(k == 0 ? 0 : clock.moved[k - 1] + (clock.times[k] > clock.times[k - 1] ? 1 : 0));
    }
    clock.span = {clock.times.front(), clock.times.back()};
    if (const auto* t = column(setup->chart, {ChannelKind::t, 0}); t && !t->empty()) {
        clock.span.low = std::min(clock.span.low, *std::ranges::min_element(*t));
        clock.span.high = std::max(clock.span.high, *std::ranges::max_element(*t));
    }
    clock.format = time_format(clock.times, std::max(clock.span.high, frames() == 1 ? setup->scene_end : 0));
    if (!(clock.span.high > clock.span.low)) clock.span.high = clock.span.low + clock.format.unit;  // a single instant
}

void FilmContext::place_panels() {
    Shown shown = setup->view.shown();
    shown.title = shown.title && !setup->title.empty();
    shown.captions = !setup->callouts.empty();
    shown.moment = scales.moment > 0;
    shown.warning = shown.warning && !setup->warning.empty();
    const int width = setup->width, height = setup->height;
    const int mechanisms = setup->comparison == Comparison::panels ? members() : 1;
    places = layout(width, height,
                    setup->layout ? *setup->layout : standard_grid(width, height, standard(*setup), mechanisms), shown);
    look.unit = places.unit;
    look.letters = places.letters;
    if (places.first(PanelKind::mechanism) || places.first(PanelKind::overview)) extent = view_extent_of(*this);
}

SpeedUnit Units::speed_in_charts() const {
    return speed == SpeedUnit::automatic && degrees ? SpeedUnit::degrees : speed;
}

double Units::factor(const std::string& si) const {
    if (si == "rad/s") return factor_of(speed_in_charts());
    return si == "rad" && degrees ? factor_of(SpeedUnit::degrees) : 1;
}

std::string Units::unit(const std::string& si) const {
    if (si == "m/s^2") return "m/s²";
    if (si == "rad/s") return name_of(speed_in_charts());
    return si == "rad" && degrees ? "°" : si;
}

double FilmContext::shown_factor(Channel channel) const {
    if (scales.turns && channel.kind == ChannelKind::theta) return 1 / sim::kFullTurn;
    return setup->units.factor(sim::unit(channel, setup->problem));
}
std::string FilmContext::shown_unit(Channel channel) const {
    if (scales.turns && channel.kind == ChannelKind::theta) return look.translate("turns");
    return setup->units.unit(sim::unit(channel, setup->problem));
}

double FilmContext::measured_angle(std::size_t k, double t) const {
    const FilmData& data = setup->data[k];
    const std::vector<double>* theta = data.find({sim::ChannelKind::theta, 0});
    return theta ? value_at(data.t, *theta, t) : kNan;
}

bool FilmContext::names_in_panels() const {
    std::ptrdiff_t named = 0;
    for (const PanelSlot& slot : places.panels)
        if (slot.spec.kind == PanelKind::mechanism && has_names(slot.box, look.unit)) ++named;
    return named >= (setup->comparison == Comparison::ghosts ? 1 : members());
}

const sim::Problem* FilmContext::section_reference(int member) const {
    if (motion(member).problem.cam) return nullptr;
    for (int m = 0; m < members(); ++m)
        if (motion(m).problem.cam) return &motion(m).problem;
    return nullptr;
}

void FilmContext::check() const {
    constexpr int kLargest = 16384;  // OSMesa's limit, and Cairo's is twice that
    const FilmSetup& s = *setup;
    if (s.width < 1 || s.height < 1 || s.width > kLargest || s.height > kLargest)
        throw PictureError(fmt::format("a picture of {}×{} pixels cannot be drawn; choose 1 to {} each way", s.width,
                                       s.height, kLargest));
    if (s.frames() == 0) throw PictureError("the film has no frames; give it a duration longer than half a frame");
    if (s.view.exaggeration && !(*s.view.exaggeration >= 1 && std::isfinite(*s.view.exaggeration)))
        throw PictureError(
            fmt::format("deflection cannot be exaggerated by {}; choose 1 (true) or more", *s.view.exaggeration));
    for (int m = 0; m < members(); ++m) {
        const Motion& one = motion(m);
        if (one.frames() != s.frames()) throw PictureError("motions that are compared need the same instants");
        for (const Pose& pose : one.poses)
            if (pose.centreline.size() < 2) throw PictureError("a pose needs at least two stations along the beam");
    }
}

// At the instant of a touch the gap is zero but for rounding, and so is the force.
sim::Pose FilmContext::pose(int member, int frame) const {
    constexpr double kForceRounding = 1e-9;  // of the film's largest force
    sim::Pose out = motion(member).pose(static_cast<std::size_t>(frame));
    if (out.nearest && out.nearest->force < kForceRounding * scales.largest_force)
        out.nearest->force = out.nearest->friction = 0;
    for (double& value : out.moment) value *= moment_share(frame);
    return out;
}

// With fewer than six frames a period of the first vibration the colour of the moment fades, with three there is none:
// it would show the frame rate. A still has all of it.
double FilmContext::moment_share(int frame) const {
    constexpr double kNone = 3;  // frames a period
    if (frames() == 1) return 1;
    const double speed = setup->speeds.empty() ? 1 : setup->speeds[static_cast<std::size_t>(frame)];
    return std::clamp(scales.period * setup->fps / (kNone * speed) - 1, 0.0, 1.0);
}

double first_period(const sim::Problem& problem) {
    const std::vector<sim::Mode> modes = sim::natural_modes(problem);
    return modes.empty() ? std::numeric_limits<double>::infinity() : sim::kFullTurn / modes.front().omega;
}

void FilmContext::choose_scales() {
    double moment = 0, force = 0;
    scales.exaggeration = std::numeric_limits<double>::infinity();
    for (int m = 0; m < members(); ++m) {
        const Motion& one = motion(m);
        const bool flexible = one.problem.beam.model != sim::ModelKind::rigid;
        // A rigid beam among flexible ones does not limit their exaggeration.
        if (flexible || members() == 1) {
            scales.exaggeration = std::min(
                scales.exaggeration, film_factor(
                                         one.problem, one.surveyed(), [&](std::size_t k) { return one.surveyed(k); },
                                         setup->view.exaggeration));
            // The survey may miss an instant that requires a smaller scales.exaggeration; frames must not.
            if (!one.survey.empty())
                scales.exaggeration = clear_factor(
                    one.problem, one.frames(), [&](std::size_t k) { return one.pose(k); }, scales.exaggeration);
        }
        double largest = 0;
        for (std::size_t k = 0; k < one.surveyed(); ++k) {
            const Pose p = one.surveyed(k);
            for (double value : p.moment) largest = std::max(largest, std::abs(value));
            if (p.nearest) force = std::max(force, p.nearest->force);
            scales.turns = scales.turns || (setup->units.degrees && std::abs(p.theta) > 2 * sim::kFullTurn);
        }
        // A moment that bends the beam by less than a billionth of its length is a rounding error.
        const double negligible = 1e-9 * one.problem.beam.bending_stiffness() / one.problem.beam.length;
        scales.period = std::min(scales.period, first_period(one.problem));
        if (flexible && largest > negligible) moment = std::max(moment, largest);
    }
    if (!std::isfinite(scales.exaggeration)) scales.exaggeration = 1;
    scales.arrow_force = force;
    double smallest = std::numeric_limits<double>::infinity();
    for (int m = 0; m < members(); ++m) {
        double own = 0;
        for (const TraceSample& s : samples[static_cast<std::size_t>(m)]) own = std::max(own, s.force);
        for (const sim::Impact& i : motion(m).impacts) own = std::max(own, i.force_peak.value_or(0));
        force = std::max(force, own);
        if (own > 0) smallest = std::min(smallest, own);
    }
    scales.force_unit = prefix_for(std::min(smallest, force));
    if (force >= 1e4 * scales.force_unit.factor) scales.force_unit = prefix_for(force);
    for (int k = 0; k < frames() && moment > 0; ++k)
        if (moment_share(k) > 0) scales.moment = round_up_125(moment);
    scales.largest_force = force;
}

const std::vector<double>* column(const sim::Table& table, Channel channel) {
    for (std::size_t c = 0; c < table.channels.size(); ++c)
        if (table.channels[c] == channel && c < table.values.size()) return &table.values[c];
    return nullptr;
}

double first_touch(const Motion& motion) {
    return motion.impacts.empty() ? std::numeric_limits<double>::infinity() : motion.impacts.front().t_start;
}

double first_touch(const FilmContext& context) {
    double touch = std::numeric_limits<double>::infinity();
    for (int m = 0; m < context.members(); ++m) touch = std::min(touch, first_touch(context.motion(m)));
    return touch;
}

double begins_with_touch(const FilmContext& context) {
    const double touch = first_touch(context);
    return touch <= context.clock.at(context.frames() - 1) ? touch : -std::numeric_limits<double>::infinity();
}

double value_at(const std::vector<double>& times, const std::vector<double>& values, double t) {
    const auto after = std::ranges::upper_bound(times, t);
    if (after == times.begin()) return kNan;
    const auto i = static_cast<std::size_t>(after - times.begin()) - 1;
    if (times[i] == t || i + 1 == times.size()) return times[i] == t ? values[i] : kNan;
    const double share = (t - times[i]) / (times[i + 1] - times[i]);
    return values[i] * (1 - share) + values[i + 1] * share;
}

std::string motion_suffix(const FilmContext& context, int member) {
    return context.members() > 1 ? ", " + context.labels[static_cast<std::size_t>(member)] : std::string();
}

void draw_heading(Canvas& canvas, const FilmContext& context, const Box& box, const std::string& markup) {
    canvas.text({box.x, box.y + 26 * context.look.unit}, markup,
                {.size = context.look.letters.heading,
                 .color = context.look.palette.ink,
                 .weight = Weight::semibold,
                 .max_width = box.w});
}

void stroke_places(Canvas& canvas, const FilmContext& context, const std::vector<float>& places, double width,
                   const std::function<void(std::size_t)>& path, const std::function<Color(double)>& color) {
    constexpr int kShades = 12;
    if (!(context.scales.largest_force > 0)) return;
    std::array<std::vector<std::size_t>, kShades> shade;
    for (std::size_t i = 0; i < places.size(); ++i)
        if (places[i] > 0) {
            const double share = std::sqrt(std::min(1.0, double(places[i]) / context.scales.largest_force));
            shade[static_cast<std::size_t>(std::min(kShades - 1.0, std::floor(share * kShades)))].push_back(i);
        }
    for (int k = 0; k < kShades; ++k) {
        if (shade[static_cast<std::size_t>(k)].empty()) continue;
        for (std::size_t i : shade[static_cast<std::size_t>(k)]) path(i);
        canvas.stroke({color((k + 0.5) / kShades), width, {}, Cap::butt});
    }
}

}  // namespace beamcam::render
