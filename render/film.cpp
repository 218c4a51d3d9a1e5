#include "render/film.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "render/canvas.hpp"
#include "render/chart.hpp"
#include "render/error.hpp"
#include "render/labels.hpp"
#include "render/lit.hpp"
#include "render/mechanism.hpp"
#include "render/ticks.hpp"
#include "render/trace.hpp"

namespace beamcam::render {
namespace {

using sim::ChannelKind;
using sim::Pose;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kPi = std::numbers::pi;
constexpr int kFlashFrames = 24;  // an impact's ring fades within this many frames (0.4 s at 60 fps)
constexpr int kTrailFrames = 72;  // length of the tip's trail

const std::vector<double>* column(const sim::Table& table, ChannelKind kind) {
    for (std::size_t c = 0; c < table.channels.size(); ++c)
        if (table.channels[c].kind == kind && c < table.values.size()) return &table.values[c];
    return nullptr;
}

void check(const FilmSetup& s) {
    constexpr int kLargest = 16384;  // OSMesa's limit, and Cairo's is twice that
    if (s.width < 1 || s.height < 1 || s.width > kLargest || s.height > kLargest)
        throw PictureError(fmt::format("a picture of {}×{} pixels cannot be drawn; choose 1 to {} each way", s.width,
                                       s.height, kLargest));
    if (s.poses.empty()) throw PictureError("the film has no frames; give it a duration longer than half a frame");
    if (s.view.exaggeration && !(*s.view.exaggeration >= 1 && std::isfinite(*s.view.exaggeration)))
        throw PictureError(
            fmt::format("deflection cannot be exaggerated by {}; choose 1 (true) or more", *s.view.exaggeration));
    for (const Pose& pose : s.poses)
        if (pose.centreline.size() < 2) throw PictureError("a pose needs at least two stations along the beam");
}

// A box with room for shadows around it, in whole pixels, cut to the mechanism's.
Box covered(const Box& shapes, const Box& within, double unit) {
    const Box wide = shapes.inset(-26 * unit - 4);
    const double x0 = std::clamp(std::floor(wide.x), within.x, within.right() - 1),
                 y0 = std::clamp(std::floor(wide.y), within.y, within.bottom() - 1);
    const double x1 = std::clamp(std::ceil(wide.right()), x0 + 1, within.right()),
                 y1 = std::clamp(std::ceil(wide.bottom()), y0 + 1, within.bottom());
    return {x0, y0, x1 - x0, y1 - y0};
}

double pose_force(const Pose& pose) { return pose.nearest ? pose.nearest->force : kNan; }

struct Flash {
    int frame = 0;              // the first that shows it
    double material_angle = 0;  // on the disc, from its mark [rad]
};

}  // namespace

// ---- prepared once for a film ----------------------------------------------------------------

struct Film::Prepared {
    std::shared_ptr<const FilmSetup> setup;
    const Palette* palette = nullptr;
    bool cjk = false;
    Layout places;
    MechanismLook look;
    TimeFormat time;
    double force_scale = 0;  // largest force of the film, rounded up [N]
    double arrow_scale = 0;  // largest force of a frame [N]
    std::vector<TraceSample> samples;
    Box lit_box;             // what the lit mechanism ever covers, shadows included; whole pixels
    std::vector<Vec2> tips;  // drawn tip of every frame [px]
    std::vector<Flash> flashes;
    std::vector<Chart> charts;  // as places.charts
    std::vector<Image> pasts;
    std::vector<std::string> pills;
    Image ground;  // all that never changes
    std::vector<Box> ground_texts;

    explicit Prepared(std::shared_ptr<const FilmSetup> s);
    const Pose& pose(int frame) const { return setup->poses[static_cast<std::size_t>(frame)]; }
    DrawnBeam beam(int frame) const { return drawn_beam(setup->problem, pose(frame), look.factor, look.depth); }

