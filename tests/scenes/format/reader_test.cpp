#include "scenes/format/reader.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <numbers>

#include "scenes/format/checks.hpp"
#include "scenes/scene/film_times.hpp"
#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

using ::testing::AllOf, ::testing::Contains, ::testing::ElementsAre, ::testing::HasSubstr, ::testing::Not,
    ::testing::StartsWith;
using testing::messages, testing::read;

TEST(Reader, InitialCoordinatesHaveTheUnitOfTheModel) {
    EXPECT_EQ(read(R"({"initial": {"q": ["5 mm"]}})").scene->problem.initial.q, std::vector<double>{5e-3});
    const std::string exact = R"({"beam": {"model": "exact"}, "initial": )";
    EXPECT_THAT(read(exact + R"({"q": ["5 mm"]}})").report(), HasSubstr("measured in rad"));
    EXPECT_TRUE(read(exact + R"({"q": ["0.1 deg"], "q_dot": ["1 deg/s"]}})").scene);
}

TEST(Reader, AnEmptySceneIsThePapersSystem) {
    const Reading reading = read("{}");
    ASSERT_TRUE(reading.scene) << reading.report();
    const sim::Problem& p = reading.scene->problem;
    EXPECT_EQ(p.beam.length, 1);
    EXPECT_EQ(p.cam->speed, 1);
    EXPECT_EQ(p.gravity, 9.81);
    EXPECT_EQ(reading.scene->end_time, 1.5);
    EXPECT_EQ(reading.scene->name, "scene");
    EXPECT_TRUE(reading.scene->outputs.empty());
}

TEST(Reader, TheShippedDefaultSaysInUnitsWhatTheDefaultsAreInNumbers) {
    const Reading shipped = read_scene(load_source(BEAMCAM_TEST_DIR "/../scenes/default.json"));
    ASSERT_TRUE(shipped.scene) << shipped.report();
    EXPECT_TRUE(shipped.messages.empty()) << shipped.report();
    Scene empty = *read("{\"time\": {\"end\": 10}}").scene;
    Scene scene = *shipped.scene;
    scene.title.clear();
    scene.outputs.clear();
    EXPECT_EQ(to_json(scene), to_json([&] {
                  empty.problem.beam.damping_ratio = {0};
                  empty.problem.beam.depth = beam_depth(empty.problem.beam);
                  empty.problem.contact.exponent = contact_exponent(empty.problem);
                  empty.units = {true, render::SpeedUnit::radians};
                  return empty;
              }()));
}

TEST(Reader, ASectionAndAMaterialExcludeTheNumbersTheyReplace) {
    const std::string section = R"({"beam": {"section": {"width": "25 mm", "height": "0.8 mm"}, )";
    for (const char* number : {"area", "second_moment"})
        EXPECT_THAT(messages(read(section + fmt::format(R"("{}": 1e-5}}}})", number))),
                    Contains(AllOf(HasSubstr("\"section\""), HasSubstr(fmt::format("\"{}\"", number)))));
    for (const char* number : {"density", "youngs_modulus", "poisson_ratio"})
        EXPECT_THAT(messages(read(fmt::format(R"({{"beam": {{"material": "steel", "{}": 0.3}}}})", number))),
                    Contains(AllOf(HasSubstr("\"material\""), HasSubstr(fmt::format("\"{}\"", number)))));
    const Reading ruler = read(section + R"("material": "steel", "length": "300 mm"}})");
    ASSERT_TRUE(ruler.scene) << ruler.report();
    EXPECT_NEAR(ruler.scene->problem.beam.line_density(), 0.157, 1e-15);
    EXPECT_EQ(to_json(*read(to_json(*ruler.scene)).scene), to_json(*ruler.scene));
}

TEST(Reader, NotesWhatIsAssumedOfABeamOfOnesOwn) {
    EXPECT_TRUE(read(R"({"cam": {"speed": 5}})").scene->notes.empty());
    const std::string cam = R"({"cam": {"radius": "90 mm"}, "contact": )";
    EXPECT_THAT(read(cam + "{}}").scene->notes, ElementsAre(AllOf(HasSubstr("1e+08 N/m^1.5"), HasSubstr("\"hertz\""))));
    EXPECT_TRUE(read(cam + R"({"stiffness": 1e8}})").scene->notes.empty());
    EXPECT_TRUE(read(cam + R"({"stiffness": "hertz"}})").scene->notes.empty());
}

