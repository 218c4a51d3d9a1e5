// The system with its symbols, to the scene's own scale. Integrates nothing.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <variant>

#include "render/mechanism/cam_outline.hpp"
#include "scenes/figures/figure_types.hpp"
#include "scenes/figures/sketch.hpp"
#include "sim/cam/lever.hpp"
#include "sim/problem/problem.hpp"

namespace beamcam::scenes {
namespace {

using sim::Vec2;

// A beam that rests on the cam lies along the tangent from the hub's axis; it sags by much less than a line is wide.
struct Tangent {
    double angle, length;  // [rad, m]
};
std::optional<Tangent> resting_tangent(const sim::Problem& p) {
    if (p.initial.shape != sim::InitialShape::resting || !p.cam) return std::nullopt;
    const sim::Lever::State lever = sim::Lever(p).at(-p.cam->phase);
    if (!std::isfinite(lever.foot)) return std::nullopt;
    return Tangent{lever.motion.theta, lever.foot};
}

double start_angle(const sim::Problem& p) {
    const auto tangent = resting_tangent(p);
    return tangent ? tangent->angle : p.initial.angle;
}

bool has_torque(const sim::Drive& drive) {
    return !std::holds_alternative<sim::FreeDrive>(drive) && !is_prescribed(drive);
}

// At other angles the symbols of beam and frames would overlap.
double drawn_angle(const sim::Problem& p) {
    const double angle = std::clamp(start_angle(p), -1.4, 1.4);
    return std::abs(angle) < 0.23 ? 0.23 : angle;
}

class Drawing : private Sketch {
  public:
    // `letter`: size of letters, in radii of the magnified disc.
    Drawing(const sim::Problem& problem, double letter) : p_(problem), letter_(letter) {
        size_ = p_.beam.length + p_.hub.radius;
        unit_ = size_;
        theta_ = drawn_angle(p_);
    }

    std::vector<Shape> shapes() {
        if (p_.cam) cam();
        frames();
        beam();
        hub();
        if (has_torque(p_.hub.drive)) torque();
        angle();
        if (p_.gravity != 0) gravity();
        return take();
    }

  private:
    static constexpr double kDimension = 0.12;   // distance of the dimension L from the beam, in lengths
    static constexpr double kMagnified = 0.235;  // radius of the magnified disc, in lengths

    // [m], about; a cam on the left makes the drawing wider, and letters larger in it.
    double letter_height() const {
        const bool wide = p_.cam && p_.cam->centre.x < 0;
        return (wide ? 1.5 : 1) * letter_ * kMagnified * unit_;
    }

    // The disc to scale, and magnified beside it with its symbols, for which it is too small.
    void cam() {
        const sim::Cam& cam = *p_.cam;
        const Vec2 c = cam.centre, b = cam.profile ? c : disc_centre(cam, 0);
        const double reach = cam.profile ? render::cam_reach(p_) : cam.radius;
        if (cam.profile) {
            sim::Pose start;
            start.cam_centre = c;
            start.cam_angle = cam.phase;
            std::vector<Vec2> outline = render::placed_outline(p_, start, 240);
            add({.kind = Kind::area, .points = outline, .color = kSteel});
            add({.kind = Kind::line, .points = std::move(outline), .color = kInk, .width = 0.9});
        } else {
            disc(b, cam.radius);
        }
        dot(c);
        const double near = c.x < 0 ? 0.7 : 1;  // the drawing is wider then, and the disc smaller on paper
        // Within the disc and clear of the axis X, or on the magnified one alone.
        for (const double side : {-0.75, 0.75}) {
            const Vec2 beside = near * Vec2{side, c.y > 0 ? 0.8 : -0.8};
            if (norm(c + letter_height() * beside - b) + 0.3 * letter_height() >
                (cam.profile ? sim::cam_shape(p_)->least_height() : cam.radius))
                continue;
            label(c, "$C$", beside);
            break;
        }
        const double low =  // below disc and hub
            std::min(std::min(b.y, c.y) - reach - 0.13 * unit_, -p_.hub.radius - 0.1 * unit_);
        line({0, -0.02 * unit_}, {0, low - 0.02 * unit_}, kGrey);
        line(c, {c.x, low - 0.02 * unit_}, kGrey, 0, {3, 3});
        dimension({0, low}, {c.x, low});
        label({0.5 * c.x, low}, "$D$", {0, -0.85});
        if (cam.profile && cam.speed != 0) rotation(c, 1.1 * reach, -0.25 * std::numbers::pi, cam.speed);
        if (cam.profile) return;

        const double radius = kMagnified * unit_, zoom = radius / cam.radius;
        const double away = (1.2 * cam.radius + 1.35 * radius) * (c.x < 0 ? -1 : 1);  // from the hub
        const Vec2 centre{b.x + away, std::min(-0.06 * unit_, c.y) - 1.12 * radius};
        // Common tangents, so that the eye follows.
        const Vec2 way = centre - b;
        const double turn = std::acos(std::clamp((cam.radius - radius) / norm(way), -1.0, 1.0));
        for (const double side : {-1.0, 1.0}) {
            const Vec2 n = sim::unit(std::atan2(way.y, way.x) + side * turn);
            line(b + cam.radius * n, centre + radius * n, kGrey, 0, {3, 3});
        }
        disc(centre, radius);
        draw_disc_symbols(cam, centre, zoom, letter_, *this);
    }

