// What is not done because nobody asks for it, or because it is done already. Counted, never timed.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>

#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

namespace fs = std::filesystem;
using testing::Finished, testing::Folder, testing::shell, testing::slurp;
using ::testing::HasSubstr, ::testing::Not;

// A line for every frame of a film, as FFmpeg decodes and then filters it.
std::string frame_digests(const Folder& folder, const std::string& file, const std::string& filter = {}) {
    return shell(folder, fmt::format("ffmpeg -v error -i {} {} -f framemd5 - | grep -v '^#'", file, filter)).out;
}

// A count of the line that -v ends with.
long count(const Finished& finished, const std::string& what) {
    EXPECT_EQ(finished.code, 0) << finished.err;
    const std::size_t line = finished.err.rfind("work:");
    const std::size_t at = line == std::string::npos ? line : finished.err.find(" " + what + "=", line);
    if (at == std::string::npos) {
        ADD_FAILURE() << "no count of " << what << " in " << finished.err;
        return -1;
    }
    return std::stol(finished.err.substr(at + what.size() + 2));
}

// The compressed pixels of a PNG file, without what it says about itself.
std::string pixels(const fs::path& file) {
    const std::string bytes = slurp(file);
    std::string data;
    for (std::size_t at = 8; at + 12 <= bytes.size();) {
        std::size_t length = 0;
        for (std::size_t i = 0; i < 4; ++i) length = length << 8 | static_cast<unsigned char>(bytes[at + i]);
        if (bytes.compare(at + 4, 4, "IDAT") == 0) data += bytes.substr(at + 8, length);
        at += length + 12;
    }
    EXPECT_GT(data.size(), 100u) << file;
    return data;
}

// Changes whenever the file is replaced or written to.
std::pair<ino_t, long> stamp(const fs::path& file) {
    struct stat status {};
    EXPECT_EQ(stat(file.c_str(), &status), 0) << file;
    return {status.st_ino, status.st_mtim.tv_nsec};
}

constexpr const char* kStill =
    R"({"type": "still", "file": "s.png", "at": 0.29, "size": [320, 180], "view": {"style": "flat"}})";

std::string scene(const std::string& outputs, const std::string& physics = "") {
    return "{" + physics + "\"solver\": {\"method\": \"rk8\"}, \"time\": {\"end\": 0.3}, \"outputs\": [" + outputs +
           "]}";
}

// ---- only what is asked for ----------------------------------------------------------------------

TEST(Skipping, ATableLoadsNeitherFontsNorOpenGlNorTheEncoder) {
    const Folder folder;
    folder.write("s.json", scene(R"({"type": "trajectory", "file": "t.csv", "channels": ["theta"]})"));
    // The dynamic linker tells of every library it opens; fonts and the renderer's module are not even there.
    const Finished run = shell(folder,
                               "BEAMCAM_FONT_DIR=/nowhere BEAMCAM_MODULE_DIR=/nowhere LD_DEBUG=files $BEAMCAM run -v "
                               "s.json");
    EXPECT_EQ(count(run, "integrations"), 1);
    for (const char* what : {"font_sets", "gl_contexts", "encoder_modules", "encoders", "frames_drawn"})
        EXPECT_EQ(count(run, what), 0) << what;
    for (const char* library : {"libOSMesa", "libEGL", "libavcodec", "libavformat", "libx264"})
        EXPECT_THAT(run.err, Not(HasSubstr(library)));
    EXPECT_THAT(run.err, HasSubstr("libc.so"));  // the linker did tell
}

TEST(Skipping, AHorizonTakesASecondIntegration) {
    const Folder folder;
    folder.write("s.json", "{\"time\": {\"end\": 0.3}}");
    EXPECT_EQ(count(shell(folder, "$BEAMCAM simulate s.json --summary - -v"), "integrations"), 1);
    EXPECT_EQ(count(shell(folder, "$BEAMCAM simulate s.json --summary - --horizon -v"), "integrations"), 2);
}

TEST(Skipping, NoContactIsSearchedWhereTheBeamCannotReach) {
    const Folder folder;
    folder.write("s.json", "{}");
    const auto looks = [&](const char* end) {
        return count(shell(folder, fmt::format("$BEAMCAM simulate s.json --summary - -v --set time.end={}", end)),
                     "gap_evaluations");
    };
    EXPECT_EQ(looks("0.15"), 0);
    EXPECT_GT(looks("0.3"), 0);
}

TEST(Skipping, AFlatStillOpensNoOpenGl) {
    const Folder folder;
    folder.write("s.json", scene(kStill));
    const Finished run = shell(folder, "$BEAMCAM run -v s.json");
    EXPECT_EQ(count(run, "gl_contexts"), 0);
    EXPECT_EQ(count(run, "encoder_modules"), 0);
    EXPECT_EQ(count(run, "frames_drawn"), 1);
}

