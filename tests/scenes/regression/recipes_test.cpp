// The recipes of tests/REGRESSION.md work as written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scenes/regression/guarded.hpp"

namespace beamcam::scenes {
namespace {

using ::testing::AllOf, ::testing::HasSubstr;
using testing::Finished, testing::Guarded, testing::shell, testing::slurp;

const std::filesystem::path kDocument = BEAMCAM_TEST_DIR "/REGRESSION.md";

// The block of indented lines that begins with this one, without the indent.
std::string block(const std::string& first) {
    std::istringstream lines(slurp(kDocument));
    std::string text, line, blank;
    while (std::getline(lines, line)) {
        if (text.empty() && line != "    " + first) continue;
        if (line.empty()) {
            blank += "\n";
        } else if (line.starts_with("    ")) {
            text += std::exchange(blank, "") + line.substr(4) + "\n";
        } else {
            break;
        }
    }
    return text;
}

// What follows a key in the document, such as the command of a CI step.
std::string after(const std::string& key) {
    std::istringstream lines(slurp(kDocument));
    for (std::string line; std::getline(lines, line);)
        if (const std::size_t at = line.find(key); at != std::string::npos) return line.substr(at + key.size());
    return {};
}

// With beamcam on the PATH, and baselines of which one entry differs.
struct Project : Guarded {
    Project() {
        update();
        shell(*this,
              "mv b.json baselines.json; sed -i '0,/{/s/{/{\"references\": \"b\",/' baselines.json; mkdir bin; "
              "ln -s $BEAMCAM bin/beamcam");
        write("s.json", R"({"time": {"end": 0.35}, "title": "other"})");
    }
    Finished run(const std::string& command) const { return shell(*this, "export PATH=$PWD/bin:$PATH; " + command); }
};

TEST(Recipes, StepsOfContinuousIntegrationFailAndLeaveReports) {
    for (const char* key : {"- run: ", "script: "}) {
        const Project project;
        const std::string step = after(key);
        ASSERT_THAT(step, HasSubstr("beamcam test baselines.json")) << key;
        EXPECT_EQ(project.run(step).code, 7) << key;
        EXPECT_TRUE(std::filesystem::exists(project / "report/index.html")) << key;
        project.write("s.json", R"({"time": {"end": 0.35}})");
        EXPECT_EQ(project.run(step).code, 0) << key;
    }
}

TEST(Recipes, CtestRunsThemAsATest) {
    const Project project;
    project.write("CMakeLists.txt", "cmake_minimum_required(VERSION 3.20)\nproject(guarded NONE)\nenable_testing()\n" +
                                        block("add_test(NAME pictures COMMAND beamcam test "
                                              "${CMAKE_CURRENT_SOURCE_DIR}/baselines.json)"));
    const Finished failed =
        project.run("cmake -G Ninja -S . -B build >/dev/null && ctest --test-dir build --output-on-failure");
    EXPECT_EQ(failed.code, 8) << failed.err;
    EXPECT_THAT(failed.out, AllOf(HasSubstr("pictures"), HasSubstr("different   fall")));
    project.write("s.json", R"({"time": {"end": 0.35}})");
    EXPECT_EQ(project.run("ctest --test-dir build").code, 0);
}

TEST(Recipes, PytestMakesAnItemOfEachEntry) {
    const Project project;
    project.write("conftest.py", block("# conftest.py"));
    const std::string command = "/usr/bin/python3 -m pytest -p no:cacheprovider -rf";
    const Finished finished = project.run(command);
    if (finished.err.find("No module named pytest") != std::string::npos) GTEST_SKIP() << "there is no pytest";
    EXPECT_EQ(finished.code, 1) << finished.err;
    EXPECT_THAT(finished.out,
                AllOf(HasSubstr("2 failed, 2 passed"), HasSubstr("::fall"), HasSubstr("of 129600 pixels")));
    project.write("s.json", R"({"time": {"end": 0.35}})");
    EXPECT_EQ(project.run(command).code, 0);
}

}  // namespace
}  // namespace beamcam::scenes