TEST(Reader, EveryKeyReachesItsPlace) {
    const Reading reading = read(R"({
        "title": "all", "hub": {"radius": "5 cm", "inertia": "12 kg cm^2", "drive": {"type": "torque", "amplitude": "1 N m", "frequency": "2 Hz", "phase": "90 deg"}},
        "beam": {"length": 2, "area": 1e-4, "second_moment": 1e-8, "density": 2700, "youngs_modulus": "70 GPa", "poisson_ratio": 0.31, "depth": 0.02,
                 "model": "second-order", "basis": "cantilever", "modes": 5, "kelvin_voigt": "1 us"},
        "cam": {"centre": ["30 cm", -0.3], "radius": 0.11, "eccentricity": 0.03, "phase": "-90 deg", "speed": "300 rpm", "youngs_modulus": "210 GPa", "poisson_ratio": 0.28},
        "contact": {"model": "restitution", "stiffness": "hertz", "exponent": 1.4, "damping": "flores", "restitution": 0.6, "law": "stronge",
                    "friction": {"type": "stick-slip", "coefficient": 0.1, "static_coefficient": 0.2, "stiffness": 1e5},
                    "offset": "half-depth", "approach_floor": {"policy": "first-touch", "value": "2 mm/s"}, "collision_gap": "5 ms"},
        "gravity": 1.62, "initial": {"angle": "60 deg", "angular_velocity": "-1 rad/s", "shape": "static"},
        "solver": {"method": "rk8", "rtol": 1e-9, "atol": 1e-12}, "time": {"end": "400 ms"}})");
    ASSERT_TRUE(reading.scene) << reading.report();
    const sim::Problem& p = reading.scene->problem;
    EXPECT_EQ(reading.scene->title, "all");
    EXPECT_EQ(p.hub.radius, 0.05);
    EXPECT_EQ(p.hub.inertia, 0.0012);
    const auto& torque = std::get<sim::HarmonicTorque>(p.hub.drive);
    EXPECT_EQ(torque.amplitude, 1);
    EXPECT_EQ(torque.frequency, 2);
    EXPECT_DOUBLE_EQ(torque.phase, std::acos(0.0));
    EXPECT_EQ(p.beam.length, 2);
    EXPECT_EQ(p.beam.area, 1e-4);
    EXPECT_EQ(p.beam.second_moment, 1e-8);
    EXPECT_EQ(p.beam.density, 2700);
    EXPECT_EQ(p.beam.youngs_modulus, 7e10);
    EXPECT_EQ(p.beam.poisson_ratio, 0.31);
    EXPECT_EQ(beam_depth(p.beam), 0.02);
    EXPECT_EQ(p.beam.model, sim::ModelKind::second_order);
    EXPECT_EQ(p.beam.basis, sim::Basis::cantilever);
    EXPECT_EQ(p.beam.modes, 5);
    EXPECT_EQ(p.beam.kelvin_voigt, 1e-6);
    EXPECT_EQ(p.cam->centre, (sim::Vec2{0.3, -0.3}));
    EXPECT_EQ(p.cam->radius, 0.11);
    EXPECT_EQ(p.cam->eccentricity, 0.03);
    EXPECT_DOUBLE_EQ(p.cam->phase, -std::acos(0.0));
    EXPECT_DOUBLE_EQ(p.cam->speed, 10 * std::acos(-1.0));
    EXPECT_EQ(p.cam->youngs_modulus, 2.1e11);
    EXPECT_EQ(p.cam->poisson_ratio, 0.28);
    EXPECT_EQ(p.contact.model, sim::ContactModel::restitution);
    EXPECT_FALSE(p.contact.stiffness);
    EXPECT_EQ(p.contact.exponent, 1.4);
    EXPECT_EQ(p.contact.damping, sim::DampingLaw::flores);
    EXPECT_EQ(p.contact.restitution, 0.6);
    EXPECT_EQ(p.contact.law, sim::ImpactLaw::stronge);
    const auto& friction = std::get<sim::StickSlipFriction>(p.contact.friction);
    EXPECT_EQ(friction.coefficient, 0.1);
    EXPECT_EQ(friction.static_coefficient, 0.2);
    EXPECT_EQ(friction.stiffness, 1e5);
    EXPECT_FALSE(p.contact.offset);
    EXPECT_EQ(p.contact.approach_floor.policy, sim::ApproachFloorPolicy::first_touch);
    EXPECT_EQ(p.contact.approach_floor.value, 0.002);
    EXPECT_EQ(p.contact.collision_gap, 0.005);
    EXPECT_EQ(p.gravity, 1.62);
    EXPECT_DOUBLE_EQ(p.initial.angle, std::acos(0.5));
    EXPECT_EQ(p.initial.angular_velocity, -1);
    EXPECT_EQ(p.initial.shape, sim::InitialShape::static_equilibrium);
    EXPECT_EQ(p.solver.method, sim::Method::rk8);
    EXPECT_EQ(p.solver.rtol, 1e-9);
    EXPECT_EQ(p.solver.atol, 1e-12);
    EXPECT_EQ(reading.scene->end_time, 0.4);
}

TEST(Reader, EveryOutputTypeIsRead) {
    const Reading reading = read(R"({"outputs": [
        {"type": "video", "file": "a.mp4", "size": [640, 360], "fps": 29.97, "from": 0.1, "to": "200 ms", "view": {"style": "flat", "exaggeration": 50}, "theme": "dark", "crf": 20, "preset": "fast", "rate_mode": "variable"},
        {"type": "frames", "file": "f/#.png", "size": [33, 35], "fps": "10"},
        {"type": "still", "at": "370 ms"},
        {"type": "trajectory", "file": "t.npz", "channels": ["q2", "theta"], "times": [1, 0.5]},
        {"type": "impacts", "file": "i.csv"},
        {"type": "summary", "horizon": true}]})");
    ASSERT_TRUE(reading.scene) << reading.report();
    const std::vector<Output>& outputs = reading.scene->outputs;
    ASSERT_EQ(outputs.size(), 6u);
    const auto& video = std::get<PictureOutput>(outputs[0]);
    EXPECT_EQ(video.file, "a.mp4");
    EXPECT_EQ(video.size, (Size{640, 360}));
    EXPECT_EQ(video.span.fps, (FrameRate{30000, 1001}));
    EXPECT_EQ(video.span.from, 0.1);
    EXPECT_EQ(video.span.to, 0.2);
    EXPECT_EQ(video.view.style, render::Style::flat);
    EXPECT_EQ(video.view.exaggeration, 50);
    EXPECT_EQ(video.view.theme, render::Theme::dark);
    EXPECT_EQ(video.encoding.crf, 20);
    EXPECT_EQ(video.encoding.preset, "fast");
    EXPECT_EQ(std::get<PictureOutput>(outputs[1]).span.fps, (FrameRate{10, 1}));
    EXPECT_EQ(std::get<PictureOutput>(outputs[2]).at.t, 0.37);
    EXPECT_EQ(std::get<PictureOutput>(outputs[2]).file, "scene.png");
    const auto& table = std::get<TrajectoryOutput>(outputs[3]);
    EXPECT_EQ(table.channels, (std::vector<sim::Channel>{{sim::ChannelKind::q, 2}, {sim::ChannelKind::theta, 0}}));
    EXPECT_EQ(table.times, (std::vector<double>{1, 0.5}));
    EXPECT_EQ(file_of(outputs[4]), "i.csv");
    EXPECT_TRUE(std::get<SummaryOutput>(outputs[5]).horizon);
}

