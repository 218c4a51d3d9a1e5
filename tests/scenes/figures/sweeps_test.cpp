// Figures of sweeps: what is drawn as a section, what only as a class, and that both starts are distinguished.
#include "scenes/figures/sweeps.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "output/data/sweep_data.hpp"
#include "render/base/error.hpp"
#include "scenes/figures/command_figures.hpp"
#include "scenes/figures/figure_files.hpp"
#include "scenes/figures/figure_types.hpp"
#include "scenes/sweep/sweep_grid.hpp"
#include "sim/sweep/attractor.hpp"
#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

using sim::AttractorClass;
using ::testing::DoubleNear;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::StartsWith;

SweepGrid grid(const std::string& sweep) {
    return SweepGrid(*testing::read(R"({"beam": {"model": "rigid"}, "sweep": )" + sweep + "}").scene);
}

render::figure::Figure diagram(const char* name, const SweepGrid& grid, const output::SweepData& data,
                               const std::string& value, Lang lang = Lang::en) {
    FigureOutput how;
    how.value = value;
    how.lang = lang;
    MotionRequests none;
    return figure_type(name)->prepare(grid.scene(), how, none)({.sweep = SweepResult{&grid.scene(), &data}});
}

// Each point of these classes has two samples.
output::SweepData data(const SweepGrid& grid, const std::vector<AttractorClass>& kinds) {
    output::SweepData out;
    out.axes = grid.axes();
    out.seeds = grid.seeds();
    out.columns = {{"cam_phase", "1", ""}, {"v_n_before", "m/s", ""}};
    out.has = [](std::uint64_t) { return true; };
    out.rows = [](std::uint64_t) { return 2; };
    out.read = [kinds](std::uint64_t k) {
        output::StoredPoint p;
        p.point = k;
        p.kind = static_cast<int>(kinds[k % kinds.size()]);
        p.period = 1;
        p.impacts_per_period = 2;
        p.samples = {0.1, -1, 0.2, -2};
        return p;
    };
    return out;
}

const char* const kEightSpeeds = R"({"over": [{"key": "cam.speed", "values": [1, 2, 3, 4, 5, 6, 7, 8]}]})";
const char* const kSevenSpeeds = R"({"over": [{"key": "cam.speed", "values": [1, 2, 3, 4, 5, 6, 7]}]})";

TEST(Diagram, ShowsSectionsAsPointsAndOtherClassesAsMarksAlone) {
    const SweepGrid speeds = grid(kSevenSpeeds);
    using enum AttractorClass;
    const auto figure =
        diagram("bifurcation", speeds,
                data(speeds, {rest, following, periodic, chaotic, aperiodic, over_the_top, unsettled}), "v_n_before");
    ASSERT_THAT(figure.panels, SizeIs(2));
    EXPECT_EQ(figure.panels[0].clouds.at(0).x, (std::vector<double>{3, 3, 4, 4, 5, 5}));
    EXPECT_EQ(figure.panels[0].clouds.at(0).y, (std::vector<double>{1, 2, 1, 2, 1, 2}));
    EXPECT_THAT(figure.panels[1].cells.at(0).colors, SizeIs(7));
    EXPECT_THAT(figure.panels[1].swatches, SizeIs(7));
    EXPECT_THAT(figure.accuracy, HasSubstr("tolerance"));
}

