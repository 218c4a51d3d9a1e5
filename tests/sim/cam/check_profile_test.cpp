#include "sim/cam/check_profile.hpp"

#include <gmock/gmock.h>

#include <cstring>
#include <limits>

#include "sim/cam/cam_shape.hpp"
#include "sim/cam/lever.hpp"
#include "tests/sim/cam/profiles.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

using ::testing::AllOf, ::testing::HasSubstr;

std::vector<Issue> errors(const Profile& profile, double offset = 0) {
    Problem p = with_profile(profile);
    p.contact.offset = offset;
    std::vector<Issue> issues = validate(p);
    std::erase_if(issues, [](const Issue& issue) { return !issue.fatal; });
    return issues;
}

void expect_error(const Profile& profile, const char* path, const ::testing::Matcher<std::string>& message,
                  double offset = 0) {
    const std::vector<Issue> issues = errors(profile, offset);
    ASSERT_EQ(issues.size(), 1u) << path << (issues.empty() ? "" : issues.back().message);
    EXPECT_EQ(issues[0].path, path) << issues[0].message;
    EXPECT_THAT(issues[0].message, message);
}

template <class Change>
LawProfile changed(Change&& change) {
    LawProfile profile = lift_and_return();
    change(profile);
    return profile;
}

PointsProfile circle(int count, double radius = 0.08, Vec2 centre = {}) {
    return points_of(count, [&](double alpha) {
        return std::pair(radius + dot(centre, unit(alpha)), dot(centre, perp(unit(alpha))));
    });
}

TEST(CheckProfile, AcceptsWhatAnEngineerDraws) {
    EXPECT_TRUE(errors(lift_and_return()).empty());
    EXPECT_TRUE(errors(lift_and_return(), 0.005).empty());
    EXPECT_TRUE(errors(tangent_arcs()).empty());
    EXPECT_TRUE(errors(ArcsProfile{{{{0.02, 0}, 0.1}}}).empty());
    EXPECT_TRUE(errors(circle(24)).empty());
    EXPECT_TRUE(errors(changed([](LawProfile& p) { p.segments.back().over = 40 * kDegree; })).empty());
}

TEST(CheckProfile, NamesTheSegmentThatIsWrong) {
    expect_error(changed([](LawProfile& p) { p.segments.clear(); }), "cam.profile.segments", HasSubstr("empty"));
    expect_error(changed([](LawProfile& p) { p.segments[0].rise = 0.1; }), "cam.profile.segments.0.rise",
                 AllOf(HasSubstr("dwell"), HasSubstr("5.72958 deg")));
    expect_error(changed([](LawProfile& p) { p.segments[1].over.reset(); }), "cam.profile.segments.1",
                 HasSubstr("needs \"over\""));
    expect_error(changed([](LawProfile& p) { p.segments[1].over = 1e-9; }), "cam.profile.segments.1.over",
                 HasSubstr("at least"));
    expect_error(changed([](LawProfile& p) { p.segments[1].over = 200 * kDegree; }), "cam.profile.segments.4",
                 AllOf(HasSubstr("nothing is left"), HasSubstr("420 deg")));
    expect_error(changed([](LawProfile& p) { p.segments[4].over = 50 * kDegree; }), "cam.profile.segments.4.over",
                 AllOf(HasSubstr("370 deg"), HasSubstr("shorten")));
    expect_error(changed([](LawProfile& p) { p.segments[4].over = 30 * kDegree; }), "cam.profile.segments.4.over",
                 AllOf(HasSubstr("350 deg"), HasSubstr("add a segment")));
    expect_error(changed([](LawProfile& p) { p.segments[3].rise = -7 * kDegree; }), "cam.profile.segments.3.rise",
                 AllOf(HasSubstr("sum to 1 deg"), HasSubstr("write -8 deg")));
}

