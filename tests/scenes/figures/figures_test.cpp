// Figures of scenes: what they need and what they show.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "output/data/table_reader.hpp"
#include "render/draw/markup.hpp"
#include "scenes/figures/axis_labels.hpp"
#include "scenes/plan/plan.hpp"
#include "tests/scenes/figures/simulated.hpp"

namespace beamcam::scenes {
namespace {

using testing::figure_of;
using testing::Finished;
using testing::Folder;
using ::testing::HasSubstr;
using testing::in;
using ::testing::Not;
using testing::scene_from;
using testing::shell;
using testing::simulated;
using ::testing::StartsWith;

TEST(Figures, SchematicAndDeflectionIntegrateNothing) {
    const Scene scene = scene_from(R"({"outputs": [{"type": "figure", "figure": "schematic"},
                                              {"type": "figure", "figure": "deflection"}]})");
    const Plan p = plan(resolve(scene, {}));
    EXPECT_TRUE(p.motions.empty());
    EXPECT_FALSE(p.needs_gl());
    EXPECT_EQ(p.figures.size(), 2u);
}

TEST(Figures, ShareOneSimulationWithEachOtherAndWithTables) {
    const Scene scene = scene_from(R"({"outputs": [{"type": "figure", "figure": "energy"},
        {"type": "figure", "channels": ["theta_dot"], "x": "theta"},
        {"type": "figure", "figure": "angle", "horizon": true}, {"type": "trajectory"}]})");
    const Plan p = plan(resolve(scene, {}));
    ASSERT_EQ(p.motions.size(), 4u);
    for (const MotionRequest& each : p.motions) EXPECT_EQ(each.key, p.motions.front().key);
    EXPECT_EQ(std::ranges::count_if(p.motions, [](const MotionRequest& each) { return each.request.horizon; }), 1);
}

TEST(Figures, EqualPhysicsIsOneMotion) {
    // 1, 2 and 4 modes; the scene's own are 2.
    const Scene scene = scene_from(R"({"outputs": [{"type": "figure", "channels": ["theta"],
         "compare": [{"set": {"beam.modes": 1}}, {}, {"set": {"beam.modes": 4}}]},
        {"type": "figure", "figure": "energy"}, {"type": "figure", "figure": "contact-places", "lang": "zh"}]})");
    std::set<std::string> motions;
    for (const MotionRequest& each : plan(resolve(scene, {})).motions) motions.insert(each.key);
    EXPECT_EQ(motions.size(), 3u);
}

TEST(Figures, HaveTheUnitsOfTheScene) {
    const Scene si = scene_from(R"({"time": {"end": 0.6}, "solver": {"rtol": 1e-6}})");
    Scene shown = si;
    shown.units = {.degrees = true, .speed = render::SpeedUnit::rpm};
    const auto figure = figure_of(shown, "free-fall"), same = figure_of(si, "free-fall");
    EXPECT_THAT(figure.panels[0].y.label, ::testing::EndsWith(" / °"));
    const auto &degrees = figure.panels[0].series.front().y, &radians = same.panels[0].series.front().y;
    for (std::size_t i = 0; i < radians.size(); i += 50) EXPECT_NEAR(degrees[i], radians[i] * 180 / M_PI, 1e-12);
}

TEST(Figures, DegreesFollowTheirNumberWithoutASpace) {
    EXPECT_EQ(with_unit("2.5", "°"), "2.5°");
    EXPECT_EQ(with_unit("90", "°/s"), "90° s^{−1}");
    EXPECT_EQ(with_unit("5", "rad/s"), "5 rad s^{−1}");
    EXPECT_EQ(with_unit("3", "1"), "3");
}

TEST(Figures, FreeFallShowsTheThreePublishedTimes) {
    const auto figure = figure_of(scene_from(R"({"cam": null, "beam": {"basis": "cantilever"},
        "solver": {"rtol": 1e-11, "atol": 1e-14}, "time": {"end": 0.4}})"),
                                  "free-fall");
    ASSERT_EQ(figure.panels.size(), 2u);
    const auto& marks = figure.panels[0].marks;
    ASSERT_EQ(marks.size(), 2u);  // that of the rigid beam would cover that of the flexible one
    EXPECT_NEAR(marks[0].x, 0.369993889, 1e-9);
    EXPECT_NEAR(marks[1].x, 0.261628446653, 1e-9);
    // spaces of groups of digits
    EXPECT_THAT(figure.title, HasSubstr("flexible: zero after 0.369\u2009994 s; rigid: zero after 0.369\u2009998 s"));
}

