#include "scenes/figures/cam_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "render/draw/text_style.hpp"
#include "sim/cam/motion_law.hpp"

namespace beamcam::scenes {
namespace {

using render::figure::points, render::figure::PageCanvas;
using sim::Vec2;

// Sizes on paper.
constexpr double kMargin = points(12), kLetters = points(3.0), kOutline = points(0.5), kThin = points(0.2);  // [pt]
constexpr double kPointsPerMetre = points(1000);
constexpr double kBeyond = 4e-3;  // of centre lines, beyond the outline [m]
constexpr render::Color kBlack = render::rgb(0x000000), kGrey = render::rgb(0x777777), kFill = render::rgb(0xE6E8EC),
                        kWhite = render::rgb(0xFFFFFF);
const render::Pen kCentreLine{kGrey, kThin, {8 * kThin, 3 * kThin, kThin, 3 * kThin}, render::Cap::butt};
// ISO 128: adjacent parts are long-dashed and double-dotted.
const render::Pen kLeverLine{
    kBlack, 1.5 * kThin, {24 * kThin, 3 * kThin, kThin, 3 * kThin, kThin, 3 * kThin}, render::Cap::butt};

std::string millimetres(double metres) { return fmt::format("{:.2f}", 1e3 * metres); }

class CamDrawing {
  public:
    CamDrawing(const sim::Problem& problem, const sim::Lever& lever) : lever_(lever), shape_(lever.shape()) {
        constexpr int kCorners = 1440;  // a quarter of a degree: chords deviate by 2.4e-6 of the radius of curvature
        for (int i = 0; i < kCorners; ++i) outline_.push_back(place(sim::kFullTurn * i / kCorners));
        pivot_ = -problem.cam->centre;  // where the cam's frame is not turned
        for (const Vec2 p : outline_) bounds_.add(p);
        bounds_.add(pivot_, 6 * kLetters / kPointsPerMetre / 4);
        base_ = shape_.least_height();
        const sim::Lever::State start = lever_.at(0);
        if (std::isfinite(start.foot)) {
            const Vec2 along = sim::unit(start.motion.theta), touched = start.point.position(start.alpha);
            const double end =
                std::min(problem.hub.radius + problem.beam.length, norm(pivot_) + shape_.largest_reach());
            for (const double x : {-start.foot, end - start.foot}) bounds_.add(face_.emplace_back(touched + x * along));
        }
        if (problem.cam->profile)
            if (const auto* law = std::get_if<sim::LawProfile>(&*problem.cam->profile)) name_segments(*law);
        for (const auto& [alpha, name] : names_) {
            const Vec2 n = sim::unit(alpha);
            const double wide = 1.6 + 0.55 * static_cast<double>(name.size());
            bounds_.add(place(alpha) + kLetters / kPointsPerMetre * Vec2{n.x < 0 ? -wide : wide, 3 * n.y});
        }
        speed_ = problem.cam->speed;
    }

    render::figure::Paper paper() const {
        const render::Box box = bounds_.box();
        constexpr double kDimensions = 6.6 * kLetters;  // below the drawing
        return {box.w * kPointsPerMetre + 2 * kMargin, box.h * kPointsPerMetre + 2 * kMargin + kDimensions};
    }

    void draw(PageCanvas& to) {
        camera_ = {kPointsPerMetre, {kMargin - bounds_.x0 * kPointsPerMetre, kMargin + bounds_.y1 * kPointsPerMetre}};
        to_ = &to;
        draw_outline();
        draw_axis();
        draw_base_circle();
        draw_sharpest_place();
        draw_lever();
        draw_names();
        draw_jump();
        draw_rotation();
        draw_pivot();
    }

  private:
    Vec2 place(double alpha) const { return shape_.at(alpha).position(alpha); }
    // In the middle of each segment; a dwell at both ends of the turn is one.
    void name_segments(const sim::LawProfile& law) {
        std::vector<sim::ProgrammedMotion::Segment> all = sim::ProgrammedMotion(law).segments();
        if (all.size() > 1 && all.front().rise == 0 && all.back().rise == 0) {
            all.front().start -= all.back().over, all.front().over += all.back().over;
            all.pop_back();
        }
        for (const auto& each : all)
            names_.emplace_back(lever_.at(each.start + 0.5 * each.over).alpha, sim::name(each.law));
    }