TEST(Reader, PartsBesideThePanelsAreChosenByAWord) {
    const auto view = [](const std::string& keys) {
        const Reading reading = read(R"({"outputs": [{"type": "still", "at": 0, )" + keys + "}]}");
        return std::pair{reading.scene ? std::get<PictureOutput>(reading.scene->outputs[0]).view : View{},
                         reading.report()};
    };
    EXPECT_FALSE(view(R"("show": "clean")").first.labelled());
    EXPECT_FALSE(view(R"("show": "paper")").first.shown().title);
    EXPECT_TRUE(view(R"("show": "talk")").first.shown().title);
    EXPECT_THAT(view(R"("show": {"clock": false})").second, HasSubstr("one of all, talk, paper, clean"));
    EXPECT_THAT(view(R"("show": "tlak")").second, HasSubstr("talk"));
    EXPECT_EQ(view(R"("background": "#f4f1ea")").first.paper, 0xf4f1eau);
    EXPECT_THAT(view(R"("background": "#202020")").second, HasSubstr("hardly readable"));
    EXPECT_THAT(view(R"("background": "beige")").second, HasSubstr("a colour such as"));
}

TEST(Reader, PicturesHaveTheUnitsOfTheScene) {
    using render::SpeedUnit;
    const auto units = [](const std::string& text) { return read(text).scene->units; };
    EXPECT_EQ(units(R"({"initial": {"angle": "60 deg"}, "cam": {"speed": "-300 rpm"}})"),
              (render::Units{true, SpeedUnit::rpm}));
    EXPECT_EQ(units(R"({"hub": {"drive": {"type": "prescribed", "law": "constant", "speed": "10 rpm"}},
                        "cam": {"speed": 2, "phase": "30 deg"}})"),
              (render::Units{true, SpeedUnit::rpm}));
    EXPECT_EQ(units(R"({"initial": {"angle": 1}, "cam": {"speed": "2 rad/s"}})"),
              (render::Units{.speed = SpeedUnit::radians}));
    EXPECT_EQ(units(R"({"hub": {"drive": {"type": "prescribed", "law": "constant", "speed": "-30 deg/s"}}})"),
              (render::Units{.speed = SpeedUnit::degrees}));
    EXPECT_EQ(units(R"({"initial": {"angle": "60 deg"}, "units": {"angle": "rad"}})"), render::Units{});
    // Of a key that is swept, the values of the sweep decide.
    const std::string speed = R"({"cam": {"speed": "1 rad/s"}, "sweep": {"over": [{"key": "cam.speed", )";
    EXPECT_EQ(units(speed + R"("from": "300 rpm", "to": "400 rpm", "count": 3}]}})"),
              (render::Units{.speed = SpeedUnit::rpm}));
    EXPECT_EQ(units(speed + R"("values": ["300 rpm"]}]}})"), (render::Units{.speed = SpeedUnit::rpm}));
    EXPECT_EQ(units(speed + R"("values": [30]}]}})"), render::Units{});
    // A scene without units takes those of the motions that it compares.
    const std::string compared =
        R"("outputs": [{"type": "video", "file": "a.mp4", "compare": [{}, {"set": {"cam.speed": "60 rpm"}}]}]})";
    EXPECT_EQ(units("{" + compared), (render::Units{.speed = SpeedUnit::rpm}));
    EXPECT_EQ(units(R"({"cam": {"speed": "2 rad/s"}, )" + compared), (render::Units{.speed = SpeedUnit::radians}));
    const std::string written = to_json(*read(R"({"initial": {"angle": "60 deg"}})").scene);
    EXPECT_EQ(units(written), (render::Units{true, SpeedUnit::automatic}));
}

TEST(Reader, SuggestsAllKeysThatAreEquallyNear) {
    EXPECT_THAT(messages(read(R"({"beam": {"mode": 3}})")),
                ElementsAre("1:11 unknown key \"mode\" in beam; did you mean \"model\" or \"modes\"?"));
}

TEST(Reader, AllIssuesComeAtOnceInTheOrderOfTheText) {
    const Reading reading = read(
        "{\"beam\": {\"lenght\": 1,\n\"modes\": 2.5},\n\"cam\": {\"eccentricity\": \"2 s\"},\n\"time\": {\"end\": -1}, "
        "\"outputs\": [{\"type\": \"still\"}]}");
    EXPECT_FALSE(reading.scene);
    EXPECT_THAT(
        messages(reading),
        ElementsAre("1:11 unknown key \"lenght\" in beam; did you mean \"length\"?",
                    "2:10 beam.modes must be a whole number, not 2.5",
                    "3:25 cam.eccentricity = \"2 s\" has the wrong dimension (s); it is measured in m",
                    "4:17 time.end = -1 must be positive and at most 1e12 s; write the number of seconds to simulate",
                    "4:34 outputs.0 needs \"at\", for example \"370 ms\""));
}

TEST(Reader, BeyondAHundredIssuesAreCounted) {
    std::string text = "{\n";
    for (int i = 0; i < 250; ++i) text += fmt::format("\"nothing{}\": 1,\n", i);
    const Reading reading = read(text + "\"time\": {}}");
    EXPECT_EQ(reading.messages.size(), 250u);
    EXPECT_THAT(reading.report(),
                ::testing::AllOf(::testing::HasSubstr("nothing99"), ::testing::Not(::testing::HasSubstr("nothing100")),
                                 ::testing::EndsWith("and 150 more\n")));
}

TEST(Reader, AValueOfTheWrongKindIsReportedBesideTheOthers) {
    const Reading reading = read(
        R"({"hub": [], "beam": {"length": [], "model": 3}, "cam": 5, "contact": {"friction": "none"}, "outputs": {}})");
    EXPECT_EQ(messages(reading).size(), 6u) << reading.report();
}

TEST(Reader, ImpossiblePhysicsIsReportedAtItsKey) {
    EXPECT_THAT(messages(read("{\"cam\": {\"radius\": 0.1,\n \"eccentricity\": 0.2}}")),
                ElementsAre(StartsWith("2:18 cam.eccentricity")));
    // No such key in the text: the nearest one that is there.
    EXPECT_THAT(messages(read("{\n\"cam\": {\"eccentricity\": 0.2}}")),
                ElementsAre(StartsWith("2:25 cam.eccentricity")));
    EXPECT_THAT(messages(read("{\n \"beam\": {\"model\": \"rigid\"}, \"cam\": {\"radius\": 0.3}}")),
                ElementsAre(StartsWith("2:30 cam.centre")));
    EXPECT_THAT(messages(read("{ \"initial\": {\"angle\": 0}}")), ElementsAre(StartsWith("1:24 initial.angle")));
}

TEST(Reader, ADefaultThatReplacedAnUnreadValueIsNotJudged) {
    // With the default length 1 m this cam is never reached; the length was meant to be another.
    EXPECT_THAT(messages(read(R"({"beam": {"length": "5 s"}, "cam": {"centre": [3, 0]}})")),
                ElementsAre(HasSubstr("wrong dimension")));
    const std::string law = R"({"cam": {"profile": {"lowest": 0.2, "segments": [{"law": "345", "rise": 0.1}]}}})";
    EXPECT_THAT(messages(read(law)), ElementsAre(HasSubstr("did you mean \"3-4-5\"?")));
}

TEST(Reader, PointlessScenesAreWarnedAboutAndRead) {
    const Reading reading = read(R"({"cam": {"centre": [3, 0]}})");
    EXPECT_TRUE(reading.scene);
    ASSERT_EQ(reading.messages.size(), 1u);
    EXPECT_FALSE(reading.messages[0].fatal);
    EXPECT_THAT(reading.report(), HasSubstr("scene.json:1:20: warning: cam.centre"));
    const std::string chinese = R"({"title": "柔性梁", "outputs": [{"type": "still", "at": 0, "file": "a.png")";
    EXPECT_THAT(read(chinese + "}]}").report(), HasSubstr("warning: outputs.0.lang: the title is not English"));
    EXPECT_EQ(read(chinese + R"(, "lang": "zh"}]})").report(), "");
}

TEST(Reader, WhatTheVersionCannotDoIsRejectedByName) {
    EXPECT_THAT(messages(read(R"({"outputs": [{"type": "gif"}]})")),
                ElementsAre(HasSubstr("write a \"video\" whose \"file\" ends in .gif")));
}

TEST(Reader, ATypeThatIsLeftOutFollowsFromTheOtherKeys) {
    const auto drive = [](const char* keys) {
        return read(fmt::format(R"({{"hub": {{"drive": {}}}}})", keys)).scene.value().problem.hub.drive;
    };
    EXPECT_TRUE(std::holds_alternative<sim::FreeDrive>(drive("{}")));
    EXPECT_TRUE(std::holds_alternative<sim::ConstantTorque>(drive(R"({"value": 1})")));
    EXPECT_TRUE(std::holds_alternative<sim::HarmonicTorque>(drive(R"({"amplitude": 1, "frequency": 2})")));
    EXPECT_TRUE(std::holds_alternative<sim::ConstantSpeed>(drive(R"({"speed": 1, "x-why": "paper"})")));
    EXPECT_TRUE(std::holds_alternative<sim::SpinUp>(drive(R"({"type": "prescribed", "speed": 1, "duration": 2})")));
    EXPECT_TRUE(std::holds_alternative<sim::AngleTable>(drive(R"({"law": "table", "t": [0, 1], "theta": [0.8, 1]})")));
    EXPECT_TRUE(std::holds_alternative<sim::StickSlipFriction>(
        read(R"({"contact": {"friction": {"coefficient": 0.2, "static_coefficient": 0.3}}})")
            .scene.value()
            .problem.contact.friction));
    EXPECT_THAT(messages(read(R"({"contact": {"friction": {"coefficient": 0.2}}})")),
                ElementsAre("1:26 contact.friction needs \"type\", one of coulomb, stick-slip"));
    EXPECT_THAT(messages(read(R"({"hub": {"drive": {"torqe": 1}}})")),
                ElementsAre("1:19 hub.drive needs \"type\", one of free, torque, prescribed",
                            HasSubstr("\"torqe\" in hub.drive; did you mean \"torque\"?")));
    EXPECT_THAT(messages(read(R"({"beam": {"section": {"width": 1, "hight": 1}}})")),
                ElementsAre(HasSubstr("beam.section needs \"height\""), HasSubstr("did you mean \"height\"?")));
    EXPECT_THAT(messages(read(R"({"beam": {"section": {}}})")), ElementsAre(HasSubstr("rectangle, circle, tube")));
    EXPECT_THAT(messages(read(R"({"beam": {"section": {"width": 1}}})")),
                ElementsAre(HasSubstr("beam.section needs \"height\"")));
    EXPECT_THAT(messages(read(R"({"outputs": [{"file": "a.mp4"}]})")),
                ElementsAre(HasSubstr("needs \"type\", one of video")));
}

TEST(Reader, ShortPlainNumbersOfImplausibleSizeArePerhapsInAnotherUnit) {
    const Reading reading = read(R"({"initial": {"angle": 45}, "cam": {"phase": 6.5e0, "speed": 7}})");
    EXPECT_TRUE(reading.scene);
    EXPECT_THAT(messages(reading),
                ElementsAre("1:23 initial.angle = 45 is in rad; write \"45 deg\" if that is meant",
                            "1:45 cam.phase = 6.5e0 is in rad; write \"6.5e0 deg\" if that is meant"));
    EXPECT_THAT(messages(read(R"({"beam": {"length": 300, "area": 73, "second_moment": 8219, "density": 7.85,
                                           "youngs_modulus": 210}})")),
                AllOf(Contains(HasSubstr("beam.length = 300 is in m; write \"300 mm\" if that is meant")),
                      Contains(HasSubstr("\"73 mm^2\"")), Contains(HasSubstr("\"8219 mm^4\"")),
                      Contains(HasSubstr("\"7.85 g/cm^3\"")), Contains(HasSubstr("\"210 GPa\""))));
    EXPECT_TRUE(messages(read(R"({"beam": {"length": "300 m"}, "cam": {"phase": 7.853981634}})")).empty());
    EXPECT_THAT(messages(read(R"({"beam": {"length": "12 inch"}})")), ElementsAre(HasSubstr("\"inch\"; write in")));
}

TEST(Reader, MessagesOfNumbersNameTheRemedy) {
    const std::pair<const char*, const char*> cases[] = {
        {R"({"contact": {"stiffness": "Hertz"}})", "contact.stiffness must be \"hertz\" or a number"},
        {R"({"contact": {"offset": "half_depth"}})", "contact.offset must be \"half-depth\" or a number"},
        {R"({"beam": {"length": "1,2 mm"}})", "the decimal sign is a point"},
        {R"({"beam": {"section": {"width": 20, "height": 1}}})", "is 1 m deep, but the beam 1 m long"},
        {R"({"cam": {"profile": {"type": "points", "x": [0, 1, 1, 0], "y": "@c.csv:y"}}})",
         "cam.profile.x has 4 of at least 24 numbers"},
        {R"({"cam": {"profile": {"lowest": 1, "segments": [{"law": "harmonic", "rise": "8 mm"}]}}})",
         "measured in rad: divide by the distance from the pivot"}};
    for (const auto& [scene, remedy] : cases) EXPECT_THAT(messages(read(scene)), Contains(HasSubstr(remedy)));
    EXPECT_THAT(messages(read(R"({"outputs": [{"type": "trajectory", "data": []}]})")),
                Contains(::testing::EndsWith("it goes with type=figure")));
}

TEST(Reader, KeysForWhatIsNotModelledSaySo) {
    for (const auto& [scene, message] :
         {std::pair{R"({"cam": {"liftTable": 1}})", "\"profile\" of the cam describes any convex outline"},
          {R"({"hub": {"return_spring": {}}})", "springs at the beam are not modelled"},
          {R"({"hub": {"damping": 1}})", "friction at the hub is not modelled"},
          {R"({"beam": {"tip-mass": 1}})", "a mass at the tip or at a point is not modelled"},
          {R"({"contact": {"roller_radius": 1}})", "a roller or a nose is not modelled"},
          {R"({"beam": {"taper": 0.5}})", "tapered and stepped beams are not modelled"},
          {R"({"beam": {"width": 0.01}})", "write \"section\": {\"type\": \"rectangle\""}})
        EXPECT_THAT(messages(read(scene)), ElementsAre(HasSubstr(message)));
    EXPECT_THAT(messages(read(R"({"beam": {"dampng_ratio": 1}})")), ElementsAre(HasSubstr("did you mean")));
}

TEST(Reader, AProfileReplacesTheNumbersOfTheDisc) {
    const std::string arcs = R"({"cam": {"profile": {"arcs": [{"centre": ["20 mm", 0], "radius": "10 cm"}]})";
    const Reading reading = read(arcs + "}}");
    ASSERT_TRUE(reading.scene) << reading.report();
    const auto& profile = std::get<sim::ArcsProfile>(*reading.scene->problem.cam->profile);
    ASSERT_EQ(profile.arcs.size(), 1u);
    EXPECT_EQ(profile.arcs[0].radius, 0.1);
    EXPECT_EQ(profile.arcs[0].centre, (sim::Vec2{0.02, 0}));
    for (const char* number : {"radius", "eccentricity"})
        EXPECT_THAT(messages(read(arcs + fmt::format(R"(, "{}": 0.05}}}})", number))),
                    Contains(AllOf(HasSubstr("\"profile\""), HasSubstr(fmt::format("\"{}\"", number)))));
    EXPECT_TRUE(read(R"({"cam": {"profile": null}})").scene);
    EXPECT_THAT(messages(read(R"({"cam": {"profile": {"type": "law", "lowest": "14 deg",
        "segments": [{"law": "cycloidal", "rise": "8 deg"}]}}})")),
                ElementsAre(AllOf(HasSubstr("2:51"), HasSubstr("write 0 deg here"))));
}