TEST(Figures, TrialMethodMeetsTheLocatedTouch) {
    const auto figure =
        figure_of(scene_from(R"({"cam": {"eccentricity": 0, "speed": 0}, "time": {"end": 0.3}})"), "distance");
    const auto& arrivals = figure.panels[1];
    ASSERT_EQ(arrivals.rules.size(), 1u);
    const auto& refined = arrivals.series[0];
    const auto first = std::min_element(refined.y.begin(), refined.y.end()) - refined.y.begin();
    EXPECT_NEAR(refined.x[static_cast<std::size_t>(first)], arrivals.rules[0].at, 0.00125);  // the refined spacing
    EXPECT_NEAR(arrivals.rules[0].at, 0.229, 0.001);
}

// The scale of the schematic is the scene's own: a beam that rests on the cam lies along the tangent to it.
TEST(Figures, SchematicShowsARestingBeamOnTheCam) {
    const auto figure = figure_of(scene_from(R"({"initial": {"shape": "resting"}, "beam": {"model": "rigid"},
        "cam": {"centre": [0.3, 0], "radius": 0.1, "eccentricity": 0}})"),
                                  "schematic");
    double nearest = 1;
    for (const auto& shape : figure.panels[0].shapes)
        if (shape.points.size() > 20)
            for (const auto& p : shape.points) nearest = std::min(nearest, std::hypot(p.x - 0.3, p.y));
    EXPECT_NEAR(nearest, 0.1, 1e-3);
    const auto has = [](const auto& made, const std::string& markup) {
        return std::ranges::any_of(made.panels[0].shapes, [&](const auto& s) { return s.markup == markup; });
    };
    EXPECT_TRUE(has(figure, "$g$"));
    EXPECT_FALSE(has(figure_of(scene_from(R"({"gravity": 0})"), "schematic"), "$g$"));
}

// The cam turns while the beam falls, so that the touch is far from where its first phase puts it.
TEST(Figures, TheTrialMethodSearchesBesideItsFirstPoints) {
    const auto figure = figure_of(scene_from(R"({"hub": {"drive": {"type": "torque", "value": "1.5 N m"}},
        "cam": {"speed": 4}, "initial": {"angle": "30 deg"}, "time": {"end": 1}})"),
                                  "distance");
    const auto& arrivals = figure.panels[1];
    ASSERT_EQ(arrivals.rules.size(), 1u);
    EXPECT_LT(arrivals.series.at(1).x.at(0), arrivals.rules[0].at);  // the first point
    EXPECT_GT(arrivals.series.back().x.at(0), arrivals.rules[0].at);
}

TEST(Figures, OfVibrationEndAtEventsIfTheMotionHasThem) {
    const auto end_of = [](const std::string& mechanics, const std::string& name = "strobe") {
        const Scene scene = scene_from("{" + mechanics + R"("time": {"end": 1}, "outputs": [{"type": "figure",
            "figure": ")" + name + R"("}]})");
        const auto find = [](const sim::Problem& problem, const sim::Request& request) {
            return sim::simulate(problem, request);
        };
        return std::get<FigureOutput>(resolve(scene, find).outputs.front().output).series.to.value_or(scene.end_time);
    };
    EXPECT_NEAR(end_of(""), 0.277, 0.001);
    EXPECT_EQ(end_of(R"("cam": null, )"), 1);
    EXPECT_NEAR(end_of("", "tip-vibration"), 0.53, 0.02);
    EXPECT_EQ(end_of(R"("cam": null, )", "tip-vibration"), 1);
    EXPECT_EQ(end_of(R"("initial": {"shape": "resting"}, "cam": {"speed": 0}, )"), 1);
    EXPECT_EQ(end_of(R"("gravity": 1.2, )", "models"), 1);  // before the apex
    EXPECT_EQ(end_of(R"("gravity": 1.2, )", "apex-modes"), 1);
}

