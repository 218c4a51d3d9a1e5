#include "sim/cam/cam_shape.hpp"

#include "sim/cam/profile_spans.hpp"
#include "tests/sim/cam/profiles.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

// The largest differences of h, h′ and ρ from an exact outline.
template <class Exact>
CamPoint largest_error(const CamShape& shape, Exact&& exact, int count = 5003) {
    CamPoint worst;
    for (int i = 0; i < count; ++i) {
        const double alpha = kFullTurn * i / count;
        const CamPoint is = shape.at(alpha), should = exact(alpha);
        worst.h = std::max(worst.h, std::fabs(is.h - should.h));
        worst.slope = std::max(worst.slope, std::fabs(is.slope - should.slope));
        worst.radius = std::max(worst.radius, std::fabs(is.radius - should.radius));
    }
    return worst;
}

CamPoint disc(double radius, double eccentricity, double alpha) {
    return {radius + eccentricity * std::cos(alpha), -eccentricity * std::sin(alpha), radius};
}
// Semi-axes a, b along x, y about the axis.
CamPoint ellipse(double a, double b, double alpha) {
    const double c = std::cos(alpha), s = std::sin(alpha), h = std::hypot(a * c, b * s);
    return {h, (b * b - a * a) * c * s / h, a * a * b * b / (h * h * h)};
}

TEST(CamShape, DiscIsItsFormula) {
    const CamShape shape{Problem{}};
    EXPECT_TRUE(shape.is_disc());
    for (double alpha = -7; alpha < 7; alpha += 0.37) {
        const CamPoint p = shape.at(alpha);
        EXPECT_EQ(p.h, 0.1 + 0.02 * std::cos(alpha));
        EXPECT_EQ(p.radius, 0.1);
        EXPECT_NEAR(norm(p.position(alpha) - Vec2{0.02, 0}), 0.1, 1e-16);
    }
    EXPECT_EQ(shape.least_radius(), 0.1);
    EXPECT_EQ(shape.largest_reach(), 0.1 + 0.02);
    EXPECT_EQ(shape.least_height(), 0.1 - 0.02);
    EXPECT_EQ(shape.largest_slope(), 0.02);
    EXPECT_EQ(shape.largest_arm(), 0.02);
    EXPECT_TRUE(shape.kinks().empty());
}

TEST(CamShape, OneArcIsTheDisc) {
    const CamShape shape(with_profile(ArcsProfile{{{{0.02, 0}, 0.1}}}));
    EXPECT_FALSE(shape.is_disc());
    const CamPoint error = largest_error(shape, [](double alpha) { return disc(0.1, 0.02, alpha); });
    EXPECT_LT(error.h, 3e-16);
    EXPECT_LT(error.slope, 3e-16);
    EXPECT_LT(error.radius, 3e-16);
    EXPECT_TRUE(shape.kinks().empty());
    EXPECT_NEAR(shape.largest_reach(), 0.12, 1e-15);
    EXPECT_NEAR(shape.largest_arm(), 0.02, 1e-15);
    EXPECT_NEAR(shape.least_height(), 0.08, 1e-15);
}

// The spline's own errors: h⁗Δ⁴/384·… of h, e Δ²/12 of ρ.
TEST(CamShape, PointsOfTheDiscAreTheDisc) {
    const auto support = [](double alpha) {
        const CamPoint p = disc(0.1, 0.02, alpha);
        return std::pair(p.h, p.slope);
    };
    PointsProfile points = points_of(720, support);
    const auto exact = [](double alpha) { return disc(0.1, 0.02, alpha); };
    const CamPoint error = largest_error(CamShape(with_profile(points)), exact);
    EXPECT_LT(error.h, 2e-12);
    EXPECT_LT(error.slope, 1e-9);
    EXPECT_LT(error.radius, 2e-7);

    PointsProfile closed = points;  // with the first point once more
    closed.x.push_back(closed.x.front());
    closed.y.push_back(closed.y.front());
    PointsProfile clockwise = points;
    std::ranges::reverse(clockwise.x);
    std::ranges::reverse(clockwise.y);
    const CamShape shape(with_profile(points));
    for (const PointsProfile& other : {closed, clockwise}) {
        const CamPoint difference =
            largest_error(CamShape(with_profile(other)), [&](double alpha) { return shape.at(alpha); });
        EXPECT_LT(difference.h, 1e-15);
        EXPECT_LT(difference.radius, 1e-11);
    }
}

