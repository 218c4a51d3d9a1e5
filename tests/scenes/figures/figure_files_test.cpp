// The files of a figure: fonts, data and caption.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "scenes/format/embedded.hpp"
#include "tests/scenes/figures/simulated.hpp"

namespace beamcam::scenes {
namespace {

using testing::Folder;
using ::testing::HasSubstr;
using testing::shell;
using ::testing::StartsWith;

TEST(FigureFiles, PdfHasTrueTypeSubsetsItsSceneAndTheSameBytesTwice) {
    const Folder folder;
    folder.write("s.json", R"({"title": "x"})");
    for (const char* lang : {"en", "zh"}) {
        const std::string make = fmt::format("$BEAMCAM figure s.json schematic --lang {} -q --force -o ", lang);
        ASSERT_EQ(shell(folder, make + "a.pdf && " + make + "b.pdf && " + make + "a.svg && " + make + "b.svg").code, 0);
        EXPECT_EQ(testing::slurp(folder / "a.pdf"), testing::slurp(folder / "b.pdf"));
        EXPECT_EQ(testing::slurp(folder / "a.svg"), testing::slurp(folder / "b.svg"));
        EXPECT_THAT(testing::slurp(folder / "a.svg"), HasSubstr("\"youngs_modulus\""));
    }
}

TEST(FigureFiles, PdfFontsAreEmbeddedTrueType) {
    const Folder folder;
    folder.write("s.json", R"({"cam": null, "time": {"end": 0.4}})");
    if (shell(folder, "command -v pdffonts").code != 0) GTEST_SKIP() << "needs pdffonts (Debian: poppler-utils)";
    for (const char* lang : {"en", "zh"}) {
        ASSERT_EQ(
            shell(folder, fmt::format("$BEAMCAM figure s.json free-fall --lang {} -q --force -o a.pdf", lang)).code, 0);
        std::istringstream fonts(shell(folder, "pdffonts a.pdf").out);
        std::string line;
        std::getline(fonts, line);
        std::getline(fonts, line);
        int count = 0;
        for (; std::getline(fonts, line); ++count) {
            EXPECT_THAT(line, HasSubstr("TrueType"));
            EXPECT_THAT(line, HasSubstr(" yes yes "));  // embedded, subset
        }
        EXPECT_GE(count, 2);
    }
    // 90 mm by what suits the figure, to a hundredth of a point.
    EXPECT_THAT(shell(folder, "pdfinfo a.pdf").out, HasSubstr("255.118 x"));
    EXPECT_THAT(shell(folder, "pdfinfo a.pdf").out, HasSubstr("beamcam"));
}

TEST(FigureFiles, DataAndCaptionLieBesideThem) {
    const Folder folder;
    folder.write("s.json", "{}");
    ASSERT_EQ(shell(folder, "$BEAMCAM figure s.json deflection -o a.png --data a.csv --caption a.txt -q").code, 0);
    EXPECT_THAT(testing::slurp(folder / "a.csv"), StartsWith("horizontal distance x from O / m,"));
    EXPECT_THAT(testing::slurp(folder / "a.txt"), HasSubstr("All parameters have their default values."));
    EXPECT_THAT(testing::slurp(folder / "a.png"), HasSubstr("pHYs"));
    EXPECT_THAT(testing::slurp(folder / "a.png"), HasSubstr("beamcam-scene"));
}

TEST(FigureFiles, RunMakesThoseThatASceneLists) {
    const Folder folder;
    folder.write("s.json",
                 R"({"outputs": [{"type": "figure", "figure": "schematic", "file": "a.svg", "column": "nature"}]})");
    EXPECT_THAT(shell(folder, "$BEAMCAM plan s.json").out, HasSubstr("figure      a.svg: schematic"));
    ASSERT_EQ(shell(folder, "$BEAMCAM run s.json -q").code, 0);
    EXPECT_THAT(testing::slurp(folder / "a.svg"), HasSubstr("width=\"89mm\""));
}

}  // namespace
}  // namespace beamcam::scenes