// The letters of a slide shrink where five curves and their legend have no room beside large ones.
TEST(Figures, OfEnergyFitOnASlide) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.5}})");
    const Finished made = shell(folder, "$BEAMCAM figure s.json energy --column slide --theme dark -o e.png");
    EXPECT_EQ(made.code, 0) << made.err;
    EXPECT_EQ(shell(folder, "$BEAMCAM figure s.json energy --height 0.021 -o f.png").code, 3);
}

TEST(Presets, ShowAnyCollisionInCloseUp) {
    const Folder folder;
    folder.write("s.json", R"({"beam": {"model": "rigid"}, "time": {"end": 1.2}})");
    const auto start = [&](int number) {
        const Finished made =
            shell(folder, fmt::format("$BEAMCAM figure s.json collision --from collision:{0} --to liftoff:{0} -o c.svg "
                                      "--data c.csv --force",
                                      number));
        EXPECT_EQ(made.code, 0) << made.err;
        return output::read_table(folder / "c.csv").columns.at(0).values.at(0);
    };
    EXPECT_LT(start(1), start(2));
    const Finished none = shell(folder, "$BEAMCAM figure s.json collision --from collision:99 -o n.svg");
    EXPECT_EQ(none.code, 3);
    EXPECT_THAT(none.err, HasSubstr("collision 99 does not occur: the motion has "));
}

TEST(Presets, AreListedWithTheFigures) {
    const Folder folder;
    folder.write("s.json", "{}");
    const std::string list = shell(folder, "$BEAMCAM figure s.json --list").out;
    for (const char* name : {"series", "schematic", "angle", "speeds", "tip-vibration", "energy", "phase", "collision",
                             "apex-modes", "models"})
        EXPECT_THAT("\n" + list, HasSubstr(fmt::format("\n{:<18} ", name)));
    EXPECT_EQ(shell(folder, "$BEAMCAM figure s.json").out, list);
    EXPECT_THAT(list, Not(HasSubstr("not for this scene: the hub")));
    folder.write("n.json", R"({"cam": null})");
    EXPECT_THAT(shell(folder, "$BEAMCAM figure n.json --list").out,
                ::testing::ContainsRegex("collision [^\n]*not for this scene"));
}

// The same bytes by its name, by its name in a scene, and by a file with its keys.
TEST(Presets, OfOnesOwnWorkAsThoseOfTheProgram) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.4}})");
    folder.write("k.json",
                 R"({"time": {"end": 0.4}, "outputs": [{"type": "figure", "figure": "energy", "file": "k.svg"}]})");
    folder.write("mine.json", testing::slurp(BEAMCAM_TEST_DIR "/../scenes/presets/energy.json"));
    const Finished made = shell(folder,
                                "$BEAMCAM figure s.json energy -o a.svg -q && $BEAMCAM run k.json -q && "
                                "$BEAMCAM figure s.json --preset mine.json -o b.svg -q");
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_EQ(testing::slurp(folder / "a.svg"), testing::slurp(folder / "b.svg"));
    EXPECT_EQ(testing::slurp(folder / "a.svg"), testing::slurp(folder / "k.svg"));
    folder.write("strobe.json", R"({"figure": "strobe", "title": "Until the touch", "to": "touch"})");
    ASSERT_EQ(shell(folder, "$BEAMCAM figure s.json --preset strobe.json -o c.svg --caption c.txt -q").code, 0);
    EXPECT_THAT(testing::slurp(folder / "c.txt"), StartsWith("Until the touch. "));
}

TEST(Presets, OfOnesOwnTakeTheOptionsOfTheirFigure) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.4}})");
    folder.write("mine.json", R"({"panels": [{"channels": ["theta"], "title": "Old title"}]})");
    const Finished made =
        shell(folder, "$BEAMCAM figure s.json --preset mine.json --to 0.1 --title 'New title' -o a.pdf -q");
    ASSERT_EQ(made.code, 0) << made.err;
    const std::string shown = shell(folder, "$BEAMCAM info a.pdf --scene").out;
    EXPECT_THAT(shown, AllOf(HasSubstr("\"to\": 0.1"), HasSubstr("New title"), Not(HasSubstr("Old title"))));
}

