// Sections and materials against their formulas, what follows from them, and Hertz's contacts.
#include <cmath>
#include <numbers>

#include "sim/problem/assumptions.hpp"
#include "sim/problem/number_keys.hpp"
#include "tests/sim/support.hpp"

namespace beamcam::sim::testing {
namespace {

using std::numbers::pi;

Problem ruler() {
    Problem p;
    p.beam.length = 0.3;
    p.beam.section = Rectangle{0.025, 0.0008};
    p.beam.material = Material::steel;
    return p;
}

bool has_error(const Problem& problem, const char* path) {
    return std::ranges::any_of(validate(problem), [&](const Issue& i) { return i.fatal && i.path == path; });
}

TEST(Sections, HaveTheirAreaSecondMomentAndOutermostFibre) {
    const auto expect = [](const Section& section, double area, double second_moment, double c_max) {
        const SectionProperties s = section_properties(section);
        EXPECT_NEAR(s.area, area, 1e-14 * area);
        EXPECT_NEAR(s.second_moment, second_moment, 1e-14 * second_moment);
        EXPECT_NEAR(s.c_max, c_max, 1e-14 * c_max);
    };
    expect(Rectangle{0.025, 0.0008}, 2e-5, 0.025 * 5.12e-10 / 12, 0.0004);
    expect(Circle{0.01}, pi * 2.5e-5, pi * 1e-8 / 64, 0.005);
    expect(Tube{0.01, 0.001}, pi / 4 * (1e-4 - 0.64e-4), pi / 64 * (1e-8 - 0.4096e-8), 0.005);
    expect(Tube{0.01, 0.005}, pi * 2.5e-5, pi * 1e-8 / 64, 0.005);
    expect(CustomSection{1e-4, 1e-9, 0.01}, 1e-4, 1e-9, 0.01);
}

TEST(Sections, ReplaceAreaSecondMomentAndDepth) {
    const Problem p = ruler();
    EXPECT_DOUBLE_EQ(p.beam.line_density(), 7850 * 2e-5);
    EXPECT_DOUBLE_EQ(p.beam.bending_stiffness(), 210e9 * section_properties(p.beam).second_moment);
    EXPECT_DOUBLE_EQ(beam_depth(p.beam), 0.0008);
    Beam tube;
    tube.section = Tube{0.01, 0.001};
    EXPECT_DOUBLE_EQ(beam_depth(tube), 0.01);
    tube.section = CustomSection{1e-4, 1e-9, 0.01};
    EXPECT_DOUBLE_EQ(beam_depth(tube), 0.02);
    tube.depth = 0.03;
    EXPECT_DOUBLE_EQ(beam_depth(tube), 0.03);
    EXPECT_DOUBLE_EQ(section_properties(tube).c_max, 0.01);
}

TEST(Sections, MoveAsTheirNumbersDo) {
    Problem named = ruler(), numbers = named;
    named.cam.reset();
    numbers.cam.reset();
    numbers.beam.section.reset();
    numbers.beam.material.reset();
    numbers.beam.area = section_properties(named.beam).area;
    numbers.beam.second_moment = section_properties(named.beam).second_moment;
    numbers.beam.density = 7850;
    numbers.beam.youngs_modulus = 210e9;
    for (const char* channel : {"theta", "tip_deflection", "stress_max"})
        EXPECT_NEAR(series(named, channel, {0.1})[0], series(numbers, channel, {0.1})[0],
                    1e-12 * std::fabs(series(numbers, channel, {0.1})[0]))
            << channel;
}

TEST(Sections, AreRejectedWhereNoneHasTheseNumbers) {
    Problem p = ruler();
    EXPECT_TRUE(is_plain(p));
    p.beam.section = Tube{0.01, 0.006};
    EXPECT_TRUE(has_error(p, "beam.section.wall"));
    p.beam.section = CustomSection{1e-4, 1.1e-8, 0.01};
    EXPECT_TRUE(has_error(p, "beam.section.second_moment"));
    p.beam.section = Rectangle{-1, 0.001};
    EXPECT_TRUE(has_error(p, "beam.section.width"));
}

TEST(Sections, AreVariedByTheirNumbersAndNotByThoseTheyReplace) {
    Problem p = ruler();
    EXPECT_TRUE(set_number(p, "beam.section.height", 0.001));
    EXPECT_DOUBLE_EQ(beam_depth(p.beam), 0.001);
    for (const char* replaced : {"beam.area", "beam.second_moment", "beam.density", "beam.youngs_modulus"}) {
        EXPECT_FALSE(number_key(p, replaced)) << replaced;
        EXPECT_FALSE(set_number(p, replaced, 1)) << replaced;
        EXPECT_TRUE(number_key(Problem{}, replaced)) << replaced;
    }
}

TEST(Materials, AreWithinTheRangesOfTheirSources) {
    struct Range {
        double density[2], modulus[2], ratio[2];
    };
    const auto within = [](double value, const double(&range)[2]) { return range[0] <= value && value <= range[1]; };
    // Gere, Mechanics of Materials, appendix; PMMA and POM: data sheets.
    const std::pair<Material, Range> all[] = {{Material::steel, {{7850, 7850}, {190e9, 210e9}, {0.27, 0.30}}},
                                              {Material::aluminium, {{2600, 2800}, {70e9, 79e9}, {0.3, 0.345}}},
                                              {Material::titanium, {{4500, 4500}, {100e9, 120e9}, {0.33, 0.361}}},
                                              {Material::brass, {{8400, 8600}, {96e9, 110e9}, {0.33, 0.36}}},
                                              {Material::pmma, {{1160, 1200}, {2.4e9, 3.45e9}, {0.35, 0.4}}},
                                              {Material::pom, {{1410, 1420}, {2.5e9, 3.1e9}, {0.35, 0.44}}},
                                              {Material::rubber, {{960, 1300}, {0.7e6, 4e6}, {0.45, 0.4999}}}};
    EXPECT_EQ(std::size(all), names(Material{}).size());
    for (const auto& [material, range] : all) {
        const MaterialProperties values = material_properties(material);
        EXPECT_TRUE(within(values.density, range.density)) << name(material);
        EXPECT_TRUE(within(values.youngs_modulus, range.modulus)) << name(material);
        EXPECT_TRUE(within(values.poisson_ratio, range.ratio)) << name(material);
    }
}

// Palmgren's law for steel, with lengths in mm and forces in N: δ = 3.84·10⁻⁵ F^0.9/b^0.8.
TEST(Hertz, LineContactOfSteelIsThatOfRollerBearings) {
    Problem p = ruler();
    p.contact.stiffness.reset();
    EXPECT_DOUBLE_EQ(contact_exponent(p), 10.0 / 9);
    p.beam.material.reset();
    p.beam.youngs_modulus = 206e9;
    for (const double force : {10.0, 1000.0}) {
        const double depth = std::pow(force / contact_stiffness(p), 0.9);
        EXPECT_NEAR(depth, 3.84e-8 * std::pow(force, 0.9) / std::pow(25, 0.8), 5e-3 * depth);
    }
}

// The middle of a strip of half-width a, a² = 4FR/(πbE*), on two half-spaces under Hertz's pressure sinks, by
// integrating Boussinesq's point loads, by δ = (2F/(πbE*))(½ + ln 4 + ln(b/2a)); forces of 1 to 100 N/mm.
TEST(Hertz, LineContactIsNearTheLogarithmOfAStrip) {
    Problem p = ruler();
    p.contact.stiffness.reset();
    p.cam->radius = 0.04;
    const double eta = (1 - 0.09) / 210e9, width = 0.025;
    for (const double force : {25.0, 250.0, 2500.0}) {
        const double a = std::sqrt(4 * force * p.cam->radius * 2 * eta / (pi * width));
        const double depth = 4 * force * eta / (pi * width) * (0.5 + std::log(4) + std::log(width / (2 * a)));
        EXPECT_NEAR(std::pow(force / contact_stiffness(p), 0.9), depth, 0.25 * depth) << force;
    }
}

TEST(Hertz, UsesTheMaterialOfTheCam) {
    Problem p;
    p.contact.stiffness.reset();
    p.beam.material = Material::pmma;
    p.cam->material = Material::steel;
    const double modulus = 1 / ((1 - 0.35 * 0.35) / 3.3e9 + (1 - 0.09) / 210e9);
    EXPECT_DOUBLE_EQ(contact_exponent(p), 1.5);
    EXPECT_NEAR(contact_stiffness(p), 4.0 / 3 * modulus * std::sqrt(0.1), 1e-6 * contact_stiffness(p));
}

TEST(Hertz, HasTheExponentOfItsLaw) {
    Problem p = ruler();
    p.contact.stiffness.reset();
    EXPECT_FALSE(has_error(p, "contact.exponent"));
    p.contact.exponent = 1.5;
    EXPECT_TRUE(has_error(p, "contact.exponent"));
    p.beam.section = Circle{0.005};
    EXPECT_FALSE(has_error(p, "contact.exponent"));
    p.contact.exponent = 2;
    EXPECT_TRUE(has_error(p, "contact.exponent"));
    p.contact.stiffness = 1e8;
    EXPECT_FALSE(has_error(p, "contact.exponent"));
}

TEST(Assumptions, AreSaidOfABeamOfOnesOwn) {
    EXPECT_TRUE(assumptions(Problem{}, false, 1).empty());
    EXPECT_EQ(assumptions(ruler(), false, 1).size(), 3u);
    EXPECT_EQ(assumptions(ruler(), true, 1).size(), 2u);
    Problem cam;
    cam.cam->radius = 0.09;
    EXPECT_EQ(assumptions(cam, false, 1).size(), 1u);
    cam.contact.model = ContactModel::restitution;
    EXPECT_TRUE(assumptions(cam, false, 1).empty());
    Problem driven;
    driven.hub.drive = TorqueTable{{0, 0.5}, {0, 3}};
    EXPECT_EQ(assumptions(driven, true, 0.5).size(), 1u);  // its basis converges slowly
    EXPECT_EQ(assumptions(driven, true, 1).back(),
              "hub.drive: after the table's last time, 0.5 s, the torque stays constant");
    driven.beam.basis = Basis::cantilever;
    EXPECT_TRUE(assumptions(driven, true, 0.5).empty());
}

// A cantilever of steel under its weight: v′(L) = q L³/(6 E I).
TEST(Assumptions, KnowTheSlopeUnderTheWeight) {
    const Problem p = ruler();
    EXPECT_NEAR(static_slope(p), 7850 * 9.81 * 12 * 0.027 / (6 * 210e9 * 0.0008 * 0.0008), 1e-12);
}

}  // namespace
}  // namespace beamcam::sim::testing
