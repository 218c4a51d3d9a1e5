// `beamcam cam` and the figure svaj: numbers, files, errors.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "output/data/table_reader.hpp"
#include "sim/cam/cam_shape.hpp"
#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

using testing::Finished, testing::Folder, testing::shell;
using ::testing::HasSubstr;

constexpr const char* kLaw = R"("type": "law", "lowest": "14 deg", "segments": [{"law": "dwell", "over": "60 deg"},
    {"law": "cycloidal", "rise": "8 deg", "over": "100 deg"}, {"law": "dwell", "over": "40 deg"},
    {"law": "3-4-5", "rise": "-8 deg", "over": "120 deg"}, {"law": "dwell"}])";

std::string scene_with(const std::string& profile) {
    return R"({"beam": {"model": "rigid"}, "cam": {"centre": [0.25, 0], "profile": {)" + profile + "}}}";
}

TEST(CamCommand, PrintsTheNumbersOfTheCam) {
    const Folder folder;
    folder.write("law.json", scene_with(kLaw));
    const Finished printed = shell(folder, "$BEAMCAM cam law.json --json");
    ASSERT_EQ(printed.code, 0) << printed.err;
    const auto numbers = nlohmann::json::parse(printed.out);
    EXPECT_NEAR(numbers["base_radius"].get<double>(), 0.25 * std::sin(14 * std::numbers::pi / 180), 1e-15);
    EXPECT_NEAR(numbers["rho_min"].get<double>(), 0.03663479779, 5e-12);
    EXPECT_NEAR(numbers["rho_max"].get<double>(), 0.11911152977, 5e-12);
    EXPECT_NEAR(numbers["rho_min_phi"].get<double>(), 136.82916 * std::numbers::pi / 180, 1e-5);
    EXPECT_EQ(numbers["pressure_angle_max"].get<double>(), 0);
    EXPECT_NEAR(numbers["jump_speed"].get<double>(), 6.900035815, 5e-10);
    EXPECT_NEAR(numbers["jump_phi"].get<double>(), 135.137 * std::numbers::pi / 180, 1e-5);
    EXPECT_THAT(shell(folder, "$BEAMCAM cam law.json").out, HasSubstr("6.900035815 rad/s (65.8905 rpm)"));
    const std::string spring = R"( --set 'hub.spring={"stiffness": "0.5 N m/rad", "free_angle": "-60 deg"}')";
    EXPECT_THAT(shell(folder, "$BEAMCAM cam law.json" + spring).out, HasSubstr("9.176477235 rad/s"));
    const Finished disc = shell(folder, R"($BEAMCAM cam law.json --set cam.profile=null --json)");
    EXPECT_EQ(nlohmann::json::parse(disc.out)["rho_min"].get<double>(), 0.1);
}

TEST(CamCommand, WritesPointsThatAreTheSameOutline) {
    const Folder folder;
    folder.write("law.json", scene_with(kLaw));
    ASSERT_EQ(shell(folder, "$BEAMCAM cam law.json -o cam.csv").code, 0);
    const output::ColumnTable table = output::read_table(folder / "cam.csv");
    EXPECT_EQ(table.names(), (std::vector<std::string>{"alpha", "phi", "x", "y", "arc_length", "curvature"}));
    const Reading law = read_scene(load_source((folder / "law.json").string()));
    folder.write("points.json", scene_with(R"("file": "cam.csv", "x": "x", "y": "y")"));
    const Reading points = read_scene(load_source((folder / "points.json").string()));
    ASSERT_TRUE(law.scene && points.scene) << points.report();
    const sim::CamShape exact(law.scene->problem), read(points.scene->problem);
    for (std::size_t i = 0; i < table.rows(); i += 7) {
        const double alpha = table.columns[0].values[i];
        EXPECT_NEAR(1 / table.columns[5].values[i], exact.at(alpha).radius, 1e-15);
        EXPECT_NEAR(table.columns[4].values[i], exact.arc(alpha), 1e-15);
        // The splines smooth the kinks over two points.
        EXPECT_NEAR(read.at(alpha + 1e-3).h, exact.at(alpha + 1e-3).h, 1e-9);
    }
}