    // Fixed: X, Y. Moving: x′ along the undeformed beam, y′ normal to it.
    void frames() {
        const double reach = std::max(
            1.12 * size_ * std::cos(theta_),
            p_.cam ? p_.cam->centre.x + 1.5 * (p_.cam->profile ? render::cam_reach(p_) : p_.cam->radius) : 0.0);
        arrow({-0.06 * unit_, 0}, {reach, 0});
        label({reach, 0}, "$X$", {0.2, theta_ < 0.6 ? -0.9 : 0.8});  // clear of beam and magnified disc
        arrow({0, -0.06 * unit_}, {0, 0.42 * unit_});
        // Beside the arrow, or above it for a steep beam unless the dimension of the beam passes there.
        const double height = 0.46 * unit_, line = height / std::tan(theta_) - kDimension * size_ / std::sin(theta_);
        Vec2 beside{-0.9, -0.2};
        if (theta_ > 1.1) beside = std::abs(line) > 0.03 * unit_ ? Vec2{0, 0.75} : Vec2{line > 0 ? -0.9 : 0.9, -0.2};
        label({0, 0.42 * unit_}, "$Y$", beside);
        if (p_.hub.radius < 0)  // the root is on the left
            label({0, 0}, "$O$", {0.9, -0.9});
        else
            label(-0.71 * p_.hub.radius * Vec2{1, 1}, "$O$", {-0.9, -0.9});
        const Vec2 i = sim::unit(theta_), j = sim::perp(i);
        arrow({0, 0}, 1.16 * size_ * i, kGrey);
        label(1.16 * size_ * i, "$x′$", {0.8, 0.0}, kGrey);
        arrow({0, 0}, 0.26 * size_ * j, kGrey);
        label(0.26 * size_ * j, "$y′$", {-0.9, 0.1}, kGrey);
    }

    bool is_flexible() const { return p_.beam.model != sim::ModelKind::rigid; }
    // The share of the beam's length from its root to the cam.
    double support_share() const {
        const auto tangent = resting_tangent(p_);
        if (!tangent || theta_ != tangent->angle) return 0;
        return std::clamp((tangent->length - p_.hub.radius) / p_.beam.length, 0.0, 0.9);
    }
    // The deflected centre line: a clamped beam's sag, drawn far larger than it is.
    Vec2 on_beam(double share) const {
        const Vec2 i = sim::unit(theta_), j = sim::perp(i);
        // A beam that rests on the cam touches it where the tangent does, and sags beyond.
        const double support = support_share(), s = std::max(0.0, (share - support) / (1 - support));
        const double sag = is_flexible() ? -0.085 * size_ * (1 - support) * (s * s * (6 - 4 * s + s * s)) / 3 : 0;
        return (p_.hub.radius + share * p_.beam.length) * i + sag * j;
    }

    void beam() {
        Shape curve{.kind = Kind::line, .color = kBlue, .width = 2.2};
        for (int k = 0; k <= 60; ++k) curve.points.push_back(on_beam(k / 60.0));
        add(curve);
        const Vec2 i = sim::unit(theta_), j = sim::perp(i);
        if (is_flexible()) {
            const double at = 0.70;
            const Vec2 foot = (p_.hub.radius + at * p_.beam.length) * i, sagging = on_beam(at);
            arrow(foot, sagging, kBlue, 0.9);
            const bool low = theta_ > 0 && theta_ < 0.4;  // above the beam, which has the axis X or the cam close below
            label(low ? foot : sagging, "$v(x, t)$", low ? Vec2{0, 1} : Vec2{2.4, -0.7}, kBlue);
        }
        // Length, beside the beam.
        const Vec2 off = kDimension * size_ * j;
        line(p_.hub.radius * i + 0.25 * off, p_.hub.radius * i + 1.1 * off, kGrey);
        line((p_.hub.radius + p_.beam.length) * i + 0.25 * off, (p_.hub.radius + p_.beam.length) * i + 1.1 * off,
             kGrey);
        dimension(p_.hub.radius * i + off, (p_.hub.radius + p_.beam.length) * i + off);
        const double along = theta_ > 0 && theta_ < 0.7 ? 0.65 : 0.45;  // clear of gravity
        label((p_.hub.radius + along * p_.beam.length) * i + off, "$L$", {-0.6, 0.7});
        dot(on_beam(1), kBlue, 1.4);
    }