    Vec2 at(Vec2 p) const { return camera_.to_pixels(p); }
    void label(Vec2 where, const std::string& text, render::HAlign align = render::HAlign::centre,
               render::Color halo = kWhite) {
        to_->text(where, text,
                  {.size = kLetters, .color = kBlack, .align = align, .valign = render::VAlign::middle, .halo = halo});
    }
    void arrow(Vec2 from, Vec2 to) {
        to_->arrow(from, to, {kBlack, kThin, {}, render::Cap::butt},
                   {.length = kLetters, .half_width = 0.2, .back = 1});
    }
    void line(Vec2 from, Vec2 to, const render::Pen& pen) { to_->line(from, to, pen); }

    void draw_outline() {
        std::vector<Vec2> corners;
        for (const Vec2 p : outline_) corners.push_back(at(p));
        to_->polyline(corners);
        to_->close();
        to_->fill_keeping_path(kFill);
        to_->stroke({kBlack, kOutline});
        constexpr double kTick = points(1.5);
        for (const double kink : shape_.kinks()) {
            const Vec2 p = at(place(kink)), n{std::cos(kink), -std::sin(kink)};
            line(p - kTick * n, p + kTick * n, {kBlack, kThin});
        }
    }

    void draw_axis() {
        const double right = shape_.at(0).h + kBeyond, left = shape_.at(std::numbers::pi).h + kBeyond;
        const double up = shape_.at(0.5 * std::numbers::pi).h + kBeyond;
        const double down = shape_.at(1.5 * std::numbers::pi).h + kBeyond;
        line(at({-left, 0}), at({right, 0}), kCentreLine);
        line(at({0, -down}), at({0, up}), kCentreLine);
    }

    void draw_base_circle() {
        constexpr double kSlope = 0.6;  // of the dimension [rad]
        const Vec2 c = at({0, 0});
        const double radius = base_ * kPointsPerMetre;
        to_->circle(c, radius);
        to_->stroke({kGrey, kThin, {4 * kThin, 3 * kThin}, render::Cap::butt});
        const Vec2 along{std::cos(kSlope), -std::sin(kSlope)};
        arrow(c, c + radius * along);
        arrow(c, c - radius * along);
        const Vec2 across{along.y, -along.x};  // to the upper left, on paper
        to_->text(
            c + 0.5 * radius * along + 0.4 * kLetters * across, "Ø " + millimetres(2 * base_),
            {.size = kLetters, .color = kBlack, .align = render::HAlign::centre, .halo = kFill, .turned = kSlope});
    }

    void draw_sharpest_place() {
        const double alpha = summary_.rho_min_normal;
        const sim::CamPoint p = shape_.at(alpha);
        if (p.radius * kPointsPerMetre < 3 * kLetters) return;  // without room; the number is below the drawing
        const Vec2 n = sim::unit(alpha), touched = p.position(alpha), centre = touched - p.radius * n;
        arrow(at(centre), at(touched));
        to_->circle(at(centre), points(0.4));
        to_->fill(kBlack);
        const Vec2 beside{0.9 * kLetters * std::abs(n.y) + 0.2 * kLetters, -0.9 * kLetters * std::abs(n.x)};
        label(at(centre + 0.55 * p.radius * n) + beside, "R " + millimetres(p.radius), render::HAlign::left, kFill);
    }

    // The face of the straight lever where the cam's frame is not turned.
    void draw_lever() {
        if (face_.empty()) return;
        const Vec2 root = at(face_[0]), tip = at(face_[1]);
        line(root, tip, kLeverLine);
        const Vec2 along = render::normalized(tip - root), off = 0.5 * kLetters * Vec2{along.y, -along.x};
        to_->text(root + 0.35 * (tip - root) + (lever_.side() > 0 ? 1 : -2.4) * off, "straight lever at φ = 0",
                  {.size = kLetters,
                   .color = kBlack,
                   .align = render::HAlign::centre,
                   .halo = kWhite,
                   .turned = -std::atan(along.y / along.x)});
    }

    // Of the segments, beside the outline; those near the lever are within the cam.
    void draw_names() {
        for (const auto& [alpha, name] : names_) {
            const bool within = std::cos(alpha - lever_.at(0).alpha) > std::numbers::sqrt2 / 2;
            const Vec2 beside = (within ? -1 : 1) * Vec2{std::cos(alpha), -std::sin(alpha)};
            label(at(place(alpha)) + 1.6 * kLetters * beside, name,
                  beside.x < 0 ? render::HAlign::right : render::HAlign::left, within ? kFill : kWhite);
        }
    }

