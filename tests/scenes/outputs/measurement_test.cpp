// Measured data as machines write them: the columns that the scene names are all that matters.
#include "scenes/scene/measurement.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <functional>

#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

using ::testing::AllOf, ::testing::HasSubstr, ::testing::Not;
using testing::Finished, testing::Folder, testing::shell, testing::slurp;

constexpr const char* kRotating =
    R"({{"cam": {{"speed": "120 rpm"{}}}, "beam": {{"model": "rigid"}}, "time": {{"end": 2}}, "contact": {{"model": "restitution"}},
        "data": [{{"file": "enc.csv", "label": "encoder", "t": "t", "cam_angle": "deg", "units": {{"deg": "deg"}}{}}}]}})";

// The angle of a cam at 120 rpm as an encoder gives it, each 10 ms for 2 s.
std::string encoder(const std::function<double(double degrees)>& reading) {
    std::string text = "t,deg\n";
    for (int k = 0; k <= 200; ++k) text += fmt::format("{:.3f},{:.3f}\n", 0.01 * k, reading(-7.2 * k));
    return text;
}
double within_turn(double degrees) { return degrees - 360 * std::floor(degrees / 360); }

double number_of_summary(const std::string& json, const std::string& key) {
    const std::size_t at = json.find("\"" + key + "\": ", json.find("\"data\""));
    return at == std::string::npos ? NAN : std::stod(json.substr(at + key.size() + 4));
}

struct Judged {
    double rms = NAN;
    std::string messages;
};
Judged judged(const std::string& data, const std::string& cam = "", const std::string& keys = "") {
    const Folder folder;
    folder.write("enc.csv", data);
    folder.write("s.json", fmt::format(kRotating, cam, keys));
    const Finished done = shell(folder, "$BEAMCAM simulate s.json --summary o.json -v");
    EXPECT_EQ(done.code, 0) << done.err;
    return {number_of_summary(slurp(folder / "o.json"), "rms"), done.err};
}

TEST(MeasuredAngles, ThatWrapAreJoinedWithAMessage) {
    const Judged wrapped = judged(encoder(within_turn));
    EXPECT_LT(wrapped.rms, 1e-4);
    EXPECT_THAT(wrapped.messages, HasSubstr("the column \"deg\" jumps by 3"));
    const Judged centred = judged(encoder([](double angle) { return within_turn(angle + 180) - 180; }));
    EXPECT_LT(centred.rms, 1e-4);
    // The cam begins at another angle, which the encoder gives within a turn.
    EXPECT_LT(judged(encoder([](double angle) { return within_turn(angle - 800); }), R"(, "phase": "-800 deg")").rms,
              1e-4);
    const Judged whole = judged(encoder([](double angle) { return angle; }));
    EXPECT_LT(whole.rms, 1e-4);
    EXPECT_THAT(whole.messages, Not(HasSubstr("jumps")));
}

// A pendulum that swings through half a turn between two rows is not a wrap: its values span more than a turn.
TEST(MeasuredAngles, OfMoreThanATurnAreNotJoined) {
    const Judged coarse = judged("t,deg\n0,0\n0.3,-216\n0.6,-432\n0.9,-648\n");
    EXPECT_LT(coarse.rms, 1e-6);
    EXPECT_THAT(coarse.messages, Not(HasSubstr("jumps")));
}

// ---- files of machines ---------------------------------------------------------------------------------

constexpr const char* kScene =
    R"({"cam": {"speed": 1}, "time": {"end": 0.5}, "data": [{"file": "FILE", "t": "time", "theta": "angle"}]})";

class MachineFiles : public ::testing::Test {
  protected:
    MachineFiles() {
        folder_.write("plain.json", R"({"cam": {"speed": 1}, "time": {"end": 0.5}})");
        const Finished done = shell(folder_, "$BEAMCAM simulate plain.json --times 0,0.1,0.2,0.3 --channels theta");
        std::istringstream lines(done.out);
        std::string line;
        std::getline(lines, line);
        while (std::getline(lines, line)) rows_.push_back(line);
    }
    // The rows, each as `row` writes it.
    std::string body(const std::function<std::string(const std::string& t, const std::string& angle)>& row) const {
        std::string text;
        for (const std::string& each : rows_)
            text += row(each.substr(0, each.find(',')), each.substr(each.find(',') + 1)) + "\n";
        return text;
    }
    Finished read(const std::string& text, const std::string& file = "rig.csv") const {
        folder_.write(file, text);
        std::string scene = kScene;
        scene.replace(scene.find("FILE"), 4, file);
        folder_.write("s.json", scene);
        return shell(folder_, "$BEAMCAM simulate s.json --summary o.json --force -v");
    }
    double rms() const { return number_of_summary(slurp(folder_ / "o.json"), "rms"); }