// All motions have peaks, also those without a section; curves run along the key.
TEST(Diagram, OfPeaksIsACurveForEachStartInPrefixedUnits) {
    const SweepGrid speeds = grid(R"({"over": [{"key": "cam.speed", "values": [3, 1, 2]}], "sample": "peaks",
                                      "seed": ["carry-up", "carry-down"]})");
    output::SweepData peaks = data(speeds, {AttractorClass::unsettled});
    peaks.columns = {{"force_peak", "N", ""}, {"stress_peak", "Pa", ""}};
    peaks.rows = [](std::uint64_t) { return 1; };
    peaks.read = [](std::uint64_t k) {
        output::StoredPoint p;
        p.point = k;
        p.kind = static_cast<int>(AttractorClass::unsettled);
        p.samples = {static_cast<double>(k), 1e6 * static_cast<double>(1 + k)};
        return p;
    };
    const auto figure = diagram("peaks", speeds, peaks, "stress_peak");
    ASSERT_THAT(figure.panels, SizeIs(1));
    EXPECT_THAT(figure.panels[0].y.label, HasSubstr("MPa"));
    ASSERT_THAT(figure.panels[0].series, SizeIs(2));
    EXPECT_EQ(figure.panels[0].series[0].x, (std::vector<double>{3, 1, 2}));
    EXPECT_EQ(figure.panels[0].series[0].y, (std::vector<double>{1, 3, 5}));
    EXPECT_EQ(figure.panels[0].series[1].y, (std::vector<double>{2, 4, 6}));
    EXPECT_FALSE(figure.panels[0].series[0].line);  // the motions are independent
    EXPECT_EQ(diagram("peaks", speeds, peaks, "").panels[0].name, "force_peak");
}

TEST(Diagram, LeavesOutOfItsCaptionWhatTheSweepVaries) {
    using enum AttractorClass;
    const SweepGrid swept = grid(
        R"({"over": [{"key": "cam.eccentricity", "values": [1e-3, 3e-3]}, {"key": "gravity", "values": [9.81]}],
            "sample": "apexes", "seed": {"random": 5}})");
    const auto figure = diagram("map", swept, data(swept, {periodic}), "class");
    EXPECT_THAT(figure.title,
                HasSubstr("Map of motions over cam eccentricity $e$ and gravity $g$: every maximum of $θ$ in "));
    for (const char* key : {"eccentricity", "initial."}) EXPECT_THAT(figure.caption, Not(HasSubstr(key)));
}

// Cells reach half-way to the next value on a logarithmic scale.
TEST(Diagram, HasCellsAroundTheValuesOfItsScale) {
    using enum AttractorClass;
    const SweepGrid inertia = grid(R"({"over": [{"key": "hub.inertia", "from": 0.1, "to": 10, "count": 3,
        "spacing": "log"}], "sample": {"section": "theta", "at": 0.5}})");
    EXPECT_THAT(diagram("bifurcation", inertia, data(inertia, {rest}), "v_n_before").panels.back().cells.at(0).x,
                ElementsAre(DoubleNear(std::pow(10, -1.5), 1e-15), DoubleNear(std::pow(10, -0.5), 1e-15),
                            DoubleNear(std::pow(10, 0.5), 1e-14), DoubleNear(std::pow(10, 1.5), 1e-13)));
}

TEST(Diagram, HasALinearAxisWhereALogarithmOfItsValuesIsMissing) {
    using enum AttractorClass;
    const SweepGrid swept = grid(R"({"over": [{"key": "gravity", "values": [0, 1, 10], "spacing": "log"}]})");
    const render::figure::Figure figure = diagram("bifurcation", swept, data(swept, {rest}), "v_n_before");
    EXPECT_EQ(figure.panels.back().x.scale, render::Scale::linear);
    EXPECT_THAT(figure.panels.back().cells.at(0).x, ElementsAre(-0.5, 0.5, 5.5, 14.5));
}

TEST(Diagram, HasAStripOfTheExponentsThatAreKnown) {
    const SweepGrid speeds = grid(R"({"over": [{"key": "cam.speed", "values": [1, 2, 3]}]})");
    using enum AttractorClass;
    output::SweepData points = data(speeds, {periodic, chaotic, following});
    const double known[] = {-2, 3, -std::numeric_limits<double>::infinity()};
    const auto read = points.read;
    points.read = [=](std::uint64_t k) {
        output::StoredPoint p = read(k);
        p.exponent = known[k];
        return p;
    };
    const auto figure = diagram("bifurcation", speeds, points, "v_n_before");
    ASSERT_THAT(figure.panels, SizeIs(3));
    EXPECT_EQ(figure.panels[1].name, "exponent");
    EXPECT_EQ(figure.panels[1].clouds.at(0).x, (std::vector<double>{1, 2}));
    EXPECT_EQ(figure.panels[1].clouds.at(0).y, (std::vector<double>{-2, 3}));
    EXPECT_EQ(figure.panels[1].rules.at(0).at, 0);
    EXPECT_EQ(figure.panels[1].x.from, figure.panels[2].x.from);
}