TEST(Reader, AnOutlineIsReadFromAFile) {
    const testing::Folder folder;
    std::string rows = "x [mm];y;phi;r\n", clockwise = rows;
    for (int i = 0; i < 60; ++i) {
        const double angle = i < 25 ? 6.0 * i : 6.0 * i - 360, a = angle * std::numbers::pi / 180;
        rows += fmt::format("{};{};{};{}\n", 80 * std::cos(a), 0.08 * std::sin(a), angle, 8);
    }
    folder.write("cam.csv", rows);
    const auto read_profile = [&](const std::string& keys) {
        return read_scene({(folder / "scene.json").string(), R"({"cam": {"profile": {)" + keys + "}}}", true});
    };
    for (const char* keys :
         {R"("file": "cam.csv", "x": "x", "y": "y")", R"("x": "@cam.csv:x [mm]", "y": "@cam.csv:y")",
          R"("file": "cam.csv", "angle": "phi", "radius": "r", "units": {"phi": "deg", "r": "cm"})"}) {
        const Reading reading = read_profile(keys);
        ASSERT_TRUE(reading.scene) << reading.report();
        EXPECT_TRUE(reading.messages.empty()) << reading.report();
        const auto& points = std::get<sim::PointsProfile>(*reading.scene->problem.cam->profile);
        ASSERT_EQ(points.x.size(), 60u);
        EXPECT_NEAR(points.x[10], 0.04, 1e-15) << keys;
        EXPECT_NEAR(points.y[10], 0.04 * std::sqrt(3.0), 1e-15) << keys;
    }
    const auto error = [&](const std::string& keys) { return messages(read_profile(keys)); };
    EXPECT_THAT(error(R"("file": "none.csv", "x": "x [mm]", "y": "y")"), Contains(HasSubstr("none.csv")));
    EXPECT_THAT(error(R"("file": "cam.csv", "x": "x", "y": "z")"), Contains(HasSubstr("no column \"z\"")));
    EXPECT_THAT(error(R"("file": "cam.csv", "x": "@cam.csv", "y": "y")"),
                Contains(HasSubstr("no column \"\"; the choices are x [mm], y")));
    EXPECT_THAT(error(R"("file": "cam.csv", "x": "x [mm]", "y": "y", "units": {"y": "kg"})"),
                Contains(HasSubstr("\"kg\" is not a unit of the column \"y\", which is measured in m")));
    folder.write("cam.csv", rows + "1;;2;3\n");
    EXPECT_THAT(error(R"("file": "cam.csv", "x": "x [mm]", "y": "y")"), Contains(HasSubstr("line 62")));
    folder.write("cam.csv", rows + "1;two;2;3\n");
    EXPECT_THAT(error(R"("file": "cam.csv", "x": "x [mm]", "y": "y")"), Contains(HasSubstr("62")));
}