    const Folder folder_;
    std::vector<std::string> rows_;
};

std::string with_commas(std::string number) {
    std::ranges::replace(number, '.', ',');
    return number;
}

TEST_F(MachineFiles, AreReadWithColumnsThatTheSceneDoesNotName) {
    const auto plain = [](const std::string& t, const std::string& angle) { return t + "," + angle; };
    for (const std::string& text :
         {"time,angle\n" + body(plain), "time,angle,note\n" + body([&](auto&t, auto&a) { return plain(t, a) + ",ok"; }),
          ",time,angle\n" + body([&](auto&t, auto&a) { return "0," + plain(t, a); }),
          "time,angle\ns,rad\n" + body(plain), "# rig 7\n# operator: X\ntime,angle\n" + body(plain) + "\n\n\n",
          "date,time,angle\n" + body([&](auto&t, auto&a) { return "2026-11-28T12:00:00," + plain(t, a); }),
          "time,angle,force\n" + body([&](auto&t, auto&a) { return plain(t, a) + ",NA"; }),
          "time;angle\n" + body([&](auto&t, auto&a) { return with_commas(t) + ";" + with_commas(a); }),
          "time\tangle\r\n" + body([&](auto&t, auto&a) { return with_commas(t) + "\t" + with_commas(a) + "\r"; })}) {
        const Finished done = read(text);
        ASSERT_EQ(done.code, 0) << done.err << text;
        EXPECT_LT(rms(), 1e-12) << text;
    }
    const Finished german =
        read("time;angle\n" + body([&](auto& t, auto& a) { return with_commas(t) + ";" + with_commas(a); }), "RIG.CSV");
    EXPECT_EQ(german.code, 0) << german.err;
}

TEST_F(MachineFiles, HaveTheUnitsThatTheyState) {
    const auto degrees = [](const std::string& t, const std::string& angle) {
        return fmt::format("{:.17g},{:.17g}", 1000 * std::stod(t), std::stod(angle) * 180 / M_PI);
    };
    const Finished done = read("time,angle\n[ms],[deg]\n" + body(degrees));
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_LT(rms(), 1e-12);
    const Finished counts = read("time,angle\ns,counts\n" + body([](auto& t, auto& a) { return t + "," + a; }));
    EXPECT_EQ(counts.code, 0);
    EXPECT_THAT(counts.err, HasSubstr("data.0.file: the file states \"counts\" for the column \"angle\""));
}

TEST_F(MachineFiles, AreRefusedWithThePlaceWhereANamedColumnIsWrong) {
    for (const auto& [text, words] :
         {std::pair{"time,angle\n0,0.1\n0.1,bad\n", "rig.csv:3:5: \"bad\" is not a number"},
          std::pair{"# rig\n\ntime,angle\ns,rad\n0,0.1\n0.1,bad\n", "rig.csv:6:5: \"bad\" is not a number"},
          std::pair{"time,angle\n0,0.1\n\n\n0,0.1\n", "line 5: the time does not increase"},
          std::pair{"time;angle\n0,1;1,5\n0,2;1.5\n", "rig.csv:3:5: \"1.5\" has another decimal sign"},
          std::pair{"time,angle\n2026-11-28 12:00:00,1\n",
                    "rig.csv:2:1: \"2026-11-28 12:00:00\" is not a number; write times in seconds"},
          std::pair{"0,0.1\n0.1,0.2\n", "rig.csv:1:1: a number where the names of the columns should be"}}) {
        const Finished done = read(text);
        EXPECT_EQ(done.code, 3) << text;
        EXPECT_THAT(done.err, HasSubstr(words)) << text;
    }
    const Finished gaps = read("time,angle\n0,NA\n0.1,0.2\n,0.3\n0.3,\n");
    EXPECT_EQ(gaps.code, 0) << gaps.err;
}

// ---- columns in place of lists ------------------------------------------------------------------------