TEST(Diagram, WithoutSectionsInventsNoNumbers) {
    const SweepGrid speeds = grid(R"({"over": [{"key": "cam.speed", "values": [1, 2]}]})");
    using enum AttractorClass;
    const auto figure = diagram("bifurcation", speeds, data(speeds, {following, over_the_top}), "v_n_before");
    ASSERT_THAT(figure.panels, SizeIs(2));
    EXPECT_FALSE(figure.panels[0].y.numbered);
    EXPECT_EQ(figure.panels[0].title, "No samples to draw; motions: following, over-the-top");
    EXPECT_THAT(missing_data(figure), ElementsAre("no points"));
    EXPECT_THAT(missing_data(diagram("bifurcation", speeds, data(speeds, {periodic}), "v_n_before")), SizeIs(0));
}

// Diagrams have the units in which the scene gives angles and speeds.
TEST(Diagram, HasTheUnitsOfTheScene) {
    const SweepGrid speeds = grid(R"({"over": [{"key": "cam.speed", "values": ["300 rpm", "400 rpm"]}]})");
    const auto one = diagram("bifurcation", speeds, data(speeds, {AttractorClass::periodic}), "");
    EXPECT_EQ(one.panels[0].x.label, "$ω$ / rpm");
    EXPECT_NEAR(one.panels[0].clouds[0].x.back(), 400, 1e-9);
    const SweepGrid both = grid(R"({"over": [{"key": "cam.speed", "values": ["300 rpm", "400 rpm"]},
                                             {"key": "cam.eccentricity", "values": ["1 mm", "2 mm"]}]})");
    const auto two = diagram("map", both, data(both, {AttractorClass::periodic}), "");
    EXPECT_EQ(two.panels[0].y.label, "$e$ / mm");
    EXPECT_NEAR(two.panels[0].cells[0].y.back(), 2.5, 1e-9);
    const auto plane = diagram("impact-map", speeds, data(speeds, {AttractorClass::periodic}), "");
    EXPECT_THAT(plane.panels[0].clouds[1].label, HasSubstr("400 rpm"));
}

TEST(Diagram, OfBranchesHasTheImpactsOfASweepBeneath) {
    output::BranchTable table;
    table.key = "cam.speed";
    sim::BranchPoint point;
    point.orbit.impacts = {{0, 0.3}};
    sim::Branch branch;
    for (const double parameter : {1.0, 2.0}) {
        point.parameter = parameter;
        branch.points.push_back(point);
    }
    table.branches = {branch};
    table.from = 0.5, table.to = 3;
    const Scene scene;
    EXPECT_THAT(branches_figure(table, {}, scene, Lang::en).panels[0].clouds, SizeIs(0));
    const auto figure = branches_figure(table, {{1.5, 1.6}, {0.2, 0.1}}, scene, Lang::en);
    ASSERT_THAT(figure.panels[0].clouds, SizeIs(1));
    EXPECT_EQ(figure.panels[0].clouds[0].y, (std::vector<double>{0.2, 0.1}));
    EXPECT_THAT(figure.panels[0].series, SizeIs(1));
    EXPECT_EQ(figure.panels[0].x.from, 0.5);  // the range that was asked for
    EXPECT_EQ(figure.panels[0].x.to, 3);
}

// The pieces of a curve between its gaps.
std::vector<std::vector<double>> pieces_of(const render::figure::Series& curve) {
    std::vector<std::vector<double>> out(1);
    for (const double y : curve.y) {
        if (!std::isnan(y)) out.back().push_back(y);
        if (std::isnan(y) && !out.back().empty()) out.emplace_back();
    }
    out.pop_back();
    return out;
}