TEST(Reader, AnImpossibleFormatIsRejectedWithAPossibleOne) {
    EXPECT_THAT(messages(read(R"({"outputs": [{"type": "video", "background": "transparent"}]})")),
                ElementsAre(HasSubstr("name a .webm (vp9)")));
    EXPECT_THAT(messages(read(R"({"outputs": [{"type": "video", "file": "a.webm", "size": [321, 240]}]})")),
                ElementsAre(HasSubstr("use 322x240")));
    EXPECT_THAT(messages(read(R"({"outputs": [{"type": "video", "file": "a.gif", "fps": 60}]})")),
                ElementsAre(HasSubstr("use 50, 25 or 20")));
    EXPECT_THAT(messages(read(R"({"outputs": [{"type": "video", "codec": "vp9"}]})")),
                ElementsAre(HasSubstr("name a .webm or .mkv file")));
}

TEST(Reader, TheEndingChoosesTheCodec) {
    const Reading reading =
        read(R"({"outputs": [{"type": "video", "file": "a.webm"}, {"type": "video", "file": "b.gif"},
        {"type": "video", "file": "c.mov"}, {"type": "video", "file": "d.mkv"}]})");
    ASSERT_TRUE(reading.scene) << reading.report();
    const output::Codec expected[] = {output::Codec::vp9, output::Codec::gif, output::Codec::prores,
                                      output::Codec::ffv1};
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_EQ(std::get<PictureOutput>(reading.scene->outputs[i]).encoding.codec, expected[i]);
    EXPECT_EQ(std::get<PictureOutput>(reading.scene->outputs[1]).span.fps, (FrameRate{25, 1}));
}

