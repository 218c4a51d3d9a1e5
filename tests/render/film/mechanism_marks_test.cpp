// The letters of the disc.
#include "render/film/mechanism_marks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/film/mechanism_cameras.hpp"
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

}  // namespace
}  // namespace beamcam::render
