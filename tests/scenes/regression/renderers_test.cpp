// Baselines of several machines: what a renderer of which nothing is accepted yet comes to, and the pictures and
// tolerances that each has of its own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/motions/fingerprint.hpp"
#include "scenes/regression/regression.hpp"
#include "tests/scenes/regression/guarded.hpp"

namespace beamcam::scenes {
namespace {

using ::testing::AllOf, ::testing::HasSubstr, ::testing::Not;
using testing::Finished, testing::Guarded, testing::shell, testing::slurp;

const std::string kTest = "$BEAMCAM test b.json --only fast";

// An entry is guarded on another machine.
struct Machines : Guarded {
    explicit Machines(const std::string& which = "fast") : entry(which) {}
    const std::string entry, here = flat_fingerprint().id(), first = "b/" + entry + "/0000.png",
                             own = "b/" + entry + "/0000-" + here + ".png";

    std::string digest(const std::string& file) const {
        return shell(*this, "$BEAMCAM hash " + file).out.substr(0, 64);
    }
    // A reference as if a renderer had drawn it whose pictures are these ones filtered.
    void filter(const std::string& file, const std::string& how) const {
        const std::string bytes = "sha256sum " + file + " | cut -c1-64", marker = "b/" + entry + "/.beamcam-reference",
                          before = shell(*this, bytes).out.substr(0, 64), pixels = digest(file);
        ASSERT_EQ(shell(*this, "ffmpeg -v error -i " + file + " -vf '" + how + "' -y x.png && mv x.png " + file).code,
                  0);
        swap(marker, before, shell(*this, bytes).out.substr(0, 64));
        swap(marker, pixels, digest(file));
        swap("b.json", pixels, digest(file));
    }
    void accept_of_another(const std::string& how) const {
        shell(*this, "$BEAMCAM test b.json --update " + entry);
        filter(first, how);
        swap("b.json", R"("renderer": ")" + here, R"("renderer": "0123456789ab)");
        swap("b.json", "\"" + here + "\": {", "\"0123456789ab\": {");
        swap("b.json", R"("freetype": ")" + flat_fingerprint().parts.at("freetype"), R"("freetype": "2.0.0)");
    }
};

TEST(Renderers, SimilarPicturesOfANewRendererPassOnRequest) {
    const Machines folder;
    folder.accept_of_another("lutrgb=r=max(val-9\\,0)");
    const std::string renderer = flat_fingerprint().id(), accepted = slurp(folder / "b.json");
    const std::string command = "$BEAMCAM test b.json --only fast";
    for (const char* policy : {"", " --on-new-renderer fail"}) {
        const Finished fails = shell(folder, command + policy);
        EXPECT_EQ(fails.code, 7) << fails.err;
        EXPECT_THAT(fails.out, AllOf(HasSubstr("new-renderer"), HasSubstr(renderer),
                                     HasSubstr("the nearest is 0123456789ab, with freetype 2.0.0 for ")));
    }
    EXPECT_EQ(shell(folder, command + " --on-new-renderer any").code, 2);
    const Finished warns = shell(folder, command + " --on-new-renderer warn --junit j.xml");
    EXPECT_EQ(warns.code, 0) << warns.out;
    EXPECT_THAT(warns.out, AllOf(HasSubstr("new-renderer"), HasSubstr(renderer)));
    EXPECT_THAT(slurp(folder / "j.xml"), HasSubstr("failures=\"0\""));
    EXPECT_EQ(slurp(folder / "b.json"), accepted);
    EXPECT_EQ(shell(folder, command + " --on-new-renderer warn --strict").code, 0);
    EXPECT_EQ(shell(folder, command + " --on-new-renderer accept").code, 0);
    EXPECT_NE(slurp(folder / "b.json"), accepted);
    EXPECT_EQ(shell(folder, command + " --strict").code, 0);

    const Machines other;
    other.accept_of_another("negate");
    for (const char* policy : {"warn", "accept"}) {
        const Finished differs = shell(other, command + " --on-new-renderer " + policy);
        EXPECT_EQ(differs.code, 7);
        EXPECT_THAT(differs.out, HasSubstr("different   fast"));
    }
}

TEST(Renderers, ANewRendererExcusesNoMotion) {
    EntryResult entry;
    entry.picture = Verdict::new_renderer;
    entry.motion = Verdict::equivalent;
    EXPECT_TRUE((PassRule{.strict = false, .new_renderer = NewRenderer::warn}.passes(entry)));
    EXPECT_FALSE((PassRule{.strict = true, .new_renderer = NewRenderer::warn}.passes(entry)));
}

TEST(Renderers, EachHasItsOwnPicturesSideBySide) {
    const Machines folder;
    folder.accept_of_another("lutrgb=r=max(val-9\\,0)");
    const std::string others = folder.digest("b/fast/0000.png");
    EXPECT_EQ(shell(folder, kTest + " --add-digest").code, 7);
    EXPECT_EQ(folder.digest("b/fast/0000.png"), others);
    ASSERT_TRUE(std::filesystem::exists(folder / folder.own));
    EXPECT_THAT(slurp(folder / "b.json"), AllOf(HasSubstr(others), HasSubstr(folder.digest(folder.own))));
    const Finished same = shell(folder, kTest + " --strict --json");
    EXPECT_EQ(same.code, 0) << same.out;
    shell(folder, "sed -i 's/cam.speed=5/cam.speed=6/' b.json");
    const Finished changed = shell(folder, kTest);
    EXPECT_EQ(changed.code, 7);
    EXPECT_THAT(changed.out, AllOf(HasSubstr("different   fast"), HasSubstr("expected    " + folder.own)));
    // What is replaced is so for all: the pictures of the others are those of what was before.
    EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --update fast").code, 7);
    EXPECT_FALSE(std::filesystem::exists(folder / folder.own));
    EXPECT_THAT(slurp(folder / "b.json"), Not(HasSubstr("0123456789ab")));
    EXPECT_EQ(shell(folder, kTest + " --strict").code, 0);
}

TEST(Renderers, PicturesOfOthersStayWhereTheMotionAloneIsNew) {
    const Machines folder;
    folder.accept_of_another("lutrgb=r=max(val-9\\,0)");
    EXPECT_EQ(shell(folder, kTest + " --add-digest").code, 7);
    const std::string others = folder.digest("b/fast/0000.png"), own = folder.digest(folder.own);
    folder.swap("b.json", R"("cam.speed=5")", R"("cam.speed=5", "solver.rtol=1e-9")");
    EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --update fast").code, 7);
    EXPECT_EQ(folder.digest("b/fast/0000.png"), others);
    EXPECT_EQ(folder.digest(folder.own), own);
    EXPECT_THAT(slurp(folder / "b.json"), AllOf(HasSubstr("0123456789ab"), HasSubstr(others), HasSubstr(own)));
    EXPECT_EQ(shell(folder, kTest + " --strict").code, 0);
}

TEST(Renderers, ThoseThatDrawAlikeShareAPicture) {
    const Machines folder("hit");
    folder.accept_of_another("lutrgb=r=max(val-9\\,0)");  // the first of two pictures
    for (const char* way : {"--add-digest", "--on-new-renderer warn --report r; $BEAMCAM accept r"}) {
        const std::string text = slurp(folder / "b.json"), command = "$BEAMCAM test b.json --only hit ";
        shell(folder, command + way);
        EXPECT_TRUE(std::filesystem::exists(folder / folder.own)) << way;
        EXPECT_FALSE(std::filesystem::exists(folder / ("b/hit/0001-" + folder.here + ".png"))) << way;
        const std::string added = slurp(folder / "b.json");
        EXPECT_EQ(shell(folder, command + "--strict --add-digest").code, 0) << way;  // nothing is left to add
        EXPECT_EQ(slurp(folder / "b.json"), added) << way;
        folder.write("b.json", text);
        std::filesystem::remove(folder / folder.own);
    }
}

TEST(Renderers, ReportsOfOtherMachinesBringTheirPictures) {
    const Machines folder;
    folder.accept_of_another("lutrgb=r=max(val-9\\,0)");
    ASSERT_EQ(shell(folder, kTest + " --on-new-renderer warn --report r").code, 0);
    const Finished accepted = shell(folder, "$BEAMCAM accept r");
    EXPECT_EQ(accepted.out, "added     fast\n") << accepted.err;
    EXPECT_EQ(folder.digest(folder.own), folder.digest("r/fast/0000-actual.png"));
    EXPECT_EQ(shell(folder, kTest + " --strict").code, 0);
}

TEST(Renderers, APictureOfOneIsNotThatOfAnother) {
    const Machines folder;
    folder.accept_of_another("lutrgb=r=max(val-9\\,0)");
    shell(folder, kTest + " --add-digest");
    const std::string right = slurp(folder / folder.own);
    shell(folder, "ffmpeg -v error -i b/fast/0000.png -vf negate -y " + folder.own);
    const Finished exchanged = shell(folder, kTest);
    EXPECT_EQ(exchanged.code, 7);
    EXPECT_THAT(exchanged.out, HasSubstr(folder.own + " is not the picture that was accepted"));
    EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --update fast").code, 6);  // it was changed by hand
    folder.write(folder.own, right);
    EXPECT_EQ(shell(folder, kTest + " --strict").code, 0);
}

TEST(Renderers, EachHasItsOwnTolerance) {
    const Machines folder;
    folder.accept_of_another("lutrgb=r=max(val-9\\,0)");
    shell(folder, kTest + " --add-digest");
    folder.filter(folder.own, "lutrgb=r=max(val-2\\,0)");
    EXPECT_EQ(shell(folder, kTest).code, 7);
    const std::string scene = R"("fast": {"scene")", text = slurp(folder / "b.json");
    for (const auto& [renderer, code] : {std::pair(std::string("0123456789ab"), 7), {folder.here, 0}}) {
        folder.write("b.json", text);
        folder.swap("b.json", scene,
                    R"("fast": {"tolerance": {"renderers": {")" + renderer + R"(": {"channel": 2}}}, "scene")");
        const Finished finished = shell(folder, kTest);
        EXPECT_EQ(finished.code, code) << finished.out << finished.err;
    }
    EXPECT_EQ(shell(folder, kTest + " --tolerance channel=1").code, 7);  // over all of them
}

TEST(Renderers, AcceptingNothingTouchesNothing) {
    const Guarded folder;
    for (const char* policy : {" --on-new-renderer accept", " --add-digest"}) {
        EXPECT_EQ(shell(folder, kTest + policy).code, 7);
        EXPECT_FALSE(std::filesystem::exists(folder / "b")) << policy;
    }
}

}  // namespace
}  // namespace beamcam::scenes