    void hub() {
        const double a = p_.hub.radius;
        if (a > 0) {
            disc({0, 0}, a);
            arrow({0, 0}, a * sim::unit(-0.8));
            label(a * sim::unit(-0.8), "$a$", {0.6, -0.5});
        } else {
            label({0, 0}, a < 0 ? "$a < 0$" : "$a = 0$", {-3.5, -0.9}, kGrey);
        }
        add({.kind = Kind::disc, .centre = {0, 0}, .radius_points = 3, .color = render::rgb(0xFFFFFF)});
        add({.kind = Kind::circle, .centre = {0, 0}, .radius_points = 3, .color = kInk, .width = 0.9});
        dot({0, 0}, kInk, 1);
    }

    void torque() {
        const double r = std::max(0.1 * unit_, 1.3 * p_.hub.radius), middle = -2.2;  // between O and the dimension D
        add({.kind = Kind::turn, .centre = {0, 0}, .radius = r, .from = middle - 0.35, .to = middle + 0.35});
        label(r * sim::unit(middle), "$τ$", 0.75 * sim::unit(middle));
    }

    void angle() {
        // So far away that the label has room between beam and axis.
        const double r = std::max({0.115 * unit_, 1.2 * p_.hub.radius, 1.2 * letter_height() / std::abs(theta_)});
        add({.kind = Kind::turn, .centre = {0, 0}, .radius = r, .from = 0, .to = theta_, .color = kInk, .width = 0.8});
        label(r * sim::unit(0.5 * theta_), "$θ$", 0.75 * sim::unit(0.5 * theta_));
    }

    void gravity() {
        const double length = 0.17 * unit_;
        double x = 0.28 * size_, low = 0.98 * size_ * std::sin(theta_) - length;
        // Above the dimension of the beam, which is low where the beam is.
        const double line = x * std::tan(theta_) + kDimension * size_ / std::cos(theta_);
        const bool steep = theta_ > 0.7 && low < line + 0.03 * unit_;
        if (steep) x = (std::cos(theta_) + 0.22) * size_;  // on the other side of the beam
        if (theta_ > 0 && theta_ < 0.7) low = std::max(low, line + 0.05 * unit_);
        const Vec2 from{x, low + length}, to{x, low};
        arrow(from, to, kInk, 0.9);
        // On the other side than the dimension, if that is close.
        label(0.5 * (from + to), "$g$", {theta_ > 0.7 && !steep ? -0.8 : 0.8, 0});
    }

    const sim::Problem& p_;
    double letter_, size_ = 1, unit_ = 1, theta_ = 0.78;
};

constexpr double kAspect = 0.98;
// Explains the symbols that are drawn.
std::string symbols_of(const sim::Problem& p) {
    std::string all =
        "The system; $X$, $Y$: fixed axes; $x′$, $y′$: axes of the hub, whose radius is $a$ and whose angle is $θ$; "
        "$L$: length of the beam";
    if (p.beam.model != sim::ModelKind::rigid) all += "; $v$: its deflection, exaggerated";
    if (has_torque(p.hub.drive)) all += "; $τ$: torque";
    if (p.gravity != 0) all += "; $g$: gravity";
    if (!p.cam) return all;
    all += "; $C$: axis of the cam, at the distance $D$ from $O$";
    if (!p.cam->profile) all += "; $B$: centre of its disc; $R$: radius";
    if (!p.cam->profile && p.cam->eccentricity > 0) all += "; $e$: eccentricity";
    if (p.cam->speed != 0) all += "; $ω$: speed";
    return all;
}

// The magnified disc's radius is about an eighth of the page's shorter side.
double letter_of(const FigureOutput& how) {
    const render::figure::Column& column = *render::figure::column_named(how.column);
    Figure figure;
    figure.aspect = kAspect;
    if (how.series.height) figure.height = *how.series.height * 1e3;
    const auto page =
        render::figure::page_of(figure, column, how.width ? std::optional(*how.width * 1e3) : std::nullopt);
    return page.style.letters / (0.124 * render::figure::points(std::min(page.width, page.height)));
}

FigureDrawing prepare_schematic(const Scene&, const FigureOutput& how, MotionRequests&) {
    return [letter = letter_of(how)](const Subject& subject, const MotionResults&) -> Figure {
        auto shapes = Drawing(subject.problem, letter).shapes();
        render::Bounds extent;
        for (const auto& shape : shapes) {
            extent.add(shape.centre, shape.radius);
            for (const Vec2 p : shape.points) extent.add(p);
        }
        // Of a wide drawing with room for labels.
        const double aspect = std::min(kAspect, 0.15 + (extent.y1 - extent.y0) / (extent.x1 - extent.x0));
        Figure figure{
            .title = symbols_of(subject.problem), .panels = {{.shapes = std::move(shapes)}}, .aspect = aspect};
        add_caption(figure, std::vector{subject.problem}, subject.units);
        return figure;
    };
}

}  // namespace

extern const FigureType kSchematic{"schematic", "The system and its symbols, deflection exaggerated", no_refusal,
                                   prepare_schematic};

}  // namespace beamcam::scenes