TEST(GlSkipping, AMechanismThatStandsStillIsLitOnce) {
    const Folder folder;
    folder.write("s.json", R"({"cam": null, "gravity": 0, "time": {"end": 0.5}, "outputs": [
        {"type": "frames", "file": "f-##.png", "size": [320, 180], "fps": 12}]})");
    const Finished run = shell(folder, "$BEAMCAM run -v -j 1 s.json");
    EXPECT_EQ(count(run, "frames_drawn"), 6);  // the clock runs
    EXPECT_EQ(count(run, "bodies_drawn"), 1);
    EXPECT_EQ(count(run, "gl_contexts"), 1);
}

// ---- not twice -----------------------------------------------------------------------------------

constexpr const char* kSeveral = R"({"type": "trajectory", "file": "t.csv"}, {"type": "impacts", "file": "i.json"},
    {"type": "summary", "file": "s-summary.json"}, )";

TEST(Skipping, ASecondRunLeavesEverythingAsItIs) {
    const Folder folder;
    folder.write("s.json", scene(std::string(kSeveral) + kStill));
    EXPECT_EQ(count(shell(folder, "$BEAMCAM run -v s.json"), "files_written"), 4);
    const auto before = stamp(folder / "t.csv");
    const Finished again = shell(folder, "$BEAMCAM run -v s.json");
    for (const char* what : {"integrations", "frames_drawn", "files_written", "font_sets"})
        EXPECT_EQ(count(again, what), 0) << what;
    EXPECT_EQ(count(again, "files_left"), 4);
    EXPECT_THAT(again.err, HasSubstr("kept ./t.csv: up to date"));
    EXPECT_EQ(stamp(folder / "t.csv"), before);
    EXPECT_THAT(shell(folder, "$BEAMCAM plan s.json").out, HasSubstr("kept        t.csv"));
    EXPECT_EQ(count(shell(folder, "$BEAMCAM run -v --force s.json"), "files_written"), 4);
    // A file that was changed is not taken for the output, and not replaced either.
    folder.write("t.csv", "mine");
    EXPECT_EQ(shell(folder, "$BEAMCAM run s.json").code, 6);
}

TEST(Skipping, OneChangedOutputIsMadeAlone) {
    const Folder folder;
    folder.write("s.json", scene(std::string(kSeveral) + kStill));
    shell(folder, "$BEAMCAM run s.json");
    const Finished dark = shell(folder, "$BEAMCAM run -v s.json --set outputs.3.theme=dark");
    EXPECT_EQ(count(dark, "integrations"), 1);
    EXPECT_EQ(count(dark, "frames_drawn"), 1);
    EXPECT_EQ(count(dark, "files_left"), 3);
    // The same picture as in a run of all outputs.
    shell(folder, "$BEAMCAM run -q -o fresh s.json --set outputs.3.theme=dark");
    EXPECT_EQ(slurp(folder / "s.png"), slurp(folder / "fresh/s.png"));
    EXPECT_EQ(slurp(folder / "t.csv"), slurp(folder / "fresh/t.csv"));
    // The title is on the picture, not in the data.
    const Finished title = shell(folder, "$BEAMCAM run -v s.json --set outputs.3.theme=dark --set title=x");
    EXPECT_EQ(count(title, "files_left"), 3);
}

TEST(Skipping, ScenesOfOneMotionAreSimulatedOnce) {
    const Folder folder;
    folder.write("a.json", scene(R"({"type": "trajectory", "file": "a.csv"})"));
    folder.write("b.json", scene(R"({"type": "trajectory", "file": "b.csv", "times": [0.2]})"));
    folder.write("c.json", scene(R"({"type": "trajectory", "file": "c.csv"})", R"("cam": {"speed": 2}, )"));
    const Finished all = shell(folder, "$BEAMCAM run -v a.json b.json c.json");
    EXPECT_EQ(count(all, "integrations"), 2);
    EXPECT_EQ(count(all, "files_written"), 3);
    const std::string before = slurp(folder / "b.csv");
    shell(folder, "$BEAMCAM run -q -o alone b.json");
    EXPECT_EQ(before, slurp(folder / "alone/b.csv"));
    // One of three changed.
    const Finished one = shell(folder, "sed -i 's/0.2/0.25/' b.json; $BEAMCAM run -v a.json b.json c.json");
    EXPECT_EQ(count(one, "integrations"), 1);
    EXPECT_EQ(count(one, "files_written"), 1);
    EXPECT_EQ(count(one, "files_left"), 2);
}