TEST(Presets, WithMistakesAreReported) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.4}})");
    const auto refusal = [&](const char* preset) {
        folder.write("mine.json", preset);
        const Finished made = shell(folder, "$BEAMCAM figure s.json --preset mine.json -o a.svg");
        EXPECT_NE(made.code, 0) << preset;
        return made.err;
    };
    EXPECT_THAT(refusal(R"({"figure": "series", "channels": ["theta"], "fom": 0.1})"),
                HasSubstr("unknown key \"fom\""));
    EXPECT_THAT(refusal(R"({"figure": "serious", "channels": ["theta"]})"),
                HasSubstr("there is no figure \"serious\""));
    EXPECT_THAT(refusal(R"({"channels": ["thetta"]})"), HasSubstr("did you mean \"theta\"?"));
    EXPECT_THAT(refusal("[1]"), HasSubstr("a preset is an object"));
    EXPECT_THAT(refusal(R"({"figure": )"), HasSubstr("mine.json:1:"));
    EXPECT_EQ(shell(folder, "$BEAMCAM figure s.json energy --preset mine.json -o a.svg").code, 2);
    EXPECT_EQ(shell(folder, "$BEAMCAM figure s.json --preset none.json -o a.svg").code, 6);
}

TEST(Presets, CompareTheMotionsOfTheirKeys) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.6}})");
    ASSERT_EQ(shell(folder, "$BEAMCAM figure s.json apex-modes -o a.pdf -q").code, 0);
    const std::string shown = shell(folder, "$BEAMCAM info a.pdf --scene").out;
    for (const int modes : {1, 4, 8})
        EXPECT_THAT(shown.substr(shown.find("\"compare\"")), HasSubstr(fmt::format("\"modes\": {}", modes)));
}

// The keys of the output stand before those of the preset.
TEST(Presets, GiveKeysThatAnOutputCanReplace) {
    const Scene scene = scene_from(R"({"time": {"end": 0.4}, "outputs": [
        {"type": "figure", "figure": "angle", "title": "Mine", "to": 0.2}]})");
    const auto& how = std::get<FigureOutput>(scene.outputs.front());
    EXPECT_EQ(how.figure, "series");
    EXPECT_EQ(how.file, "angle.pdf");
    EXPECT_EQ(how.title, "Mine");
    EXPECT_EQ(how.series.to, 0.2);
}

// Places along a beam of any size, in the unit that suits it; those of the paper in millimetres.
TEST(ContactPlaces, HaveTheUnitThatSuitsTheBeam) {
    const auto label = [](const char* scene) {
        return figure_of(scene_from(scene), "contact-places").panels[0].y.label;
    };
    EXPECT_THAT(label(R"({"time": {"end": 0.4}})"), HasSubstr("/ mm"));
    EXPECT_THAT(label(R"({"beam": {"length": 20, "area": 0.02, "second_moment": 2e-4, "density": 7850, "modes": 2,
        "youngs_modulus": "210 GPa"}, "cam": {"centre": [6, 0], "radius": 2, "eccentricity": 0.5}, "time": {"end": 2}})"),
                HasSubstr("/ m"));
    EXPECT_THAT(label(R"({"contact": {"model": "restitution"}, "time": {"end": 0.4}})"), HasSubstr("/ mm"));
}

TEST(ContactPlaces, OfAnInstantAreOnePoint) {
    const auto figure = figure_of(scene_from(R"({"time": {"end": 0.9}})"), "contact-places");
    for (std::size_t k = 0; k < 2; ++k) {
        std::vector<double> times = figure.panels.at(k).series[0].x;
        EXPECT_EQ(times.size(), 2u);  // of a brief collision that of its largest force
        std::ranges::sort(times);
        EXPECT_EQ(std::ranges::adjacent_find(times), times.end());
    }
    const std::vector<double>& first = figure.panels.at(2).series.at(0).x;
    EXPECT_EQ(std::ranges::adjacent_find(first), first.end());  // with gaps where the contact is interrupted
}