// From 180 to 360 points the errors of h decrease by 2⁴, those of ρ by 2².
TEST(CamShape, PointsOfAnEllipseConverge) {
    const auto exact = [](double alpha) { return ellipse(0.1, 0.07, alpha); };
    CamPoint error[2];
    for (int i = 0; i < 2; ++i) {
        const auto support = [&](double alpha) { return std::pair(exact(alpha).h, exact(alpha).slope); };
        error[i] = largest_error(CamShape(with_profile(points_of(180 << i, support))), exact);
    }
    EXPECT_LT(error[1].h, 1e-9);
    EXPECT_GT(error[0].h / error[1].h, 12);
    EXPECT_GT(error[0].radius / error[1].radius, 3.5);
}

TEST(CamShape, LawIsItsFormulaToRounding) {
    const Problem p = with_profile(lift_and_return());
    const CamShape shape(p);
    const ProgrammedMotion motion(lift_and_return());
    for (double phi = 0.001; phi < kFullTurn; phi += 0.00931) {
        const LeverMotion m = motion.at(phi);
        const double alpha = m.theta + std::numbers::pi / 2 + phi;
        const CamPoint exact = touched_point(m, p.cam->centre, 0, 1), is = shape.at(alpha);
        EXPECT_NEAR(is.h, exact.h, 4e-16) << phi;
        EXPECT_NEAR(is.slope, exact.slope, 6e-16) << phi;
        EXPECT_NEAR(is.radius, exact.radius, 6e-15) << phi;
    }
    // By (S103) at a million angles, in another program; and its values at 136.8° and 63.3°... of the turn.
    EXPECT_NEAR(shape.least_radius(), 0.03663479779, 5e-12);
    EXPECT_NEAR(shape.largest_radius(), 0.11911152977, 5e-12);
    EXPECT_NEAR(shape.least_height(), 0.25 * std::sin(14 * kDegree), 1e-15);
    // The jerk of the cycloidal rise jumps at both its ends, that of the return, too.
    ASSERT_EQ(shape.kinks().size(), 4u);
    for (const double phi : {60.0, 160.0, 200.0, 320.0}) {
        const double alpha = motion.at(phi * kDegree).theta + std::numbers::pi / 2 + phi * kDegree;
        const double turn = alpha < kFullTurn ? alpha : alpha - kFullTurn;
        EXPECT_TRUE(std::ranges::any_of(shape.kinks(), [&](double kink) { return std::fabs(kink - turn) < 1e-14; }));
    }
}

// By the points themselves: dp/dα = ρ t, and the derivative of h is h′.
TEST(CamShape, SlopeAndRadiusAreDerivatives) {
    for (const MotionLaw law :
         {MotionLaw::harmonic, MotionLaw::modified_sine, MotionLaw::modified_trapezoid, MotionLaw::polynomial_4567}) {
        LawProfile profile = lift_and_return();
        profile.segments[1].law = profile.segments[3].law = law;
        const CamShape shape(with_profile(profile));
        for (double alpha = 0.013; alpha < kFullTurn; alpha += 0.0487) {
            const auto is_near = [&](double kink) { return std::fabs(kink - alpha) < 4e-3; };
            if (std::ranges::any_of(shape.intervals(), is_near)) continue;
            const CamPoint p = shape.at(alpha);
            EXPECT_NEAR(scalar_slope_at_zero([&](double x) { return shape.at(alpha + x).h; }, 1e-3), p.slope, 1e-13);
            const Vec2 along = perp(unit(alpha));
            EXPECT_NEAR(scalar_slope_at_zero(
                            [&](double x) { return dot(shape.at(alpha + x).position(alpha + x), along); }, 1e-3),
                        p.radius, 1e-12);
            EXPECT_NEAR(scalar_slope_at_zero([&](double x) { return shape.at(alpha + x).radius; }, 1e-3),
                        shape.radius_slope(alpha), 1e-9);
        }
    }
}

// ρ′ of harmonic laws and ρ of none jump where only the fourth derivative of 4-5-6-7 does.
TEST(CamShape, KinksAreWhereTheCurvatureOrItsSlopeJumps) {
    LawProfile profile = lift_and_return();
    profile.segments[1].law = profile.segments[3].law = MotionLaw::polynomial_4567;
    EXPECT_TRUE(CamShape(with_profile(profile)).kinks().empty());
    profile.segments[1].law = MotionLaw::modified_trapezoid;
    EXPECT_EQ(CamShape(with_profile(profile)).kinks().size(), 2u);
    profile.segments[3].law = MotionLaw::harmonic;
    EXPECT_EQ(CamShape(with_profile(profile)).kinks().size(), 4u);
    EXPECT_EQ(CamShape(with_profile(tangent_arcs())).kinks().size(), 4u);
}