TEST(CheckProfile, KnowsWhichAnglesALeverCanReach) {
    expect_error(changed([](LawProfile& p) { p.lowest = -5 * kDegree; }), "cam.profile.lowest",
                 AllOf(HasSubstr("between -5 and 3 deg"), HasSubstr("between 0 and 82 deg")));
    expect_error(changed([](LawProfile& p) { p.lowest = 85 * kDegree; }), "cam.profile.lowest", HasSubstr("93 deg"));
    expect_error(changed([](LawProfile& p) { p.lowest = -95 * kDegree; }), "cam.profile.lowest",
                 AllOf(HasSubstr("between -95 and -87 deg"), HasSubstr("\"lowest\" between -90 and -8 deg")));
    // With the face 0.1 m below the pivot a lever at 14 deg would lie below the axis: asin(0.1/0.25) = 23.6 deg.
    expect_error(lift_and_return(), "cam.profile.lowest", HasSubstr("23.5782"), 0.1);
    Problem p = with_profile(lift_and_return());
    p.contact.offset = 0.3;
    EXPECT_EQ(validate(p).back().path, "cam.centre");
}

TEST(CheckProfile, KnowsReturnsThatNoCamCanMake) {
    const auto fast = changed([](LawProfile& p) {
        p.lowest = 20 * kDegree;
        p.segments[1].rise = 30 * kDegree;
        p.segments[3].rise = -30 * kDegree;
        p.segments[3].over = 40 * kDegree;
    });
    // 15/8 · 30/40 is less than 1 …, 15/8 · 30/40 = 1.40625 is more.
    expect_error(fast, "cam.profile.segments.3", AllOf(HasSubstr("1.406 rad per rad"), HasSubstr("220 deg")));
}

// The remedies are enough, and a little less is not.
TEST(CheckProfile, SaysWhatCuresAnUndercut) {
    const LawProfile undercut = changed([](LawProfile& p) { p.lowest = 5 * kDegree; });
    const std::vector<Issue> issues = errors(undercut, 0.005);
    ASSERT_EQ(issues.size(), 1u);
    const std::string& message = issues[0].message;
    EXPECT_THAT(message,
                AllOf(HasSubstr("undercut"), HasSubstr("at the turn 13"), HasSubstr("radius of curvature is -0.0")));
    double lowest = 0, factor = 0, distance = 0;
    ASSERT_EQ(std::sscanf(message.c_str() + message.find("at least"), "at least %lf", &lowest), 1) << message;
    ASSERT_EQ(std::sscanf(message.c_str() + message.find("at most"), "at most %lf", &factor), 1) << message;
    const std::size_t move = message.find("move the cam to at least");
    if (move != std::string::npos) std::sscanf(message.c_str() + move, "move the cam to at least %lf", &distance);
    for (const double less : {0.0, 0.05}) {
        const bool enough = less == 0;
        EXPECT_EQ(errors(changed([&](LawProfile& p) { p.lowest = (lowest - less) * kDegree; }), 0.005).empty(), enough);
        LawProfile smaller = undercut;
        for (LawSegment& each : smaller.segments) each.rise *= factor + less;
        EXPECT_EQ(errors(smaller, 0.005).empty(), enough) << factor;
    }
}

// The mirror image of a lever above the cam, below it, must be lowered by as much as that one must be raised.
TEST(CheckProfile, SaysWhatCuresAnUndercutBelowTheCam) {
    const LawProfile above = changed([](LawProfile& p) {
        p.lowest = 5 * kDegree;
        p.segments.back().over = 40 * kDegree;
    });
    LawProfile below = above;
    below.lowest = -above.lowest;
    std::ranges::reverse(below.segments);
    const auto remedy = [](const LawProfile& profile, const char* change) {
        const std::vector<Issue> issues = errors(profile, 0.005);
        const std::size_t at = issues.empty() ? std::string::npos : issues[0].message.find(change);
        double angle = 0;
        if (at != std::string::npos) std::sscanf(issues[0].message.c_str() + at + std::strlen(change), "%lf", &angle);
        return angle;
    };
    const double raised = remedy(above, "raise \"lowest\" to at least "),
                 lowered = remedy(below, "lower \"lowest\" to at most ");
    EXPECT_GT(raised, 5);
    EXPECT_NEAR(lowered, -raised, 1e-9);
    below.lowest = lowered * kDegree;
    EXPECT_TRUE(errors(below, 0.005).empty());
}