TEST(CamCommand, DrawsTheOutlineToScale) {
    const Folder folder;
    folder.write("law.json", scene_with(kLaw));
    ASSERT_EQ(shell(folder, "$BEAMCAM cam law.json -o cam.svg -o cam.pdf").code, 0);
    // The pivot is 250 mm from the axis: the drawing is wider by the cam and two margins; it is higher than the cam by
    // the lever above it.
    const std::string svg = testing::slurp(folder / "cam.svg");
    double width = 0, height = 0;
    ASSERT_EQ(std::sscanf(svg.c_str() + svg.find("width=\""), "width=\"%lfmm\" height=\"%lfmm\"", &width, &height), 2)
        << svg.substr(0, 300);
    const sim::CamShape shape(read_scene(load_source((folder / "law.json").string())).scene->problem);
    EXPECT_NEAR(width, 250 + 1e3 * shape.largest_reach() + 24, 12);
    EXPECT_NEAR(height, 1e3 * (shape.at(std::numbers::pi / 2).h + shape.at(3 * std::numbers::pi / 2).h) + 24 + 15, 35);
    EXPECT_THAT(shell(folder, "$BEAMCAM info --scene cam.svg").out, HasSubstr("\"law\""));
    EXPECT_TRUE(testing::slurp(folder / "cam.pdf").starts_with("%PDF"));
}

// The leaf of CAMS.md; the rigid one jumps as the lever.
TEST(CamCommand, FindsTheJumpSpeedOfTheBeam) {
    const Folder folder;
    const auto jump = [&](const std::string& model) {
        const Finished found =
            shell(folder, std::string("$BEAMCAM cam '") + BEAMCAM_TEST_DIR +
                              "/../scenes/valve-lever.json' --beam --json --set beam.model=" + model);
        EXPECT_EQ(found.code, 0) << found.err;
        return nlohmann::json::parse(found.out);
    };
    const auto flexible = jump("first-order"), rigid = jump("rigid");
    EXPECT_NEAR(flexible["beam_jump_speed"].get<double>() * 30 / std::numbers::pi, 1369, 1);
    EXPECT_NEAR(rigid["beam_jump_speed"].get<double>() / rigid["jump_speed"].get<double>(), 1, 1e-4);
    const auto impulses = jump("rigid --set contact.model=restitution");
    EXPECT_NEAR(impulses["beam_jump_speed"].get<double>() / impulses["jump_speed"].get<double>(), 1, 2e-5);
}

TEST(CamCommand, RefusesWhatItCannotDo) {
    const Folder folder;
    folder.write("law.json", scene_with(kLaw));
    EXPECT_EQ(shell(folder, "$BEAMCAM cam law.json --set cam=null").code, 3);
    EXPECT_EQ(shell(folder, "$BEAMCAM cam law.json -o cam.mp4").code, 2);
    folder.write("disc.json", R"({"cam": {"eccentricity": 0}})");
    EXPECT_THAT(shell(folder, "$BEAMCAM cam disc.json --beam").err, HasSubstr("see the gap_peak of `beamcam sweep"));
    const Finished undercut = shell(folder, "$BEAMCAM cam law.json --set cam.profile.lowest='5 deg'");
    EXPECT_EQ(undercut.code, 3);
    EXPECT_THAT(undercut.err, HasSubstr("undercut"));
}

TEST(FigureSvaj, ShowsTheLawAndTheBeam) {
    const Folder folder;
    folder.write("law.json", scene_with(kLaw));
    ASSERT_EQ(shell(folder, "$BEAMCAM figure law.json svaj -o a.pdf --data a.csv --set time.end=7").code, 0);
    const output::ColumnTable table = output::read_table(folder / "a.csv");
    const auto peak = [&](const char* column) {
        double most = 0;
        for (const double y : *table.find(column))
            if (std::isfinite(y)) most = std::max(most, std::abs(y));
        return most;
    };
    // The beam is shown over a whole turn alone, here the first.
    EXPECT_THAT(table.names(), ::testing::Contains(HasSubstr("beam")));
    ASSERT_EQ(shell(folder, "$BEAMCAM figure law.json svaj -o d.pdf --data d.csv --set time.end=6").code, 0);
    EXPECT_THAT(testing::slurp(folder / "d.csv"), Not(HasSubstr("beam")));
    const double rise = 8 * std::numbers::pi / 180, over = 100 * std::numbers::pi / 180;
    EXPECT_NEAR(peak("velocity: dθ/dφ"), 2 * rise / over, 1e-6);
    EXPECT_NEAR(peak("acceleration: d²θ/dφ²"), 2 * std::numbers::pi * rise / (over * over), 1e-5);
    EXPECT_NEAR(peak("jerk: d³θ/dφ³"), 4 * std::numbers::pi * std::numbers::pi * rise / std::pow(over, 3), 1e-9);
    EXPECT_EQ(shell(folder, "$BEAMCAM figure law.json svaj -o b.pdf --set cam.speed=0").code, 0);
    EXPECT_EQ(shell(folder, "$BEAMCAM figure law.json svaj -o c.pdf --set cam=null").code, 3);
}

}  // namespace
}  // namespace beamcam::scenes
