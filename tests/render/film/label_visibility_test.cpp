// Labels beside obstacles: what gives way, where a leader line ends, and when a label is hidden.
#include "render/film/label_visibility.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/film/caption_places.hpp"
#include "render/film/mechanism_marks.hpp"
#include "tests/render/drawing.hpp"
#include "tests/render/synthetic.hpp"

namespace beamcam::render {
namespace {

// A mechanism at the first frame of a film, drawn mark by mark on white paper.
class Marks {
  public:
    explicit Marks(const FilmSetup& setup)
        : context_(std::make_shared<const FilmSetup>(setup)),
          home(context_, *context_.places.first(PanelKind::mechanism)),
          cameras(home),
          pose_(context_.pose(0, 0)) {
        cameras.follow(std::vector<Followed>(std::size_t(context_.frames())));
        at_.emplace(cameras.view(0));
        at_->labels = &labels;
        perspective = cameras.perspective(*at_, 0);
    }

    template <class Draw>
    Image drawn(const Draw& draw) {
        Image image(context_.setup->width, context_.setup->height);
        Canvas canvas(image, fonts());
        canvas.paint(rgb(0xFFFFFF));
        canvas.record = &texts;
        const DrawnBeam beam = at_->drawn(0, pose_);
        const MechanismShape shape = mechanism_shape(at_->problem(), pose_, beam, at_->look, at_->palette);
        draw(MechanismScene{canvas, 0, pose_, beam, shape, *at_, perspective ? &*perspective : nullptr});
        return image;
    }
    const MechanismView& at() const { return *at_; }
    const sim::Pose& pose() const { return pose_; }

  private:
    FilmContext context_;

  public:
    MechanismView home;
    MechanismCameras cameras;
    MechanismLabels labels;
    std::optional<Perspective> perspective;
    std::vector<Box> texts;