TEST(CamShape, ArcsAreTangent) {
    const ArcsProfile profile = tangent_arcs();
    const CamShape shape(with_profile(profile));
    EXPECT_NEAR(shape.at(0).h, 0.032 + 0.008, 1e-16);
    EXPECT_NEAR(shape.at(0).radius, 0.008, 1e-16);
    EXPECT_NEAR(shape.at(std::numbers::pi).h, 0.03, 1e-16);
    EXPECT_NEAR(shape.least_radius(), 0.008, 1e-15);
    EXPECT_NEAR(shape.largest_radius(), 0.09, 1e-15);
    EXPECT_NEAR(shape.largest_reach(), 0.04, 1e-15);
    for (const double kink : shape.kinks()) {
        EXPECT_NEAR(shape.at(kink - 1e-12).h, shape.at(kink + 1e-12).h, 1e-13);
        EXPECT_NEAR(shape.at(kink - 1e-12).slope, shape.at(kink + 1e-12).slope, 1e-12);
    }
}

// A drawing states micrometres: the outline is closed all the same, and within these digits of the drawing.
TEST(CamShape, RoundedArcsAreClosed) {
    ArcsProfile rounded = tangent_arcs();
    const auto round = [](double& x) { x = std::round(x * 1e7) / 1e7; };
    for (Arc& arc : rounded.arcs)
        for (double* x : {&arc.centre.x, &arc.centre.y, &arc.radius}) round(*x);
    const std::vector<Arc> closed = closed_arcs(rounded);
    for (std::size_t i = 0; i < closed.size(); ++i) {
        const Arc &arc = closed[i], &next = closed[(i + 1) % closed.size()];
        EXPECT_NEAR(norm(next.centre - arc.centre), std::fabs(next.radius - arc.radius), 1e-16);
        EXPECT_NEAR(norm(arc.centre - rounded.arcs[i].centre), 0, 1e-7);
        EXPECT_NEAR(arc.radius, rounded.arcs[i].radius, 1e-7);
    }
    const CamShape shape(with_profile(rounded));
    for (const double kink : shape.kinks()) EXPECT_NEAR(shape.at(kink - 1e-13).h, shape.at(kink + 1e-13).h, 1e-14);
}

TEST(CamShape, LengthIsThatOfTheOutline) {
    const CamShape disc{Problem{}}, one(with_profile(ArcsProfile{{{{0.02, 0}, 0.1}}}));
    for (double alpha = 0; alpha < kFullTurn; alpha += 0.7) EXPECT_NEAR(one.arc(alpha), disc.arc(alpha), 1e-14);
    // The perimeter is the integral of h (Cauchy), and dp/dα = ρ t.
    const CamShape shape(with_profile(lift_and_return()));
    double perimeter = 0;
    constexpr int kSteps = 20000;
    for (int i = 0; i < kSteps; ++i) perimeter += shape.at(kFullTurn * i / kSteps).h * kFullTurn / kSteps;
    EXPECT_NEAR(shape.arc(kFullTurn), perimeter, 1e-12);
    EXPECT_EQ(shape.arc(0), 0);
    for (double alpha = 0.05; alpha < 6; alpha += 0.31)
        EXPECT_NEAR(scalar_slope_at_zero([&](double x) { return shape.arc(alpha + x); }, 1e-4), shape.at(alpha).radius,
                    1e-8);
}

TEST(CamShape, AnglesRepeatAfterATurn) {
    const CamShape shape(with_profile(lift_and_return()));
    for (double alpha = 0; alpha < kFullTurn; alpha += 0.1) {
        EXPECT_NEAR(shape.at(alpha - kFullTurn).h, shape.at(alpha).h, 1e-15);
        EXPECT_NEAR(shape.at(alpha + 100 * kFullTurn).h, shape.at(alpha).h, 1e-13);
    }
    EXPECT_NEAR(shape.at(-1e-17).h, shape.at(0).h, 1e-15);
    EXPECT_NEAR(shape.at(std::nextafter(kFullTurn, 0)).radius, shape.at(0).radius, 1e-14);
}

}  // namespace
}  // namespace beamcam::sim::testing