TEST(Reader, ComparedMotionsAreTheSceneWithChanges) {
    const Reading reading = read(R"({"beam": {"modes": 5}, "outputs": [{"type": "video", "compare": [{"label": "a"},
        {"label": "b", "set": {"cam.speed": 5, "beam.model": "rigid"}}, {"set": {"cam": null}}]}]})");
    ASSERT_TRUE(reading.scene) << reading.report();
    const auto& compared = std::get<PictureOutput>(reading.scene->outputs[0]).compare;
    ASSERT_EQ(compared.size(), 3u);
    EXPECT_EQ(compared[0].problem.beam.modes, 5);
    EXPECT_EQ(compared[0].problem.cam->speed, reading.scene->problem.cam->speed);
    EXPECT_EQ(compared[1].problem.cam->speed, 5);
    EXPECT_EQ(compared[1].problem.beam.model, sim::ModelKind::rigid);
    EXPECT_EQ(compared[1].label, "b");
    EXPECT_FALSE(compared[2].problem.cam);
    EXPECT_EQ(compared[2].label, "3");
}

TEST(Reader, WhatAComparisonCannotChangeIsReportedAtItsPlace) {
    EXPECT_THAT(messages(read(R"({"outputs": [{"type": "video", "compare": [{}, {"set": {"cam.spede": 1}}]}]})")),
                ElementsAre(HasSubstr("did you mean \"speed\"")));
    EXPECT_THAT(messages(read(R"({"outputs": [{"type": "video", "compare": [{}, {"set": {"time.end": 1}}]}]})")),
                ElementsAre(HasSubstr("is not part of the mechanics")));
}

TEST(Reader, AnErrorOfTheSceneIsNotRepeatedForItsComparedMotions) {
    const std::string compared =
        R"("outputs": [{"type": "video", "compare": [{}, {"set": {"beam.model": "rigid"}}, {"label": "c"}]}]})";
    for (const std::string wrong : {"cam.spede=3", "cam.speed=3furlongs", "beam.length=-3"})
        EXPECT_THAT(messages(read("{" + compared, {wrong})), ElementsAre(HasSubstr(wrong.substr(0, 3))));
    EXPECT_THAT(messages(read(R"({"beam": {"length": -3}, )" + compared)), ElementsAre(HasSubstr("beam.length")));
}