TEST(Presets, ShowTheEnergiesThatTheSceneHas) {
    const auto labels = [](const char* scene) {
        std::string all;
        const auto figure = figure_of(scene_from(scene), "energy");
        for (const auto& panel : figure.panels)
            if (panel.legend)
                for (const auto& series : panel.series) all += series.label + "; ";
        return all;
    };
    EXPECT_EQ(labels(R"({"time": {"end": 0.4}})"),
              "kinetic; potential; lost; external work; sum − work; bending; contact; ");
    EXPECT_EQ(labels(R"({"cam": null, "gravity": 0, "initial": {"angular_velocity": 1}, "time": {"end": 0.1}})"),
              "kinetic; sum − work; ");  // a straight beam that turns is not bent
}

TEST(Figures, QuantitiesHaveTheColoursOfFilms) {
    const auto looks = [](const char* output) {
        std::vector<int> all;
        const auto figure = simulated(output);
        for (const auto& series : figure.panels[0].series) all.push_back(series.look);
        return all;
    };
    constexpr int kBlue = 0, kVermilion = 1, kGreen = 2;
    EXPECT_THAT(looks(R"({"contact": {"friction": {"type": "coulomb", "coefficient": 0.2}}, "time": {"end": 0.3},
        "outputs": [{"type": "figure", "channels": ["friction_force", "contact_force"]}]})"),
                ::testing::ElementsAre(kBlue, kVermilion));
    EXPECT_THAT(looks(R"({"time": {"end": 0.3}, "outputs": [{"type": "figure", "channels": ["q1", "q2"]}]})"),
                ::testing::ElementsAre(kBlue, kGreen));
}

TEST(Figures, PrintedSlopeJumpsAndTheCorrectedDoesNot) {
    const auto figure = figure_of(scene_from("{}"), "deflection");
    const auto& slope = figure.panels[1].series;
    const auto jump = [](const render::figure::Series& s) {
        double largest = 0;
        for (std::size_t i = 1; i < s.x.size(); ++i)
            if (std::abs(s.x[i] - s.x[i - 1]) < 1e-12) largest = std::max(largest, std::abs(s.y[i] - s.y[i - 1]));
        return largest;
    };
    ASSERT_EQ(slope.size(), 9u);  // three curves of three supports
    for (std::size_t k = 0; k < 9; k += 3) {
        EXPECT_LT(jump(slope[k]), 1e-9) << k;      // along the rod
        EXPECT_LT(jump(slope[k + 1]), 1e-9) << k;  // with the missing terms
        EXPECT_GT(jump(slope[k + 2]), 1e-4) << k;  // as printed
    }
}

// Of the deflection across the beam, by its own length.
TEST(Figures, TheSlopeOfTheStaticDeflectionIsThatOfTheBeam) {
    const auto figure = figure_of(scene_from("{}"), "deflection");
    const double cosine = std::sqrt(1 - 0.4 * 0.4);  // the beam is tangent to the disc
    const auto &v = figure.panels[0].series[0], &slope = figure.panels[1].series[0];
    const std::size_t last = v.x.size() - 1;
    EXPECT_NEAR(v.x[last], cosine, 1e-12);
    EXPECT_THAT(figure.panels[0].x.label, HasSubstr("horizontal distance"));
    const double length = (v.x[last] - v.x[last - 2]) / cosine;  // along the beam
    EXPECT_NEAR((v.y[last] - v.y[last - 2]) / length, slope.y[last - 1], 1e-5);
}

TEST(Figures, EachStaticDeflectionHasItsNameInTheData) {
    const auto figure = figure_of(scene_from("{}"), "deflection");
    for (const auto& panel : figure.panels) {
        std::set<std::string> names;
        for (std::size_t k = 0; k < 9; ++k) names.insert(panel.series[k].name);
        EXPECT_EQ(names.size(), 9U);
    }
}

