#include "render/film/mechanism_panel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <ranges>
#include <utility>

#include "render/draw/smooth_path.hpp"
#include "render/plot/ticks.hpp"

namespace beamcam::render {
namespace {

using sim::Pose;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kPi = std::numbers::pi;
constexpr double kFlash = 0.4;   // an impact's ring fades within so much of the film [s]
constexpr double kTrail = 1.2;   // so much of the film is the tip's trail, what stands still not counted [s]
constexpr double kReadable = 9;  // the least size of letters [px]
constexpr double kArcStep = 6;   // of what is drawn of the tip's path [design px]

// A box with room for shadows around it, in whole pixels, cut to the mechanism's.
Box covered(const Box& shapes, const Box& within, double unit) {
    const Box wide = shapes.inset(-26 * unit - 4);
    const double x0 = std::clamp(std::floor(wide.x), within.x, within.right() - 1),
                 y0 = std::clamp(std::floor(wide.y), within.y, within.bottom() - 1);
    const double x1 = std::clamp(std::ceil(wide.right()), x0 + 1, within.right()),
                 y1 = std::clamp(std::ceil(wide.bottom()), y0 + 1, within.bottom());
    return {x0, y0, x1 - x0, y1 - y0};
}

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

// Tiles that a round can touch in a picture of this height.
void add_round(Tiles& tiles, int height, Vec2 centre, double radius) {
    constexpr double kRow = Tiles::kHeight;
    const double from = std::min<double>(height, std::max(0.0, centre.y - radius)),
                 to = std::min<double>(height, centre.y + radius);
    for (int row = static_cast<int>(std::floor(from / kRow)); row * kRow < to; ++row) {
        const double y = row * kRow;
        const double off = std::clamp(centre.y, y, y + kRow) - centre.y;
        const double half = std::sqrt(std::max(0.0, radius * radius - off * off));
        tiles.add({centre.x - half, y, 2 * half, kRow - 1});
    }
}

// What the scene, whose corner is at `origin`, can touch, shadows included: beyond it the lit picture is transparent.
Tiles lit_tiles(const LitScene& scene, Vec2 origin, int width, int height) {
    Tiles tiles(width, height);
    const double around = 26 * scene.unit + 4;
    for (const auto* rounds : {&scene.behind, &scene.front})
        for (const LitRound& r : *rounds) add_round(tiles, height, origin + r.centre, r.radius + around);
    const LitStrip& strip = scene.strip;
    for (std::size_t i = 0; i + 1 < strip.face.size(); ++i) {
        Bounds piece;
        for (Vec2 p : {strip.face[i], strip.face[i + 1], strip.back[i], strip.back[i + 1]})
            piece.add(origin + p, around);
        tiles.add({piece.x0, piece.y0, piece.x1 - piece.x0, piece.y1 - piece.y0});
    }
    return tiles;
}

// Markup of the lines that plain words fill, broken where they say so or grow too wide; six at most.
std::vector<std::string> wrapped(Canvas& canvas, const std::string& words, const TextStyle& style) {
    constexpr std::size_t kMost = 6;
    TextStyle natural = style;
    natural.max_width = 0;
    std::vector<std::string> lines;
    std::string line;
    const auto markup = [&](const std::string& plain) { return escape(canvas.drawable(plain)); };
    const auto end_line = [&] {
        lines.push_back(markup(line));
        line.clear();
    };
    for (std::size_t at = 0; at < words.size() && lines.size() < kMost;) {
        const std::size_t end = std::min(words.find_first_of(" \n", at), words.size());
        const std::string word = words.substr(at, end - at);
        std::string longer = line;
        if (!line.empty()) longer += ' ';
        longer += word;
        // The last line takes what is left; it is cut.
        const bool fits = lines.size() + 1 == kMost || canvas.measure(markup(longer), natural).w <= style.max_width;
        if (!fits && !line.empty()) end_line();
        line += line.empty() ? word : " " + word;
        if (end < words.size() && words[end] == '\n') end_line();
        at = end + 1;
    }
    if (!line.empty() && lines.size() < kMost) end_line();
    return lines;
}

}  // namespace

// ---- prepared once for a film ----------------------------------------------------------------

struct MechanismPanel::Threads final : Panel::State {
    Threads(const FilmFacts& facts, int member, double scale, const Box& box)
        : path(facts.setup->view.tip_path ? static_cast<int>(box.w) : 1,
               facts.setup->view.tip_path ? static_cast<int>(box.h) : 1),
          trace(facts.samples[static_cast<std::size_t>(member)], 1, 1, 1, 1) {
        const sim::Problem& problem = facts.motion(member).problem;
        const double r = problem.cam ? problem.cam->radius : 1, l = problem.beam.length;
        const auto places = [](double px) { return static_cast<std::size_t>(std::clamp(px, 1.0, 65536.0)); };
        trace = Trace(facts.samples[static_cast<std::size_t>(member)], 2 * kPi * r, places(2 * kPi * r * scale), l,
                      places(l * scale));
    }
    GrowingLayer path;
    Trace trace;
    std::unique_ptr<LitRenderer> lit;  // made when first needed
    Image lit_image;
    std::optional<MechanismShape> lit_shape;  // what lit_image shows
    Tiles lit_tiles;                          // where it does
};

MechanismPanel::MechanismPanel(const FilmFacts& facts, const PanelSlot& slot)
    : facts_(facts),
      palette_(*facts.palette),
      box_(slot.box),
      member_(std::min(slot.spec.member, facts.members() - 1)),
      ghosts_(facts.members() > 1 && facts.setup->comparison == Comparison::ghosts),
      u_(facts.unit),
      small_(is_small(slot.box, facts.unit)) {
    // Mechanisms beside each other share one camera's scale, so that they can be compared.
    for (int m = 0; m < facts.members(); ++m) shown_.push_back(m);
    look_.unit = u_;
    look_.factor = facts.factor;
    look_.moment_scale = facts.moment_scale;
    place_camera();
    OccupancyGrid room = still_room();
    note_extent(room);
    place_words(std::move(room));
    find_flashes();
}

std::unique_ptr<Panel::State> MechanismPanel::make_state() const {
    return std::make_unique<Threads>(facts_, member_, look_.camera.scale, box_);
}

DrawnBeam MechanismPanel::beam_of(int member, int frame) const {
    const Motion& one = facts_.motion(member);
    const double factor = one.problem.beam.model == sim::ModelKind::rigid ? 1 : look_.factor;
    return drawn_beam(one.problem, facts_.pose(member, frame), factor, look_.depth, facts_.with(member));
}
DrawnBeam MechanismPanel::surveyed_beam(int member, std::size_t k) const {
    const Motion& one = facts_.motion(member);
    const double factor = one.problem.beam.model == sim::ModelKind::rigid ? 1 : look_.factor;
    return drawn_beam(one.problem, one.surveyed(k), factor, look_.depth, facts_.with(member));
}

// The camera shows whatever is drawn at any frame, the disc wherever it turns, and the support.
void MechanismPanel::place_camera() {
    // A beam thinner than a line gets the weight of one; it grows away from the cam.
    const auto as_deep_as = [&](const Sight& sight) {
        // Labels of mechanisms beside each other stand above them, all in one line.
        const double label = facts_.members() > 1 && !ghosts_ && box_.h > 200 * u_ ? 38 * u_ : 0;
        look_.camera = sight.camera({box_.x, box_.y + label, box_.w, box_.h - label}, u_);
        look_.depth = std::max(problem().beam.depth, 7 * u_ / look_.camera.scale);
    };
    as_deep_as(facts_.sight);
    if (look_.depth > problem().beam.depth) as_deep_as(sight_of(facts_, look_.depth));
    marks_ = mark_unit(problem(), look_.camera, u_);
}

// In pieces of a few stations, which the curve leaves by less than a pixel.
void MechanismPanel::take_beam(OccupancyGrid& room, const std::vector<Vec2>& face,
                               const std::vector<Vec2>& back) const {
    const std::size_t step = face.size() > 40 ? 4 : 1;
    for (std::size_t i = 0; i + 1 < face.size(); i += step) {
        const std::size_t next = std::min(i + step, face.size() - 1);
        room.cover_convex(std::array{face[i], face[next], back[next], back[i]});
    }
}

// What the motions leave free as far as their survey tells: the same for mechanisms that stand beside each other.
OccupancyGrid MechanismPanel::still_room() const {
    OccupancyGrid room(box_, std::max(2.0, 4 * u_));
    const Sight& sight = facts_.sight;
    for (const std::vector<Vec2>& strip : sight.strips) {
        std::vector<Vec2> face, back;
        for (std::size_t i = 0; i + 1 < strip.size(); i += 2)
            face.push_back(px(strip[i])), back.push_back(px(strip[i + 1]));
        take_beam(room, face, back);
    }
    for (const sim::Problem* p : sight.problems) {
        const Vec2 o = px({0, 0});
        const double hub = hub_radius(*p, look_.camera, u_), half = support_half_width(hub, marks_);
        room.cover_disc(o, hub + 4 * u_);
        room.cover(Box{o.x - half, o.y, 2 * half, support_reach(hub, marks_)}, 1);
        room.cover(Box{box_.x, o.y - 3 * u_, box_.w, 6 * u_}, 1);  // the horizontal
        if (!p->cam || !problem().cam) continue;
        const Vec2 axis = px(p->cam->centre);
        const bool arrow = p->cam->speed != 0 && !small_;
        room.cover_disc(axis, (p->cam->radius + p->cam->eccentricity) * look_.camera.scale + (arrow ? 34 : 4) * u_);
        if (!small_) room.cover(speed_box(axis, 150 * u_, nullptr), 1);
    }
    for (const Sight::Push& push : sight.pushes) {
        const Vec2 foot = px(push.foot), n{push.normal.x, -push.normal.y};
        const double length = push_length(push.share, small_, marks_), half = 8 * marks_;
        const Vec2 side = Vec2{-n.y, n.x} * half, tip = foot + n * length;
        room.cover_convex(std::array{foot + side, tip + side, tip - side, foot - side});
        if (small_) continue;
        const Vec2 at = foot + n * push_label(length, look_.depth * look_.camera.scale, u_);
        room.cover(Box{at.x - 150 * u_, at.y - 16 * u_, 136 * u_, 28 * u_}, 1);  // its number
    }
    return room;
}

bool MechanismPanel::has_label() const { return facts_.members() > 1 && box_.w >= 160 * u_; }
bool MechanismPanel::has_bar() const {
    return box_.w >= 300 * u_ && box_.h >= 220 * u_ && facts_.places.clock && facts_.setup->view.style != Style::solid;
}

// In corners, or along edges, where nothing moving comes.
void MechanismPanel::place_words(OccupancyGrid room) {
    Image scratch(1, 1);
    Canvas canvas(scratch, *facts_.fonts);
    const double gap = std::min(4 * u_, 0.1 * std::min(box_.w, box_.h));
    const auto choose = [&](Vec2 size, Corner first) {
        const Box place = room.choose(places_along(box_.inset(gap), size, first));
        room.cover(place.inset(-gap), 1);
        return place;
    };
    if (has_label()) {
        double widest = 0;  // of all, so that the labels of mechanisms beside each other stand at one place
        for (int m = 0; m < facts_.members(); ++m)
            widest = std::max(widest, canvas.measure(label_words(canvas, m), label_style()).w);
        const double lines = ghosts_ ? facts_.members() : 1;
        label_ = choose({std::min(46 * u_ + widest, box_.w - 2 * gap), 34 * u_ * lines}, Corner::top_left);
    }
    if (!has_bar()) return;
    const double wide = std::max(scale_length() * look_.camera.scale,
                                 canvas.measure(quantity(scale_length(), "m"), {.size = 17 * u_}).w);
    bar_ = choose({wide + 2 * u_, 30 * u_}, Corner::bottom_right);
}

std::vector<Box> MechanismPanel::words() const {
    std::vector<Box> out;
    if (label_) out.push_back(*label_);
    if (bar_) out.push_back(*bar_);
    return out;
}

// As its arc shows it: in the sense in which the hub has turned, without whole turns [rad].
static double drawn_angle(const Pose& pose) { return std::fmod(pose.theta, 2 * kPi); }

// How large an arc about `centre` over these angles can be within the box.
static double arc_room(Range angles, Vec2 centre, const Box& box) {
    Bounds reach;  // of the unit arc [px]
    constexpr int kSteps = 64;
    for (int i = 0; i <= kSteps; ++i) reach.add(down(angles.low + (angles.high - angles.low) * i / kSteps));
    const auto fits = [](double room, double need) {
        return need > 1e-3 ? std::max(room, 0.0) / need : std::numeric_limits<double>::infinity();
    };
    return std::min({fits(centre.x - box.x, -reach.x0), fits(box.right() - centre.x, reach.x1),
                     fits(centre.y - box.y, -reach.y0), fits(box.bottom() - centre.y, reach.y1)});
}

void MechanismPanel::note_extent(OccupancyGrid& room) {
    Bounds seen;
    Range turned{0, 0};  // [rad]
    for (int k = 0; k < facts_.frames(); ++k) {
        const double angle = drawn_angle(facts_.pose(member_, k));
        turned = {std::min(turned.low, angle), std::max(turned.high, angle)};
        const MechanismShape shape = mechanism_shape(problem(), facts_.pose(member_, k), beam(k), look_, palette_);
        tips_.push_back((shape.face.back() + shape.back.back()) * 0.5);
        if (has_label() || has_bar()) take_beam(room, shape.face, shape.back);
        for (std::size_t i = 0; i < shape.face.size(); ++i) seen.add(shape.face[i]), seen.add(shape.back[i]);
        seen.add(shape.hinge, shape.hub);
        if (shape.disc) seen.add(shape.disc->centre, shape.disc->radius);
    }
    wide_ = std::clamp(0.06 * motion().problem.beam.length * look_.camera.scale, 18 * u_, 80 * u_);
    for (int k = 0; k < facts_.frames(); ++k)
        moved_.push_back(k == 0 ? 0 : moved_.back() + (facts_.at(0, k) > facts_.at(0, k - 1) ? 1 : 0));
    arc_room_ = arc_room(turned, px({0, 0}), box_.inset(4 * u_));
    if (facts_.setup->view.tip_path) note_path();
    lit_box_ = covered({seen.x0, seen.y0, seen.x1 - seen.x0, seen.y1 - seen.y0}, box_, u_);
}

// Through the motion's survey and the frames. A piece of the path is there when the instant at its end is.
void MechanismPanel::note_path() {
    struct Tip {
        double t;
        Vec2 at;
    };
    std::vector<Tip> tips;
    const double now = facts_.at(member_, facts_.frames() - 1);
    for (int k = 0; k < facts_.frames(); ++k)
        tips.push_back({facts_.at(member_, k), tips_[static_cast<std::size_t>(k)]});
    for (std::size_t k = 0; motion().survey && k < motion().surveyed(); ++k)
        if (const DrawnBeam b = surveyed_beam(member_, k); motion().survey->time(k) <= now)
            tips.push_back(
                {motion().survey->time(k), px((b.face(b.line.size() - 1) + b.back(b.line.size() - 1)) * 0.5)});
    std::ranges::stable_sort(tips, {}, &Tip::t);
    tips.erase(std::unique(tips.begin(), tips.end(), [](const Tip& a, const Tip& b) { return a.t == b.t; }),
               tips.end());
    std::vector<Vec2> all, inside;
    std::vector<double> times;
    for (const Tip& tip : tips) all.push_back(tip.at);
    for (std::size_t k = 0; k < all.size(); ++k) {
        std::vector<Vec2> piece{all[k]};
        if (k > 0) piece = smooth_piece(all, k - 1, kArcStep * u_), piece.erase(piece.begin());
        for (Vec2 p : piece) {
            times.push_back(tips[k].t);
            inside.push_back(p - Vec2{box_.x, box_.y});
        }
    }
    path_ = thinned(times, inside, 0.5);
}

void MechanismPanel::find_flashes() {
    std::vector<double> times;
    for (int k = 0; k < facts_.frames(); ++k) times.push_back(facts_.at(member_, k));
    for (const sim::Impact& impact : motion().impacts) {
        const auto first = std::lower_bound(times.begin(), times.end(), impact.t_start);
        if (first == times.end() || (first == times.begin() && *first > impact.t_start)) continue;
        const int at = static_cast<int>(first - times.begin());
        const DrawnBeam b = beam(at);
        if (!b.contact) continue;
        flashes_.push_back(
            {at, std::atan2(b.contact->normal.y, b.contact->normal.x) - facts_.pose(member_, at).cam_angle});
    }
}

// ---- the ground ------------------------------------------------------------------------------

void MechanismPanel::draw_ground(Canvas& canvas) const {
    if (facts_.setup->view.style == Style::solid) return label(canvas);  // all else is seen from moving places
    const Vec2 o = px({0, 0});
    canvas.move_to({box_.x, o.y});
    canvas.line_to({box_.right(), o.y});
    canvas.stroke({palette_.faint, 1.5 * u_, {10 * u_, 8 * u_}, Cap::butt});
    draw_support(canvas, o, hub_radius(problem(), look_.camera, u_), marks_, palette_);
    scale_bar(canvas);
    label(canvas);
}

// A round length near a seventh of the view [m].
double MechanismPanel::scale_length() const { return round_down_125(0.17 * box_.w / look_.camera.scale); }

void MechanismPanel::scale_bar(Canvas& canvas) const {
    if (!bar_) return;
    const double w = scale_length() * look_.camera.scale, middle = bar_->x + bar_->w / 2, y = bar_->bottom() - 4 * u_;
    const double x = middle - w / 2;
    canvas.move_to({x, y - 5 * u_});
    canvas.line_to({x, y});
    canvas.line_to({x + w, y});
    canvas.line_to({x + w, y - 5 * u_});
    canvas.stroke({palette_.muted, 1.6 * u_, {}, Cap::butt});
    canvas.text({middle, y - 9 * u_}, quantity(scale_length(), "m"),
                {.size = 17 * u_, .color = palette_.muted, .align = HAlign::centre, .halo = palette_.paper});
}

TextStyle MechanismPanel::label_style() const {
    return {.size = 24 * u_, .color = palette_.ink, .weight = Weight::semibold, .halo = palette_.paper};
}

std::string MechanismPanel::label_words(Canvas& canvas, int member) const {
    return escape(canvas.drawable(facts_.motion(member).label));
}

// Which motion this is, where there are several; with ghosts, all of them.
void MechanismPanel::label(Canvas& canvas) const {
    if (!label_) return;
    double y = label_->y + 24 * u_;
    TextStyle style = label_style();
    style.max_width = label_->w - 44 * u_;
    for (int m = 0; m < facts_.members(); ++m) {
        if (!ghosts_ && m != member_) continue;
        const double x = label_->x + 2 * u_;
        canvas.move_to({x, y - 8 * u_});
        canvas.line_to({x + 30 * u_, y - 8 * u_});
        canvas.stroke({facts_.member_color(m), 6 * u_, {}, Cap::butt});
        canvas.text({x + 42 * u_, y}, label_words(canvas, m), style);
        y += 34 * u_;
    }
}

// ---- what moves ------------------------------------------------------------------------------

Vec2 MechanismPanel::seen(Vec2 flat, const Perspective* view) const {
    if (!view) return flat;
    const Vec2 middle = box_.centre();
    return view->to_pixels({flat.x - middle.x, middle.y - flat.y, 0.5 * wide_});
}

Vec2 MechanismPanel::Scene::on(Vec2 flat) const { return panel.seen(flat, view); }

void MechanismPanel::Scene::arc(Vec2 centre, double radius, double from, double to) const {
    if (!view) return canvas.arc(centre, radius, from, to);
    constexpr int kPieces = 48;
    std::vector<Vec2> points;
    for (int i = 0; i <= kPieces; ++i) points.push_back(on(centre + down(from + (to - from) * i / kPieces) * radius));
    canvas.polyline(points);
}

// Far enough for a mild perspective, and a little smaller than the flat view, so that what comes nearer stays within.
Perspective MechanismPanel::view_of(int frame) const {
    const Orbit& orbit = facts_.setup->view.orbit;
    const double turn = 2 * kPi * frame / std::max(1, facts_.frames());
    return Perspective::looking(box_.centre(), 2.4 * std::max(box_.w, box_.h), 0.9,
                                orbit.yaw + orbit.swing * std::sin(turn), orbit.pitch);
}

bool MechanismPanel::whole_path() const {
    return facts_.setup->view.tip_path && facts_.setup->view.style != Style::solid;
}

void MechanismPanel::grow(Canvas& kept, const Image& ground, int frame, bool anew, State* state) const {
    if (!whole_path()) return;
    GrowingLayer& path = static_cast<Threads*>(state)->path;
    Box changed = path.until(facts_.at(member_, frame), path_, kept.fonts(), {palette_.motion_faint, 1.6 * u_});
    if (anew) changed = path.whole();
    if (changed.empty()) return;
    kept.replace_part(ground, 0, 0, {changed.x + box_.x, changed.y + box_.y, changed.w, changed.h});
    kept.image_part(path.image(), static_cast<int>(box_.x), static_cast<int>(box_.y), changed);
}

void MechanismPanel::draw(Canvas& canvas, int frame, Style style, State* state) const {
    auto& threads = *static_cast<Threads*>(state);
    const Pose& pose = facts_.pose(member_, frame);
    const DrawnBeam drawn = beam(frame);
    const MechanismShape shape = mechanism_shape(problem(), pose, drawn, look_, palette_);
    threads.trace.show_until(pose.t);
    const Perspective view = view_of(frame);
    const Scene s{canvas, frame, pose, drawn, shape, *this, style == Style::solid ? &view : nullptr};
    trail(s);
    if (ghosts_) ghost_bodies(s);
    switch (style) {
        case Style::solid:
            draw_solid(s, threads.trace, threads);
            break;
        case Style::lit:
            angle_arc(s);
            base_line(s);
            turning_arrow(s);
            draw_lit(shape, canvas, threads);
            break;
        case Style::flat:
            angle_arc(s);
            base_line(s);
            turning_arrow(s);
            draw_flat(canvas, shape, look_, palette_);
            break;
    }
    disc_marks(s, threads.trace);
    if (!s.view) beam_trace(s, threads.trace);
    if (ghosts_) ghosts(s);
    flash(s);
    force_arrow(s);
    callout(s);
}

void MechanismPanel::draw_solid(const Scene& s, const Trace& trace, Threads& threads) const {
    const int width = static_cast<int>(box_.w), height = static_cast<int>(box_.h);
    if (!threads.lit) threads.lit = make_lit_renderer(width, height);
    Perspective inside = *s.view;
    inside.centre = inside.centre - Vec2{box_.x, box_.y};
    const SolidScene scene = solid_scene(s.shape, palette_, box_, inside, wide_, u_, rim_colors(trace, s.pose.t));
    threads.lit->draw(scene, threads.lit_image);
    s.canvas.image_part(threads.lit_image, static_cast<int>(box_.x), static_cast<int>(box_.y), {0, 0, box_.w, box_.h});
    turning_arrow(s);
}

// A colour for each place around the disc, none where it was never touched.
std::vector<Color> MechanismPanel::rim_colors(const Trace& trace, double now) const {
    const double half_life = trace_half_life(facts_.span);
    std::vector<Color> out(trace.rim().size(), Color{0, 0, 0, 0});
    for (std::size_t i = 0; i < out.size(); ++i) {
        if (!(trace.rim()[i] > 0) || !(facts_.force_scale > 0)) continue;
        if (facts_.setup->view.trace == TraceColor::force) {
            out[i] = force_color(palette_, std::sqrt(std::min(1.0, double(trace.rim()[i]) / facts_.force_scale)));
        } else {
            const double age = std::max(0.0, now - trace.rim_times()[i]);
            out[i] = age_color(palette_, age, half_life);
        }
    }
    return out;
}

void MechanismPanel::draw_lit(const MechanismShape& shape, Canvas& canvas, Threads& threads) const {
    if (!threads.lit) {
        threads.lit = make_lit_renderer(static_cast<int>(lit_box_.w), static_cast<int>(lit_box_.h));
        ++facts_.counts->gl_contexts;
    }
    const LitScene scene = lit_scene(shape, look_, palette_, {lit_box_.x, lit_box_.y});
    if (threads.lit_shape != shape) {
        const int width = static_cast<int>(lit_box_.w), height = static_cast<int>(lit_box_.h);
        const double before = threads.lit->read_back;
        Tiles now = lit_tiles(scene, {}, width, height), changed = now;
        if (std::exchange(threads.lit_shape, std::nullopt)) {
            changed.add(threads.lit_tiles);
            threads.lit->redraw(scene, changed, threads.lit_image);
        } else {
            threads.lit->draw(scene, threads.lit_image);
        }
        threads.lit_tiles = std::move(now);
        threads.lit_shape = shape;
        facts_.counts->read_back += threads.lit->read_back - before;
        ++facts_.counts->mechanisms_lit;
    }
    canvas.image_tiles(threads.lit_image, static_cast<int>(lit_box_.x), static_cast<int>(lit_box_.y),
                       lit_tiles(scene, {lit_box_.x, lit_box_.y}, canvas.image().width, canvas.image().height));
}

// Out along the face and back, from where the beam leaves the hub; `foot`: along the hub, which stays in front.
MechanismPanel::Outline MechanismPanel::ghost_outline(const Scene& s, const DrawnBeam& beam) const {
    const auto outside = [&](const auto& point) {
        std::vector<Vec2> line;
        for (std::size_t i = 0; i < beam.line.size(); ++i) {
            const Vec2 p = px(point(i));
            if (norm(p - s.shape.hinge) < s.shape.hub) continue;
            if (line.empty() && i > 0) {  // where it crosses the hub's edge
                Vec2 in = px(point(i - 1)), out = p;
                for (int pass = 0; pass < 40; ++pass) {
                    const Vec2 middle = (in + out) * 0.5;
                    (norm(middle - s.shape.hinge) < s.shape.hub ? in : out) = middle;
                }
                line.push_back(out);
            }
            line.push_back(p);
        }
        return line;
    };
    Outline all{outside([&](std::size_t i) { return beam.face(i); }), {}};
    const std::vector<Vec2> back = outside([&](std::size_t i) { return beam.back(i); });
    all.edge.insert(all.edge.end(), back.rbegin(), back.rend());
    if (all.edge.empty()) return all;
    const Vec2 from = all.edge.back() - s.shape.hinge, to = all.edge.front() - s.shape.hinge;
    const double begin = std::atan2(from.y, from.x), radius = norm(from);
    const double turn = std::remainder(std::atan2(to.y, to.x) - begin, 2 * kPi);
    const int pieces = 1 + static_cast<int>(std::abs(turn) * std::sqrt(radius));  // within 1/8 px of the circle
    for (int i = 1; i < pieces; ++i) {
        const double a = begin + turn * i / pieces;
        all.foot.push_back(s.shape.hinge + Vec2{std::cos(a), std::sin(a)} * radius);
    }
    for (std::vector<Vec2>* line : {&all.edge, &all.foot})
        for (Vec2& p : *line) p = s.on(p);
    return all;
}

// The other motions: outlines of their beams, and of their discs where those stand elsewhere.
void MechanismPanel::ghosts(const Scene& s) const {
    for (int m : shown_) {
        if (m == member_) continue;
        const DrawnBeam other = beam_of(m, s.frame);
        const Color color = facts_.member_color(m);
        const Pose& pose = facts_.pose(m, s.frame);
        const std::optional<sim::Cam>& cam = facts_.motion(m).problem.cam;
        if (cam && (!s.shape.disc || norm(px(pose.disc_centre) - s.shape.disc->centre) > 0.5)) {
            s.arc(px(pose.disc_centre), cam->radius * look_.camera.scale, 0, 2 * kPi);
            s.canvas.stroke({color.faded(0.8), 2 * u_, {8 * u_, 6 * u_}, Cap::butt});
        }
        s.canvas.polyline(ghost_outline(s, other).edge);
        s.canvas.stroke({color, 2.2 * u_});
    }
}

// Under the first motion's beam, whose colours mean something.
void MechanismPanel::ghost_bodies(const Scene& s) const {
    for (int m : shown_) {
        if (m == member_) continue;
        const Outline outline = ghost_outline(s, beam_of(m, s.frame));
        s.canvas.polyline(outline.edge);
        for (const Vec2& p : outline.foot) s.canvas.line_to(p);
        s.canvas.fill(facts_.member_color(m).faded(0.16));
    }
}

// The tip's path over the last of the film, fading.
void MechanismPanel::trail(const Scene& s) const {
    if (whole_path()) return;  // all of it is drawn already
    const auto now = static_cast<std::size_t>(s.frame);
    for (std::size_t k = now; k-- > 0;) {
        const double age = (moved_[now] - moved_[k]) / (kTrail * facts_.setup->fps);
        if (age > 1) break;
        if (moved_[k + 1] == moved_[k]) continue;
        std::vector<Vec2> piece = smooth_piece(tips_, k, kArcStep * u_);
        for (Vec2& p : piece) p = s.on(p);
        s.canvas.polyline(piece);
        s.canvas.stroke({palette_.motion.faded(0.55 * (1 - age)), 2 * u_, {}, Cap::butt});
    }
}

void MechanismPanel::angle_arc(const Scene& s) const {
    if (small_) return;
    double radius = std::min(92 * marks_, arc_room_);
    if (problem().cam) {
        const double free = norm(s.pose.cam_centre) - problem().cam->radius - problem().cam->eccentricity;
        radius = std::min(radius, 0.86 * free * look_.camera.scale);
    }
    const double letter = std::max(marks_, kReadable / 21);  // [px] of a design pixel of θ
    const double hub = hub_radius(problem(), look_.camera, u_);
    const double angle = drawn_angle(s.pose);
    if (radius < hub + 22 * marks_ || std::abs(angle) < 0.02) return;
    s.arc(px({0, 0}), radius, 0, angle);
    s.canvas.stroke({palette_.muted, 1.6 * u_, {}, Cap::butt});
    // The letter stands in the middle of what the section leaves free; where that is too little it gives way to
    // beyond the horizontal.
    const double out = radius - 17 * letter, need = 19 * letter / out;
    double free = std::abs(angle);
    const auto keep_off = [&](const auto& edge) {
        const double far = out / look_.camera.scale;
        for (std::size_t i = 1; i < s.beam.line.size(); ++i) {
            const Vec2 a = edge(i - 1), b = edge(i);
            const double from = norm(a), to = norm(b);
            if (to < far || from == to) continue;
            const Vec2 p = a + (b - a) * std::clamp((far - from) / (to - from), 0.0, 1.0);
            const double beyond = std::remainder(std::atan2(p.y, p.x) - angle, 2 * kPi);
            free = std::min(free, std::abs(angle) + std::copysign(beyond, beyond * angle));
            return;
        }
    };
    keep_off([&](std::size_t i) { return s.beam.face(i); });
    keep_off([&](std::size_t i) { return s.beam.back(i); });
    const double at = std::min(free / 2, free - need);
    if (radius > hub + 38 * letter)
        s.canvas.text(s.on(px({0, 0}) + down(std::copysign(1, angle) * at) * out) + Vec2{0, 6 * letter}, math("θ"),
                      {.size = 21 * letter, .color = palette_.muted, .align = HAlign::centre, .halo = palette_.paper});
}

// Outside the circle that the disc sweeps, on the side away from the beam; positive speed turns clockwise.
void MechanismPanel::turning_arrow(const Scene& s) const {
    if (!problem().cam || small_) return;
    const sim::Cam& cam = *problem().cam;
    const Vec2 axis = px(s.pose.cam_centre);
    const double swept = (cam.radius + cam.eccentricity) * look_.camera.scale, radius = swept + 20 * u_;
    const std::string label = math("ω") + "\u2009=\u2009" + quantity(cam.speed, "rad/s");
    TextStyle style{.size = 21 * u_, .color = palette_.muted};
    if (!s.view) style.halo = palette_.paper;  // over a soft shadow it would only glow
    if (cam.speed != 0) {
        const double span = std::min(0.8, 150 * u_ / radius), middle = -0.30 * kPi;
        const double from = middle + (cam.speed > 0 ? span / 2 : -span / 2), to = 2 * middle - from;
        const double head = 17 * u_, back = (to < from ? 1 : -1) * 0.9 * head / radius;
        s.arc(axis, radius, from, to + back);
        s.canvas.stroke({palette_.muted, 2.6 * u_, {}, Cap::butt});
        s.canvas.arrow(s.on(axis + down(to + back) * radius), s.on(axis + down(to) * radius),
                       {palette_.muted, 2.6 * u_}, {head});
    }
    const Box at = speed_box(axis, s.canvas.measure(label, style).w, s.view);
    s.canvas.text({at.x, at.bottom()}, label, style);
}

// Room for the cam's speed, so wide: beside the arrow; where the panel ends there, below it. Its bottom is the
// baseline.
Box MechanismPanel::speed_box(Vec2 axis, double w, const Perspective* view) const {
    const sim::Cam& cam = *problem().cam;
    const double radius = (cam.radius + cam.eccentricity) * look_.camera.scale + 20 * u_;
    Vec2 at = seen(axis + down(-0.26 * kPi) * (radius + 16 * u_), view) + Vec2{8 * u_, 12 * u_};
    if (at.x + w > box_.right())
        at = {box_.right() - w, seen(axis + down(-0.5 * kPi) * (radius + 26 * u_), view).y + 8 * u_};
    at.y = std::min(at.y, box_.bottom() - 34 * u_);
    return {at.x, at.y - 22 * u_, w, 22 * u_};
}

// The straight line that deflection is drawn about.
void MechanismPanel::base_line(const Scene& s) const {
    const bool led = sim::is_prescribed(problem().hub.drive);
    const Vec2 base = sim::unit(look_.factor == 1 && led ? s.pose.theta : s.beam.base_angle);
    // True deflection is seen against the direction of a led hub, unless the horizontal is drawn there already.
    if (look_.factor == 1 && !(led && std::abs(base.y) > 0.01)) return;
    const double clear = 4 * u_ / look_.camera.scale;
    std::vector<Vec2> line;  // only where it runs clear of the section: dashes along an edge would be noise
    for (Vec2 p : s.beam.line) {
        const double below = -cross(base, p);  // the base line's offset from the centre line
        const bool covered = below > s.beam.low - clear && below < s.beam.high + clear;
        line.push_back(covered ? Vec2{kNan, kNan} : s.px(base * dot(base, p)));
    }
    s.canvas.clip(box_, [&] {  // the straight line may be longer than what the camera was fitted to
        s.canvas.polyline(line);
        s.canvas.stroke({palette_.faint, 1.5 * u_, {6 * u_, 7 * u_}, Cap::butt});
    });
}

void MechanismPanel::disc_marks(const Scene& s, const Trace& trace) const {
    if (!s.shape.disc) return;
    const DiscShape& d = *s.shape.disc;
    if (s.view) return disc_letters(s, palette_.ink);
    const double inset = std::min(7 * u_, 0.1 * d.radius), n = static_cast<double>(trace.rim().size());
    const auto place = [&](std::size_t i) {
        const double at = d.angle + 2 * kPi * (static_cast<double>(i) + 0.5) / n, half = 2 * kPi * 1.7 / n;
        s.canvas.move_to(d.centre + down(at - half) * (d.radius - inset));
        s.canvas.arc(d.centre, d.radius - inset, at - half, at + half);
    };
    const double width = std::min(7 * u_, 0.1 * d.radius);
    if (facts_.setup->view.trace == TraceColor::force) {
        stroke_places(s.canvas, facts_, trace.rim(), width, place);
    } else {
        const std::vector<Color> colors = rim_colors(trace, s.pose.t);
        for (std::size_t i = 0; i < colors.size(); ++i) {
            if (colors[i].a == 0) continue;
            place(i);
            s.canvas.stroke({colors[i], width, {}, Cap::butt});
        }
    }
    if (d.radius < 26 * marks_) return;
    const Color ink = facts_.setup->view.theme == Theme::dark && facts_.setup->view.style == Style::flat
                          ? palette_.paper
                      : facts_.setup->view.theme == Theme::dark ? rgb(0x14171D)
                                                                : palette_.steel_edge;
    const double apart = norm(d.centre - d.axis), pen = std::max(marks_, 0.45);
    if (apart > d.bore + 2) {
        s.canvas.move_to(d.axis + (d.centre - d.axis) * (d.bore / apart));
        s.canvas.line_to(d.centre);
        s.canvas.stroke({ink, 1.8 * pen});
    }
    s.canvas.circle(d.centre, 4 * marks_);
    s.canvas.fill(ink);
    for (Vec2 arm : {Vec2{1, 0}, Vec2{0, 1}}) {
        s.canvas.move_to(d.axis - arm * (d.bore * 0.75));
        s.canvas.line_to(d.axis + arm * (d.bore * 0.75));
    }
    s.canvas.stroke({palette_.ink, 1.6 * pen, {}, Cap::butt});
    disc_letters(s, ink);
}

// B and C beyond the ends of the line between them, so that they keep off it at any angle, and within the disc.
void MechanismPanel::disc_letters(const Scene& s, Color ink) const {
    const DiscShape& d = *s.shape.disc;
    const double size = 22 * marks_;
    if (size < kReadable || d.radius < 60 * marks_) return;
    const double apart = norm(d.centre - d.axis);
    const Vec2 along = apart > 2 ? (d.centre - d.axis) * (1 / apart) : Vec2{0, -1};
    const TextStyle style{.size = size, .color = ink, .align = HAlign::centre};
    s.canvas.text(s.on(d.centre + along * (20 * marks_)) + Vec2{0, 7 * marks_}, math("B"), style);
    // The shaft that stands out in the solid view needs more room. Far out, C would come upon the rim: it stands
    // beside.
    const double off = d.bore + (s.view ? 24 : 16) * marks_;
    const Vec2 way = apart + off + 24 * marks_ <= d.radius ? along * -1 : Vec2{along.y, -along.x};
    s.canvas.text(s.on(d.axis + way * off) + Vec2{0, 7 * marks_}, math("C"), style);
}

void MechanismPanel::beam_trace(const Scene& s, const Trace& trace) const {
    const double n = static_cast<double>(trace.beam().size()), last = static_cast<double>(s.beam.line.size() - 1);
    const double inset = 4.5 * u_;
    const auto at = [&](double place) {
        const double station = std::clamp(place / n * last, 0.0, last);
        const auto i = std::min(static_cast<std::size_t>(station), s.beam.line.size() - 2);
        const double part = station - static_cast<double>(i);
        const Vec2 face = s.px(s.beam.face(i) * (1 - part) + s.beam.face(i + 1) * part),
                   back = s.px(s.beam.back(i) * (1 - part) + s.beam.back(i + 1) * part);
        return face + (back - face) * (inset / norm(back - face));
    };
    stroke_places(s.canvas, facts_, trace.beam(), 5 * u_, [&](std::size_t i) {
        s.canvas.move_to(at(static_cast<double>(i) - 1.2));
        s.canvas.line_to(at(static_cast<double>(i) + 2.2));
    });
}

double MechanismPanel::flash_frames() const { return kFlash * facts_.setup->fps; }

// The camera, and the rings of impacts.
bool MechanismPanel::plays(int frame) const {
    const View& view = facts_.setup->view;
    if (view.style == Style::solid && view.orbit.swing != 0) return true;
    return std::ranges::any_of(flashes_, [&](const Flash& f) {
        return frame >= f.frame && frame < f.frame + flash_frames() + 1;  // gone with the last
    });
}

// A ring that opens and fades where an impact began, carried along by the disc.
void MechanismPanel::flash(const Scene& s) const {
    if (!problem().cam) return;
    for (const Flash& f : flashes_) {
        const int age = s.frame - f.frame;
        if (age < 0 || age >= flash_frames()) continue;
        const double share = age / flash_frames();
        const Vec2 at =
            s.px(s.pose.disc_centre + sim::unit(s.pose.cam_angle + f.material_angle) * problem().cam->radius);
        s.canvas.circle(at, (7 + 20 * std::sqrt(share)) * marks_);
        s.canvas.stroke(
            {palette_.contact.faded((1 - share) * (1 - share)), (3.2 - 2 * share) * std::max(marks_, 0.45)});
    }
}

void MechanismPanel::force_arrow(const Scene& s) const {
    if (!shows_force(s.pose, s.beam)) return;
    const Vec2 flat = px(s.beam.contact->on_disc), foot = s.on(flat),
               n{s.beam.contact->normal.x, -s.beam.contact->normal.y};
    s.canvas.circle(foot, 5 * marks_);
    s.canvas.fill(palette_.contact);
    // In proportion to the force; where that is too short for an arrow, the dot and the number tell of it.
    const double length = push_length(s.pose.nearest->force / facts_.arrow_scale, small_, marks_);
    const Vec2 tip = s.on(flat + n * length);
    if (length > 7 * marks_)
        s.canvas.arrow(foot, tip, {palette_.contact, 4 * marks_}, {std::min(19 * marks_, 0.7 * length)});
    if (small_) return;
    const TextStyle style{.size = 22 * u_,
                          .color = palette_.contact,
                          .weight = Weight::medium,
                          .align = HAlign::right,
                          .halo = palette_.paper};
    const std::string label = math("F") + "\u2009=\u2009" + quantity(s.pose.nearest->force, "N");
    // Beside the tip and clear of the beam's back, however short the arrow.
    const double clear = push_label(length, look_.depth * look_.camera.scale, u_);
    Vec2 at = s.on(flat + n * clear) + Vec2{-14 * u_, 6 * u_};
    const double w = s.canvas.measure(label, style).w;
    at.x = std::max(at.x, box_.x + w);
    s.canvas.text(at, label, style);
}

// Words at the contact, on a plate beside it.
void MechanismPanel::callout(const Scene& s) const {
    if (member_ != 0) return;
    const Callout* last = nullptr;  // a later one takes the place of those before
    for (const Callout& c : facts_.setup->callouts)
        if (s.frame >= c.first && s.frame <= c.last && (!last || c.first >= last->first)) last = &c;
    if (last) {
        const Callout& c = *last;
        const TextStyle style{
            .size = 22 * u_, .color = palette_.ink, .weight = Weight::medium, .max_width = 0.45 * box_.w};
        const std::vector<std::string> lines = wrapped(s.canvas, c.text, style);
        const double line = 29 * u_;
        double widest = 0;
        for (const std::string& words : lines) widest = std::max(widest, s.canvas.measure(words, style).w);
        const Vec2 foot =
            s.beam.contact ? s.px(s.beam.contact->on_disc) : s.on(tips_[static_cast<std::size_t>(s.frame)]);
        // To the right of the cam, below the horizontal: neither the beam nor the force comes there.
        const double swept =
            problem().cam ? (problem().cam->radius + problem().cam->eccentricity) * look_.camera.scale : 0;
        const Vec2 from = problem().cam ? s.px(s.pose.cam_centre) : foot;
        Box plate{from.x + swept + 60 * u_, from.y + 26 * u_, widest + 32 * u_,
                  17 * u_ + line * static_cast<double>(lines.size())};
        const auto keep_inside = [&] {
            plate.x = std::clamp(plate.x, box_.x, std::max(box_.x, box_.right() - plate.w));
            plate.y = std::clamp(plate.y, box_.y, std::max(box_.y, box_.bottom() - plate.h - 40 * u_));
        };
        keep_inside();
        if (problem().cam && !small_) {
            const Box words = speed_box(px(s.pose.cam_centre), 150 * u_, s.view);
            if (plate.overlaps(words)) plate.y = words.bottom() + 12 * u_;  // below the cam's speed, else above it
            keep_inside();
            if (plate.overlaps(words)) plate.y = std::max(box_.y, words.y - 12 * u_ - plate.h);
        }
        s.canvas.move_to({plate.x + 10 * u_, plate.y + 10 * u_});
        s.canvas.line_to(foot);
        s.canvas.stroke({palette_.ink, 1.6 * u_});
        s.canvas.rounded(plate, 8 * u_);
        s.canvas.fill_keeping_path(palette_.paper);
        s.canvas.stroke({palette_.ink, 1.6 * u_});
        for (std::size_t i = 0; i < lines.size(); ++i)
            s.canvas.text({plate.x + 16 * u_, plate.y + 31 * u_ + line * static_cast<double>(i)}, lines[i], style);
    }
}

std::unique_ptr<Panel> make_mechanism_panel(const FilmFacts& facts, const PanelSlot& slot) {
    return std::make_unique<MechanismPanel>(facts, slot);
}

}  // namespace beamcam::render