  private:
    void choose_scales();
    void place_camera();
    void find_flashes();
    void make_charts();
    ChartContent angle_content() const;
    ChartContent force_content() const;
    ChartContent position_content() const;
    ChartContent deflection_content() const;
    double deflection_prefix() const;
    ChartContent blank_content() const;
    void draw_ground();
    void draw_header(Canvas& canvas) const;
    void draw_reference(Canvas& canvas) const;
    void draw_scale_bar(Canvas& canvas) const;
    void draw_color_bars(Canvas& canvas) const;
};

struct Film::Tools {
    explicit Tools(const Prepared& p) : fonts(p.cjk), trace(p.samples, 1, 1, 1, 1) {
        const sim::Problem& problem = p.setup->problem;
        const double r = problem.cam ? problem.cam->radius : 1, l = problem.beam.length, scale = p.look.camera.scale;
        const auto places = [](double px) { return static_cast<std::size_t>(std::clamp(px, 1.0, 65536.0)); };
        trace = Trace(p.samples, 2 * kPi * r, places(2 * kPi * r * scale), l, places(l * scale));
    }
    Fonts fonts;
    Trace trace;
    std::unique_ptr<LitRenderer> lit;  // made when first needed
    Image lit_image;
};

Film::Prepared::Prepared(std::shared_ptr<const FilmSetup> s) : setup(std::move(s)) {
    check(*setup);
    palette = &render::palette(setup->view.theme);
    cjk = needs_cjk(setup->title) || needs_cjk(setup->accuracy_note);
    std::vector<ChartKind> kinds{ChartKind::angle};
    samples = contact_samples(setup->trace);
    if (setup->problem.cam) kinds.push_back(ChartKind::force);
    if (setup->problem.cam) kinds.push_back(ChartKind::position);
    if (!setup->problem.cam && column(setup->chart, ChannelKind::tip_deflection))
        kinds.push_back(ChartKind::deflection);
    places = layout(setup->width, setup->height, kinds);
    std::vector<double> times;
    for (const Pose& p : setup->poses) times.push_back(p.t);
    time = time_format(times);
    choose_scales();
    place_camera();
    find_flashes();
    make_charts();
    draw_ground();
}

void Film::Prepared::choose_scales() {
    look.unit = places.unit;
    look.factor = film_factor(setup->problem, setup->poses, setup->view.exaggeration);
    double moment = 0, force = 0;
    for (const Pose& p : setup->poses) {
        for (double m : p.moment) moment = std::max(moment, std::abs(m));
        if (p.nearest) force = std::max(force, p.nearest->force);
    }
    arrow_scale = force;
    for (const TraceSample& s : samples) force = std::max(force, s.force);
    for (const sim::Impact& i : setup->impacts) force = std::max(force, i.force_peak);
    // What bends the beam by less than a billionth of its length is rounding, not a moment to be coloured.
    const double negligible = 1e-9 * setup->problem.beam.bending_stiffness() / setup->problem.beam.length;
    if (setup->problem.beam.model != sim::ModelKind::rigid && moment > negligible)
        look.moment_scale = round_up_125(moment);
    if (force > 0) force_scale = round_up_125(force);
    if (look.factor > 1) pills.push_back(fmt::format("deflection ×{}", power_text(look.factor)));
}

// The camera shows whatever is drawn at any frame, the disc wherever it turns, and the support.
void Film::Prepared::place_camera() {
    const sim::Problem& problem = setup->problem;
    const double u = places.unit;
    const Box room = places.mechanism.inset(std::min(26 * u, 0.08 * std::min(places.mechanism.w, places.mechanism.h)));
    look.depth = problem.beam.depth;
    std::vector<DrawnBeam> beams;
    for (int pass = 0; pass < 4; ++pass) {  // sizes fixed in pixels make the fit implicit; it settles at once
        if (pass < 2) {
            beams.clear();
            for (int k = 0; k < static_cast<int>(setup->poses.size()); ++k) beams.push_back(beam(k));
        }
        Bounds all;
        const double px = pass == 0 ? 0 : 1 / look.camera.scale;  // [m] of a pixel
        for (const DrawnBeam& b : beams)
            for (std::size_t i = 0; i < b.line.size(); i += (i + 5 < b.line.size() ? 4 : 1))
                all.add(b.face(i)), all.add(b.back(i));
        if (problem.cam) {
            const double swept = problem.cam->radius + problem.cam->eccentricity;
            all.add(setup->poses.front().cam_centre, swept + (problem.cam->speed != 0 ? 34 * u * px : 0));
        }
        const double hub = pass == 0 ? std::max(problem.hub.radius, 0.0) : hub_radius(problem, look.camera, u) * px;
        all.add({0, 0}, hub + 12 * u * px);
        all.add({0, -support_reach(hub / std::max(px, 1e-300), u) * px});
        look.camera = fit(all, room);
        // A beam thinner than a line gets the weight of one; it grows away from the cam.
        look.depth = std::max(problem.beam.depth, 7 * u / look.camera.scale);
    }
    Bounds seen;
    for (int k = 0; k < static_cast<int>(setup->poses.size()); ++k) {
        const MechanismShape shape = mechanism_shape(problem, pose(k), beam(k), look, *palette);
        tips.push_back((shape.face.back() + shape.back.back()) * 0.5);
        for (std::size_t i = 0; i < shape.face.size(); ++i) seen.add(shape.face[i]), seen.add(shape.back[i]);
        seen.add(shape.hinge, shape.hub);
        if (shape.disc) seen.add(shape.disc->centre, shape.disc->radius);
    }
    lit_box = covered({seen.x0, seen.y0, seen.x1 - seen.x0, seen.y1 - seen.y0}, places.mechanism, u);
}

void Film::Prepared::find_flashes() {
    for (const sim::Impact& impact : setup->impacts) {
        const auto at = std::ranges::lower_bound(setup->poses, impact.t_start, {}, &Pose::t);
        if (at == setup->poses.end() || (at == setup->poses.begin() && at->t > impact.t_start)) continue;
        const int frame = static_cast<int>(at - setup->poses.begin());
        const DrawnBeam b = beam(frame);
        if (!b.contact) continue;
        flashes.push_back({frame, std::atan2(b.contact->normal.y, b.contact->normal.x) - at->cam_angle});
    }
}

// ---- charts ----------------------------------------------------------------------------------

ChartContent Film::Prepared::blank_content() const {
    ChartContent c;
    double first = setup->poses.front().t, last = setup->poses.back().t;
    if (const auto* t = column(setup->chart, ChannelKind::t); t && !t->empty()) {
        first = std::min(first, *std::ranges::min_element(*t));
        last = std::max(last, *std::ranges::max_element(*t));
    }
    c.time = {first / time.unit, last / time.unit};
    if (!(c.time.high > c.time.low)) c.time.high = c.time.low + 1;  // a still of one instant
    c.time_label = math("t") + " / " + time.symbol;
    for (const sim::Impact& i : setup->impacts) c.marks.push_back({i.t_start / time.unit});
    std::erase_if(c.marks, [&](const ChartMark& m) { return m.t < c.time.low || m.t > c.time.high; });
    c.color = palette->motion, c.faint = palette->motion_faint;
    return c;
}

ChartContent Film::Prepared::angle_content() const {
    ChartContent c = blank_content();
    c.words = "Hub angle ", c.symbol = math("θ") + " / rad";
    double low = setup->poses.front().theta, high = low;
    for (const Pose& p : setup->poses) low = std::min(low, p.theta), high = std::max(high, p.theta);
    const auto *t = column(setup->chart, ChannelKind::t), *theta = column(setup->chart, ChannelKind::theta);
    if (t && theta)
        for (std::size_t i = 0; i < setup->chart.rows(); ++i) {
            c.t.push_back((*t)[i] / time.unit), c.v.push_back((*theta)[i]);
            if (!std::isnan((*theta)[i])) low = std::min(low, (*theta)[i]), high = std::max(high, (*theta)[i]);
        }
    // A constant angle still needs an axis: a twentieth of a radian either way.
    if (high - low < 1e-9) low -= 0.05, high += 0.05;
    c.value = {low, high};
    return c;
}

// The force from the chart's table, with the peaks that its sampling misses.
ChartContent Film::Prepared::force_content() const {
    ChartContent c = blank_content();
    const Prefix prefix = prefix_for(force_scale > 0 ? force_scale : 1);
    c.words = "Contact force ", c.symbol = math("F") + " / " + prefix.symbol + "N";
    c.color = palette->contact, c.faint = palette->contact_faint;
    c.filled = true;
    c.value = {0, (force_scale > 0 ? force_scale : 1) / prefix.factor};
    std::vector<std::array<double, 2>> rows;
    const auto *t = column(setup->chart, ChannelKind::t), *force = column(setup->chart, ChannelKind::contact_force);
    if (t && force)
        for (std::size_t i = 0; i < setup->chart.rows(); ++i)
            if (!std::isnan((*force)[i])) rows.push_back({(*t)[i], (*force)[i]});
    for (const TraceSample& s : samples) rows.push_back({s.t, s.force});
    // Only impacts that fall between the samples: a longer contact shows its own peak.
    const double spacing = t && t->size() > 1 ? (t->back() - t->front()) / static_cast<double>(t->size() - 1) : 0;
    for (const sim::Impact& i : setup->impacts) {
        if (!i.t_end || *i.t_end - i.t_start > 4 * spacing) continue;
        rows.push_back({i.t_start, 0});
        rows.push_back({(i.t_start + *i.t_end) / 2, i.force_peak});
        rows.push_back({*i.t_end, 0});
    }
    std::erase_if(rows, [&](const auto& r) { return r[0] / time.unit < c.time.low || r[0] / time.unit > c.time.high; });
    std::ranges::stable_sort(rows, {}, [](const auto& r) { return r[0]; });
    double most = 0;
    for (const auto& r : rows) {
        c.t.push_back(r[0] / time.unit), c.v.push_back(r[1] / prefix.factor);
        most = std::max(most, r[1] / prefix.factor);
    }
    if (most > 0) c.value = {0, 1.02 * most};
    return c;
}

ChartContent Film::Prepared::position_content() const {
    ChartContent c = blank_content();
    const sim::Problem& problem = setup->problem;
    const Prefix prefix = prefix_for(problem.beam.length);
    c.words = "Contact point on the beam ", c.symbol = math("x") + "<sub>c</sub> / " + prefix.symbol + "m";
    c.color = palette->contact, c.faint = palette->contact_faint;
    double low = 0, high = problem.beam.length / prefix.factor;
    if (!samples.empty()) {
        const auto [least, most] = std::ranges::minmax_element(samples, {}, &TraceSample::x);
        low = least->x / prefix.factor, high = most->x / prefix.factor;
        const double around = std::max(0.05 * (high - low), 1e-3 * problem.beam.length / prefix.factor);
        low -= around, high += around;
    }
    c.value = {low, high};
    for (const TraceSample& s : samples) {
        const double t = s.t / time.unit;
        if (t < c.time.low || t > c.time.high) continue;
        c.dots.push_back({t, s.x / prefix.factor, force_color(*palette, std::sqrt(s.force / force_scale))});
    }
    return c;
}

double Film::Prepared::deflection_prefix() const {
    double most = 0;
    if (const auto* v = column(setup->chart, ChannelKind::tip_deflection))
        for (double d : *v)
            if (std::abs(d) > most) most = std::abs(d);
    return most > 0 ? prefix_for(most).factor : 1;
}

ChartContent Film::Prepared::deflection_content() const {
    ChartContent c = blank_content();
    const double unit = deflection_prefix();
    c.words = "Tip ", c.symbol = std::string("deflection / ") + prefix_for(unit).symbol + "m";
    const auto *t = column(setup->chart, ChannelKind::t), *v = column(setup->chart, ChannelKind::tip_deflection);
    double most = 0;
    for (std::size_t i = 0; t && v && i < setup->chart.rows(); ++i) {
        c.t.push_back((*t)[i] / time.unit), c.v.push_back((*v)[i] / unit);
        if (!std::isnan(c.v.back())) most = std::max(most, std::abs(c.v.back()));
    }
    if (most == 0) most = 1;
    c.value = {-most, most};
    return c;
}

void Film::Prepared::make_charts() {
    const Fonts fonts(cjk);
    for (const ChartSlot& slot : places.charts) {
        switch (slot.kind) {
            case ChartKind::angle:
                charts.emplace_back(angle_content(), slot.box, slot.plot, places.unit);
                break;
            case ChartKind::force:
                charts.emplace_back(force_content(), slot.box, slot.plot, places.unit);
                break;
            case ChartKind::position:
                charts.emplace_back(position_content(), slot.box, slot.plot, places.unit);
                break;
            case ChartKind::deflection:
                charts.emplace_back(deflection_content(), slot.box, slot.plot, places.unit);
                break;
        }
        pasts.push_back(charts.back().past(fonts, *palette));
    }
}

// ---- the ground layer ------------------------------------------------------------------------

void Film::Prepared::draw_ground() {
    ground = Image(setup->width, setup->height);
    const Fonts fonts(cjk);
    Canvas canvas(ground, fonts);
    canvas.record = &ground_texts;
    canvas.paint(palette->paper);
    draw_header(canvas);
    draw_reference(canvas);
    for (const Chart& chart : charts) chart.draw_ground(canvas, *palette);
    draw_scale_bar(canvas);
    draw_color_bars(canvas);
}

void Film::Prepared::draw_header(Canvas& canvas) const {
    const double u = places.unit;
    if (const auto& b = places.title; b && !setup->title.empty()) {
        TextStyle style{.size = 40 * u, .color = palette->ink, .weight = Weight::semibold};
        // A long title becomes smaller, down to two thirds; then it is cut.
        const double natural = canvas.measure(escape(setup->title), style).w;
        if (natural > b->w) style.size *= std::max(2.0 / 3, 0.999 * b->w / natural);
        style.max_width = b->w;
        canvas.text({b->x, b->y + 38 * u}, escape(setup->title), style);
    }
    if (const auto& b = places.parameters) {
        const TextStyle style{.size = 21 * u, .color = palette->muted};
        double x = b->x;
        for (const std::string& piece : parameter_pieces(setup->problem)) {  // whole pieces, as many as fit
            const double w = canvas.measure(piece, style).w;
            if (x + w > b->right()) break;
            canvas.text({x, b->y + 24 * u}, piece, style);
            x += w + 26 * u;
        }
    }
    if (const auto& b = places.note; b && !setup->accuracy_note.empty())
        canvas.text({b->right(), b->y + 19 * u}, escape(setup->accuracy_note),
                    {.size = 17 * u, .color = palette->muted, .align = Align::right, .max_width = b->w});
}

void Film::Prepared::draw_reference(Canvas& canvas) const {
    const double u = places.unit;
    const Vec2 o = look.camera.to_pixels({0, 0});
    canvas.move_to({places.mechanism.x, o.y});
    canvas.line_to({places.mechanism.right(), o.y});
    canvas.stroke({palette->faint, 1.5 * u, {10 * u, 8 * u}, Cap::butt});
    draw_support(canvas, o, hub_radius(setup->problem, look.camera, u), u, *palette);
}

// A round length near a seventh of the view, at the bottom left of the mechanism.
void Film::Prepared::draw_scale_bar(Canvas& canvas) const {
    const double u = places.unit;
    const Box& m = places.mechanism;
    if (m.w < 300 * u || m.h < 220 * u || !places.clock) return;
    const double length = round_down_125(0.17 * m.w / look.camera.scale), w = length * look.camera.scale;
    const double y = m.bottom() - 8 * u, x = m.right() - w - 4 * u;
    canvas.move_to({x, y - 5 * u});
    canvas.line_to({x, y});
    canvas.line_to({x + w, y});
    canvas.line_to({x + w, y - 5 * u});
    canvas.stroke({palette->muted, 1.6 * u, {}, Cap::butt});
    canvas.text({x + w / 2, y - 9 * u}, quantity(length, "m"),
                {.size = 17 * u, .color = palette->muted, .align = Align::centre, .halo = palette->paper});
}

void Film::Prepared::draw_color_bars(Canvas& canvas) const {
    if (!places.scales) return;
    const double u = places.unit;
    const Box& b = *places.scales;
    const TextStyle small{.size = 16 * u, .color = palette->muted, .align = Align::centre};
    const auto bar = [&](double right, const std::string& name, const auto& color, std::array<std::string, 3> marks,
                         std::array<double, 3> at) {
        const Box strip{std::round(right - 250 * u), std::round(b.y + 22 * u), std::round(250 * u), std::round(10 * u)};
        for (double i = 0; i < strip.w; ++i) {
            canvas.rectangle({strip.x + i, strip.y, 1, strip.h});
            canvas.fill(color((i + 0.5) / strip.w));
        }
        canvas.text({strip.x + strip.w / 2, strip.y - 8 * u}, name, small);
        for (std::size_t i = 0; i < 3; ++i) {
            TextStyle style = small;
            style.align = i == 0 ? Align::left : i == 1 ? Align::centre : Align::right;
            canvas.text({strip.x + at[i] * strip.w, strip.bottom() + 19 * u}, marks[i], style);
        }
    };
    double right = b.right();
    if (force_scale > 0) {
        const std::string top = quantity(force_scale, "N"), quarter = quantity(force_scale / 4, "N");
        bar(right, "contact force, trace", [&](double s) { return force_color(*palette, s); }, {"0", quarter, top},
            {0, 0.5, 1});
        right -= 300 * u;
    }
    if (look.moment_scale > 0) {
        const std::string top = quantity(look.moment_scale, "N\u2009m");
        bar(right, "bending moment", [&](double s) { return moment_color(*palette, 2 * s - 1); }, {"−" + top, "0", top},
            {0, 0.5, 1});
    }
}

// ---- what moves ------------------------------------------------------------------------------

namespace {

// Places with a force, as short strokes; strong over weak. `path(i)` adds the stroke of place i.
void stroke_places(Canvas& canvas, const std::vector<float>& places, double force_scale, const Palette& palette,
                   double width, const std::function<void(std::size_t)>& path) {
    constexpr int kShades = 12;
    if (!(force_scale > 0)) return;
    std::array<std::vector<std::size_t>, kShades> shade;
    for (std::size_t i = 0; i < places.size(); ++i)
        if (places[i] > 0) {
            const double share = std::sqrt(std::min(1.0, double(places[i]) / force_scale));
            shade[static_cast<std::size_t>(std::min(kShades - 1.0, std::floor(share * kShades)))].push_back(i);
        }
    for (int k = 0; k < kShades; ++k) {
        if (shade[static_cast<std::size_t>(k)].empty()) continue;
        for (std::size_t i : shade[static_cast<std::size_t>(k)]) path(i);
        canvas.stroke({force_color(palette, (k + 0.5) / kShades), width, {}, Cap::butt});
    }
}

Vec2 down(double angle) { return {std::cos(angle), -std::sin(angle)}; }  // unit vector in pixels

}  // namespace

// One frame being drawn: the layers in their order, each a method.
class FramePainter {
  public:
    struct Context {
        const FilmSetup& setup;
        const Palette& palette;
        const Layout& places;
        const MechanismLook& look;
        const TimeFormat& time;
        const std::vector<Vec2>& tips;
        const std::vector<Flash>& flashes;
        const std::vector<std::string>& pills;
        double force_scale, arrow_scale;
    };
    FramePainter(const Context& c, int frame, const DrawnBeam& beam, Canvas& canvas)
        : c_(c),
          frame_(frame),
          pose_(c.setup.poses[static_cast<std::size_t>(frame)]),
          beam_(beam),
          canvas_(canvas),
          u_(c.places.unit),
          small_(c.places.mechanism.w < 420 * c.places.unit || c.places.mechanism.h < 300 * c.places.unit) {}