TEST(Figures, FreeFallShowsTheDifferenceOfTheBeamsUnlessOneIsRigid) {
    const auto figure = figure_of(scene_from(R"({"time": {"end": 0.3}})"), "free-fall");
    ASSERT_EQ(figure.panels.size(), 2U);
    const auto &fall = figure.panels[0].series, &difference = figure.panels[1].series;
    EXPECT_EQ(difference[0].y[900], fall[0].y[900] - fall[1].y[900]);
    EXPECT_EQ(figure_of(scene_from(R"({"beam": {"model": "rigid"}})"), "free-fall").panels.size(), 1U);
}

TEST(Figures, SchematicHasTheTorqueOnTheHub) {
    const auto torques = [](const char* scene) {
        return std::ranges::count(figure_of(scene_from(scene), "schematic").panels[0].shapes, "$τ$",
                                  &render::figure::Shape::markup);
    };
    EXPECT_EQ(torques(R"({"hub": {"drive": {"type": "torque", "value": "1.5 N m"}}})"), 1);
    EXPECT_EQ(torques("{}"), 0);
    EXPECT_EQ(torques(R"({"hub": {"drive": {"type": "prescribed", "law": "constant", "speed": 1}}})"), 0);
}

// Also what a figure computes beside the scene must be possible: without the cam nothing rests on it.
TEST(Figures, OfARestingBeamAreMadeOrRejected) {
    SKIP_UNDER_SANITIZERS();
    const Folder folder;
    folder.write("s.json", R"({"initial": {"shape": "resting"}, "time": {"end": 0.2}})");
    for (const FigureType& type : figure_types()) {
        if (type.takes("table")) continue;  // of a file
        const std::string options = std::string_view(type.name) == "series" ? "--channels theta" : "";
        const Finished made =
            shell(folder, fmt::format("$BEAMCAM figure s.json {} {} -o a.svg -q --force", type.name, options));
        EXPECT_TRUE(made.code == 0 || made.code == 3) << type.name << made.err;
    }
    for (const char* name : {"free-fall", "distance"}) {
        const Finished rejected = shell(folder, fmt::format("$BEAMCAM figure s.json {} -o b.svg", name));
        EXPECT_EQ(rejected.code, 3);
        EXPECT_THAT(rejected.err, HasSubstr("rests on the cam"));
    }
}

TEST(Figures, OptionsOfOtherFiguresAreNamedAsTheyWereGiven) {
    const Folder folder;
    folder.write("s.json", "{}");
    const auto refusal = [&](const std::string& options) {
        const Finished made = shell(folder, "$BEAMCAM figure s.json " + options + " -o a.svg");
        EXPECT_EQ(made.code, 2) << options;
        return made.err;
    };
    for (const std::string option : {"--low 1", "--high 1", "--title x", "--log", "--lines 1", "--panels", "--note 1=x",
                                     "--compare s.json", "--impacts", "--residuals", "--x-low 1"})
        EXPECT_THAT(refusal("schematic " + option),
                    StartsWith("beamcam: " + option.substr(0, option.find(' ')) + " belongs to the figure \"series\""));
}

TEST(Figures, AskWhetherTheVariantsTheyComputeArePossible) {
    const auto without = [](const std::string& text) {
        return refusal_of_variants({without_cam(scene_from(text).problem)});
    };
    const auto why = without(R"({"initial": {"shape": "resting"}})");
    ASSERT_TRUE(why);
    EXPECT_THAT(*why, HasSubstr("initial.shape"));
    EXPECT_FALSE(without("{}"));
}

