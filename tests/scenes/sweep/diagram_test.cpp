// Figures of sweeps: what is drawn as a section, what only as a class, and that both starts are told apart.
#include "scenes/sweep/diagram.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/scene/exit_code.hpp"
#include "sim/sweep/attractor.hpp"
#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

using sim::AttractorClass;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::SizeIs;

SweepGrid grid(const std::string& sweep) {
    return SweepGrid(*testing::read(R"({"beam": {"model": "rigid"}, "sweep": )" + sweep + "}").scene);
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
        p.samples = {0.1, -1, 0.2, -2};
        return p;
    };
    return out;
}

const char* const kEightSpeeds = R"({"over": [{"key": "cam.speed", "values": [1, 2, 3, 4, 5, 6, 7, 8]}]})";

TEST(Diagram, ShowsSectionsAsPointsAndOtherClassesAsMarksAlone) {
    const SweepGrid speeds = grid(kEightSpeeds);
    using enum AttractorClass;
    const auto figure =
        diagram("bifurcation", speeds,
                data(speeds, {rest, following, periodic, quasi_periodic, chaotic, aperiodic, over_the_top, unsettled}),
                "v_n_before");
    ASSERT_THAT(figure.panels, SizeIs(2));
    EXPECT_EQ(figure.panels[0].clouds.at(0).x, (std::vector<double>{3, 3, 4, 4, 5, 5, 6, 6}));
    EXPECT_EQ(figure.panels[0].clouds.at(0).y, (std::vector<double>{-1, -2, -1, -2, -1, -2, -1, -2}));
    EXPECT_THAT(figure.panels[1].cells.at(0).colors, SizeIs(8));
    EXPECT_THAT(figure.panels[1].swatches, SizeIs(8));
    EXPECT_THAT(figure.caption, HasSubstr("transient 200 turns of the cam"));
    EXPECT_THAT(figure.caption, HasSubstr("1 over-the-top"));
    EXPECT_THAT(figure.caption, HasSubstr("statistic"));
    EXPECT_THAT(figure.accuracy, HasSubstr("tolerance"));
}

TEST(Diagram, TellsUpAndDownApart) {
    const SweepGrid both =
        grid(R"({"over": [{"key": "cam.speed", "values": [1, 2]}], "seed": ["carry-up", "carry-down"]})");
    const auto figure = diagram("bifurcation", both, data(both, {AttractorClass::periodic}), "v_n_before");
    ASSERT_THAT(figure.panels[0].clouds, SizeIs(2));
    EXPECT_EQ(figure.panels[0].clouds[0].label, "carried up");
    EXPECT_EQ(figure.panels[0].clouds[1].label, "carried down");
    EXPECT_FALSE(figure.panels[0].clouds[0].color == figure.panels[0].clouds[1].color);
    EXPECT_EQ(figure.panels[1].cells[0].y.back(), 2);
}

TEST(Diagram, IsAMapOfTwoKeysAndBasinsOfTwoInitialValues) {
    const SweepGrid two =
        grid(R"({"over": [{"key": "cam.speed", "values": [2, 1, 3]}, {"key": "gravity", "values": [9, 10]}]})");
    EXPECT_EQ(diagram_names(two).front(), "map");
    const auto figure = diagram("map", two, data(two, {AttractorClass::periodic, AttractorClass::chaotic}), "");
    const auto& cells = figure.panels.at(0).cells.at(0);
    EXPECT_EQ(cells.x, (std::vector<double>{0.5, 1.5, 2.5, 3.5}));
    // Values are put in order: 2, 1, 3 are periodic, chaotic, periodic in the first row.
    EXPECT_FALSE(cells.colors[0] == cells.colors[1]);
    EXPECT_TRUE(cells.colors[1] == cells.colors[2]);
    const SweepGrid starts = grid(R"({"over": [{"key": "initial.angle", "values": [0.5, 0.6]},
        {"key": "initial.angular_velocity", "values": [0, 1]}]})");
    EXPECT_EQ(diagram_names(starts).front(), "basins");
    EXPECT_THROW(diagram("bifurcation", two, data(two, {AttractorClass::periodic}), "theta"), SceneError);
}

TEST(Diagram, PairsEachImpactWithTheNext) {
    const SweepGrid speeds = grid(kEightSpeeds);
    const auto figure = diagram("impact-map", speeds, data(speeds, {AttractorClass::periodic}), "");
    EXPECT_THAT(figure.panels.at(0).clouds.at(0).x, Each(0.1));
    EXPECT_THAT(figure.panels.at(0).clouds.at(0).y, Each(0.2));
    EXPECT_THROW(diagram("poincare", speeds, data(speeds, {AttractorClass::unsettled}), ""), SceneError);
    EXPECT_THROW(diagram("bifurcation", speeds, data(speeds, {AttractorClass::periodic}), "theta"), SceneError);
}

TEST(Diagram, TellsFewValuesApart) {
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
            std::string("$BEAMCAM sweep s.json --over cam.speed=20:40:9n --transient 30 --keep 12 --caption c.txt "
                        "--force --diagram d.") +
                ending);
        ASSERT_EQ(done.code, 0) << done.err;
        EXPECT_GT(testing::slurp(folder / (std::string("d.") + ending)).size(), 3000u);
    }
    EXPECT_THAT(testing::slurp(folder / "c.txt"), HasSubstr("transient 30 turns"));
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