output::BranchTable branch_of(const std::vector<std::pair<double, std::vector<sim::OrbitImpact>>>& orbits) {
    output::BranchTable table;
    table.key = "cam.speed";
    table.from = 0, table.to = 10;
    sim::Branch& branch = table.branches.emplace_back();
    for (const auto& [section, impacts] : orbits) {
        sim::BranchPoint& point = branch.points.emplace_back();
        point.parameter = static_cast<double>(branch.points.size());
        point.orbit.section = section, point.orbit.impacts = impacts;
    }
    return table;
}

// Where the section moves, the first impact is another one; the cam angles are continued from the section.
TEST(Diagram, OfBranchesFollowsEachImpactWhereTheSectionMoves) {
    const auto table = branch_of({{1, {{-1.3, 0.54}, {-2.4, 0.23}, {-8.0, 0.67}, {-10.4, 0.01}}},
                                  {1, {{-1.35, 0.53}, {-2.4, 0.228}, {-8.01, 0.673}, {-10.45, 0.011}}},
                                  {1.08, {{-1.72, 0.673}, {-4.17, 0.011}, {-7.63, 0.536}, {-8.68, 0.228}}}});
    EXPECT_THAT(pieces_of(branches_figure(table, {}, Scene(), Lang::en).panels[0].series.at(0)),
                ElementsAre(ElementsAre(0.54, 0.53, 0.536), ElementsAre(0.23, 0.228, 0.228),
                            ElementsAre(0.67, 0.673, 0.673), ElementsAre(0.01, 0.011, 0.011)));
}

// Along orbits that end in a rest, where their number changes.
TEST(Diagram, OfBranchesBreaksAtTheEndsOfImpacts) {
    const auto table = branch_of({{1, {{1, 0.2}}}, {1, {{1, 0.3}, {2, 0.01}}}, {1, {{1, 0.4}, {2, 0.02}}}});
    EXPECT_THAT(pieces_of(branches_figure(table, {}, Scene(), Lang::en).panels[0].series.at(0)),
                ElementsAre(ElementsAre(0.2, 0.3, 0.4), ElementsAre(0.01, 0.02)));
}

TEST(Diagram, OfBranchesHasTheUnitsOfTheScene) {
    output::BranchTable table;
    table.key = "cam.speed";
    sim::BranchPoint point;
    point.orbit.impacts = {{0, 0.3}};
    point.parameter = 10 * std::numbers::pi;
    table.branches.emplace_back().points = {point, point};
    table.branches[0].special.emplace_back().at = point;
    table.from = 30, table.to = 40;
    Scene scene;
    scene.units.speed = render::SpeedUnit::rpm;
    const auto figure = branches_figure(table, {{10 * std::numbers::pi}, {0.2}}, scene, Lang::en);
    EXPECT_EQ(figure.panels[0].x.label, "$ω$ / rpm");
    EXPECT_NEAR(figure.panels[0].series[0].x[0], 300, 1e-9);
    EXPECT_NEAR(figure.panels[0].clouds[0].x[0], 300, 1e-9);
    EXPECT_NEAR(figure.panels[0].marks[0].x, 300, 1e-9);
}

// In a cascade only the first labels have room; beside it each other change has its own label.
TEST(Diagram, OfBranchesMarksEachChangeThatHasRoom) {
    using enum sim::OrbitChange;
    output::BranchTable table;
    table.key = "contact.restitution";
    table.from = 0.3, table.to = 0.9;
    sim::BranchPoint point;
    point.orbit.impacts = {{0, 0.3}, {1, 0.2}};
    table.branches.emplace_back().points = {point, point};
    const auto add = [&](sim::OrbitChange change, double value, bool impacts) {
        sim::BranchPoint at;
        at.parameter = value;
        if (impacts) at.orbit.impacts = point.orbit.impacts;
        table.branches[0].special.push_back({change, at, 0});
    };
    add(release, 0.81, false);  // of a beam that follows the cam: its impacts begin with no speed
    add(period_doubling, 0.82, true);
    add(period_doubling, 0.83, true);
    add(release, 0.819, true);
    add(release, 0.85, true);
    std::vector<std::string> labels;
    const render::figure::Figure figure = branches_figure(table, {}, Scene(), Lang::en);
    for (const auto& mark : figure.panels[0].marks) labels.push_back(mark.label);
    EXPECT_THAT(labels, ElementsAre("R", "PD", "R"));
    EXPECT_EQ(figure.panels[0].marks[0].y, 0);
}