  private:
    sim::Pose pose_;
    std::optional<MechanismView> at_;
};

FilmSetup visible_film_of(Style style) {
    FilmSetup setup = test::flat_film({.duration = 0.2}, 1280, 720);
    setup.view.style = style;
    setup.layout = LayoutNode{};
    return setup;
}

long inked(const Image& a, const Image& b) { return differing_pixels(a, b, {0, 0, double(a.width), double(a.height)}); }

// Films with and without an arc of θ differ by the leader of the cam's speed if the arc lies between label and arrow.
TEST(MechanismMarks, TheLeaderOfTheSpeedDoesNotCrossTheArcOfTheAngle) {
    Marks marks(visible_film_of(Style::flat));
    const MechanismView& at = marks.at();
    const Vec2 axis = at.px(at.problem().cam->centre), hinge = at.px({0, 0});
    marks.labels.speed_way = 0.8 * std::numbers::pi;  // towards the beam
    const Vec2 arrow = axis + down(marks.labels.speed_way) * speed_radius(at);
    const auto leader = [&](Vec2 label) {
        marks.labels.speed = LabelPlace{at.look.camera.to_world(arrow), label - arrow, {60, 20}, {}, {}};
        const auto draw = [](const MechanismScene& s) { draw_cam_speed(s); };
        marks.labels.arc_radius = 0.85 * norm(arrow - hinge);
        const Image with = marks.drawn(draw);
        marks.labels.arc_radius = 0;
        return inked(with, marks.drawn(draw));
    };
    EXPECT_GT(leader(arrow + Vec2{0, 120}), 20);  // across the start of the arc
    EXPECT_EQ(leader(arrow - Vec2{0, 120}), 0);
}

// A label may be far from its arrow, to which no line leads then: it would cross the picture.
TEST(MechanismMarks, LeadersHaveAGreatestLength) {
    for (const double zoom : {1.0, 3.0}) {
        FilmSetup setup = visible_film_of(Style::flat);
        setup.view.shot.zoom = zoom;
        Marks marks(setup);
        const auto drawn_over = [&](double length) {
            const MechanismView& at = marks.at();
            const LabelPlace label{{}, {}, {20, 20}, {}, {}};
            const auto draw = [&](const MechanismScene& s) {
                const Box box = s.label_box(label, label.base);
                draw_leader(s, label, box, rgb(0), {box.right() + length * at.unit, box.centre().y});
            };
            return inked(marks.drawn(draw), marks.drawn([](const MechanismScene&) {})) > 0;
        };
        EXPECT_FALSE(drawn_over(kFarLabel - 5));
        EXPECT_TRUE(drawn_over(150));
        EXPECT_FALSE(drawn_over(300)) << zoom;
    }
}

// The label of a force may be beyond the foot of its arrow, which the line must not cross then.
TEST(MechanismMarks, TheLeaderOfAForceEndsAtTheNearerEndOfItsArrow) {
    Marks marks(visible_film_of(Style::flat));
    const ForceArrow arrow{marks.pose().cam_centre, {0, 1}, 1e9};
    const MechanismView& at = marks.at();
    const Vec2 foot = at.px(arrow.foot), tip = arrow_tip(at, nullptr, arrow);
    ASSERT_GT(norm(tip - foot), 30);
    const Box before_tip = Box{tip.x, tip.y, 0, 0}.inset(-15), before_foot = Box{foot.x, foot.y, 0, 0}.inset(-15);
    const auto leader_meets = [&](Vec2 label, const Box& part) {
        marks.labels.force = LabelPlace{arrow.foot, label - foot, {20, 10}, {}, {}};
        const Image with = marks.drawn([&](MechanismScene s) {
            s.arrow = arrow;
            draw_force_leader(s);
        });
        return differing_pixels(with, marks.drawn([](const MechanismScene&) {}), part) > 0;
    };
    EXPECT_TRUE(leader_meets(tip + Vec2{0, -60}, before_tip));
    EXPECT_FALSE(leader_meets(tip + Vec2{0, -60}, before_foot));
    EXPECT_TRUE(leader_meets(foot + Vec2{0, 60}, before_foot));
    EXPECT_FALSE(leader_meets(foot + Vec2{0, 60}, before_tip));
}

// The box of the label has room for the widest number; the line begins at the number of this frame.
TEST(MechanismMarks, TheLeaderOfAForceBeginsAtItsNumber) {
    Marks marks(visible_film_of(Style::flat));
    const ForceArrow arrow{marks.pose().cam_centre, {0, 1}, 4};
    const MechanismView& at = marks.at();
    const Vec2 foot = at.px(arrow.foot);
    constexpr double kWide = 200, kFarBelow = 150;
    marks.labels.force = LabelPlace{arrow.foot, Vec2{0, kFarBelow}, {kWide, 20}, {}, {}};
    const Image with = marks.drawn([&](MechanismScene s) {
        s.arrow = arrow;
        draw_force_leader(s);
    });
    const Image without = marks.drawn([](const MechanismScene&) {});
    const Box above{foot.x - kWide / 2, foot.y + kFarBelow - 40, kWide, 20};  // the label, left: its number
    EXPECT_GT(differing_pixels(with, without, {above.x, above.y, kWide / 2, above.h}), 0);
    EXPECT_EQ(differing_pixels(with, without, {above.centre().x, above.y, kWide / 2, above.h}), 0);
}

// The letters of a mechanism that is small in its picture have their usual size before a near camera.
TEST(MechanismMarks, LettersOfTheDiscGrowWithTheZoom) {
    Marks marks(visible_film_of(Style::flat));
    const auto height = [&](double share, double zoom) {
        marks.texts.clear();
        marks.drawn([&](const MechanismScene& s) {
            MechanismView small = s.at;
            small.marks = share * small.unit;
            const MechanismView at = small.with_camera({small.look.camera, zoom});
            draw_disc_letters({s.canvas, 0, s.pose, s.beam, s.shape, at, nullptr});
        });
        EXPECT_EQ(marks.texts.size(), 2U);
        return marks.texts.empty() ? 0 : marks.texts[0].h;
    };
    EXPECT_LT(height(0.3, 1), 0.8 * height(1, 1));
    EXPECT_EQ(height(0.3, 8), height(1, 1));
}

// The caption goes where its line to the anchor crosses no label.
TEST(Captions, LinesToTheirAnchorsPassTheLabels) {
    FilmSetup setup = visible_film_of(Style::flat);
    setup.callouts = {{0, 5, "a place in the air", Anchor{Anchor::Kind::place, {0.5, 0.75}}}};
    Marks marks(setup);
    marks.labels.captions.resize(1);
    const auto placed = [&] {
        Box plate;
        CaptionLeader leader;
        marks.drawn([&](const MechanismScene& s) {
            const CaptionPlaces places(s);
            const Callout& callout = s.at.context.setup->callouts[0];
            plate = places.placed(callout, {});
            leader = places.leader_of(callout, plate, *places.leader_foot(callout));
        });
        return std::pair{plate, leader};
    };
    const auto [plate, leader] = placed();
    ASSERT_FALSE(leader.crosses_label);
    const Vec2 between = (leader.points.back() * 0.6 + Vec2{leader.points.back().x, plate.bottom()} * 0.4);
    marks.labels.speed = LabelPlace{marks.at().look.camera.to_world(between), {}, {400, 4}, {}, {}};
    const auto [other, clear] = placed();
    EXPECT_FALSE(clear.crosses_label);
    EXPECT_NE(other, plate);
}

// From far above, letters at another depth would be beside the line through B and C on the front of the disc.
TEST(MechanismMarks, LettersOfTheDiscAreOnItsFront) {
    FilmSetup setup = visible_film_of(Style::solid);
    setup.problem.cam->eccentricity = 0.05;
    for (sim::Pose& pose : setup.poses) pose.disc_centre = setup.problem.cam->centre + Vec2{0.05, 0};
    setup.view.shot.pitch = 1;
    Marks marks(setup);
    const MechanismView& at = marks.at();
    marks.drawn([](const MechanismScene& s) { draw_disc_letters(s); });
    ASSERT_EQ(marks.texts.size(), 2U);
    const Vec2 axis = at.px(at.problem().cam->centre);
    const auto beside_line = [&](Vec2 p, double depth) {
        double least = 1e9;
        for (double x = -200; x < 200; x += 0.5)
            least = std::min(least, norm(at.seen(axis + Vec2{x, 0}, &*marks.perspective, depth) - p));
        return least;
    };
    const Vec2 letter = marks.texts.front().centre();
    EXPECT_LT(beside_line(letter, kDiscDepth), 2);
    EXPECT_GT(beside_line(letter, 0.5), 3);
}

// A label over the beam moves to the free place beside it and stays opaque; one as large as the view is hidden.
TEST(LabelVisibility, HidesLabelsBeforeAMovingCameraOnlyWithoutRoom) {
    FilmSetup setup = visible_film_of(Style::flat);
    setup.view.shot = {.zoom = 1.5, .follow = {Anchor::Kind::place, {0.4, 0.4}}};
    Marks marks(setup);
    const auto shifted = [&](Vec2 size) {
        LabelPlace label{{}, {}, size, {}, {}};
        shift_clear(label, marks.cameras, [&](const SeenFrame& now) {
            const DrawnBeam beam = now.at.beam_of(0, now.frame);
            const Vec2 on = now.at.px(beam.line[beam.line.size() / 2]);
            return WantedPlace{now.at.px(label.base), Box{on.x - size.x / 2, on.y - size.y / 2, size.x, size.y}, {}};
        });
        return label;
    };
    const LabelPlace small = shifted({60, 20});
    const Box view = marks.home.box;
    const LabelPlace large = shifted({0.9 * view.w, 0.9 * view.h});
    for (int k = 0; k < int(setup.poses.size()); ++k) {
        const SeenFrame now(marks.cameras, k);
        EXPECT_EQ(small.opacity_at(k), 1) << k;
        EXPECT_FALSE(meets_body(now.at.label_box(small, now.by(), {}, k), now)) << k;
        EXPECT_EQ(large.opacity_at(k), 0) << k;
    }
}

}  // namespace
}  // namespace beamcam::render