// With an offset alone, distance from the pivot helps.
TEST(CheckProfile, SaysHowFarTheCamMustBeMoved) {
    Problem p = with_profile(lift_and_return());
    p.contact.offset = 0.045;
    const std::vector<Issue> issues = validate(p);
    ASSERT_FALSE(issues.empty());
    const std::size_t at = issues.back().message.find("move the cam to at least");
    ASSERT_NE(at, std::string::npos) << issues.back().message;
    double distance = 0;
    std::sscanf(issues.back().message.c_str() + at, "move the cam to at least %lf", &distance);
    p.cam->centre.x = distance * 1.001;
    EXPECT_TRUE(check_profile(p).empty());
    p.cam->centre.x = distance * 0.999;
    EXPECT_FALSE(check_profile(p).empty());
}

TEST(CheckProfile, KnowsArcsThatAreNoOutline) {
    expect_error(ArcsProfile{}, "cam.profile.arcs", HasSubstr("empty"));
    expect_error(ArcsProfile{{{{0, 0}, 0.03}, {{0.01, 0}, 0.02}}}, "cam.profile.arcs", HasSubstr("one point only"));
    ArcsProfile arcs = tangent_arcs();
    arcs.arcs[2].radius += 1e-4;
    expect_error(arcs, "cam.profile.arcs.2.radius",
                 AllOf(HasSubstr("not tangent"), HasSubstr("differ by 0.0819"), HasSubstr("within 1")));
    arcs = tangent_arcs();
    arcs.arcs.insert(arcs.arcs.begin() + 1, arcs.arcs[1]);
    expect_error(arcs, "cam.profile.arcs.2", HasSubstr("same circle"));
    arcs = tangent_arcs();
    std::ranges::reverse(arcs.arcs);
    expect_error(arcs, "cam.profile.arcs", HasSubstr("counter-clockwise"));
    for (Arc& arc : (arcs = tangent_arcs()).arcs) arc.centre.x += 0.05;
    expect_error(arcs, "cam.profile", HasSubstr("outside the outline by 0.02 m"));
    expect_error(ArcsProfile{{{{0.1, 0}, 0.08}}}, "cam.profile", HasSubstr("by 0.02 m"));
    expect_error(ArcsProfile{{{{0, 0}, 0}}}, "cam.profile.arcs.0.radius", HasSubstr("positive"));
    expect_error(ArcsProfile{{{{0, 0}, std::nan("")}}}, "cam.profile.arcs.0.radius", HasSubstr("nan"));
}

