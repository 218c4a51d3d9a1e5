// Labels of the mechanism never lie over moving parts, from any side and with any camera.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "render/film/impact_rings.hpp"
#include "render/film/mechanism_cameras.hpp"
#include "render/film/mechanism_marks.hpp"
#include "render/film/panel.hpp"
#include "render/film/swept_region.hpp"
#include "tests/render/drawing.hpp"
#include "tests/render/synthetic.hpp"

namespace beamcam::render {
namespace {

// Any point of the label is inside the triangle, or a corner of the triangle inside the label.
bool meets(const Box& label, const std::array<Vec2, 3>& triangle) {
    if (std::ranges::any_of(triangle, [&](Vec2 p) { return label.contains({p.x, p.y, 0, 0}); })) return true;
    constexpr int kAlong = 24, kDown = 6;
    for (int i = 0; i <= kAlong; ++i)
        for (int j = 0; j <= kDown; ++j) {
            const Vec2 p{label.x + label.w * i / kAlong, label.y + label.h * j / kDown};
            int left = 0, right = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                const double side = cross(triangle[(k + 1) % 3] - triangle[k], p - triangle[k]);
                left += side > 0, right += side < 0;
            }
            if (left == 0 || right == 0) return true;
        }
    return false;
}

// The visible faces of a piece of the beam, or in the flat view the piece itself.
bool meets_beam(const Box& label, const MechanismView& at, const DrawnBeam& beam, const Perspective* view) {
    const Vec2 middle = at.box.centre();
    for (std::size_t i = 0; i + 1 < beam.line.size(); ++i) {
        std::vector<Vec2> corners;
        for (const double z : {-0.5, 0.5})
            for (const Vec2 p : {beam.face(i), beam.face(i + 1), beam.back(i + 1), beam.back(i)}) {
                const Vec2 flat = at.px(p);
                corners.push_back(view ? view->to_pixels({flat.x - middle.x, middle.y - flat.y, z * at.wide}) : flat);
            }
        Bounds around;
        for (const Vec2 p : corners) around.add(p);
        if (!label.overlaps(around.box())) continue;
        // Every triangle of corners is inside the convex piece.
        for (std::size_t a = 0; a < corners.size(); ++a)
            for (std::size_t b = a + 1; b < corners.size(); ++b)
                for (std::size_t c = b + 1; c < corners.size(); ++c)
                    if (meets(label, {corners[a], corners[b], corners[c]})) return true;
    }
    return false;
}

struct Labelled {
    int labels = 0, over_beam = 0;
    std::vector<Box> places;
};

Labelled labels_of(const FilmSetup& setup, int step) {
    const FilmContext context(std::make_shared<const FilmSetup>(setup));
    const MechanismView home(context, *context.places.first(PanelKind::mechanism));
    MechanismCameras cameras(home);
    std::vector<Followed> followed;
    for (int k = 0; k < context.frames(); ++k) {
        const sim::Pose pose = context.pose(0, k);
        const DrawnBeam beam = home.drawn(0, pose);
        const Vec2 tip = (beam.face(beam.line.size() - 1) + beam.back(beam.line.size() - 1)) * 0.5;
        followed.push_back({tip, beam.contact ? beam.contact->on_disc : tip, pose.cam_centre});
    }
    cameras.follow(followed);
    Film film(setup);
    Labelled out;
    for (int k = 0; k < film.frames(); k += step) {
        const FrameGeometry g = film.geometry(k);
        const MechanismView at = cameras.view(k);
        const auto view = cameras.perspective(at, k);
        for (const Box& label : g.labels) {
            ++out.labels;
            out.over_beam += meets_beam(label, at, g.beam, view ? &*view : nullptr);
            if (std::ranges::find(out.places, label) == out.places.end()) out.places.push_back(label);
        }
    }
    return out;
}

FilmSetup film_in(Style style) {
    FilmSetup setup = test::synthetic_film({.duration = 1});
    setup.width = 1280, setup.height = 720;
    setup.view.style = style;
    return setup;
}

TEST(MechanismLabels, AreClearOfBodiesSeenFromAnySide) {
    for (const double yaw : {-1.1, 0.42, 1.1})
        for (const double pitch : {-0.4, 0.9}) {
            FilmSetup setup = film_in(Style::solid);
            setup.view.shot.yaw = yaw, setup.view.shot.pitch = pitch;
            const Labelled seen = labels_of(setup, 3);
            EXPECT_EQ(seen.over_beam, 0) << yaw << ", " << pitch;
            EXPECT_EQ(seen.places.size(), 3U) << yaw << ", " << pitch;  // the angle, the speed and the force
        }
}

TEST(MechanismLabels, AreClearOfBodiesBeforeANearCamera) {
    for (const Style style : {Style::flat, Style::solid})
        for (const Anchor::Kind follow : {Anchor::Kind::tip, Anchor::Kind::contact})
            for (const double zoom : {2.0, 6.0}) {
                FilmSetup setup = film_in(style);
                setup.view.shot.zoom = zoom, setup.view.shot.follow.kind = follow;
                EXPECT_EQ(labels_of(setup, 3).over_beam, 0) << int(style) << ", " << int(follow) << ", " << zoom;
            }
}

// A camera that has not moved yet shows labels where a fixed one does, at the lower edge, too.
TEST(MechanismLabels, HaveTheirPlacesBeforeTheCameraMoves) {
    FilmSetup setup = film_in(Style::solid);
    setup.width = 960, setup.height = 540;
    const std::vector<Box> fixed = Film(setup).geometry(0).labels;
    setup.moves = {{40, 20, Ease::smooth, setup.view.shot}};
    setup.moves[0].shot.zoom = 4;
    const std::vector<Box> before = Film(setup).geometry(0).labels;
    ASSERT_FALSE(fixed.empty());
    ASSERT_EQ(fixed.size(), before.size());
    EXPECT_NEAR(norm(fixed[0].centre() - before[0].centre()), 0, 0.5);
}

// Captions keep their places while the beam passes them.
TEST(Captions, AreClearOfTheBeamWhileTheyAreShown) {
    for (const Style style : {Style::flat, Style::solid}) {
        FilmSetup setup = film_in(style);
        setup.layout = LayoutNode{};
        Film plain(setup);
        for (const Vec2 at : {Vec2{0.5, 0.3}, {0.7, 0.35}, {0.8, 0.1}})
            setup.callouts.push_back({0, 50, "a place that the beam passes", Anchor{Anchor::Kind::place, at}});
        for (const int first : {5, 10, 15})
            setup.callouts.push_back({first, 50, "words about the contact that fill more than one line"});
        const FilmContext context(std::make_shared<const FilmSetup>(setup));
        const MechanismView home(context, *context.places.first(PanelKind::mechanism));
        const MechanismCameras cameras(home);
        Film film(setup);
        int captions = 0;
        for (int k = 0; k <= 50; k += 2) {
            const FrameGeometry g = film.geometry(k);
            const std::vector<Box> others = plain.geometry(k).texts;
            const auto view = cameras.perspective(home, k);
            for (const Box& text : g.texts) {
                if (std::ranges::find(others, text) != others.end()) continue;
                ++captions;
                EXPECT_FALSE(meets_beam(text, home, g.beam, view ? &*view : nullptr)) << int(style) << ", " << k;
            }
        }
        EXPECT_GT(captions, 100);
    }
}

// Where the arc of θ is beside the disc, no caption covers it.
TEST(Captions, AreClearOfTheArcOfTheAngle) {
    SKIP_WITHOUT_GL();
    FilmSetup setup = film_in(Style::solid);
    setup.problem.cam->centre.x = 0.35;  // the first place of a caption is over the start of the arc
    setup.problem.cam->speed = 0;        // no other arc has this colour
    FilmSetup without = setup;
    without.view.show.labels = false;
    Film plain(setup), bare(without);
    const FilmContext context(std::make_shared<const FilmSetup>(setup));
    const MechanismView home(context, *context.places.first(PanelKind::mechanism));
    const Color muted = palette(setup.view.theme).muted;
    const auto of_arc = [&](std::uint32_t p) {
        const auto near = [&](int shift, double value) { return std::abs((p >> shift & 255) / 255.0 - value) < 0.1; };
        return near(16, muted.r) && near(8, muted.g) && near(0, muted.b);
    };
    const auto of_arc_in = [&](const Image& image, const Box& box) {
        int count = 0;
        for (int y = int(box.y); y < int(box.bottom()); ++y)
            for (int x = int(box.x); x < int(box.right()); ++x)
                count += of_arc(image.pixels[std::size_t(y) * std::size_t(image.width) + std::size_t(x)]);
        return count;
    };
    int captions = 0;
    for (const char* words : {"touch", "first touch", "the first touch\nof this motion"}) {
        setup.callouts = {{15, 40, words}};
        Film film(setup);
        for (int k = 15; k <= 40; k += 5) {
            const FrameGeometry g = plain.geometry(k);
            const std::vector<Box>& others = g.texts;
            const Image before = drawn(plain, k);
            int seen = of_arc_in(before, home.box) - of_arc_in(drawn(bare, k), home.box);
            for (const Box& label : g.labels) seen -= of_arc_in(before, label);
            EXPECT_GT(seen, 70) << k;  // the line at its start alone has 44
            for (const Box& text : film.geometry(k).texts) {
                if (std::ranges::find(others, text) != others.end()) continue;
                ++captions;
                EXPECT_EQ(of_arc_in(before, text.inset(-6)), 0) << words << ", " << k;  // its plate is larger
            }
        }
    }
    EXPECT_EQ(captions, 24);  // lines
}

TEST(MechanismLabels, SmallAnglesAndArcsInTheHubAreNotShown) {
    const FilmContext context(std::make_shared<const FilmSetup>(test::flat_film({.duration = 0.1}, 1280, 720)));
    const MechanismView at(context, *context.places.first(PanelKind::mechanism));
    sim::Pose pose = context.pose(0, 0);
    pose.theta = 0.5;
    EXPECT_TRUE(shows_angle_arc(at, 100 * at.unit, pose));
    EXPECT_FALSE(shows_angle_arc(at, at.hub(), pose));
    pose.theta = 0.01;
    EXPECT_FALSE(shows_angle_arc(at, 100 * at.unit, pose));
}

// Before a near camera, too, they keep one place each, beside beam and disc, while the camera moves.
TEST(Captions, KeepTheirPlacesBeforeANearCamera) {
    for (const Style style : {Style::flat, Style::solid}) {
        FilmSetup setup = film_in(style);
        setup.layout = LayoutNode{};
        setup.view.shot = {.zoom = 3, .follow = {Anchor::Kind::contact, {}}};
        setup.moves = {{.arrives = 50, .lasts = 20, .shot = {.zoom = 2, .follow = {Anchor::Kind::cam, {}}}}};
        Film plain(setup);
        setup.callouts = {{20, 50, "contact"}, {10, 50, "tip", Anchor{Anchor::Kind::tip, {}}}};
        const FilmContext context(std::make_shared<const FilmSetup>(setup));
        const MechanismView home(context, *context.places.first(PanelKind::mechanism));
        Film film(setup);
        std::vector<Box> places;
        for (int k = 10; k <= 50; k += 2) {
            const FrameGeometry g = film.geometry(k);
            const std::vector<Box> others = plain.geometry(k).texts;
            for (const Box& text : g.texts) {
                if (std::ranges::find(others, text) != others.end()) continue;
                if (std::ranges::find(places, text) == places.end()) places.push_back(text);
                if (style == Style::solid) continue;
                MechanismView at = home;
                at.look.camera = g.camera;
                EXPECT_FALSE(meets_beam(text, at, g.beam, nullptr)) << k;
                const sim::Pose pose = context.pose(0, k);
                const Vec2 disc = at.px(pose.disc_centre),
                           nearest{std::clamp(disc.x, text.x, text.right()), std::clamp(disc.y, text.y, text.bottom())};
                EXPECT_GT(norm(disc - nearest), setup.problem.cam->radius * g.camera.scale) << k;
            }
        }
        EXPECT_EQ(places.size(), 2U) << int(style);
    }
}

// The arrow of the cam's speed finds the only free direction, between those that are tried first.
TEST(MechanismLabels, TheArrowOfTheSpeedIsClearWhereThereIsAPlace) {
    const FilmContext context(std::make_shared<const FilmSetup>(test::flat_film({.duration = 0.1}, 1280, 720)));
    const MechanismView at(context, *context.places.first(PanelKind::mechanism));
    const MechanismCameras cameras(at);
    const Vec2 axis = at.px(at.problem().cam->centre);
    for (const double free : {0.4, 2.5, -2.8}) {
        SweptRegion swept(at, OccupancyGrid(at.box, 2), {}), in_contact = swept;
        constexpr double kHalf = 0.52, kStep = 0.05;  // the arrow spans up to 0.8 rad
        for (double angle = free + kHalf; angle < free - kHalf + 2 * std::numbers::pi; angle += kStep)
            swept.room.cover_convex(std::array{axis, axis + down(angle) * 3000, axis + down(angle + kStep) * 3000});
        const MechanismLabels labels = place_labels(at, cameras, {}, swept, in_contact);
        EXPECT_LT(std::abs(std::remainder(labels.speed_way - free, 2 * std::numbers::pi)), kHalf - 0.35) << free;
    }
}

// A line to an arrow that moves far away would appear and disappear, or sweep the picture: in such a film the label of
// the force begins with a sample of the arrow.
TEST(MechanismLabels, TheForceHasASampleOfAnArrowThatMovesFarAway) {
    const FilmContext context(std::make_shared<const FilmSetup>(test::flat_film({.duration = 0.1}, 1280, 720)));
    const MechanismView at(context, *context.places.first(PanelKind::mechanism));
    const MechanismCameras cameras(at);
    const auto label_with = [&](const std::vector<ForceArrow>& arrows) {
        SweptRegion swept(at, OccupancyGrid(at.box, 2), {}), in_contact = swept;
        LabelNeeds needs;
        needs.arrows = arrows;
        return *place_labels(at, cameras, needs, swept, in_contact).force;
    };
    const ForceArrow struck{{0.25, 0.1}, {-0.3, 0.95}, context.arrow_scale}, carried{{0.24, 0.16}, {-0.6, 0.8}, 1},
        far{{0.25 + 600 * at.unit / at.look.camera.scale, 0.1}, {0, 1}, 1};
    const LabelPlace near = label_with({struck, carried}), sampled = label_with({struck, far});
    EXPECT_FALSE(near.has_sample);
    EXPECT_TRUE(sampled.has_sample);
    EXPECT_GT(sampled.size.x, near.size.x + 30 * at.unit);
}

// A near camera shows the whole arrow of a force whose foot is in its view, and a shorter one at the edge.
TEST(MechanismLabels, ArrowsEndInTheViewOfANearCamera) {
    FilmSetup setup = film_in(Style::flat);
    const FilmContext context(std::make_shared<const FilmSetup>(setup));
    MechanismView at(context, *context.places.first(PanelKind::mechanism));
    ForceArrow arrow{{0.5, 0.2}, {0, 1}, context.arrow_scale};
    EXPECT_GT(norm(arrow_tip(at, nullptr, arrow) - at.px(arrow.foot)), 20);
    CameraFrame near{at.look.camera, 1, 0, 0};
    near.camera.origin = near.camera.origin + Vec2{0, at.box.y + 10 - at.px(arrow.foot).y};  // its foot is at the edge
    const MechanismView above = at.with_camera(near);
    const Vec2 tip = arrow_tip(above, nullptr, arrow), foot = above.px(arrow.foot);
    EXPECT_TRUE(above.shows(tip));
    EXPECT_GT(norm(tip - foot), 5);
    EXPECT_LT(norm(tip - foot), 10);
}

// At the edge of the view of a near camera the label of the force gives way to its arrow; it does not lie over it.
TEST(MechanismLabels, TheForceIsClearOfItsArrowAtTheEdge) {
    FilmSetup setup = test::flat_film({.duration = 2}, 1280, 720);
    setup.impacts.clear();
    setup.layout = LayoutNode{};
    setup.view.shot = {.zoom = 2, .follow = {Anchor::Kind::place, {0.25, 0.1}}};
    const FilmContext context(std::make_shared<const FilmSetup>(setup));
    const MechanismView home(context, *context.places.first(PanelKind::mechanism));
    const double unit = home.unit, scale = 2 * home.look.camera.scale;
    const double at_rest = home.beam_of(0, context.frames() - 1).contact->on_disc.x;
    for (const double from_edge : {30.0, 60.0, 90.0}) {
        setup.view.shot.follow.place.x = at_rest + (home.box.w / 2 - from_edge * unit) / scale;
        Film film(setup);
        int forces = 0;
        for (int k = 0; k < film.frames(); ++k) {
            const sim::Pose& pose = setup.poses[std::size_t(k)];
            if (!(pose.nearest->force > 0)) continue;
            const FrameGeometry g = film.geometry(k);
            MechanismView at = home;
            at.look.camera = g.camera, at.moved = true;
            const ForceArrow arrow{g.beam.contact->on_disc, g.beam.contact->normal, pose.nearest->force};
            const Vec2 foot = at.px(arrow.foot), tip = arrow_tip(at, nullptr, arrow);
            bool near = false;
            for (const Box& label : g.labels) {
                near = near || norm(label.centre() - foot) < 300 * unit;
                for (int i = 0; i <= 20; ++i) {
                    const Vec2 on = foot + (tip - foot) * (i / 20.0);
                    EXPECT_FALSE(label.contains({on.x, on.y, 0, 0})) << from_edge << ", " << k;
                }
            }
            EXPECT_TRUE(near) << from_edge << ", " << k;
            ++forces;
        }
        EXPECT_GT(forces, 5);
    }
}

// A camera that moves during a contact takes the label of the force along, at the same distance beyond the beam.
TEST(MechanismLabels, TheForceStaysNearItsArrowWhileTheCameraMoves) {
    FilmSetup setup = test::flat_film({.duration = 2}, 1280, 720);
    setup.impacts.clear();
    setup.layout = LayoutNode{};
    setup.view.shot = {.zoom = 3, .follow = {Anchor::Kind::contact, {}}};
    double first = 1e9, last = 0;  // frames with a force
    for (std::size_t k = 0; k < setup.poses.size(); ++k)
        if (setup.poses[k].nearest->force > 0) first = std::min(first, double(k)), last = double(k);
    setup.moves = {{last, last - first, Ease::linear, setup.view.shot}};
    setup.moves[0].shot.follow = {Anchor::Kind::hub, {}};
    Film film(setup);
    int forces = 0;
    for (int k = 0; k < film.frames(); ++k) {
        if (!(setup.poses[std::size_t(k)].nearest->force > 0)) continue;
        const FrameGeometry g = film.geometry(k);
        const Vec2 foot = g.camera.to_pixels(g.beam.contact->on_disc);
        const double beam = (g.beam.high - g.beam.low) * g.camera.scale, arrow = 150 * g.layout.unit;
        double nearest = 1e9;
        for (const Box& label : g.labels) nearest = std::min(nearest, norm(label.centre() - foot));
        EXPECT_LT(nearest, std::max(beam, arrow) + 150 * g.layout.unit) << k;
        ++forces;
    }
    EXPECT_GT(forces, 5);
}

// The angle has its arc and letter, too, where the cam leaves no room between itself and the hub.
TEST(MechanismLabels, TheAngleIsShownBesideACamAtTheHub) {
    for (const double centre : {0.06, 0.5}) {
        FilmSetup setup = test::led_rod(1.2, -0.2);
        sim::Cam& cam = *setup.problem.cam;
        cam.centre = {centre, 0}, cam.radius = 0.8 * centre, cam.eccentricity = 0.15 * centre, cam.speed = 0;
        for (sim::Pose& pose : setup.poses) pose.cam_centre = pose.disc_centre = cam.centre;
        const FilmContext context(std::make_shared<const FilmSetup>(setup));
        const MechanismView home(context, *context.places.first(PanelKind::mechanism));
        const Vec2 hinge = home.px({0, 0});
        int near = 0;
        for (const Box& label : Film(setup).geometry(0).labels)
            near += norm(label.centre() - hinge) < 0.45 * home.look.camera.scale;
        EXPECT_GE(near, 1) << centre;
    }
}

// While the usual place of the letter is below the view of this camera, it is in the sector, before the disc.
TEST(MechanismLabels, TheAngleIsNamedBeforeANearCamera) {
    FilmSetup setup = test::flat_film({.duration = 1}, 640, 360);
    setup.layout = LayoutNode{};
    setup.view.shot = {.zoom = 4, .follow = {Anchor::Kind::contact, {}}};
    Film film(setup);
    for (int k = 0; k < film.frames(); k += 4) {
        const FrameGeometry g = film.geometry(k);
        int named = 0;
        for (const Box& label : g.labels) {
            const Vec2 way = g.camera.to_world(label.centre());
            const double angle = std::atan2(way.y, way.x);
            named += angle > -1 && angle < setup.poses[std::size_t(k)].theta &&
                     norm(way) < arc_before_cam(*setup.problem.cam);
        }
        EXPECT_EQ(named, 1) << k;
    }
}

// A large hub covers the usual arc: its arc is outside the hub.
TEST(MechanismLabels, TheAngleIsShownBesideALargeHub) {
    for (const Style style : {Style::flat, Style::solid})
        for (const double radius : {0.05, 0.1, 0.3}) {
            FilmSetup setup = test::led_rod(0.7, -0.2);
            setup.problem.hub.radius = radius, setup.problem.cam.reset();
            setup.view.style = style;
            EXPECT_EQ(Film(setup).geometry(0).labels.size(), 1U) << int(style) << ", " << radius;
        }
}

// Where the beam sweeps nearly all directions, the letter is across the horizontal from it until the beam passes there.
TEST(MechanismLabels, TheAngleOfABeamThatTurnsOverHasItsLetter) {
    FilmSetup setup = test::led_rod(0.17, 5.9);
    sim::Cam& cam = *setup.problem.cam;
    cam.centre = {0.06, 0}, cam.radius = 0.015, cam.eccentricity = 0.005, cam.speed = 50;
    for (sim::Pose& pose : setup.poses) pose.cam_centre = pose.disc_centre = cam.centre;
    Film film(setup);
    EXPECT_EQ(film.geometry(0).labels.size(), 2U);
    EXPECT_EQ(film.geometry(film.frames() / 2).labels.size(), 2U);
}

// The arrow of a peak that is held stays where the beam was struck, and turns with the beam.
TEST(ImpactRings, ThePeakStaysOnTheBeam) {
    FilmSetup setup = film_in(Style::flat);
    sim::Impact impact;
    impact.t_start = 0.3, impact.t_end = 0.301, impact.force_peak = 100;
    impact.x = 0.25 * setup.problem.beam.length;
    setup.impacts = {impact};
    const FilmContext context(std::make_shared<const FilmSetup>(setup));
    const MechanismView at(context, *context.places.first(PanelKind::mechanism));
    ImpactRings rings;
    rings.find(at);
    int held = 0;
    for (int k = 0; k < context.frames(); ++k) {
        const DrawnBeam beam = at.beam_of(0, k);
        const auto peak = rings.peak(k, beam);
        if (!peak) continue;
        ++held;
        const std::size_t struck = (beam.line.size() - 1) / 4;
        EXPECT_NEAR(norm(peak->foot - beam.face(struck)), 0, 1e-12) << k;
        EXPECT_NEAR(dot(peak->normal, beam.left[struck]), 1, 0.02) << k;  // the beam may be bent by then
    }
    EXPECT_GT(held, 10);
}

// Peaks above all forces of the frames have arrows in proportion, too; the largest one has the longest arrow.
TEST(ImpactRings, ArrowsOfPeaksAreInProportionToTheirForces) {
    FilmSetup setup = film_in(Style::flat);
    const double frames = FilmContext(std::make_shared<const FilmSetup>(setup)).frame_force;
    ASSERT_GT(frames, 0);
    sim::Impact strong, weak;
    strong.t_start = 0.1, strong.t_end = 0.101, strong.force_peak = 4 * frames, strong.collision = 1;
    weak.t_start = 0.7, weak.t_end = 0.701, weak.force_peak = 1.5 * frames, weak.collision = 2;
    setup.impacts = {strong, weak};
    const FilmContext context(std::make_shared<const FilmSetup>(setup));
    const MechanismView at(context, *context.places.first(PanelKind::mechanism));
    ImpactRings rings;
    rings.find(at);
    const auto peak = [&](double t) {
        const int frame = static_cast<int>(std::ceil(t * setup.fps));
        return rings.peak(frame, at.beam_of(0, frame));
    };
    const auto first = peak(0.101), second = peak(0.701);
    ASSERT_TRUE(first && second);
    EXPECT_DOUBLE_EQ(first->force, 4 * frames);
    EXPECT_DOUBLE_EQ(second->force, 1.5 * frames);
    const double longest = force_arrow_length(1, at.small, at.marks);
    EXPECT_NEAR(arrow_length(at, *first), longest, 1e-9);
    EXPECT_NEAR(arrow_length(at, *second), longest * 1.5 / 4, 1e-9);

    setup.impacts[0].t_end = 0.3;  // longer than two frames: no arrow shows its peak
    EXPECT_DOUBLE_EQ(FilmContext(std::make_shared<const FilmSetup>(setup)).arrow_scale, 1.5 * frames);
    FilmSetup bare = setup, small = setup;  // which hold no peaks
    bare.view.show.labels = false;
    small.width = 200, small.height = 112;
    for (const FilmSetup& each : {bare, small})
        EXPECT_DOUBLE_EQ(FilmContext(std::make_shared<const FilmSetup>(each)).arrow_scale, frames) << each.width;
}

// The names of many motions stay inside their panel, in whatever form.
TEST(MechanismLegend, StaysWithinItsPanel) {
    for (const auto& [width, height] : {std::pair{1280, 720}, {640, 360}, {320, 180}, {200, 200}}) {
        FilmSetup setup = test::synthetic_film({.duration = 0.2});
        setup.width = width, setup.height = height;
        setup.view.style = Style::flat;
        setup.label = "ω = 0";
        for (int i = 1; i < 8; ++i)
            setup.others.push_back(setup), setup.others.back().label = "ω = " + std::to_string(i);
        setup.comparison = Comparison::ghosts;
        const FrameGeometry g = Film(setup).geometry(0);
        const Box panel = g.layout.first(PanelKind::mechanism)->box;
        for (const Box& each : g.legend) EXPECT_TRUE(panel.contains(each)) << width << "×" << height;
        if (width >= 640) {
            EXPECT_FALSE(g.legend.empty()) << width << "×" << height;
        }
    }
}

// Names of many motions are divided into two lists where one has no free place, and none lies over a beam.
TEST(MechanismLegend, IsClearOfManyBeamsInASmallPicture) {
    for (const Comparison how : {Comparison::ghosts, Comparison::panels}) {
        FilmSetup setup = test::flat_film({.duration = 0.8}, 320, 180);
        setup.label = "ω = 0 rad/s";
        for (int i = 1; i < 8; ++i)
            setup.others.push_back(setup), setup.others.back().label = "ω = " + std::to_string(i) + " rad/s";
        setup.comparison = how;
        const FilmContext context(std::make_shared<const FilmSetup>(setup));
        const MechanismView home(context, *context.places.first(PanelKind::mechanism));
        Film film(setup);
        for (int k = 0; k < film.frames(); k += 4) {
            const FrameGeometry g = film.geometry(k);
            EXPECT_EQ(g.legend.size(), how == Comparison::ghosts ? 2U : 1U);
            for (const Box& list : g.legend) EXPECT_FALSE(meets_beam(list, home, g.beam, nullptr)) << int(how) << k;
        }
    }
}

// A name that is too long for its panel has two lines before it is cut.
TEST(MechanismLegend, ALongNameHasTwoLines) {
    FilmSetup setup = test::flat_film({.duration = 0.2}, 640, 360);
    for (int i = 1; i < 8; ++i) setup.others.push_back(setup);
    const auto highest = [&](const std::string& name) {
        setup.label = name;
        for (Motion& other : setup.others) other.label = name;
        return Film(setup).geometry(0).legend.at(0).h;
    };
    EXPECT_GT(highest("a cam that is turning clockwise"), 1.4 * highest("a cam"));
}

}  // namespace
}  // namespace beamcam::render