    void trail() const;
    void angle_arc() const;
    void turning_arrow() const;
    void base_line() const;
    void disc_marks(const MechanismShape& shape, const Trace& trace) const;
    void beam_trace(const Trace& trace) const;
    void flash() const;
    void force_arrow() const;
    void clock() const;

  private:
    Vec2 px(Vec2 world) const { return c_.look.camera.to_pixels(world); }
    const sim::Problem& problem() const { return c_.setup.problem; }

    const Context& c_;
    int frame_;
    const Pose& pose_;
    const DrawnBeam& beam_;
    Canvas& canvas_;
    double u_;
    bool small_;
};

// The tip's path over the last frames, fading.
void FramePainter::trail() const {
    const int first = std::max(0, frame_ - kTrailFrames);
    for (int k = first; k < frame_; ++k) {
        const double age = double(frame_ - k) / kTrailFrames;
        canvas_.move_to(c_.tips[static_cast<std::size_t>(k)]);
        canvas_.line_to(c_.tips[static_cast<std::size_t>(k + 1)]);
        canvas_.stroke({c_.palette.motion.faded(0.55 * (1 - age)), 2 * u_, {}, Cap::butt});
    }
}

void FramePainter::angle_arc() const {
    if (small_) return;
    double radius = 92 * u_;
    if (problem().cam) {
        const double free = norm(pose_.cam_centre) - problem().cam->radius - problem().cam->eccentricity;
        radius = std::min(radius, 0.86 * free * c_.look.camera.scale);
    }
    const double hub = hub_radius(problem(), c_.look.camera, u_);
    const double angle = std::remainder(pose_.theta, 2 * kPi);
    if (radius < hub + 22 * u_ || std::abs(angle) < 0.02) return;
    canvas_.arc(px({0, 0}), radius, 0, angle);
    canvas_.stroke({c_.palette.muted, 1.6 * u_, {}, Cap::butt});
    const double room = std::clamp((std::abs(angle) * radius - 30 * u_) / (12 * u_), 0.0, 1.0);
    if (room > 0 && radius > hub + 38 * u_)
        canvas_.text(px({0, 0}) + down(angle / 2) * (radius - 17 * u_) + Vec2{0, 6 * u_}, math("θ"),
                     {.size = 21 * u_,
                      .color = c_.palette.muted.faded(room),
                      .align = Align::centre,
                      .halo = c_.palette.paper.faded(room)});
}

// Outside the circle that the disc sweeps, on the side away from the beam; positive speed turns clockwise.
void FramePainter::turning_arrow() const {
    if (!problem().cam || small_) return;
    const sim::Cam& cam = *problem().cam;
    const Vec2 axis = px(pose_.cam_centre);
    const double swept = (cam.radius + cam.eccentricity) * c_.look.camera.scale, radius = swept + 20 * u_;
    const std::string label = math("ω") + "\u2009=\u2009" + quantity(cam.speed, "rad/s");
    const TextStyle style{.size = 21 * u_, .color = c_.palette.muted, .halo = c_.palette.paper};
    if (cam.speed != 0) {
        const double span = std::min(0.8, 150 * u_ / radius), middle = -0.30 * kPi;
        const double from = middle + (cam.speed > 0 ? span / 2 : -span / 2), to = 2 * middle - from;
        const double head = 17 * u_, back = (to < from ? 1 : -1) * 0.9 * head / radius;
        canvas_.arc(axis, radius, from, to + back);
        canvas_.stroke({c_.palette.muted, 2.6 * u_, {}, Cap::butt});
        canvas_.arrow(axis + down(to + back) * radius, axis + down(to) * radius, {c_.palette.muted, 2.6 * u_}, head);
    }
    const Vec2 at = axis + down(-0.26 * kPi) * (radius + 16 * u_);
    canvas_.text({at.x + 8 * u_, at.y + 12 * u_}, label, style);
}

// The straight line that deflection is drawn about.
void FramePainter::base_line() const {
    if (c_.look.factor == 1) return;
    const Vec2 base = sim::unit(beam_.base_angle);
    const double clear = 4 * u_ / c_.look.camera.scale;
    std::vector<Vec2> line;  // only where it runs clear of the section: dashes along an edge would be noise
    for (Vec2 p : beam_.line) {
        const double below = -cross(base, p);  // the base line's offset from the centre line
        const bool covered = below > beam_.low - clear && below < beam_.high + clear;
        line.push_back(covered ? Vec2{kNan, kNan} : px(base * dot(base, p)));
    }
    canvas_.polyline(line);
    canvas_.stroke({c_.palette.faint, 1.5 * u_, {6 * u_, 7 * u_}, Cap::butt});
}

void FramePainter::disc_marks(const MechanismShape& shape, const Trace& trace) const {
    if (!shape.disc) return;
    const DiscShape& d = *shape.disc;
    const double inset = std::min(7 * u_, 0.1 * d.radius), n = static_cast<double>(trace.rim().size());
    stroke_places(
        canvas_, trace.rim(), c_.force_scale, c_.palette, std::min(7 * u_, 0.1 * d.radius), [&](std::size_t i) {
            const double at = d.angle + 2 * kPi * (static_cast<double>(i) + 0.5) / n, half = 2 * kPi * 1.7 / n;
            canvas_.move_to(d.centre + down(at - half) * (d.radius - inset));
            canvas_.arc(d.centre, d.radius - inset, at - half, at + half);
        });
    if (d.radius < 26 * u_) return;
    const Color ink = c_.setup.view.theme == Theme::dark && c_.setup.view.style == Style::flat ? c_.palette.paper
                      : c_.setup.view.theme == Theme::dark                                     ? rgb(0x14171D)
                                                                                               : c_.palette.steel_edge;
    const double apart = norm(d.centre - d.axis);
    if (apart > d.bore + 2) {
        canvas_.move_to(d.axis + (d.centre - d.axis) * (d.bore / apart));
        canvas_.line_to(d.centre);
        canvas_.stroke({ink, 1.8 * u_});
    }
    canvas_.circle(d.centre, 4 * u_);
    canvas_.fill(ink);
    for (Vec2 arm : {Vec2{1, 0}, Vec2{0, 1}}) {
        canvas_.move_to(d.axis - arm * (d.bore * 0.75));
        canvas_.line_to(d.axis + arm * (d.bore * 0.75));
    }
    canvas_.stroke({c_.palette.ink, 1.6 * u_, {}, Cap::butt});
    if (d.radius < 60 * u_) return;
    // The letters stand beyond the ends of the line C–B, so that they keep off it at any angle.
    const Vec2 along = apart > 2 ? (d.centre - d.axis) * (1 / apart) : Vec2{0, -1};
    const TextStyle style{.size = 22 * u_, .color = ink, .align = Align::centre};
    canvas_.text(d.centre + along * (20 * u_) + Vec2{0, 7 * u_}, math("B"), style);
    canvas_.text(d.axis - along * (d.bore + 16 * u_) + Vec2{0, 7 * u_}, math("C"), style);
}

void FramePainter::beam_trace(const Trace& trace) const {
    const double n = static_cast<double>(trace.beam().size()), last = static_cast<double>(beam_.line.size() - 1);
    const double inset = 4.5 * u_;
    const auto at = [&](double place) {
        const double station = std::clamp(place / n * last, 0.0, last);
        const auto i = std::min(static_cast<std::size_t>(station), beam_.line.size() - 2);
        const double s = station - static_cast<double>(i);
        const Vec2 face = px(beam_.face(i) * (1 - s) + beam_.face(i + 1) * s),
                   back = px(beam_.back(i) * (1 - s) + beam_.back(i + 1) * s);
        return face + (back - face) * (inset / norm(back - face));
    };
    stroke_places(canvas_, trace.beam(), c_.force_scale, c_.palette, 5 * u_, [&](std::size_t i) {
        canvas_.move_to(at(static_cast<double>(i) - 1.2));
        canvas_.line_to(at(static_cast<double>(i) + 2.2));
    });
}

// A ring that opens and fades where an impact began, carried along by the disc.
void FramePainter::flash() const {
    if (!problem().cam) return;
    for (const Flash& f : c_.flashes) {
        const int age = frame_ - f.frame;
        if (age < 0 || age >= kFlashFrames) continue;
        const double s = double(age) / kFlashFrames;
        const Vec2 at = px(pose_.disc_centre + sim::unit(pose_.cam_angle + f.material_angle) * problem().cam->radius);
        canvas_.circle(at, (7 + 20 * std::sqrt(s)) * u_);
        canvas_.stroke({c_.palette.contact.faded((1 - s) * (1 - s)), (3.2 - 2 * s) * u_});
    }
}

void FramePainter::force_arrow() const {
    if (!pose_.nearest || !pose_.nearest->touching || !(pose_.nearest->force > 0) || !beam_.contact) return;
    const Vec2 foot = px(beam_.contact->on_disc), n{beam_.contact->normal.x, -beam_.contact->normal.y};
    canvas_.circle(foot, 5 * u_);
    canvas_.fill(c_.palette.contact);
    // A stub that shows the direction, then in proportion to the force; the number stands beside it.
    const double longest = (small_ ? 60 : 150) * u_, stub = 36 * u_;
    const double length = stub + (longest - stub) * pose_.nearest->force / c_.arrow_scale;
    const Vec2 tip = foot + n * length;
    canvas_.arrow(foot, tip, {c_.palette.contact, 4 * u_}, 19 * u_);
    if (small_) return;
    const TextStyle style{.size = 22 * u_,
                          .color = c_.palette.contact,
                          .weight = Weight::medium,
                          .align = Align::right,
                          .halo = c_.palette.paper};
    const std::string label = math("F") + "\u2009=\u2009" + quantity(pose_.nearest->force, "N");
    // Beside the tip and clear of the beam's back, however short the arrow.
    const double clear = std::max(length, c_.look.depth * c_.look.camera.scale + 26 * u_);
    Vec2 at = foot + n * clear + Vec2{-14 * u_, 6 * u_};
    const double w = canvas_.measure(label, style).w;
    at.x = std::max(at.x, c_.places.mechanism.x + w);
    canvas_.text(at, label, style);
}

void FramePainter::clock() const {
    if (!c_.places.clock) return;
    const Box& b = *c_.places.clock;
    const TextStyle big{.size = 46 * u_, .color = c_.palette.ink, .weight = Weight::semibold};
    const std::string text = clock_text(c_.time, pose_.t);
    const double widest = canvas_.measure(clock_text(c_.time, c_.setup.poses.back().t), big).w;
    if (widest > b.w) return;
    canvas_.text({b.x, b.y + 40 * u_}, text, big);
    double x = b.x + widest + 36 * u_;
    for (const std::string& pill : c_.pills) {
        const TextStyle style{.size = 20 * u_, .color = c_.palette.motion, .weight = Weight::medium};
        const Box size = canvas_.measure(pill, style);
        const Box box{x, b.y + 6 * u_, size.w + 34 * u_, 36 * u_};
        if (box.right() > b.right()) break;
        canvas_.rounded(box, 18 * u_);
        canvas_.fill(c_.palette.motion.faded(0.14));
        canvas_.text({x + 17 * u_, b.y + 31 * u_}, pill, style);
        x = box.right() + 14 * u_;
    }
}

namespace {

LitScene lit_scene(const MechanismShape& shape, const MechanismLook& look, const Palette& palette, Vec2 origin) {
    LitScene scene;
    scene.unit = look.unit;
    scene.shadow = palette.shadow;
    const double u = look.unit;
    if (shape.disc) {
        const DiscShape& d = *shape.disc;
        scene.behind.push_back({d.centre - origin, d.radius, d.axis - origin, d.bore,
                                std::min(4.5 * u, 0.06 * d.radius), palette.steel, Finish::turned, true});
        scene.behind.push_back(
            {d.mark - origin, d.mark_radius, {}, 0, 0, mix(palette.steel, rgb(0), 0.25), Finish::dimple, false});
    }
    for (std::size_t i = 0; i < shape.face.size(); ++i) {
        scene.strip.face.push_back(shape.face[i] - origin);
        scene.strip.back.push_back(shape.back[i] - origin);
    }
    scene.strip.colors = shape.colors;
    scene.strip.chamfer = std::min(6 * u, 0.2 * norm(shape.back[0] - shape.face[0]));
    scene.front.push_back(
        {shape.hinge - origin, shape.hub, {}, 0, 4 * u, mix(palette.steel, rgb(0xFFFFFF), 0.15), Finish::turned, true});
    scene.front.push_back({shape.hinge - origin, shape.pin, {}, 0, 0, palette.pin, Finish::dome, false});
    return scene;
}

// What the scene can touch, shadows included: beyond it the lit picture is transparent.
Box lit_bounds(const LitScene& scene) {
    Bounds all;
    for (const auto* rounds : {&scene.behind, &scene.front})
        for (const LitRound& r : *rounds) all.add(r.centre, r.radius);
    for (Vec2 p : scene.strip.face) all.add(p);
    for (Vec2 p : scene.strip.back) all.add(p);
    const double around = 26 * scene.unit + 4;
    return {all.x0 - around, all.y0 - around, all.x1 - all.x0 + 2 * around, all.y1 - all.y0 + 2 * around};
}

}  // namespace

// ---- the film --------------------------------------------------------------------------------

Film::Film(FilmSetup setup) : Film(std::make_shared<const FilmSetup>(std::move(setup))) {}
Film::Film(std::shared_ptr<const FilmSetup> setup) : Film(std::make_shared<const Prepared>(std::move(setup))) {}
Film::Film(std::shared_ptr<const Prepared> prepared)
    : prepared_(std::move(prepared)), tools_(std::make_unique<Tools>(*prepared_)) {}
Film::~Film() = default;
Film::Film(Film&&) noexcept = default;
Film& Film::operator=(Film&&) noexcept = default;

Film Film::another() const { return Film(prepared_); }
int Film::frames() const { return static_cast<int>(prepared_->setup->poses.size()); }
double Film::exaggeration() const { return prepared_->look.factor; }

namespace {

void paint_cursors(Canvas& canvas, const std::vector<Chart>& charts, const std::vector<Image>& pasts,
                   const Layout& places, const Palette& palette, const Pose& pose, const TimeFormat& time,
                   const sim::Problem& problem, double force_scale) {
    for (std::size_t i = 0; i < charts.size(); ++i) {
        const Chart& chart = charts[i];
        const double t = pose.t / time.unit;
        const Box at = chart.past_box();
        canvas.image_until(pasts[i], static_cast<int>(at.x), static_cast<int>(at.y), chart.cursor_column(t) + 1);
        switch (places.charts[i].kind) {
            case ChartKind::angle:
                chart.draw_cursor(canvas, palette, t, pose.theta, fixed(pose.theta, 3));
                break;
            case ChartKind::force: {
                const double force = pose_force(pose) / prefix_for(force_scale > 0 ? force_scale : 1).factor;
                chart.draw_cursor(canvas, palette, t, force,
                                  std::isnan(force) ? "" : fixed(force, force < 100 ? 1 : 0));
                break;
            }
            case ChartKind::position: {
                const bool on = pose.nearest && pose.nearest->touching;
                const double x = on ? pose.nearest->x / prefix_for(problem.beam.length).factor : kNan;
                chart.draw_cursor(canvas, palette, t, x, on ? fixed(x, problem.beam.length == 1 ? 4 : 3) : "");
                break;
            }
            case ChartKind::deflection:
                chart.draw_cursor(canvas, palette, t, kNan, "");
                break;
        }
    }
}

}  // namespace

void Film::paint(int frame, Style style, Image& out, std::vector<Box>* texts) {
    const Prepared& p = *prepared_;
    if (frame < 0 || frame >= frames()) throw std::out_of_range(fmt::format("frame {} of {}", frame, frames()));
    out = p.ground;
    const Pose& pose = p.pose(frame);
    const DrawnBeam beam = p.beam(frame);
    const MechanismShape shape = mechanism_shape(p.setup->problem, pose, beam, p.look, *p.palette);
    tools_->trace.show_until(pose.t);
    Canvas canvas(out, tools_->fonts);
    canvas.record = texts;
    const FramePainter::Context context{*p.setup, *p.palette, p.places, p.look,        p.time,
                                        p.tips,   p.flashes,  p.pills,  p.force_scale, p.arrow_scale};
    const FramePainter painter(context, frame, beam, canvas);

    painter.trail();
    painter.angle_arc();
    painter.base_line();
    painter.turning_arrow();
    switch (style) {
        case Style::lit:
            draw_lit(shape, canvas);
            break;
        case Style::flat:
            draw_flat(canvas, shape, p.look, *p.palette);
            break;
    }
    painter.disc_marks(shape, tools_->trace);
    painter.beam_trace(tools_->trace);
    painter.flash();
    painter.force_arrow();
    painter.clock();
    paint_cursors(canvas, p.charts, p.pasts, p.places, *p.palette, pose, p.time, p.setup->problem, p.force_scale);
}

void Film::draw_lit(const MechanismShape& shape, Canvas& canvas) {
    const Box& box = prepared_->lit_box;
    if (!tools_->lit) tools_->lit = make_lit_renderer(static_cast<int>(box.w), static_cast<int>(box.h));
    const LitScene scene = lit_scene(shape, prepared_->look, *prepared_->palette, {box.x, box.y});
    tools_->lit->draw(scene, tools_->lit_image);
    canvas.image_part(tools_->lit_image, static_cast<int>(box.x), static_cast<int>(box.y), lit_bounds(scene));
}

void Film::draw(int frame, Image& out) { paint(frame, prepared_->setup->view.style, out, nullptr); }

FrameGeometry Film::geometry(int frame) {
    const Prepared& p = *prepared_;
    FrameGeometry out{p.places, p.look.camera, p.look.factor, {}, p.ground_texts};
    Image scratch;
    paint(frame, Style::flat, scratch, &out.texts);
    out.beam = p.beam(frame);
    return out;
}

}  // namespace beamcam::render