    // The place where the straight rigid lever leaves the cam at its jump speed; the speed is in the last line.
    void draw_jump() {
        if (!summary_.jump || !(summary_.jump->speed > 0)) return;
        to_->circle(at(place(lever_.at(summary_.jump->phi).alpha)), points(0.7));
        to_->fill(kBlack);
        const double rpm = summary_.jump->speed * 30 / std::numbers::pi;
        label({kMargin, at({0, bounds_.y0}).y + 6.2 * kLetters},
              fmt::format("a rigid lever jumps at the dot: {:.{}f} rpm", rpm, rpm < 1000 ? 1 : 0),
              render::HAlign::left);
    }

    void draw_rotation() {
        if (speed_ == 0) return;
        // To the right of the centre, on the side away from the lever [rad].
        const double from = lever_.side() > 0 ? -1.4 : 0.5, to = from + 0.9;
        const double radius = 0.5 * base_ * kPointsPerMetre, end = speed_ > 0 ? from : to;
        to_->arc(at({0, 0}), radius, from, to);
        to_->stroke({kBlack, kThin, {}, render::Cap::butt});
        const Vec2 tip = at({0, 0}) + radius * Vec2{std::cos(end), -std::sin(end)};
        const Vec2 along = (speed_ > 0 ? 1 : -1) * Vec2{std::sin(end), std::cos(end)};
        arrow(tip - kLetters * along, tip);
    }

    void draw_pivot() {
        const Vec2 c = at({0, 0}), o = at(pivot_);
        line(c, o, kCentreLine);
        to_->circle(o, points(1.5));
        to_->fill_keeping_path(render::rgb(0xFFFFFF));
        to_->stroke({kBlack, kOutline});
        label(o + Vec2{0, -1.4 * kLetters}, "O");
        // The distance, below everything, along the line to the pivot where that is level.
        const double low = at({0, bounds_.y0}).y + 3 * kLetters;
        if (std::abs(o.x - c.x) > 4 * kLetters && std::abs(o.y - c.y) < 0.01 * kLetters) {
            const render::Pen thin{kBlack, kThin, {}, render::Cap::butt};
            line(at({0, -shape_.at(1.5 * std::numbers::pi).h - kBeyond}), {c.x, low + kLetters}, thin);
            line({o.x, o.y + points(2)}, {o.x, low + kLetters}, thin);
            const Vec2 middle{0.5 * (o.x + c.x), low};
            arrow(middle, {o.x, low});
            arrow(middle, {c.x, low});
            label(middle + Vec2{0, -0.9 * kLetters}, millimetres(norm(pivot_)));
        } else {
            const Vec2 along = (1 / std::max(1.0, norm(o - c))) * (o - c), across = sim::perp(along);
            const double side = across.y > 0 ? -1 : 1;  // above the line
            label(0.5 * (o + c) + 1.6 * side * kLetters * across, millimetres(norm(pivot_)));
        }
        const std::string radii = shape_.is_disc() ? "e " + millimetres(shape_.largest_slope())
                                                   : fmt::format("ρ {} … {}", millimetres(shape_.least_radius()),
                                                                 millimetres(shape_.largest_radius()));
        label({kMargin, low + 1.6 * kLetters}, "1:1, mm; " + radii, render::HAlign::left);
    }

    const sim::Lever& lever_;
    const sim::CamShape& shape_;
    const sim::Lever::Summary summary_ = lever_.summary();
    std::vector<Vec2> outline_;
    std::vector<Vec2> face_;  // of the lever, from its root to where it is cut; empty: no lever reaches the cam
    std::vector<std::pair<double, std::string>> names_;  // of segments, beside the outline's normal [rad]
    Vec2 pivot_;
    double base_ = 0;   // radius of the base circle [m]
    double speed_ = 0;  // of the cam [rad/s]
    render::Bounds bounds_;
    render::Camera camera_;
    PageCanvas* to_ = nullptr;
};

}  // namespace

std::string cam_drawing(const sim::Problem& problem, const sim::Lever& lever, render::Medium medium,
                        const render::Document& document) {
    CamDrawing drawing(problem, lever);
    const render::Fonts fonts(false, render::Typefaces::print);
    PageCanvas page(medium, drawing.paper(), fonts, document);
    drawing.draw(page);
    return page.bytes();
}

}  // namespace beamcam::scenes
