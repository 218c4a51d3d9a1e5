// The figure "table", and labels and units of axes.
#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

using testing::Finished;
using testing::Folder;
using ::testing::HasSubstr;
using testing::shell;

TEST(TableFigure, ShowsColumnsInTheUnitsThatAreAskedFor) {
    const Folder folder;
    folder.write("peaks.csv", "cam.speed,force_peak,stress_peak\n10,1000,2e8\n20,3000,3e8\n30,,4e8\n");
    const std::string command = "$BEAMCAM figure peaks.csv --x cam.speed --channels ";
    const Finished made =
        shell(folder, command + "force_peak --unit kN --x-unit rpm --x-label speed -o f.svg --data f.csv");
    EXPECT_EQ(made.code, 0) << made.err;
    EXPECT_THAT(testing::slurp(folder / "f.csv"),
                ::testing::StartsWith("speed / rpm,force_peak: largest F / kN\n95.492965855"));
    EXPECT_EQ(shell(folder, command + "force_peak,stress_peak -o two.pdf").code, 0);
    // Also as an output of a scene, which is made again when the table changes.
    folder.write("s.json", R"({"outputs": [{"type": "figure", "figure": "table", "file": "t.pdf",
        "table": {"file": "peaks.csv", "x": "cam.speed", "y": ["stress_peak"], "unit": "MPa", "label": "stress"}}]})");
    EXPECT_THAT(shell(folder, "$BEAMCAM run s.json").err, HasSubstr("t.pdf"));
    EXPECT_THAT(shell(folder, "$BEAMCAM plan s.json").out, HasSubstr("kept"));
    folder.write("peaks.csv", "cam.speed,stress_peak\n10,2e8\n20,3e8\n");
    EXPECT_THAT(shell(folder, "$BEAMCAM plan s.json").out, ::testing::Not(HasSubstr("kept")));
}

// Headings may state units; samples of several motions go forth and back and are not joined.
TEST(TableFigure, ReadsTablesOfOtherPrograms) {
    const Folder folder;
    folder.write("rig.csv", "Time (ms);Force (kN);note\n0;1,5;a\n2;2,5;b\n1;0,5;c\n");
    const Finished made =
        shell(folder, "$BEAMCAM figure rig.csv --x 'Time (ms)' --channels 'Force (kN)' --unit N -o f.svg --data f.csv");
    EXPECT_EQ(made.code, 0) << made.err;
    EXPECT_THAT(testing::slurp(folder / "f.csv"), HasSubstr("2500"));
    std::string many = "x,y\n";
    for (int i = 0; i < 90; ++i) many += std::to_string(i / 3) + "," + std::to_string(i % 7) + "\n";
    folder.write("many.csv", many);
    shell(folder, "$BEAMCAM figure many.csv --x x --channels y -o m.svg --data m.csv");
    EXPECT_THAT(testing::slurp(folder / "m.csv"), ::testing::StartsWith("panel,series,"));  // points, not a curve
    EXPECT_EQ(shell(folder, "$BEAMCAM figure rig.csv").out, "Time (ms)\nForce (kN)\nnote\n");
}

TEST(TableFigure, SaysWhatATableLacks) {
    const Folder folder;
    folder.write("peaks.csv", "cam.speed,force_peak,stress_peak\n10,1000,2e8\n");
    const auto told = [&](const std::string& options) {
        const Finished made = shell(folder, "$BEAMCAM figure peaks.csv -o f.pdf " + options);
        EXPECT_EQ(made.code, 2) << options;
        return made.err;
    };
    EXPECT_THAT(told("--x cam.speed"),
                HasSubstr("name the columns with --x and --channels; it has cam.speed, force_peak, stress_peak"));
    EXPECT_THAT(told("--x cam.speed --channels force"),
                HasSubstr("has no column \"force\"; did you mean \"force_peak\""));
    EXPECT_THAT(told("--x cam.speed --channels xyz"), HasSubstr("cam.speed, force_peak, stress_peak"));
    EXPECT_THAT(told("--x cam.speed --channels force_peak --unit mm"),
                HasSubstr("the column \"force_peak\" is in N; leave the unit out, or draw this column alone"));
    EXPECT_THAT(told("--x cam.speed --channels force_peak,stress_peak --label F"),
                HasSubstr("several units and panels; name columns of one unit"));
    EXPECT_THAT(told("--x cam.speed --channels force_peak --impacts"), HasSubstr("--impacts needs a scene"));
    EXPECT_THAT(shell(folder, "$BEAMCAM figure peaks.csv energy -o f.pdf").err,
                HasSubstr("figure energy needs a scene"));
    EXPECT_THAT(testing::read(R"({"outputs": [{"type": "figure", "figure": "table"}]})").report(),
                HasSubstr("needs \"table\""));
}

TEST(Units, OfAxesAreThoseThatTheKeysName) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.3}})");
    const Finished made = shell(folder,
                                "$BEAMCAM figure s.json -q --channels contact_force --unit kN --label load --x-unit ms "
                                "--x-label time --from 0.27 -o f.svg --data f.csv");
    EXPECT_EQ(made.code, 0) << made.err;
    EXPECT_EQ(testing::slurp(folder / "f.csv").substr(0, 9), "time / ms");
    EXPECT_THAT(shell(folder, "$BEAMCAM figure s.json --channels theta --unit kN -o f.svg").err,
                HasSubstr("--unit = \"kN\" is not a unit of this axis, which shows rad"));
}

}  // namespace
}  // namespace beamcam::scenes