// A hub that an encoder's record drives moves as with the same numbers in the scene.
TEST(FileColumn, IsADriveTableOfTheScene) {
    const Folder folder;
    folder.write("enc.csv", "n;t [ms];angle\n;;deg\n1;0;0\n2;500;90\n3;1000;170\n4;1500;250\n5;2000;330\n");
    const std::string scene =
        R"({"cam": null, "time": {"end": 2}, "hub": {"drive": {"type": "prescribed", "law": "table", )";
    folder.write("file.json", scene + R"("t": "@enc.csv:t [ms]", "theta": "@enc.csv:angle"}}})");
    folder.write("list.json", scene + R"("t": [0, 0.5, 1, 1.5, 2],
        "theta": [0, "90 deg", "170 deg", "250 deg", "330 deg"]}}})");
    const std::string rows = " -q --rate 20 --channels theta";
    const Finished list = shell(folder, "$BEAMCAM simulate list.json" + rows);
    const Finished file = shell(folder, "mkdir other; cd other; $BEAMCAM simulate ../file.json" + rows);
    ASSERT_EQ(file.code, 0) << file.err;
    EXPECT_EQ(file.out, list.out);
    folder.write("enc.csv", "t [ms],angle\n,deg\n0,0\n500,90\n1000,170\n1500,250\n2000,330\n2500,30\n");
    const Finished wrapped = shell(folder, "$BEAMCAM check file.json");
    EXPECT_EQ(wrapped.code, 0);
    EXPECT_THAT(wrapped.out + wrapped.err,
                HasSubstr("hub.drive.theta: the column \"angle\" jumps by more than half a turn"));
    for (const auto& [table, words] :
         {std::pair{"t,angle\n0,0\n1,\n", "line 3: the cell of the column \"angle\" is empty"},
          std::pair{"t,angle\n0,0\n1,x\n", "enc.csv:3:3: \"x\" is not a number"},
          std::pair{"t,angel\n0,0\n", "did you mean \"angel\"?"}}) {
        folder.write("enc.csv", table);
        const Finished wrong = shell(folder, "sed 's/t .ms./t/' file.json > g.json; $BEAMCAM check g.json");
        EXPECT_EQ(wrong.code, 3);
        EXPECT_THAT(wrong.out + wrong.err, HasSubstr(words));
    }
}

// ---- columns of sweeps ---------------------------------------------------------------------------------

TEST(SweptColumn, LiesBesideTheSceneAndInTheWorkingDirectoryOfTheCommand) {
    const Folder folder;
    ASSERT_EQ(shell(folder, "mkdir rel").code, 0);
    folder.write("rel/w.csv", "index;speed [rpm];note\n1;382;a\n2;401,1;b\n;;\n");
    const std::string rest =
        R"("beam": {"model": "rigid"}, "contact": {"model": "restitution"}, "cam": {"eccentricity": "2 mm"},)";
    folder.write("rel/x.json", "{" + rest + R"("sweep": {"over": [{"key": "cam.speed", "values": "@w.csv:speed [rpm]"}],
                                               "transient": {"cam_turns": 5}, "keep": {"cam_turns": 1}}})");
    const Finished done = shell(folder, "$BEAMCAM sweep rel/x.json -q");
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_THAT(done.out, AllOf(HasSubstr("\n40.0029"), HasSubstr("\n42.003")));
    EXPECT_EQ(shell(folder, "$BEAMCAM plan rel/x.json").code, 0);
    EXPECT_EQ(shell(folder, "$BEAMCAM sweep rel/x.json -q --over 'cam.speed=@rel/w.csv:speed [rpm]'").out, done.out);
    for (const auto& [table, words] : {std::pair{"speed\n1\n", "no column \"speed [rpm]\""},
                                       std::pair{"a,speed [rpm]\n1,x\n", "w.csv:2:3: \"x\" is not a number"},
                                       std::pair{"a,speed [rpm]\n1,\n", "is empty"}}) {
        folder.write("rel/w.csv", table);
        const Finished wrong = shell(folder, "$BEAMCAM check rel/x.json");
        EXPECT_EQ(wrong.code, 3) << table;
        EXPECT_THAT(wrong.out + wrong.err, HasSubstr(words)) << table;
    }
    ASSERT_EQ(shell(folder, "rm rel/w.csv; mkfifo rel/w.csv").code, 0);
    const Finished pipe = shell(folder, "timeout 20 $BEAMCAM check rel/x.json");
    EXPECT_EQ(pipe.code, 3);
    EXPECT_THAT(pipe.out + pipe.err, HasSubstr("not a regular file"));
}

TEST(Agreement, CountsRowsWithBothValuesWhereTheMotionIsReproducible) {
    sim::Result result;
    result.not_reproducible = {{3, 4}};
    Measurement data;
    data.columns = {{{sim::ChannelKind::theta, 0}, "angle"}};
    data.times = {0, 1, 1.5, 2, 2.5, 3.5, 3.9, 4.5};
    data.values = {{1, 2, 3, NAN, 5, 10, 20, 7}};
    const auto found = agreements(data, {{}, {data.times, {1, 1, 1, 1, 9, 30, 30, 7}}}, result);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].rows, 5u);
    EXPECT_DOUBLE_EQ(found[0].rms, std::sqrt((0 + 1 + 4 + 16 + 0) / 5.0));
    data.times.clear(), data.values = {{}};
    EXPECT_EQ(agreements(data, {{}, {{}, {}}}, result)[0].rows, 0u);
}

}  // namespace
}  // namespace beamcam::scenes
