// Captions of figures: facts, digits and what did not happen.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/base/error.hpp"
#include "render/draw/markup.hpp"
#include "tests/scenes/figures/simulated.hpp"

namespace beamcam::scenes {
namespace {

using testing::figure_of;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::scene_from;

TEST(Figures, CaptionsStateTheAssumptionsInBothLanguages) {
    for (const Lang lang : {Lang::en, Lang::zh}) {
        const auto figure = figure_of(scene_from("{}"), "schematic", lang);
        const std::string caption = render::to_plain(figure.caption);
        for (const char* value : {"e = 0.02 m", "K = 10⁸ N m", "0.7", "a = 0 m", "g = 9.81"})
            EXPECT_THAT(caption, HasSubstr(value));
        EXPECT_THAT(caption, HasSubstr(lang == Lang::en ? "assumptions" : "假定值"));
        EXPECT_NO_THROW(render::to_latex(figure.caption));
    }
}

std::string caption_of(const std::string& text, const char* name, Lang lang = Lang::en) {
    const auto figure = figure_of(scene_from(text), name, lang);
    return render::to_plain(figure.caption + " " + figure.accuracy);
}

TEST(Captions, StateDriveAndStart) {
    const auto with = [](const char* more) { return caption_of(more, "schematic"); };
    EXPECT_THAT(with(R"({"hub": {"drive": {"type": "torque", "value": "1.5 N m"}}})"), HasSubstr("τ = 1.5 N m"));
    EXPECT_THAT(with(R"({"initial": {"angle": "80 deg", "angular_velocity": -1}})"), HasSubstr("(0) = −1 rad"));
    EXPECT_THAT(with(R"({"initial": {"shape": "static"}})"), HasSubstr("deflected by its weight"));
    const std::string spun = with(R"({"cam": null, "initial": {"angle": 0},
        "hub": {"drive": {"type": "prescribed", "law": "spin-up", "speed": 4, "duration": 15}}})");
    EXPECT_THAT(spun, HasSubstr("spun up to 4 rad"));
    EXPECT_THAT(spun, Not(HasSubstr("released")));
    const std::string table = with(R"({"cam": null, "hub": {"drive": {"type": "prescribed", "law": "table",
        "t": [0, 1], "theta": [0.5, 1]}}, "initial": {"angle": 1}})");
    EXPECT_THAT(table, HasSubstr("θ(0) = 28.6479°"));  // the table's, not the scene's 1 rad
    const std::string resting = with(R"({"initial": {"shape": "resting"}})");
    EXPECT_THAT(resting, HasSubstr("resting on the cam"));
    EXPECT_THAT(resting, Not(HasSubstr("45°")));
}

TEST(Captions, StateTheCamsSenseOfTurning) {
    const auto with = [](const char* speed) {
        return caption_of(fmt::format(R"({{"cam": {{"speed": {}}}}})", speed), "schematic");
    };
    EXPECT_THAT(with("-3"), HasSubstr("ω = −3 rad s⁻¹ (counter-clockwise)"));
    EXPECT_THAT(with("3"), HasSubstr("ω = 3 rad s⁻¹ clockwise"));
    EXPECT_THAT(with("0"), HasSubstr("cam at rest"));
    EXPECT_THAT(with("\"-30 rpm\""), HasSubstr("ω = −30 rpm (counter-clockwise)"));
    EXPECT_THAT(with("\"90 deg/s\""), HasSubstr("ω = 90° s⁻¹ clockwise"));
}

TEST(Captions, NameThePaperInItsOwnScenesAlone) {
    constexpr const char* kOthers[] = {R"({"beam": {"length": 1.2}, "time": {"end": 0.3}})",
                                       R"({"initial": {"angle": "50 deg"}, "time": {"end": 0.3}})",
                                       R"({"cam": {"speed": 3}, "time": {"end": 0.3}})",
                                       R"({"gravity": 1.62, "time": {"end": 0.3}})"};
    for (const char* figure : {"schematic", "free-fall", "deflection", "angle"}) {
        for (const char* other : kOthers) {
            EXPECT_THAT(caption_of(other, figure), Not(HasSubstr("paper"))) << figure << other;
            EXPECT_THAT(caption_of(other, figure, Lang::zh), Not(HasSubstr("原文"))) << figure << other;
        }
        EXPECT_THAT(caption_of(R"({"time": {"end": 0.4}})", figure), HasSubstr("paper")) << figure;
    }
    EXPECT_THAT(caption_of(R"({"time": {"end": 0.4}})", "free-fall"),
                HasSubstr("a factor 2 between torque and inertia"));
    EXPECT_THAT(caption_of(kOthers[0], "models"), Not(HasSubstr("paper")));
}