TEST(Reader, AStartInTheCamNamesTheAngleThatCanChange) {
    const auto wrong = [](const std::string& drive) {
        return messages(read(R"({"initial": {"angle": 0}, "hub": {"drive": )" + drive + "}}"));
    };
    EXPECT_THAT(wrong(R"({"type": "free"})"), ElementsAre(AllOf(HasSubstr("initial.angle"), HasSubstr("resting"))));
    EXPECT_THAT(wrong(R"({"type": "prescribed", "law": "constant", "speed": 1})"),
                ElementsAre(AllOf(HasSubstr("initial.angle"), Not(HasSubstr("resting")))));
    EXPECT_THAT(wrong(R"({"type": "prescribed", "law": "table", "t": [0, 1], "theta": [0, 1]})"),
                ElementsAre(AllOf(HasSubstr("hub.drive.theta"), Not(HasSubstr("resting")))));
}

TEST(Reader, UnknownWordsAreAnsweredWithTheNearestOrAll) {
    EXPECT_THAT(messages(read(R"({"contact": {"damping": "lankarani"}})")),
                ElementsAre(HasSubstr("did you mean \"lankarani-nikravesh\"?")));
    EXPECT_THAT(messages(read(R"({"cam": {"center": [0.25, 0]}})")),
                ElementsAre(HasSubstr("did you mean \"centre\"?")));
    EXPECT_THAT(messages(read(R"({"beam": {"model": "shell"}})")),
                ElementsAre(HasSubstr("the choices are rigid, zeroth-order, first-order")));
    EXPECT_THAT(messages(read(R"({"outputs": [{"type": "trajectory", "channels": ["contact_forse"]}]})")),
                ElementsAre(HasSubstr("did you mean \"contact_force\"?")));
}

TEST(Reader, ExtensionKeysAreIgnoredEverywhere) {
    EXPECT_TRUE(
        read(
            R"({"x-a": 1, "hub": {"x-b": {}, "drive": {"type": "free", "x-c": 0}}, "outputs": [{"type": "video", "x-d": 0, "view": {"x-e": 0}}]})")
            .scene);
}

TEST(Reader, FramesAreCountedByRoundedNumbers) {
    EXPECT_EQ(problem_with_span({{60, 1}, 0, {}}, 1.5), "");
    EXPECT_EQ(problem_with_span({{60, 1}, 0.5, 0.517}, 1.5), "");
    EXPECT_THAT(problem_with_span({{60, 1}, 0.5, 0.505}, 1.5), HasSubstr("from 0.5 s to 0.505 s has no frame"));
    EXPECT_THAT(problem_with_span({{60, 1}, 2, {}}, 1.5), HasSubstr("has no frame at 60 frames a second"));
    const auto film = [](const std::string& keys) {
        return read(R"({"outputs": [{"type": "video", "from": 0.2, "to": 0.4, "duration": 2, )" + keys + "}]}")
            .report();
    };
    EXPECT_EQ(film(R"("hold": 1.9)"), "");
    EXPECT_THAT(problem_with_span({.fps = {60, 1}, .duration = 1e9}, 1.5), HasSubstr("reduce \"duration\" or \"fps\""));
    EXPECT_THAT(film(R"("hold": 2)"), HasSubstr("the freezes and the hold fill the film of 2 s"));
    EXPECT_THAT(film(R"("hold": 1, "events": [{"at": 0.3, "freeze": 1}])"), HasSubstr("fill the film of 2 s"));
}

// ---- overrides ---------------------------------------------------------------------------------

TEST(Override, ReplacesInsertsAndCountsInArrays) {
    const Reading reading = read("{\"beam\": {\"modes\": 2}, \"outputs\": [{\"type\": \"video\"}]}",
                                 {"beam.modes=7", "cam.speed=300 rpm", "contact.friction={\"type\": \"coulomb\"}",
                                  "outputs.0.fps=30", "beam.model=rigid", "title=a b"});
    ASSERT_TRUE(reading.scene) << reading.report();
    EXPECT_EQ(reading.scene->problem.beam.modes, 7);
    EXPECT_DOUBLE_EQ(reading.scene->problem.cam->speed, 10 * std::acos(-1.0));
    EXPECT_TRUE(std::holds_alternative<sim::CoulombFriction>(reading.scene->problem.contact.friction));
    EXPECT_EQ(std::get<PictureOutput>(reading.scene->outputs[0]).span.fps, (FrameRate{30, 1}));
    EXPECT_EQ(reading.scene->problem.beam.model, sim::ModelKind::rigid);
    EXPECT_EQ(reading.scene->title, "a b");
}

TEST(Override, MakesAnInvalidValueOfTheFileGood) {
    EXPECT_TRUE(read("{\"beam\": {\"length\": \"long\"}}", {"beam.length=2"}).scene);
}

TEST(Override, TheLastOneCounts) {
    EXPECT_EQ(read("{}", {"beam.modes=3", "beam.modes=4"}).scene->problem.beam.modes, 4);
}

TEST(Override, NullIsNoCam) { EXPECT_FALSE(read("{}", {"cam=null"}).scene->problem.cam); }