TEST(CheckProfile, KnowsPointsThatAreNoOutline) {
    expect_error(PointsProfile{}, "cam.profile", HasSubstr("at least 24 points, has 0"));
    expect_error(circle(23), "cam.profile", HasSubstr("at least 24 points, has 23"));
    expect_error(circle(100'001), "cam.profile", HasSubstr("at most 100000 points, this one has 100001"));
    PointsProfile points = circle(40);
    points.y.pop_back();
    expect_error(points, "cam.profile", AllOf(HasSubstr("(39)"), HasSubstr("(40)")));
    points = circle(40);
    points.x[7] = points.x[6];
    points.y[7] = points.y[6];
    expect_error(points, "cam.profile", HasSubstr("point 7 at"));
    points = circle(60);
    points.x.resize(45);
    points.y.resize(45);
    expect_error(points, "cam.profile", HasSubstr("not closed"));
    expect_error(circle(40, 0.05, {0.1, 0}), "cam.profile", HasSubstr("around the axis"));
    points = circle(40);
    points.x[12] *= 0.9;
    points.y[12] *= 0.9;
    expect_error(points, "cam.profile", AllOf(HasSubstr("not convex"), HasSubstr("point 13 at")));
    std::ranges::reverse(points.x);
    std::ranges::reverse(points.y);
    expect_error(points, "cam.profile", AllOf(HasSubstr("not convex"), HasSubstr("point 28 at")));
    points = circle(40);
    points.x[3] = std::numeric_limits<double>::infinity();
    expect_error(points, "cam.profile.x", HasSubstr("finite"));
    for (PointsProfile* square : {&points}) {
        *square = {};
        for (int side = 0; side < 4; ++side)
            for (int i = 0; i < 8; ++i) {
                const Vec2 corner = 0.05 * unit(side * std::numbers::pi / 2),
                           next = 0.05 * unit((side + 1) * std::numbers::pi / 2);
                const double bulge = 1 + 1e-3 * i * (8 - i);
                square->x.push_back(bulge * (corner.x + (next.x - corner.x) * i / 8));
                square->y.push_back(bulge * (corner.y + (next.y - corner.y) * i / 8));
            }
        EXPECT_FALSE(errors(*square).empty());  // its corners are edges
    }
}

TEST(CheckProfile, KnowsCamsThatReachThePivotOrTheHub) {
    Problem p = with_profile(ArcsProfile{{{{0.1, 0}, 0.16}}});
    EXPECT_EQ(validate(p).back().path, "cam.centre");
    p = with_profile(lift_and_return());
    p.hub.radius = 0.24;
    EXPECT_EQ(validate(p).back().path, "hub.radius");
    p = with_profile(lift_and_return());
    p.initial.angle = 10 * kDegree;
    EXPECT_EQ(validate(p).back().path, "initial.angle");
    EXPECT_THAT(validate(p).back().message, HasSubstr("overlap"));
    // The straight lever at its lowest angle lies on the cam.
    p.initial.angle = 14 * kDegree + 1e-9;
    EXPECT_TRUE(validate(p).empty());
    p.cam->phase = -180 * kDegree;
    EXPECT_FALSE(validate(p).empty());
    p.initial.angle = 22 * kDegree + 1e-9;
    EXPECT_TRUE(validate(p).empty());
}

// The only warning of a profile or of the place of its cam.
std::string warning(const Problem& p) {
    const std::vector<Issue> issues = validate(p);
    return issues.size() == 1 && !issues[0].fatal ? issues[0].path + ": " + issues[0].message : "";
}

TEST(CheckProfile, WarnsOfPointsThatDoNotDetermineTheCurvature) {
    const auto rounded_triangle = [](double alpha) {
        return std::pair(0.04 + 0.004 * std::cos(3 * alpha), -0.012 * std::sin(3 * alpha));
    };
    EXPECT_TRUE(validate(with_profile(points_of(120, rounded_triangle))).empty());
    EXPECT_THAT(warning(with_profile(points_of(30, rounded_triangle))),
                AllOf(HasSubstr("cam.profile: the radius of curvature at"), HasSubstr("is 0.006842 m, but 0.002903 m"),
                      HasSubstr("too far")));
    // Noise of 10 µm on a disc.
    Dice dice(3);
    PointsProfile noisy = circle(100, 0.03);
    for (std::vector<double>* each : {&noisy.x, &noisy.y})
        for (double& x : *each) x += dice.about_zero(5e-6);
    EXPECT_THAT(warning(with_profile(noisy)), HasSubstr("too noisy"));
    EXPECT_TRUE(validate(with_profile(circle(24, 0.03))).empty());
}

TEST(CheckProfile, HintsAtTheUnitOfPointsThatReachBeyondTheHub) {
    PointsProfile points = circle(60, 21.5);
    expect_error(points, "cam.centre", AllOf(HasSubstr("reaches 21.5 m"), HasSubstr("\"units\": {\"COLUMN\": \"mm\"")));
    points.x[12] *= 0.9;
    points.y[12] *= 0.9;
    expect_error(points, "cam.profile", AllOf(HasSubstr("not convex"), HasSubstr("in mm")));
}

// The straight lever touches the disc at most √((|C| + e)² − R²) from the hub.
TEST(CheckProfile, WarnsOfABeamThatEndsBeforeTheContact) {
    Problem p;
    p.cam->centre = {1.05, 0};
    p.initial.angle = 1;
    EXPECT_THAT(warning(p), AllOf(HasSubstr("cam.centre: "), HasSubstr("up to 1.065 m"), HasSubstr("ends at 1 m")));
    EXPECT_NEAR(Lever(p).farthest_foot(), std::sqrt(1.07 * 1.07 - 0.01), 1e-9);
    p.cam->centre = {0.95, 0};
    EXPECT_EQ(warning(p), "");
}

// Random profiles, most of which are no outlines: each has an error, or a shape whose curvature is positive.
TEST(CheckProfile, HostileProfilesAreRefusedOrAreOutlines) {
    Dice dice(7);
    const double extreme[] = {0, 1e-300, -1e-300, 1e30, -1e30, 1e-9, 3.2, INFINITY, std::nan("")};
    const auto number = [&](double size) {
        return dice.one_of(12) == 0 ? extreme[dice.one_of(9)] : dice.about_zero(size);
    };
    int accepted[3] = {};
    for (int i = 0; i < 3000; ++i) {
        Problem p;
        p.cam->centre = {number(0.5), dice.one_of(3) ? 0 : number(0.2)};
        if (dice.one_of(2)) p.cam->centre = {0.25, 0};
        p.contact.offset = dice.one_of(3) ? 0 : std::fabs(number(0.02));
        const int type = dice.one_of(3);
        if (type == 0) {
            LawProfile law{std::fabs(number(0.5)), {}};
            double sum = 0;
            for (int k = dice.one_of(5); k >= 0; --k) {
                LawSegment segment{dice.one_of(names(MotionLaw{})), number(0.2), std::fabs(number(2))};
                if (segment.law == MotionLaw::dwell) segment.rise = 0;
                if (k == 0 && dice.one_of(4)) segment = {MotionLaw::cycloidal, -sum, {}};
                sum += segment.rise;
                law.segments.push_back(segment);
            }
            p.cam->profile = law;
        } else if (type == 1) {
            ArcsProfile arcs = dice.one_of(2) ? tangent_arcs() : ArcsProfile{};
            for (int k = dice.one_of(4); k > 0; --k)
                arcs.arcs.push_back({{number(0.1), number(0.1)}, std::fabs(number(0.2))});
            if (dice.one_of(3) == 0 && !arcs.arcs.empty()) arcs.arcs.resize(1);
            for (Arc& arc : arcs.arcs) arc.centre.x += dice.one_of(4) ? 0 : number(1e-6);
            p.cam->profile = arcs;
        } else {
            PointsProfile points = circle(10 + dice.one_of(60), 0.08, {dice.about_zero(0.05), 0});
            const double noise = std::pow(10, dice.between(-12, -1));
            for (double& x : points.x) x += dice.about_zero(noise);
            for (int k = dice.one_of(3); k > 0; --k) points.y[static_cast<std::size_t>(dice.one_of(10))] = number(0.1);
            p.cam->profile = points;
        }
        const std::vector<Issue> issues = validate(p);
        if (std::ranges::any_of(issues, &Issue::fatal)) {
            for (const Issue& issue : issues) EXPECT_FALSE(issue.message.empty());
            continue;
        }
        ++accepted[type];
        const CamShape shape(p);
        EXPECT_GT(shape.least_radius(), 0) << i;
        EXPECT_GT(shape.least_height(), 0) << i;
        EXPECT_TRUE(std::isfinite(shape.largest_radius())) << i;
        EXPECT_LT(shape.largest_reach(), norm(p.cam->centre)) << i;
        const Lever lever(p);
        EXPECT_FALSE(lever.at(dice.about_zero(10)).foot < 0) << i;
        (void)lever.jump();
    }
    for (const int count : accepted) EXPECT_GT(count, 30);
}

}  // namespace
}  // namespace beamcam::sim::testing
