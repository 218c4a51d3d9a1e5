// `beamcam info` and `beamcam doctor`.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

using testing::Finished, testing::Folder, testing::shell;
using ::testing::HasSubstr, ::testing::Not;

constexpr const char* kEveryOutput = R"({"title": "θ", "time": {"end": 0.3}, "outputs": [
    {"type": "still", "file": "a.png", "at": 0.2, "size": [192, 108], "view": {"style": "flat"}},
    {"type": "video", "file": "a.mp4", "fps": 20, "size": [192, 108], "view": {"style": "flat"}},
    {"type": "trajectory", "file": "a.npz", "rate": 50, "channels": ["theta"]},
    {"type": "trajectory", "file": "a.csv", "rate": 50, "channels": ["theta"]},
    {"type": "impacts", "file": "a.json"}]})";

TEST(Info, EveryOutputGivesBackASceneThatMakesItAgain) {
    const Folder folder;
    folder.write("s.json", kEveryOutput);
    ASSERT_EQ(shell(folder, "$BEAMCAM run -q s.json").code, 0);
    for (const char* file : {"a.png", "a.mp4", "a.npz", "a.csv", "a.json"}) {
        const Finished info = shell(folder, std::string("$BEAMCAM info ") + file);
        EXPECT_EQ(info.code, 0) << info.err;
        EXPECT_THAT(info.out, HasSubstr("made by        beamcam 0.")) << file;
        const std::string again =
            std::string("$BEAMCAM info --scene ") + file + " > again.json && $BEAMCAM run -q again.json -o again";
        EXPECT_EQ(shell(folder, again).code, 0) << file;
        const std::string ending = std::string(file).substr(1);
        if (ending == ".mp4")
            EXPECT_EQ(shell(folder,
                            "ffmpeg -v error -y -i a.mp4 -f framemd5 one.txt && ffmpeg -v error -y -i again/a.mp4 -f "
                            "framemd5 two.txt && cmp one.txt two.txt")
                          .code,
                      0);
        else if (ending == ".png")
            EXPECT_EQ(shell(folder, std::string("$BEAMCAM diff a") + ending + " again/a" + ending).code, 0) << file;
        else
            EXPECT_EQ(testing::slurp(folder / file), testing::slurp(folder / ("again/" + std::string(file)))) << file;
        std::filesystem::remove_all(folder / "again");
    }
    EXPECT_THAT(shell(folder, "$BEAMCAM info a.mp4").out, HasSubstr("frames         6"));
    ASSERT_EQ(shell(folder,
                    "for e in webm gif; do $BEAMCAM render -q s.json --style flat --fps 10 --size 96x64 -o b.$e; done")
                  .code,
              0);
    for (const char* file : {"b.webm", "b.gif"})
        EXPECT_EQ(shell(folder, std::string("$BEAMCAM info --scene ") + file +
                                    " > again.json && $BEAMCAM run -q again.json -o again && ffmpeg -v error -y -i " +
                                    file + " -f framemd5 one.txt && ffmpeg -v error -y -i again/" + file +
                                    " -f framemd5 two.txt && cmp one.txt two.txt")
                      .code,
                  0)
            << file;
    EXPECT_THAT(shell(folder, "$BEAMCAM info a.png --json").out, HasSubstr("\"title\": \"θ\""));
}

TEST(Info, FiguresGiveBackTheSceneThatMakesTheSameBytes) {
    const Folder folder;
    folder.write("s.json", R"({"title": "a < b & θ", "cam": {"speed": 2}})");
    for (const char* file : {"deflection.svg", "deflection.pdf", "deflection.png"}) {
        const std::string name(file);
        ASSERT_EQ(shell(folder, "$BEAMCAM figure -q s.json deflection --lang zh --column aps -o " + name).code, 0);
        EXPECT_THAT(shell(folder, "$BEAMCAM info " + name).out, HasSubstr("made by        beamcam 0."));
        ASSERT_EQ(shell(folder, "$BEAMCAM info --scene " + name + " > t.json && $BEAMCAM run -q t.json -o again").code,
                  0);
        EXPECT_EQ(testing::slurp(folder / name), testing::slurp(folder / ("again/" + name))) << name;
    }
}

