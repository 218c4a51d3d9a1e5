// The line of the undeflected beam.
#include "render/film/mechanism_marks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/film/mechanism_cameras.hpp"
#include "tests/render/drawing.hpp"
#include "tests/render/films.hpp"
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
    std::optional<Projection> perspective;
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

// A film shows the word in slow motion only, where the beam is bent towards the horizontal.
TEST(MechanismMarks, TheUndeflectedBeamIsNamedWhereThereIsTimeToReadIt) {
    const auto words = [](double speed, double bend) {
        FilmSetup setup = visible_film_of(Style::flat);
        setup.view.exaggeration = 20;
        setup.speeds.assign(setup.frames(), speed);
        for (sim::Pose& pose : setup.poses) {
            const double length = norm(pose.centreline.back());
            const Vec2 along = sim::unit(pose.theta), across{-along.y, along.x};
            for (std::size_t i = 0; i < pose.centreline.size(); ++i) {
                const double x = double(i) / double(pose.centreline.size() - 1);
                pose.centreline[i] = along * (x * length) + across * (bend * x * x * length);
            }
        }
        Marks marks(setup);
        marks.drawn([](const MechanismScene& s) { draw_undeflected(s); });
        return marks.texts.size();
    };
    EXPECT_EQ(words(0.01, -0.01), 1U);
    EXPECT_EQ(words(1, -0.01), 0U);
    EXPECT_EQ(words(0.01, 0.01), 0U);
    EXPECT_EQ(words(0.01, 0), 0U);
}

TEST(MechanismMarks, TheAngleIsDrawnInTheSenseTheHubHasTurned) {
    // The arc of 200° is counter-clockwise: it crosses the vertical above the hub.
    FilmSetup setup = test::flat_film({.duration = 0.1, .cam = false}, 1200, 1200);
    const double angle = 200 * std::numbers::pi / 180;
    for (sim::Pose& pose : setup.poses) {
        const std::size_t n = pose.centreline.size();
        for (std::size_t i = 0; i < n; ++i) pose.centreline[i] = sim::unit(angle) * (double(i) / double(n - 1));
        pose.theta = angle;
    }
    // The first frame's beam points to the right and leaves space.
    sim::Pose& other = setup.poses.front();
    for (std::size_t i = 0; i < other.centreline.size(); ++i)
        other.centreline[i] = sim::unit(0.1) * (double(i) / double(other.centreline.size() - 1));
    other.theta = 0.1;
    setup.layout = leaf({.kind = PanelKind::mechanism});
    const Color muted = palette(setup.view.theme).muted;
    Film film(std::move(setup));
    const FrameGeometry g = film.geometry(2);
    const Image image = drawn(film, 2);
    const Vec2 hub = g.camera.to_pixels({0, 0});
    const auto has_arc = [&](double side) {
        for (double r = 80 * g.layout.unit; r < 160 * g.layout.unit; ++r) {
            const int x = int(hub.x), y = int(hub.y + side * r);
            const std::uint32_t p = pixel_at(image, x, y);
            if (difference(p, muted) < 0.25) return true;
        }
        return false;
    };
    EXPECT_TRUE(has_arc(-1));
    EXPECT_FALSE(has_arc(1));
}

}  // namespace
}  // namespace beamcam::render