// Angular velocities of samples have the unit of the scene's speeds, angles that of its angles.
TEST(Diagram, OfSamplesHasTheUnitsOfTheScene) {
    Scene scene = grid(R"({"over": [{"key": "cam.speed", "values": ["300 rpm", "400 rpm"]}]})").scene();
    scene.units.degrees = true;
    const SweepGrid speeds(scene);
    output::SweepData samples = data(speeds, {AttractorClass::periodic});
    samples.columns = {{"theta", "rad", ""}, {"theta_dot", "rad/s", ""}};
    const auto angles = diagram("bifurcation", speeds, samples, "theta");
    EXPECT_EQ(angles.panels[0].y.label, "$θ$ / °");
    EXPECT_NEAR(angles.panels[0].clouds[0].y[0], 0.1 * 180 / std::numbers::pi, 1e-9);
    const auto rates = diagram("bifurcation", speeds, samples, "theta_dot");
    EXPECT_EQ(rates.panels[0].y.label, "$\\dot{θ}$ / rpm");
    EXPECT_NEAR(rates.panels[0].clouds[0].y[0], -30 / std::numbers::pi, 1e-9);
}

// Columns of files have the sign of v_n, which is negative before an impact; figures have its approach speed.
TEST(Diagram, OfSamplesAndOfBranchesHaveOneApproachSpeed) {
    const SweepGrid one = grid(R"({"over": [{"key": "cam.speed", "values": [1]}]})");
    const auto samples = diagram("bifurcation", one, data(one, {AttractorClass::periodic}), "v_n_before");
    EXPECT_EQ(samples.panels[0].clouds[0].y, (std::vector<double>{1, 2}));
    EXPECT_EQ(samples.panels[0].y.label, "approach speed / (m s^{−1})");
    const auto section = diagram("poincare", one, data(one, {AttractorClass::periodic}), "");
    EXPECT_EQ(section.panels[0].clouds[0].y, (std::vector<double>{1, 2}));
    EXPECT_EQ(section.panels[0].y.label, samples.panels[0].y.label);
    output::BranchTable table;
    table.key = "cam.speed";
    sim::BranchPoint point;
    point.orbit.impacts = {{0, 0.3}};
    table.branches.emplace_back().points = {point, point};
    EXPECT_EQ(branches_figure(table, {}, Scene(), Lang::en).panels[0].y.label, samples.panels[0].y.label);
    const SweepGrid two = grid(
        R"({"over": [{"key": "cam.speed", "values": [1, 2]}, {"key": "cam.eccentricity", "values": [0.01, 0.02]}]})");
    const auto map = diagram("map", two, data(two, {AttractorClass::periodic}), "v_n_before");
    EXPECT_EQ(map.panels[0].cells[0].values, (std::vector<double>{1.5, 1.5, 1.5, 1.5}));
    EXPECT_EQ(map.panels[0].color_bar->label, "mean of approach speed / (m s^{−1})");
}

TEST(Diagram, DistinguishesUpAndDown) {
    const SweepGrid both =
        grid(R"({"over": [{"key": "cam.speed", "values": [1, 2]}], "seed": ["carry-up", "carry-down"]})");
    const auto figure = diagram("bifurcation", both, data(both, {AttractorClass::periodic}), "v_n_before");
    ASSERT_THAT(figure.panels[0].clouds, SizeIs(3));
    EXPECT_EQ(figure.panels[0].clouds[0].label, "carried up");
    EXPECT_EQ(figure.panels[0].clouds[1].label, "carried down");
    // The colour of a dot over a dot is in the legend.
    EXPECT_EQ(figure.panels[0].clouds[2].label, "coinciding");
    EXPECT_THAT(figure.panels[0].clouds[2].x, SizeIs(0));
    const render::Color up = figure.panels[0].clouds[0].color, down = figure.panels[0].clouds[1].color;
    EXPECT_NEAR(figure.panels[0].clouds[2].color.r, up.r * (1 - down.a) + down.r * down.a, 1e-12);
    EXPECT_FALSE(figure.panels[0].clouds[0].color == figure.panels[0].clouds[1].color);
    EXPECT_EQ(figure.panels[1].cells[0].y.back(), 2);
}