// Files name their outputs without folders, so the same film has the same bytes everywhere.
TEST(Info, FilesAreTheSameBytesInEveryFolder) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.1}})");
    ASSERT_EQ(
        shell(folder,
              R"(mkdir one two; for d in one "$PWD/two"; do small="$BEAMCAM render -q s.json --style flat --size 96x64"
        $small --at 0.05 -o "$d/a.png" && $small --to 0.05 -o "$d/a.mp4" && $small --to 0.05 -o "$d/a.gif" &&
        $BEAMCAM render -q s.json -o "$d/a.html" || exit; done)")
            .code,
        0);
    for (const std::string ending : {"png", "mp4", "gif", "html"}) {
        const std::string one = testing::slurp(folder / ("one/a." + ending));
        EXPECT_EQ(one, testing::slurp(folder / ("two/a." + ending))) << ending;
        EXPECT_THAT(one, Not(HasSubstr("one/"))) << ending;
        EXPECT_THAT(shell(folder, "$BEAMCAM info --json one/a." + ending).out,
                    HasSubstr(fmt::format("\"file\": \"a.{}\"", ending)));
    }
    EXPECT_EQ(
        shell(folder, "$BEAMCAM info --scene one/a.mp4 | $BEAMCAM run -q - -o again && cmp one/a.mp4 again/a.mp4").code,
        0);
    EXPECT_THAT(shell(folder, "$BEAMCAM render s.json --style flat --size 96x64 --at 0.05 -o \"$PWD/one/a.png\"").err,
                HasSubstr("up to date"));
}

TEST(Info, OutputsOfOneNameInTwoFoldersKeepTheirFolders) {
    const Folder folder;
    folder.write("s.json",
                 R"({"outputs": [{"type": "summary", "file": "a/x.json"}, {"type": "summary", "file": "b/x.json"}]})");
    ASSERT_EQ(shell(folder, "$BEAMCAM run -q s.json").code, 0);
    const Finished scene = shell(folder, "$BEAMCAM info --scene a/x.json");
    EXPECT_THAT(scene.out, HasSubstr("\"a/x.json\""));
    EXPECT_EQ(shell(folder, "$BEAMCAM info --scene a/x.json | $BEAMCAM check -").code, 0);
}

TEST(Info, AStillNamedByAnAbsolutePathGivesASceneThatCanBeRun) {
    const Folder folder;
    folder.write("s.json", "{}");
    ASSERT_EQ(shell(folder, "$BEAMCAM render -q s.json --style flat --at 0.1 --size 96x96 -o \"$PWD/x.png\"").code, 0);
    EXPECT_EQ(shell(folder,
                    "$BEAMCAM info x.png --scene > t.json && $BEAMCAM run -q t.json -o again && $BEAMCAM diff x.png "
                    "again/x.png")
                  .code,
              0);
}

TEST(Info, PagesFiguresAndTheFilesBesideThemAreKnownByTheListOfFiles) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.3}})");
    ASSERT_EQ(shell(folder,
                    "$BEAMCAM render -q s.json -o a.html && "
                    "$BEAMCAM figure -q s.json --channels theta -o f.svg --data f.csv --caption f.txt")
                  .code,
              0);
    for (const auto& [file, kind] : {std::pair{"a.html", "page"}, std::pair{"f.svg", "SVG figure"},
                                     std::pair{"f.csv", "table"}, std::pair{"f.txt", "caption"}}) {
        const Finished info = shell(folder, std::string("$BEAMCAM info ") + file);
        EXPECT_THAT(info.out, HasSubstr(fmt::format("{}: {}\n", file, kind))) << info.err;
        EXPECT_THAT(info.out, HasSubstr("made by        beamcam 0.")) << file;
        EXPECT_EQ(
            shell(folder, fmt::format("$BEAMCAM info {} --scene > x.json && $BEAMCAM check -q x.json", file)).code, 0)
            << file;
    }
}

TEST(Info, ForeignAndDamagedFilesAreDistinguished) {
    const Folder folder;
    folder.write("s.json", kEveryOutput);
    ASSERT_EQ(shell(folder, "$BEAMCAM run -q s.json && ffmpeg -v error -i a.png -map_metadata -1 f.png").code, 0);
    const Finished foreign = shell(folder, "$BEAMCAM info f.png");
    EXPECT_EQ(foreign.code, 0);
    EXPECT_THAT(foreign.out, HasSubstr("not by beamcam"));
    EXPECT_EQ(shell(folder, "$BEAMCAM info f.png --scene").code, 6);
    folder.write("a.csv", "t,theta\n0,1\n");
    EXPECT_THAT(shell(folder, "$BEAMCAM info a.csv").out, HasSubstr("changed since  yes"));
    const std::string film = testing::slurp(folder / "a.mp4");
    folder.write("cut.mp4", film.substr(0, 40));
    for (const char* file : {"cut.mp4", "absent.png", "."})
        EXPECT_EQ(shell(folder, std::string("$BEAMCAM info ") + file).code, 6) << file;
}

