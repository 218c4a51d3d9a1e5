// Captions of figures: title, parameters that differ from the defaults, accuracy.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/draw/markup.hpp"
#include "scenes/figures/caption.hpp"
#include "tests/scenes/figures/simulated.hpp"

namespace beamcam::scenes {
namespace {

using testing::figure_of;
using testing::Folder;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::scene_from;
using testing::shell;

std::string caption_of(const std::string& text, const char* name, Lang lang = Lang::en) {
    return render::to_plain(whole_caption(figure_of(scene_from(text), name, lang)));
}

TEST(Captions, AreTitleParametersAndAccuracy) {
    EXPECT_THAT(caption_of(R"({"beam": {"modes": 3}, "cam": {"speed": "-30 rpm"}})", "schematic"),
                HasSubstr("; ω: speed. Parameters: beam modes = 3, cam speed = −30 rpm."));
    EXPECT_THAT(caption_of("{}", "schematic"), HasSubstr("All parameters have their default values."));
    EXPECT_THAT(
        caption_of(R"({"time": {"end": 0.4}})", "angle"),
        ::testing::MatchesRegex("Hub angle. All parameters have their default values. Relative tolerance 10⁻⁸; at "
                                "the ends of steps the energy balance closes to .* of its scale."));
}

TEST(Captions, NameParametersByTheWordsOfTheirKeys) {
    EXPECT_THAT(caption_of(R"({"hub": {"drive": {"type": "torque", "value": "1.5 N m"}}})", "schematic"),
                HasSubstr("hub drive type = torque, hub drive value = 1.5 N m"));
    EXPECT_THAT(caption_of(R"({"cam": null})", "schematic"), HasSubstr("no cam"));
    EXPECT_THAT(caption_of(R"({"hub": {"drive": {"type": "torque", "t": [0, 1, 2, 3, 4, 5],
                               "torque": [0, 1, 2, 3, 4, 5]}}})",
                           "schematic"),
                HasSubstr("own hub drive t, own hub drive torque"));
}

// The speed of the cam is not that of all three.
// The depth is only drawn, and no damping is the default.
TEST(Captions, OmitParametersWithoutEffect) {
    EXPECT_THAT(caption_of(R"({"beam": {"depth": 0.04, "damping_ratio": 0}})", "schematic"),
                HasSubstr("All parameters have their default values."));
}

TEST(Captions, NameThePanelsThatAreDrawn) {
    constexpr const char* kRigid = R"({"beam": {"model": "rigid"}, "contact": {"model": "restitution"},
                                       "time": {"end": 0.4}})";
    const std::string caption = caption_of(kRigid, "energy");
    EXPECT_THAT(caption, HasSubstr("Energies: (a) kinetic, potential"));
    EXPECT_THAT(caption, Not(HasSubstr("bending")));
    EXPECT_THAT(caption, Not(HasSubstr("(c)")));
}

TEST(Captions, StateWhatAllMotionsHave) {
    const std::string caption =
        caption_of(R"({"cam": {"speed": 2}, "beam": {"modes": 3}, "time": {"end": 0.6}})", "apex-modes");
    EXPECT_THAT(caption, HasSubstr("Parameters: cam speed = 2 rad s⁻¹."));
    EXPECT_THAT(caption, HasSubstr("the energy balance of each motion closes to"));
    EXPECT_THAT(caption, Not(HasSubstr("beam modes")));
}

TEST(Captions, OfSeveralMotionsSpeakOfWhatTheyShare) {
    EXPECT_THAT(caption_of(R"({"time": {"end": 0.4}})", "models"),
                HasSubstr("All parameters that the motions share have their default values."));
}

TEST(Captions, AreEnglishBesideChinesePictures) {
    EXPECT_EQ(caption_of("{}", "deflection", Lang::zh), caption_of("{}", "deflection"));
}

TEST(Captions, AreWrittenAsText) {
    const Folder folder;
    folder.write("s.json", R"({"gravity": 1.62, "time": {"end": 0.3}})");
    ASSERT_EQ(shell(folder, "$BEAMCAM figure s.json angle -o a.svg --caption a.txt -q").code, 0);
    EXPECT_THAT(testing::slurp(folder / "a.txt"),
                ::testing::StartsWith("Hub angle. Parameters: gravity = 1.62 m s⁻². Relative tolerance"));
    EXPECT_EQ(shell(folder, "$BEAMCAM figure s.json angle -o a.svg --caption a.tex -q").code, 2);
}

TEST(Captions, HaveNumbersWithTheirSignAndPower) {
    EXPECT_EQ(number(-3.6e-6, 2), "−3.6×10^{−6}");
    EXPECT_EQ(number(0.25, 6), "0.25");
    EXPECT_EQ(grouped(0.36999493, 6), "0.369\u2009995");
    EXPECT_EQ(decimals_of(0.07), 3);
}

}  // namespace
}  // namespace beamcam::scenes