TEST(Diagram, IsAMapOfTwoKeysAndBasinsOfTwoInitialValues) {
    const SweepGrid two =
        grid(R"({"over": [{"key": "cam.speed", "values": [2, 1, 3]}, {"key": "gravity", "values": [9, 10]}]})");
    EXPECT_EQ(usual_diagram(two.scene()), "map");
    const auto figure = diagram("map", two, data(two, {AttractorClass::periodic, AttractorClass::chaotic}), "class");
    const auto& cells = figure.panels.at(0).cells.at(0);
    EXPECT_EQ(cells.x, (std::vector<double>{0.5, 1.5, 2.5, 3.5}));
    // Values are put in order: 2, 1, 3 are periodic, chaotic, periodic in the first row.
    EXPECT_FALSE(cells.colors[0] == cells.colors[1]);
    EXPECT_TRUE(cells.colors[1] == cells.colors[2]);
    const SweepGrid starts = grid(R"({"over": [{"key": "initial.angle", "values": [0.5, 0.6]},
        {"key": "initial.angular_velocity", "values": [0, 1]}]})");
    EXPECT_EQ(usual_diagram(starts.scene()), "basins");
    EXPECT_TRUE(figure_type("bifurcation")->refusal(two.scene()));
}

TEST(Diagram, ColoursAMapByANumberOfItsPoints) {
    const SweepGrid two =
        grid(R"({"over": [{"key": "cam.speed", "values": [1, 2]}, {"key": "gravity", "values": [9, 10]}]})");
    output::SweepData some = data(two, {AttractorClass::periodic});
    some.read = [read = some.read](std::uint64_t k) {
        output::StoredPoint p = read(k);
        p.exponent = k == 3 ? -std::numeric_limits<double>::infinity() : double(k);
        return p;
    };
    const auto figure = diagram("map", two, some, "exponent");
    const auto& panel = figure.panels.at(0);
    EXPECT_EQ(panel.cells.at(0).values[2], 2);
    EXPECT_TRUE(std::isnan(panel.cells.at(0).values[3]));
    EXPECT_EQ(panel.cells.at(0).colors[3].a, 0);
    EXPECT_EQ(panel.color_bar->to, 2);
    EXPECT_FALSE(panel.color_bar->is_signed);
    // Numbers of both signs, −1 to 2: white is 0, and as much below it is as dark as above.
    some.read = [read = some.read](std::uint64_t k) {
        output::StoredPoint p = read(k);
        p.exponent = k == 1 ? 0 : k == 2 ? 2 : p.exponent - 1;
        return p;
    };
    const auto both = diagram("map", two, some, "exponent").panels.at(0);
    EXPECT_TRUE(both.color_bar->is_signed);
    EXPECT_EQ(both.color_bar->from, -2);
    EXPECT_EQ(both.color_bar->to, 2);
    EXPECT_EQ(both.cells.at(0).colors[1], render::figure::signed_color(0));
    EXPECT_EQ(both.cells.at(0).colors[0], render::figure::signed_color(-0.5));
    EXPECT_NE(both.cells.at(0).colors[3], render::figure::signed_color(0));
    ASSERT_THAT(both.swatches, SizeIs(1));
    EXPECT_EQ(both.swatches[0].label, "−∞");
    EXPECT_EQ(both.swatches[0].color, both.cells.at(0).colors[3]);
    some.read = [read = some.read](std::uint64_t k) {
        output::StoredPoint p = read(k);
        if (k == 0) p.exponent = sim::kNan;
        if (k == 1) p.exponent = -1;
        return p;
    };
    const auto unknown = diagram("map", two, some, "exponent").panels.at(0);
    ASSERT_THAT(unknown.swatches, SizeIs(2));
    EXPECT_EQ(unknown.swatches[0].label, "unknown");
    EXPECT_NE(unknown.swatches[0].color, unknown.swatches[1].color);
    // The mean of a column's samples, −1 and −2.
    EXPECT_EQ(diagram("map", two, some, "v_n_before").panels.at(0).cells.at(0).values[1], 1.5);
}