// The first run finds the impacts, the second serves all outputs.
TEST(Skipping, AFilmThatSlowsDownAroundImpactsIntegratesTwice) {
    const Folder folder;
    folder.write("s.json", scene(R"({"type": "frames", "file": "f-##.png", "size": [160, 90], "fps": 60, "from": 0.25,
        "speed": {"around": "impacts", "factor": 0.5, "ease": "5 ms"}, "view": {"style": "flat"}},
        {"type": "trajectory", "file": "t.csv", "times": [0.35]})"));
    const Finished run = shell(folder, "$BEAMCAM run -v s.json");
    EXPECT_EQ(count(run, "integrations"), 2);
    EXPECT_GT(count(run, "frames_drawn"), 1);
}

TEST(Skipping, PicturesThatCompareTheSameMotionsIntegrateEachOnce) {
    const Folder folder;
    const std::string compare = R"("size": [320, 180], "view": {"style": "flat"}, "compare": [{"label": "as it is"},
        {"label": "rigid", "set": {"beam.model": "rigid"}}]})";
    folder.write("s.json", scene(R"({"type": "still", "file": "a.png", "at": 0.29, )" + compare +
                                 R"(, {"type": "still", "file": "b.png", "at": 0.1, )" + compare +
                                 R"(, {"type": "trajectory", "file": "t.csv"})"));
    EXPECT_EQ(count(shell(folder, "$BEAMCAM run -v s.json"), "integrations"), 2);
}

// ---- figures ---------------------------------------------------------------------------------------

constexpr const char* kFigures = R"({"type": "figure", "figure": "energy", "file": "e.svg"},
    {"type": "figure", "channels": ["theta_dot"], "file": "p.png", "dpi": 60})";

TEST(Skipping, FiguresShareOneMotionAndFinishedOnesAreLeftAlone) {
    const Folder folder;
    folder.write("s.json", scene(kFigures));
    const Finished first = shell(folder, "$BEAMCAM run -v s.json");
    EXPECT_EQ(count(first, "integrations"), 1);
    EXPECT_EQ(count(first, "figures_drawn"), 2);
    for (const char* what : {"gl_contexts", "encoder_modules", "frames_drawn"})
        EXPECT_EQ(count(first, what), 0) << what;
    const Finished again = shell(folder, "$BEAMCAM run -v s.json");
    EXPECT_EQ(count(again, "files_left"), 2);
    EXPECT_EQ(count(again, "integrations"), 0);
    EXPECT_EQ(count(again, "font_sets"), 0);
    const Finished chinese = shell(folder, "$BEAMCAM run -v s.json --set outputs.0.lang=zh");
    EXPECT_EQ(count(chinese, "figures_drawn"), 1);
    EXPECT_EQ(count(chinese, "files_left"), 1);
    // The instant that a document carries is one of its inputs.
    EXPECT_EQ(
        count(shell(folder, "SOURCE_DATE_EPOCH=86400 $BEAMCAM run -v s.json --set outputs.0.lang=zh"), "figures_drawn"),
        1);
}

TEST(Skipping, AFigureAndItsDataAreLeftAloneOnlyTogether) {
    const Folder folder;
    folder.write("s.json", scene(""));
    const std::string command = "$BEAMCAM figure s.json phase -v -o p.svg --data p.csv";
    EXPECT_EQ(count(shell(folder, command), "files_written"), 2);
    EXPECT_EQ(count(shell(folder, command), "files_left"), 1);
    EXPECT_EQ(count(shell(folder, "rm p.csv; " + command), "files_written"), 2);
}

TEST(Skipping, AFigureSeesNothingOfWhatOtherOutputsLookAt) {
    const Folder folder;
    folder.write("a.json", scene(kFigures));
    folder.write("b.json", scene(std::string(kFigures) + R"(, {"type": "summary", "file": "s.json"},
        {"type": "trajectory", "file": "t.csv", "times": [0.5]})"));
    shell(folder, "$BEAMCAM run -q a.json -o a; $BEAMCAM run -q b.json -o b");
    EXPECT_EQ(pixels(folder / "a/p.png"), pixels(folder / "b/p.png"));
    const auto without_scene = [&](const char* file) {
        return shell(folder, fmt::format("sed 's/<metadata.*//; /beamcam-scene/d' {}", file)).out;
    };
    EXPECT_EQ(without_scene("a/e.svg"), without_scene("b/e.svg"));
}

TEST(Skipping, ScenesThatWouldWriteOneFileAreRefusedBeforeAnyWork) {
    const Folder folder;
    folder.write("a.json", scene(R"({"type": "trajectory", "file": "t.csv"})"));
    folder.write("b.json", scene(R"({"type": "trajectory", "file": "t.csv"})"));
    const Finished run = shell(folder, "$BEAMCAM run a.json b.json");
    EXPECT_EQ(run.code, 2);
    EXPECT_THAT(run.err, HasSubstr("b.json:1:65: t.csv and a.json:1:65: t.csv"));
    EXPECT_FALSE(fs::exists(folder / "t.csv"));
}

// ---- sequences, parts ----------------------------------------------------------------------------

constexpr const char* kFrames = R"({"type": "frames", "file": "f-###.png", "size": [320, 180], "fps": 40, "from": 0.1,
    "view": {"style": "flat"}})";

