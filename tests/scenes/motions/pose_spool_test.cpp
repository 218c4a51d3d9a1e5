// Poses and trajectories that are kept in files: the same bits, and the same pictures.
#include "scenes/motions/pose_spool.hpp"

#include <gtest/gtest.h>

#include "sim/run/simulate.hpp"

namespace beamcam::scenes {
namespace {

constexpr int kStations = 97;

std::vector<double> instants(int count, double end) {
    std::vector<double> all;
    for (int k = 0; k < count; ++k) all.push_back(end * k / count);
    return all;
}

void expect_same(const sim::Pose& a, const sim::Pose& b) {
    EXPECT_EQ(a.t, b.t);
    EXPECT_EQ(a.theta, b.theta);
    EXPECT_EQ(a.theta_dot, b.theta_dot);
    EXPECT_EQ(a.centreline, b.centreline);
    EXPECT_EQ(a.moment, b.moment);
    EXPECT_EQ(a.cam_angle, b.cam_angle);
    EXPECT_EQ(a.cam_centre, b.cam_centre);
    EXPECT_EQ(a.disc_centre, b.disc_centre);
    ASSERT_EQ(a.nearest.has_value(), b.nearest.has_value());
    if (!a.nearest) return;
    EXPECT_EQ(a.nearest->x, b.nearest->x);
    EXPECT_EQ(a.nearest->s, b.nearest->s);
    EXPECT_EQ(a.nearest->point, b.nearest->point);
    EXPECT_EQ(a.nearest->normal, b.nearest->normal);
    EXPECT_EQ(a.nearest->gap, b.nearest->gap);
    EXPECT_EQ(a.nearest->force, b.nearest->force);
    EXPECT_EQ(a.nearest->friction, b.nearest->friction);
    EXPECT_EQ(a.nearest->touching, b.nearest->touching);
}

struct Both {
    sim::Result held;
    std::shared_ptr<PoseSpool> spooled;
};

// The same poses, held by the result and handed on.
Both run(const sim::Problem& problem, int frames, double end) {
    const sim::PoseRequest held{.times = instants(frames, end), .stations = kStations};
    sim::PoseRequest handed_on = held;
    Both both;
    both.spooled = std::make_shared<PoseSpool>(held);
    handed_on.take = [&](std::size_t row, const sim::Pose& pose) { both.spooled->put(row, pose); };
    sim::Request request;
    request.end_time = end;
    request.poses = {held, handed_on};
    both.held = sim::simulate(problem, request);
    return both;
}

TEST(PoseSpool, AreThePosesToTheBit) {
    sim::Problem with_friction, without_cam;
    with_friction.contact.friction = sim::CoulombFriction{.coefficient = 0.2};
    without_cam.cam.reset();
    for (const sim::Problem& problem : {with_friction, without_cam}) {
        const Both both = run(problem, 400, 0.5);  // more than memory holds
        EXPECT_TRUE(both.held.poses[1].empty());
        ASSERT_EQ(both.spooled->size(), both.held.poses[0].size());
        for (std::size_t k = 0; k < both.spooled->size(); ++k) {
            expect_same(both.spooled->pose(k), both.held.poses[0][k]);
            EXPECT_EQ(both.spooled->time(k), both.held.poses[0][k].t);
        }
    }
}

TEST(PoseSpool, OtherStationsHaveNoPlace) {
    PoseSpool poses({.times = {0, 1}, .stations = 5});
    sim::Pose pose;
    pose.centreline.resize(4), pose.moment.resize(4);
    EXPECT_THROW(poses.put(0, pose), std::invalid_argument);
    pose.centreline.resize(5), pose.moment.resize(5);
    EXPECT_THROW(poses.put(2, pose), std::invalid_argument);
    EXPECT_NO_THROW(poses.put(1, pose));
}

TEST(PoseSpool, ARestartedSurveyForgetsItsContacts) {
    PoseSpool poses({.times = {0}, .stations = 5, .contacts = 2});
    sim::Pose pose;
    pose.centreline.resize(5), pose.moment.resize(5);
    for (std::size_t row : {0, 1, 2}) poses.put(row, pose);
    EXPECT_EQ(poses.size(), 3U);
    EXPECT_THROW(poses.put(3, pose), std::invalid_argument);
    poses.put(0, pose);
    EXPECT_EQ(poses.size(), 1U);
}

TEST(PoseSpool, AFilmOfThemHasThePixelsOfOneOfHeldPoses) {
    const sim::Problem problem;
    const Both both = run(problem, 150, 0.6);
    render::FilmSetup setup;
    setup.problem = problem;
    setup.width = 640, setup.height = 360;
    setup.view.style = render::Style::flat;
    render::FilmSetup from_file = setup;
    setup.poses = both.held.poses[0];
    from_file.stored = both.spooled;
    render::Film a(std::move(setup)), b(std::move(from_file));
    EXPECT_EQ(a.exaggeration(), b.exaggeration());
    ASSERT_EQ(a.frames(), b.frames());
    for (int k = 0; k < a.frames(); k += 37) EXPECT_EQ(a.draw(k), b.draw(k)) << k;
}

}  // namespace
}  // namespace beamcam::scenes