TEST(Diagram, SpeaksChinese) {
    const SweepGrid speeds = grid(kEightSpeeds);
    const auto figure = diagram("bifurcation", speeds, data(speeds, {AttractorClass::chaotic}), "cam_phase", Lang::zh);
    EXPECT_EQ(figure.panels.at(0).y.label, "凸轮相位 / 转");
    EXPECT_EQ(figure.panels.at(1).swatches.at(0).label, "混沌");
}

TEST(Diagram, PairsEachImpactWithTheNext) {
    const SweepGrid speeds = grid(kEightSpeeds);
    const auto figure = diagram("impact-map", speeds, data(speeds, {AttractorClass::periodic}), "");
    EXPECT_THAT(figure.panels.at(0).clouds.at(0).x, Each(0.1));
    EXPECT_THAT(figure.panels.at(0).clouds.at(0).y, Each(0.2));
    EXPECT_THROW(diagram("poincare", speeds, data(speeds, {AttractorClass::unsettled}), ""), render::PictureError);
    EXPECT_THROW(diagram("bifurcation", speeds, data(speeds, {AttractorClass::periodic}), "theta"),
                 render::PictureError);
}

TEST(Diagram, DistinguishesFewValues) {
    const SweepGrid speeds = grid(R"({"over": [{"key": "cam.speed", "values": [40, 50]}], "seed": {"random": 3}})");
    const auto panel = diagram("poincare", speeds, data(speeds, {AttractorClass::chaotic}), "").panels.at(0);
    ASSERT_THAT(panel.clouds, SizeIs(2));
    EXPECT_EQ(panel.clouds[0].label, "$ω$ = 40 rad s^{−1}");
    EXPECT_EQ(panel.clouds[1].label, "$ω$ = 50 rad s^{−1}");
    for (const auto& cloud : panel.clouds) EXPECT_THAT(cloud.x, SizeIs(6));  // two samples of three starts
}

TEST(Diagram, IsAFileWithItsCaption) {
    const testing::Folder folder;
    folder.write("s.json", R"({"beam": {"model": "rigid"}, "contact": {"model": "restitution"}})");
    for (const char* ending : {"png", "pdf", "svg"}) {
        const auto done = testing::shell(
            folder,
            std::string("$BEAMCAM sweep s.json --over cam.speed=20:40:9 --transient 30 --keep 12 --caption c.txt "
                        "--force --diagram d.") +
                ending);
        ASSERT_EQ(done.code, 0) << done.err;
        EXPECT_GT(testing::slurp(folder / (std::string("d.") + ending)).size(), 3000u);
    }
    EXPECT_THAT(
        testing::slurp(folder / "c.txt"),
        ::testing::AllOf(
            HasSubstr(
                "Bifurcation diagram over cam speed ω: every impact in 12 cam turns after a transient of 30 cam turns; "
                "classes: "),
            HasSubstr("Parameters: beam model = rigid, contact model = ")));
}