TEST(Skipping, AnInterruptedSequenceResumes) {
    const Folder folder;
    folder.write("s.json", scene(kFrames));
    EXPECT_EQ(count(shell(folder, "$BEAMCAM run -v s.json -o whole"), "frames_drawn"), 8);
    shell(folder, "cp -a whole part; cd part; rm f-005.png f-009.png");
    const Finished rest = shell(folder, "$BEAMCAM run -v s.json -o part");
    EXPECT_EQ(count(rest, "frames_drawn"), 2);
    EXPECT_EQ(count(rest, "frames_left"), 6);
    EXPECT_EQ(shell(folder, "for f in whole/f-*.png; do cmp $f part/${f#whole/} || exit 1; done").code, 0);
    EXPECT_EQ(count(shell(folder, "$BEAMCAM run -v s.json -o part"), "files_left"), 1);
}

// How many frames there are, only the impacts tell.
TEST(Skipping, AnInterruptedSequenceInSlowMotionResumes) {
    const Folder folder;
    folder.write("s.json", scene(R"({"type": "frames", "file": "f-###.png", "size": [320, 180], "fps": 10, "from": 0.27,
        "view": {"style": "flat"}, "speed": {"around": "impacts", "factor": 0.02}})"));
    const int all = count(shell(folder, "$BEAMCAM run -v s.json -o whole"), "frames_drawn");
    ASSERT_GT(all, 4);
    // Files of other makers with numbers alike are none of its frames.
    shell(folder, "cp -a whole part; cd part; rm f-004.png; cp f-005.png f-0005.png; touch f-a.png");
    const Finished rest = shell(folder, "$BEAMCAM run -v s.json -o part");
    EXPECT_EQ(count(rest, "frames_drawn"), 1) << rest.err;
    EXPECT_EQ(count(rest, "frames_left"), all - 1);
    EXPECT_EQ(shell(folder, "for f in whole/f-*.png; do cmp $f part/${f#whole/} || exit 1; done").code, 0);
    const Finished none = shell(folder, "$BEAMCAM run -v s.json -o part");
    EXPECT_EQ(none.code, 0) << none.err;
    EXPECT_EQ(count(none, "frames_drawn"), 0);
    // Another scene leaves none of them.
    shell(folder, "sed -i 's/0.02/0.04/' s.json");
    EXPECT_EQ(count(shell(folder, "$BEAMCAM run -v s.json -o part"), "frames_left"), 0);
}

TEST(Skipping, AnotherOutputThatLooksFurtherLeavesThePixelsAsTheyWere) {
    const Folder folder;
    const std::string still =
        R"({"type": "still", "file": "s.png", "at": 0.278, "size": [640, 360], "view": {"style": "flat"}})";
    folder.write("a.json", "{\"outputs\": [" + still + "]}");
    folder.write("b.json",
                 "{\"outputs\": [" + still + R"(, {"type": "trajectory", "file": "t.csv", "times": [0.9]}]})");
    shell(folder, "$BEAMCAM run -q a.json -o a; $BEAMCAM run -q b.json -o b");
    EXPECT_EQ(pixels(folder / "a/s.png"), pixels(folder / "b/s.png"));
}

TEST(Skipping, WithAVariableRateAFrozenPictureIsCodedOnce) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.4}, "outputs": [{"type": "video", "file": "f.mkv", "size": [320, 180],
        "fps": 20, "view": {"style": "flat"}, "events": [{"at": 0.2, "freeze": 1}]}]})");
    const auto run = [&](const char* file, const char* mode) {
        return shell(folder, fmt::format("$BEAMCAM run -v s.json --set outputs.0.file={} --set outputs.0.rate_mode={}",
                                         file, mode));
    };
    const Finished constant = run("c.mkv", "constant"), variable = run("v.mkv", "variable");
    EXPECT_EQ(count(constant, "frames_encoded"), 28);
    const long repeated = count(variable, "frames_repeated");
    EXPECT_GE(repeated, 18);
    EXPECT_EQ(count(variable, "frames_repeated"), count(constant, "frames_repeated"));
    EXPECT_EQ(count(variable, "frames_encoded"), 28 - repeated);
    const auto digests = [&](const char* file) { return frame_digests(folder, file, "-vf fps=20"); };
    EXPECT_EQ(std::ranges::count(digests("v.mkv"), '\n'), 28);
    EXPECT_EQ(digests("v.mkv"), digests("c.mkv"));
}

}  // namespace
}  // namespace beamcam::scenes