// Within steps, which the figure "energy" shows too, the balance is interpolated and may be worse.
TEST(Captions, SayWhereTheEnergyBalanceCloses) {
    EXPECT_THAT(caption_of(R"({"time": {"end": 0.4}})", "energy"),
                HasSubstr("at the ends of steps the energy balance closes to"));
    EXPECT_THAT(caption_of(R"({"time": {"end": 0.4}})", "energy", Lang::zh), HasSubstr("能量平衡在各步末闭合到"));
    // Of several motions it is the worst, not that of the motion whose facts are listed before.
    EXPECT_THAT(caption_of(R"({"time": {"end": 0.4}})", "speeds"),
                HasSubstr("at the ends of steps the energy balance of each motion closes to"));
}

TEST(Captions, SayNothingOfAFlexibleBeamWhereItIsRigid) {
    for (const char* figure : {"schematic", "free-fall"}) {
        const std::string caption =
            caption_of(R"({"beam": {"model": "rigid"}, "initial": {"angle": 0.7}, "time": {"end": 0.5}})", figure);
        EXPECT_THAT(caption, Not(HasSubstr("lexib"))) << figure;
        EXPECT_THAT(caption, Not(HasSubstr("deflection"))) << figure;
        EXPECT_THAT(caption, Not(HasSubstr("mode"))) << figure;
    }
}

TEST(Captions, NameTheShapesThatTheModelHas) {
    EXPECT_THAT(caption_of("{}", "schematic"), HasSubstr("2 hub–beam modes"));
    const std::string exact = caption_of(R"({"beam": {"model": "exact", "modes": 6}})", "schematic");
    EXPECT_THAT(exact, HasSubstr("6 polynomials"));
    EXPECT_THAT(exact, Not(HasSubstr("hub-beam")));
}

TEST(Captions, LeaveOutWhatDidNotHappen) {
    // The torque lifts the beam: it never passes the horizontal.
    const std::string lifted =
        caption_of(R"({"hub": {"drive": {"type": "torque", "value": "1.5 N m"}}, "time": {"end": 0.3}})", "free-fall");
    EXPECT_THAT(lifted, HasSubstr("does not reach 0 before 0.3 s"));
    EXPECT_THAT(lifted, Not(HasSubstr("– ")));
    const std::string apart = caption_of(R"({"cam": {"centre": [-0.5, 0]}, "time": {"end": 0.3}})", "speeds");
    EXPECT_THAT(apart, HasSubstr("no impact"));
    EXPECT_THAT(apart, Not(HasSubstr("multiply")));
    EXPECT_THAT(apart, Not(HasSubstr("reproducible")));
    constexpr const char* kResting = R"({"cam": {"speed": 0}, "initial": {"shape": "resting"}, "time": {"end": 0.2}})";
    EXPECT_THAT(caption_of(kResting, "phase"), Not(HasSubstr("collision")));
    EXPECT_THAT(caption_of(kResting, "speeds"), HasSubstr("ω = 0 rad s⁻¹, no impact"));
    EXPECT_THROW(caption_of(kResting, "collision"), render::PictureError);
}

TEST(Captions, CallNoMotionChaotic) {
    for (const char* figure : {"angle", "speeds", "models"})
        for (const Lang lang : {Lang::en, Lang::zh}) {
            const std::string caption = caption_of(R"({"time": {"end": 0.6}})", figure, lang);
            EXPECT_THAT(caption, Not(HasSubstr("chao")));
            EXPECT_THAT(caption, Not(HasSubstr("混沌")));
        }
}

// The fewest correct digits and the most that may be printed.
TEST(Captions, HaveTheDigitsThatModesAndToleranceSupport) {
    EXPECT_EQ(supported({0.36999493, 3e-7}), "0.369\u2009995");
    EXPECT_EQ(supported({0.36999493, 3e-3}), "0.37");
    EXPECT_EQ(supported({1237.4, 60}), "1.2×10^{3}");
    EXPECT_EQ(supported({1237.4, 1e-3}), "1237.400");
    EXPECT_EQ(supported({-3.6e-6, 1e-7}), "−3.6×10^{−6}");
    EXPECT_EQ(supported({0.5, 10}), "0.5");  // one digit at least
    const sim::Problem p;
    EXPECT_DOUBLE_EQ(estimate(p, 2, 2.5).error, 0.5);
    EXPECT_DOUBLE_EQ(estimate(rigid(p), 2, std::nullopt).error, 2e-7);
    EXPECT_GT(estimate(p, 2, std::nullopt).error, 0.05);  // nothing vouches for it
}

}  // namespace
}  // namespace beamcam::scenes