TEST(Diagram, AndTheSamplesAreOutputsOfAScene) {
    const testing::Folder folder;
    const std::string physics =
        R"({"beam": {"model": "rigid"}, "contact": {"model": "restitution", "restitution": 0.5},
            "cam": {"eccentricity": "2 mm"},
            "sweep": {"over": [{"key": "cam.speed", "from": 40, "to": 45, "count": 9}],
                      "transient": {"cam_turns": 30}, "keep": {"cam_turns": 12}})";
    folder.write("s.json", physics + R"(, "outputs": [{"type": "sweep"}, {"type": "sweep", "file": "s.csv"},
        {"type": "figure", "figure": "bifurcation", "value": "cam_phase"}, {"type": "figure", "figure": "poincare"}]})");
    folder.write("t.json", physics + "}");
    const auto done = testing::shell(folder, "$BEAMCAM run s.json");
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_THAT(done.err, HasSubstr("9 points in"));
    for (const char* file : {"s-sweep.nc", "s.csv", "bifurcation.pdf", "poincare.pdf"})
        EXPECT_GT(testing::slurp(folder / file).size(), 1000u) << file;
    EXPECT_FALSE(std::filesystem::exists(folder / "s-sweep.nc.part"));
    // The command makes the same.
    ASSERT_EQ(testing::shell(folder, "$BEAMCAM sweep t.json -o t.csv").code, 0);
    EXPECT_EQ(testing::slurp(folder / "t.csv"), testing::slurp(folder / "s.csv"));
    const auto again = testing::shell(folder, "$BEAMCAM run s.json");
    EXPECT_THAT(again.err, HasSubstr("kept ./s.csv: up to date"));
    EXPECT_THAT(again.err, ::testing::Not(HasSubstr("points in")));
    folder.write("none.json", R"({"outputs": [{"type": "sweep"}, {"type": "figure", "figure": "map"}]})");
    const auto rejected = testing::shell(folder, "$BEAMCAM check none.json");
    EXPECT_EQ(rejected.code, 3);
    EXPECT_THAT(rejected.err, HasSubstr("no key \"sweep\""));
}

TEST(Diagram, IsMadeAgainWhenATableChangesAndIsGuardedAsABaseline) {
    const testing::Folder folder;
    folder.write("w.csv", "w\n40\n41\n");
    folder.write("s.json", R"({"beam": {"model": "rigid"}, "contact": {"model": "restitution", "restitution": 0.5},
        "cam": {"eccentricity": "2 mm"}, "outputs": [{"type": "figure", "figure": "bifurcation", "file": "d.png"}],
        "sweep": {"over": [{"key": "cam.speed", "values": "@w.csv:w"}],
                  "transient": {"cam_turns": 30}, "keep": {"cam_turns": 12}}})");
    const char* run = "$BEAMCAM run s.json";
    EXPECT_THAT(testing::shell(folder, run).err, HasSubstr("wrote ./d.png"));
    EXPECT_THAT(testing::shell(folder, run).err, HasSubstr("kept ./d.png"));
    folder.write("w.csv", "w\n40\n42\n");
    EXPECT_THAT(testing::shell(folder, run).err, HasSubstr("wrote ./d.png"));
    folder.write("b.json", R"({"references": "refs", "entries": {"d": {"scene": "s.json",
        "output": {"type": "figure", "figure": "bifurcation"}}}})");
    testing::shell(folder, "$BEAMCAM test b.json --update d");
    const auto same = testing::shell(folder, "$BEAMCAM test b.json");
    EXPECT_EQ(same.code, 0) << same.err;
    EXPECT_THAT(same.out + same.err, HasSubstr("1 identical"));
}

TEST(Diagram, OfVeryManyPointsIsAPictureUnderVectorAxes) {
    const testing::Folder folder;
    folder.write("s.json", R"({"beam": {"model": "rigid"}, "contact": {"model": "restitution", "restitution": 0.5},
                              "cam": {"eccentricity": 0.002}})");
    const auto pdf = [&](const char* points) {
        const auto done =
            testing::shell(folder, std::string("$BEAMCAM sweep s.json -q --transient 20 --keep 60 --force "
                                               "--diagram d.pdf --over cam.speed=45:46:") +
                                       points);
        EXPECT_EQ(done.code, 0) << done.err;
        return testing::slurp(folder / "d.pdf");
    };
    const std::string few = pdf("10"), many = pdf("200");                // fourteen impacts a turn
    EXPECT_EQ(few.find("/Subtype /Image") == std::string::npos, false);  // the strip of classes
    EXPECT_LT(many.size(), 400'000u);
    EXPECT_THAT(many, HasSubstr("/FontFile2"));
}

}  // namespace
}  // namespace beamcam::scenes