TEST(GlDoctor, NamesThePackageOfWhatIsMissing) {
    const Folder folder;
    const Finished whole = shell(folder, "$BEAMCAM doctor");
    EXPECT_EQ(whole.code, 0) << whole.out;
    EXPECT_THAT(whole.out, HasSubstr("cairo"));
    const Finished fonts = shell(folder, "BEAMCAM_FONT_DIR=/nowhere $BEAMCAM doctor --json");
    EXPECT_EQ(fonts.code, 5);
    EXPECT_THAT(fonts.out, HasSubstr("fonts-inter"));
    const Finished gl = shell(folder, "BEAMCAM_MODULE_DIR=/nowhere $BEAMCAM doctor");
    EXPECT_EQ(gl.code, 5);
    EXPECT_THAT(gl.out, HasSubstr("libosmesa6"));
}

// Both ways to OpenGL without a display come to the same driver. Of each kind of view one picture.
TEST(GlWays, OsmesaAndEglDrawTheSamePixels) {
    const Folder folder;
    folder.write("s.json", "{}");
    for (const char* way : {"osmesa", "egl"})
        if (const Finished doctor = shell(folder, fmt::format("BEAMCAM_GL={} $BEAMCAM doctor", way)); doctor.code != 0)
            GTEST_SKIP() << way << ": " << doctor.out;
    for (const char* style : {"lit", "solid"}) {
        for (const char* way : {"osmesa", "egl"})
            ASSERT_EQ(shell(folder, fmt::format("BEAMCAM_GL={0} $BEAMCAM render s.json -o {0}.png --at 0.3 --size "
                                                "320x180 --style {1} --force",
                                                way, style))
                          .code,
                      0);
        EXPECT_EQ(shell(folder, "$BEAMCAM diff osmesa.png egl.png").code, 0) << style;
    }
    const auto fingerprint = [&](const char* way) {
        return shell(folder, fmt::format("BEAMCAM_GL={} $BEAMCAM doctor --json | grep -A9 fingerprint", way)).out;
    };
    EXPECT_EQ(fingerprint("osmesa"), fingerprint("egl"));
}

TEST(GlWays, AnUnknownWayIsRejectedWithTheKnownOnes) {
    const Folder folder;
    folder.write("s.json", "{}");
    const Finished unknown = shell(folder, "BEAMCAM_GL=vulkan $BEAMCAM render s.json -o x.png --at 0 --style lit 2>&1");
    EXPECT_EQ(unknown.code, 5);
    EXPECT_THAT(unknown.out, HasSubstr("osmesa or egl"));
}

// Drivers that this machine lacks, and switches that make Mesa crash.
TEST(GlEnvironment, SettingsOfMesaAreIgnoredAndNamed) {
    const Folder folder;
    folder.write("s.json", "{}");
    const char* render = "$BEAMCAM render s.json -o x.png --at 0 --size 64x48 --force";
    ASSERT_EQ(shell(folder, std::string(render) + "; picture_hash x.png >a").code, 0);
    for (const char* setting :
         {"GALLIUM_DRIVER=d3d12", "GALLIUM_DRIVER=zink", "GALLIUM_DRIVER=virpipe", "GALLIUM_DRIVER=softpipe",
          "GALLIUM_DRIVER=nonsense", "DRAW_USE_LLVM=0", "LP_NATIVE_VECTOR_WIDTH=512", "LP_NATIVE_VECTOR_WIDTH=64",
          "MESA_EXTENSION_OVERRIDE=-GL_ARB_vertex_array_object", "MESA_GL_VERSION_OVERRIDE=2.1",
          "MESA_GLSL_VERSION_OVERRIDE=110", "LIBGL_ALWAYS_INDIRECT=1"}) {
        const Finished doctor = shell(folder, std::string(setting) + " $BEAMCAM doctor");
        EXPECT_EQ(doctor.code, 0) << setting << doctor.out;
        EXPECT_THAT(doctor.out, HasSubstr(setting));
        const Finished drawn =
            shell(folder, std::string("export ") + setting + "; " + render + " && picture_hash x.png | cmp - a");
        EXPECT_EQ(drawn.code, 0) << setting << drawn.err;
        EXPECT_THAT(drawn.err, HasSubstr(setting));
    }
    EXPECT_THAT(shell(folder, std::string("LP_NUM_THREADS=0 GALLIUM_DRIVER=llvmpipe ") + render).err,
                ::testing::Not(HasSubstr("ignored")));
}

}  // namespace
}  // namespace beamcam::scenes