// Pictures that would be empty or say one thing twice.
TEST(Figures, WithoutContentAreRejected) {
    const auto report = [](const std::string& keys) { return testing::read("{" + keys + "}]}").report(); };
    const std::string rigid = R"("beam": {"model": "rigid"}, "outputs": [{"type": "figure", "figure": )";
    EXPECT_THAT(report(rigid + "\"tip-vibration\""), HasSubstr("a rigid beam does not bend"));
    const std::string held =
        R"("hub": {"drive": {"type": "prescribed", "law": "constant", "speed": 0}}, "outputs": [{"type": "figure", "figure": )";
    EXPECT_THAT(report(held + "\"angle\""), HasSubstr("the hub is held"));
    EXPECT_EQ(report(rigid + R"("series", "channels": ["theta", "tip_deflection"])"), "");  // one of them moves
    EXPECT_THAT(report(rigid + "\"apex-modes\""), HasSubstr("a rigid beam has no modes"));
    EXPECT_THAT(report(rigid + R"("series", "panels": [{"channels": []}])"), HasSubstr("channels"));
    EXPECT_EQ(report(rigid + "\"models\""), "");  // other models beside the rigid one
    EXPECT_THAT(report(R"("cam": null, "outputs": [{"type": "figure", "figure": "collision")"),
                HasSubstr("from = \"collision 1\": the scene has no cam"));
    const auto why = [](const std::string& keys, const char* figure) -> std::string {
        try {
            figure_of(scene_from(keys), figure);
        } catch (const render::PictureError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(why(R"({"cam": null, "time": {"end": 0.05}})", "spectrogram"), "");  // of few periods
    EXPECT_THAT(why(R"({"beam": {"model": "rigid"}})", "spectrogram"), HasSubstr("does not vibrate"));
    EXPECT_THAT(why(R"({"cam": null, "hub": {"drive": {"type": "prescribed", "law": "constant", "speed": 0}},
                        "time": {"end": 0.1}})",
                    "phase"),
                HasSubstr("theta does not change"));
}

TEST(Figures, WhatASceneHasNotIsReported) {
    const Folder folder;
    folder.write("s.json", R"({"cam": null})");
    const Finished list = shell(folder, "$BEAMCAM figure s.json");
    EXPECT_EQ(list.code, 0);
    EXPECT_THAT(list.out, HasSubstr("schematic"));
    EXPECT_THAT(list.out, HasSubstr("no cam"));
    const Finished rejected = shell(folder, "$BEAMCAM figure s.json contact-places -o a.pdf");
    EXPECT_EQ(rejected.code, 3);
    EXPECT_THAT(rejected.err, HasSubstr("no cam"));
    folder.write("t.json", R"({"time": {"end": 0.01}})");
    const Finished early = shell(folder, "$BEAMCAM figure t.json collision -o a.pdf");
    EXPECT_EQ(early.code, 3);
    EXPECT_THAT(early.err, HasSubstr("time.end"));
    EXPECT_FALSE(std::filesystem::exists(folder / "a.pdf"));
}

// A light steel beam: with four cantilever shapes and more it loses its inertia when it strikes.
constexpr const char* kLight = R"({"beam": {"length": 0.5, "area": 1.5e-4, "second_moment": 3.125e-10, "density": 7850,
    "youngs_modulus": 2.1e11, "depth": 5e-3, "modes": 6, "damping_ratio": 0.005},
    "cam": {"centre": [0.2, 0], "radius": 0.05, "eccentricity": 0.01, "speed": 12.566},
    "contact": {"stiffness": 3.4e10, "restitution": 0.6, "offset": "half-depth"}, "time": {"end": 0.5}})";

// 80 µs of contact among the rows of half a second.
TEST(Presets, OfACollisionReachItsPeak) {
    SKIP_UNDER_SANITIZERS();
    const Folder folder;
    folder.write("s.json", kLight);
    ASSERT_EQ(shell(folder, "$BEAMCAM figure s.json collision -o c.svg --data c.csv").code, 0);
    const Finished printed = shell(
        folder, R"($BEAMCAM simulate s.json --impacts - | sed -n 's/.*"force_peak": \([0-9.e+-]*\).*/\1/p' | head -1)");
    const double peak = std::stod(printed.out);
    const output::ColumnTable drawn = output::read_table(folder / "c.csv");
    const auto force = std::ranges::find(drawn.columns, "F / kN", [](const auto& column) { return column.name; });
    ASSERT_NE(force, drawn.columns.end());
    double highest = 0;
    for (const double v : force->values)
        if (std::isfinite(v)) highest = std::max(highest, 1e3 * v);
    EXPECT_GT(peak, 1000);
    EXPECT_GE(highest, 0.995 * peak);
}

}  // namespace
}  // namespace beamcam::scenes