TEST(Override, ErrorsNameTheOverride) {
    EXPECT_THAT(messages(read("{}", {"beam.modes=x"})),
                ElementsAre("--set beam.modes=x beam.modes must be a whole number, not \"x\""));
    EXPECT_THAT(read("{}", {"beam.modes=x"}).report(), StartsWith("--set beam.modes=x: beam.modes must be"));
    EXPECT_THAT(read("{}", {"cam.centre.0=0.3"}).report(),
                HasSubstr("does not contain cam.centre, which entry \"0\" would belong to; set cam.centre itself"));
    EXPECT_THAT(messages(read("{}", {"beam.lenght=1"})), ElementsAre(HasSubstr("did you mean \"length\"?")));
    EXPECT_THAT(messages(read("{}", {"beam"})), ElementsAre(HasSubstr("\"=\" is missing")));
    EXPECT_THAT(messages(read("{}", {"=3"})), ElementsAre(HasSubstr("the key is missing before \"=\"")));
    EXPECT_THAT(messages(read("{}", {"beam..modes=3"})), ElementsAre(HasSubstr("empty key")));
    EXPECT_THAT(messages(read("{}", {"beam={\"modes\": }"})), ElementsAre(HasSubstr("a value is missing")));
    EXPECT_THAT(messages(read("{}", {"gravity=1e999"})), ElementsAre(HasSubstr("too large")));
    EXPECT_THAT(messages(read("{\"cam\": null}", {"cam.speed=3"})), ElementsAre(HasSubstr("cam is null")));
    EXPECT_THAT(messages(read("{\"outputs\": [{\"type\": \"video\"}]}", {"outputs.1.fps=3"})),
                ElementsAre(HasSubstr("1 entries")));
    EXPECT_THAT(messages(read("{}", {"cam={\"speed\": 1, \"speed\": 2}"})),
                ElementsAre(HasSubstr("duplicate key \"speed\"")));
}

// ---- comparisons of files --------------------------------------------------------------------------

std::string comparing(std::string_view file, int times = 1) {
    std::string entries = R"({"label": "own"})";
    for (int i = 0; i < times; ++i) entries += fmt::format(R"(, {{"scene": "{}"}})", file);
    return fmt::format(R"({{"outputs": [{{"type": "still", "at": 0, "compare": [{}]}}]}})", entries);
}

Reading read_file_of(const testing::Folder& folder, const std::string& name) {
    return read_scene(load_source((folder / name).string()));
}

// A file gives its mechanics alone: its own outputs may compare it with any other.
TEST(ComparedFiles, MayCompareOneAnother) {
    const testing::Folder folder;
    folder.write("self.json", comparing("./self.json"));
    folder.write("a.json", comparing("b.json", 7));
    folder.write(
        "b.json",
        R"({"beam": {"modes": 5}, "outputs": [{"type": "still", "at": 0, "compare": [{}, {"scene": "a.json"}]}]})");
    EXPECT_TRUE(read_file_of(folder, "self.json").scene);
    const Reading reading = read_file_of(folder, "a.json");
    ASSERT_TRUE(reading.scene) << reading.report();
    EXPECT_EQ(std::get<PictureOutput>(reading.scene->outputs[0]).compare[7].problem.beam.modes, 5);
}

TEST(ComparedFiles, AreValidScenesButForTheirOutputs) {
    const testing::Folder folder;
    folder.write("a.json", comparing("b.json"));
    for (const char* wrong : {R"({"beam": {"length": -1}})", "{\"beam\": ", "[1]", "{\"beem\": {\"modes\": 5}}",
                              R"({"time": {"end": -1}})", R"({"beam": 1})"}) {
        folder.write("b.json", wrong);
        EXPECT_THAT(messages(read_file_of(folder, "a.json")),
                    ElementsAre(AllOf(HasSubstr("it is not a valid scene"), HasSubstr("b.json` lists its errors"))))
            << wrong;
    }
    folder.write("b.json", R"({"beam": {"length": 2}, "outputs": [{"type": "nothing"}]})");
    EXPECT_TRUE(read_file_of(folder, "a.json").scene);
}

TEST(ComparedFiles, OnlyRegularFilesAreRead) {
    const testing::Folder folder;
    ASSERT_EQ(mkfifo((folder / "pipe.json").c_str(), 0600), 0);
    for (const char* name : {"pipe.json", "/dev/zero"}) {
        folder.write("a.json", comparing(name));
        EXPECT_THAT(messages(read_file_of(folder, "a.json")), ElementsAre(HasSubstr("not a regular file"))) << name;
    }
    folder.write("a.json", comparing("-"));
    EXPECT_THAT(messages(read_file_of(folder, "a.json")), ElementsAre(HasSubstr("No such file")));
}

TEST(Reader, NoTextHasTheCharacterThatEndsOne) {
    EXPECT_THAT(messages(read("{\"title\": \"a\\u0000b\"}")), ElementsAre(HasSubstr("U+0000")));
    EXPECT_THAT(messages(read("{\"x-\\u0000\": 1}")), ElementsAre(HasSubstr("U+0000")));
    EXPECT_THAT(messages(read("{}", {"title=\"\\u0000\""})), ElementsAre(HasSubstr("U+0000")));
}

// ---- files -------------------------------------------------------------------------------------

TEST(LoadSource, WhatCannotBeReadIsReported) {
    const testing::Folder folder;
    EXPECT_THROW(load_source((folder / "absent.json").string()), output::IoError);
    EXPECT_THROW(load_source(folder.path().string()), output::IoError);
    try {
        load_source(folder.path().string());
    } catch (const output::IoError& error) {
        EXPECT_THAT(error.what(), HasSubstr("is a directory"));
    }
}

TEST(LoadSource, TheSceneTakesTheFilesName) {
    const testing::Folder folder;
    const Reading reading = read_scene(load_source(folder.write("fall.v2.json", "{}").string()));
    EXPECT_EQ(reading.scene->name, "fall.v2");
    EXPECT_EQ(default_film(*reading.scene).file, "fall.v2.mp4");
}

}  // namespace
}  // namespace beamcam::scenes
