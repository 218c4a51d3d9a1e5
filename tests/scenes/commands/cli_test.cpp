// The program as scripts see it: exit codes, what goes to standard output, what is left on disk.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

using ::testing::AllOf, ::testing::AnyOf, ::testing::HasSubstr, ::testing::IsEmpty, ::testing::Not,
    ::testing::StartsWith;
using testing::Finished, testing::Folder, testing::shell;

TEST(CommandLine, VersionHelpAndSchemaAreData) {
    const Folder folder;
    EXPECT_THAT(shell(folder, "$BEAMCAM --version").out, StartsWith("beamcam "));
    for (const char* command :
         {"", "run", "render", "simulate", "check", "plan", "modes", "init", "schema", "keys", "figure"}) {
        const Finished help = shell(folder, std::string("$BEAMCAM ") + command + " --help");
        EXPECT_EQ(help.code, 0);
        EXPECT_THAT(help.out, HasSubstr("beamcam "));  // of the usage; the rest is by CLI11
        EXPECT_THAT(help.err, IsEmpty());
    }
    EXPECT_TRUE(shell(folder, "$BEAMCAM schema").out ==
                testing::slurp(BEAMCAM_TEST_DIR "/../scenes/beamcam-scene.schema.json"))
        << "after a change of keys: beamcam schema > scenes/beamcam-scene.schema.json";
}

// Those of commands that search: others work with any scene.
TEST(CommandLine, ExamplesOfTheHelpShowSomething) {
    const Folder folder;
    ASSERT_EQ(shell(folder, "$BEAMCAM init --from pressed").code, 0);
    for (const auto& [command, shown] :
         {std::pair{"orbits", "period 1 turn"}, std::pair{"sweep", "periodic"}, std::pair{"lyapunov", "chaotic:"}}) {
        const std::string help = shell(folder, fmt::format("$BEAMCAM {} --help", command)).out,
                          line = fmt::format("\n  beamcam {} ", command);
        std::size_t at = help.find(line);
        ASSERT_NE(at, std::string::npos) << command;
        for (; at != std::string::npos; at = help.find(line, at + 1)) {
            const std::string arguments = help.substr(at + 10, help.find('\n', at + 1) - at - 10);
            const Finished example = shell(folder, "$BEAMCAM" + arguments);
            EXPECT_EQ(example.code, 0) << arguments << example.err;
            EXPECT_THAT(example.out + example.err, HasSubstr(shown)) << arguments;
        }
    }
}

TEST(CommandLine, EveryKeyIsExplained) {
    const Folder folder;
    EXPECT_TRUE(shell(folder, "$BEAMCAM keys --markdown").out ==
                testing::slurp(BEAMCAM_TEST_DIR "/../scenes/FORMAT.md"))
        << "after a change of keys: beamcam keys --markdown > scenes/FORMAT.md";
    const std::string stiffness = shell(folder, "$BEAMCAM keys contact.stiff").out;
    EXPECT_THAT(stiffness, HasSubstr("contact.stiffness\n    number or \"hertz\" [N/m^n], > 0, default 100000000.0\n"));
    EXPECT_THAT(shell(folder, "$BEAMCAM keys 'outputs*size'").out,
                HasSubstr("outputs[].size  (type=video | type=frames"));
    const nlohmann::json modes = nlohmann::json::parse(shell(folder, "$BEAMCAM keys beam.modes --json").out);
    ASSERT_EQ(modes.size(), 1u);
    EXPECT_EQ(modes[0]["key"], "beam.modes");
    EXPECT_EQ(modes[0]["type"], "whole number");
    EXPECT_EQ(modes[0]["unit"], nullptr);
    EXPECT_EQ(modes[0]["default"], 2);
    EXPECT_EQ(modes[0]["min"], 1);
    EXPECT_EQ(modes[0]["max"], 40);
    for (const auto& key : nlohmann::json::parse(shell(folder, "$BEAMCAM keys --json").out))
        EXPECT_GT(key["meaning"].get<std::string>().size(), 3u) << key;
    EXPECT_EQ(shell(folder, "$BEAMCAM keys nonsense").code, 2);
    const std::string state = shell(folder, "$BEAMCAM keys state").out;
    EXPECT_THAT(state, AllOf(HasSubstr("outputs[].at  (type=state)"), HasSubstr("by default NAME-state.json")));
    EXPECT_THAT(shell(folder, "$BEAMCAM keys trajectory").out, Not(HasSubstr("stations")));
    EXPECT_THAT(shell(folder, "$BEAMCAM keys sped").err, HasSubstr("did you mean \"speed\" or \"seed\"?"));
}

TEST(CommandLine, KeysThatSelectAVariantAreExplained) {
    const Folder folder;
    EXPECT_THAT(
        shell(folder, "$BEAMCAM keys contact.friction.type").out,
        AllOf(StartsWith("contact.friction.type\n    none | coulomb | stick-slip\n"), HasSubstr("May be left out")));
    EXPECT_THAT(shell(folder, "$BEAMCAM keys hub.drive.law").out,
                StartsWith("hub.drive.law  (type=prescribed)\n    constant | spin-up | table\n"));
    EXPECT_THAT(shell(folder, "$BEAMCAM keys 'outputs*type'").out,
                HasSubstr("outputs[].type\n    video | frames | still"));
    EXPECT_THAT(shell(folder, "$BEAMCAM keys around").out,
                HasSubstr("outputs[].speed.around  (type=video | type=frames"));
}

TEST(CommandLine, AReaderThatEndsEarlyIsNoError) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 2}, "outputs": []})");
    for (const char* arguments :
         {"schema", "simulate s.json --trajectory - --rate '10 kHz'"})  // more than a pipe holds
        EXPECT_EQ(shell(folder, fmt::format("($BEAMCAM {}; echo code $? >&2) | head -c 1", arguments)).err,
                  "code 141\n");
    EXPECT_THAT(shell(folder, "$BEAMCAM schema > /dev/full").err, HasSubstr("cannot write to standard output"));
}

TEST(CommandLine, WrongUsageIsTwo) {
    const Folder folder;
    folder.write("s.json", "{}");
    for (const char* arguments : {"",
                                  "run",
                                  "fly s.json",
                                  "s.json",
                                  "run s.json --what",
                                  "render s.json",
                                  "render s.json -o a.avi",
                                  "render s.json s.json -o a.html",
                                  "render s.json -o a.png",
                                  "render s.json -o a.mp4 --at 0.1",
                                  "render s.json -o a.mp4 --size 641x360",
                                  "render s.json -o a.mp4 --size big",
                                  "render s.json -o a.mp4 --from 3",
                                  "render s.json -o a.png --at -1",
                                  "render s.json -o a.png --at '5 mm'",
                                  "simulate s.json --rate 0",
                                  "simulate s.json --rate 5 --times 1",
                                  "simulate s.json --channels thetta",
                                  "simulate s.json --trajectory - --summary -",
                                  "simulate s.json --trajectory a.txt",
                                  "run s.json -j 0",
                                  "run s.json --set cam.speed",
                                  "check s.json --set =3",
                                  "simulate s.json --summary a.json --impacts a.json",
                                  "run s.json --progress loud",
                                  "modes s.json --speed 5mm",
                                  "modes s.json --speed 1e300",
                                  "figure s.json -o a.pdf",
                                  "figure s.json shematic -o a.pdf",
                                  "figure s.json schematic -o a.bmp",
                                  "figure s.json schematic -o a.pdf --column brill",
                                  "figure s.json schematic -o a.pdf --width 3",
                                  "figure s.json schematic -o a.pdf --data a.txt",
                                  "figure s.json schematic -o a.pdf --data -",
                                  "sweep s.json --over cam.speed=1:2:2 --diagram -",
                                  "collect a.nc -o -",
                                  "keys --json nonsense",
                                  "test s.json --junit j.txt",
                                  "figure s.json --channels theta --lines 45deg,,3 -o a.pdf",
                                  "figure s.json --channels theta, -o a.pdf"}) {
        const Finished finished = shell(folder, std::string("$BEAMCAM ") + arguments);
        EXPECT_EQ(finished.code, 2) << arguments << "\n" << finished.err;
        EXPECT_THAT(finished.err, StartsWith("beamcam: ")) << arguments;
        EXPECT_THAT(finished.out, IsEmpty()) << arguments;
    }
    EXPECT_THAT(shell(folder, "$BEAMCAM sweep s.json").err, HasSubstr("no key varies"));
    EXPECT_THAT(shell(folder, "$BEAMCAM figure s.json --channels theta --low abc -o a.pdf -n").err,
                HasSubstr("beamcam: --low = \"abc\": it does not begin with a number"));
    for (const auto& [arguments, message] :
         {std::pair{"figure s.json --channels theta --low 3 --high 1 -o a.pdf",
                    "beamcam: --high must be above \"low\""},
          std::pair{"figure s.json --channels theta --log --low -1deg -o a.pdf",
                    "beamcam: --low = \"-1deg\": the ends of a logarithmic axis must be positive"},
          std::pair{"figure s.json energy --channels theta -o a.pdf",
                    "beamcam: --channels: the panels of the preset energy have channels and units of their own"},
          std::pair{"render s.json --from 1 --to 0.5 -o a.mp4", "the film from 1 s to 0.5 s has no frame"},
          std::pair{"render s.json --from 1 --to 0.5 -o a.mp4", "\"to\" must be later than \"from\""},
          std::pair{"simulate s.json -o a.csv", "a table is --trajectory a.csv"},
          std::pair{"simulate s.json -o a.json", "a summary is --summary a.json"},
          std::pair{"render s.json --from 30 -o a.mp4", "\"from\" must be earlier than the end of the scene"},
          std::pair{"render s.json --at 1 -o s.json/x.png", "s.json/x.png: Not a directory"},
          std::pair{"render s.json --at 1 -o none/x.png",
                    "none/x.png: No such file or directory; make the directory first"},
          std::pair{"render s.json --at 1 -o x.mp4", "-o x.mp4 must be a .png, .pdf or .svg file"},
          std::pair{"figure s.json energy --from -o a.pdf", "beamcam: --from: a value is missing before -o"},
          std::pair{"sweep s.json --over cam.speed=40:50:2 --value force_peak --diagram a.pdf",
                    "beamcam: --value: force_peak is a column of peaks; add \"sample\": \"peaks\""},
          std::pair{"render s.json --background transparent -o a.mp4", "beamcam: --background: H.264 cannot be"},
          std::pair{"figure s.json --channels theta --from 0.3 --to 0.2 -o a.pdf",
                    "beamcam: --from = 0.3 s is not before the end, 0.2 s; choose an earlier start, or a later end"},
          std::pair{"simulate s.json --times 3", "warning: --times = 3 s is after the end of the scene"},
          std::pair{"render s.json --duration 1e9 -o a.mp4", "reduce \"duration\" or \"fps\""}})
        EXPECT_THAT(shell(folder, std::string("$BEAMCAM ") + arguments).err, HasSubstr(message));
    EXPECT_THAT(shell(folder, "$BEAMCAM rnder s.json").err, HasSubstr("did you mean \"render\"?"));
    EXPECT_THAT(shell(folder, "$BEAMCAM help").err, HasSubstr("unknown command \"help\"; write beamcam --help"));
    EXPECT_THAT(shell(folder, "$BEAMCAM check s.json --emit=slurm").err, HasSubstr("--emit=slurm; it was withdrawn"));
    EXPECT_THAT(shell(folder, "$BEAMCAM sweep s.json --emit slurm").err, HasSubstr("unknown option --emit; it was"));
    EXPECT_THAT(shell(folder, "$BEAMCAM orbits s.json --turn 3").err,
                HasSubstr("beamcam: unknown option --turn; did you mean \"--turns\"? (see beamcam orbits --help)"));
    EXPECT_THAT(shell(folder, "$BEAMCAM modes s.json t.json").err, HasSubstr("beamcam: unexpected argument t.json"));
    EXPECT_THAT(shell(folder, "$BEAMCAM keys tip_mass").err, HasSubstr("no key matches tip_mass; a mass at the tip"));
    EXPECT_THAT(shell(folder, "$BEAMCAM cache ls").err, HasSubstr("motions are not stored between runs"));
    EXPECT_THAT(shell(folder, "$BEAMCAM run s.json --no-cache").err, HasSubstr("motions are not stored between runs"));
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 3);  // the scene, .stdout, .stderr
}

TEST(CommandLine, AnUnreadableFileDoesNotHideTheOthers) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.1}})");
    ASSERT_EQ(shell(folder, "$BEAMCAM render s.json --at 0 --size 64x64 --style flat -o a.png -q").code, 0);
    folder.write("bad.png", "no picture");
    const Finished finished = shell(folder, "$BEAMCAM info none.png bad.png a.png");
    EXPECT_EQ(finished.code, 6);
    EXPECT_THAT(finished.out, HasSubstr("a.png"));
    EXPECT_THAT(finished.err, HasSubstr("none.png"));
    folder.write("bad.json", R"({"beam": 3})");
    for (const char* command : {"check", "plan", "run -n"}) {
        const Finished scenes = shell(folder, fmt::format("$BEAMCAM {} bad.json none.json s.json", command));
        EXPECT_EQ(scenes.code, 3) << command;  // of the first error
        EXPECT_THAT(scenes.err, AllOf(HasSubstr("bad.json:1:10"), HasSubstr("none.json does not exist"))) << command;
        EXPECT_THAT(scenes.out + scenes.err, AnyOf(HasSubstr("s.json: fine"), HasSubstr("s.mp4"))) << command;
    }
}

TEST(CommandLine, QuietKeepsStandardOutput) {
    const Folder folder;
    folder.write("a.csv", "t,theta\n0,1\n");
    folder.write("b.csv", "t,theta\n0,2\n");
    folder.write("s.json", R"({"time": {"end": 0.1}})");
    for (const char* command : {"diff a.csv b.csv", "modes s.json", "check s.json", "plan s.json", "test b.json",
                                "simulate s.json --channels theta --rate 10"}) {
        folder.write("b.json", R"({"entries": {"a": {"scene": {"time": {"end": 0.1}},
  "output": {"type": "trajectory", "rate": 10, "channels": ["theta"]}}}})");
        const Finished loud = shell(folder, fmt::format("$BEAMCAM {}", command)),
                       quiet = shell(folder, fmt::format("$BEAMCAM {} -q", command));
        EXPECT_EQ(quiet.out, loud.out) << command;
        EXPECT_EQ(quiet.err, "") << command;
        EXPECT_EQ(quiet.code, loud.code) << command;
    }
    EXPECT_THAT(shell(folder, "$BEAMCAM check --help").out, HasSubstr("standard output stays"));
}

TEST(CommandLine, ARangeEndsWithACount) {
    const Folder folder;
    folder.write("s.json", "{}");
    for (const auto& [third, points] : {std::pair{"2", 2}, std::pair{"21", 21}, std::pair{"5:log", 5}})
        EXPECT_THAT(shell(folder, fmt::format("$BEAMCAM sweep s.json -n --over cam.speed=40:60:{}", third)).out,
                    HasSubstr(fmt::format("cam.speed: {} points\n", points)));
}

// Published: clamped beams turning in their plane (Wright et al. 1982), the free hub (hinged–free), see public numbers.
TEST(CommandLine, ModesOfTheRestingAndTheTurningBeam) {
    const Folder folder;
    folder.write("s.json", "{\"beam\": {\"modes\": 24}}");
    const double unit = std::sqrt(6.8952e10 * 8.2189e-9 / (2766.7 * 7.2968e-5));  // √(EI/ρA), L = 1 m
    const auto first = [&](const std::string& arguments) {
        const Finished finished = shell(folder, "$BEAMCAM modes s.json --json " + arguments);
        EXPECT_EQ(finished.code, 0) << finished.err;
        return std::stod(finished.out.substr(finished.out.find("\"omega\":") + 8)) / unit;
    };
    EXPECT_NEAR(first(""), 15.41820571698, 1e-9);
    EXPECT_NEAR(first("--set hub.inertia=" + fmt::format("{:.17g}", 0.1 * 2766.7 * 7.2968e-5)), 6.963923552724, 1e-9);
    // Twenty-four clamped shapes leave a few 1e-7 at this speed: Ritz values come from above.
    const double turning = first("--speed " + fmt::format("{:.17g}", 4 * unit));
    EXPECT_GT(turning, 3.89772252 - 1e-8);
    EXPECT_NEAR(turning, 3.89772252, 2e-6);
    EXPECT_THAT(shell(folder, "$BEAMCAM modes s.json").out, HasSubstr("816.896"));
}

TEST(CommandLine, ModesThatAreNotConvergedAreNamed) {
    const Folder folder;
    folder.write("s.json", R"({"beam": {"model": "exact", "modes": 4}})");
    EXPECT_THAT(shell(folder, "$BEAMCAM modes s.json").err,
                HasSubstr("warning: not converged: modes 2, 3, 4 would change by more than 1 %"));
    EXPECT_EQ(shell(folder, "$BEAMCAM modes s.json --set beam.model=first-order").err, "");
    EXPECT_THAT(shell(folder, "$BEAMCAM modes s.json --set beam.modes=40").err,
                HasSubstr("39, 40 would change by more than 1 % with more shapes; no model has more"));
}

TEST(CommandLine, ABadSceneIsThreeAndNothingIsWritten) {
    const Folder folder;
    folder.write("s.json", "{\"beam\": {\"lenght\": 1}}");
    for (const char* arguments :
         {"check s.json", "run s.json -o out", "plan s.json", "simulate s.json", "render s.json -o a.mp4"}) {
        const Finished finished = shell(folder, std::string("$BEAMCAM ") + arguments);
        EXPECT_EQ(finished.code, 3) << arguments;
        EXPECT_THAT(finished.err, StartsWith("s.json:1:11: unknown key \"lenght\"")) << arguments;
        EXPECT_THAT(finished.out, IsEmpty());
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST(CommandLine, AFilmBetweenEventsInTheWrongOrderIsRejected) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.7}})");
    const Finished finished = shell(folder, "$BEAMCAM render s.json --from apex:1 --to touch -o a.mp4");
    EXPECT_EQ(finished.code, 3);
    EXPECT_THAT(finished.err, HasSubstr("a.mp4: the film from 0.52"));
}

TEST(CommandLine, QuotesTheUsersWordsAsTheyAre) {
    const Folder folder;
    folder.write("s.json", "{}");
    EXPECT_THAT(shell(folder, "$BEAMCAM render s.json --at 0.3 --style speed -o a.png").err,
                HasSubstr("--style = \"speed\""));
}

TEST(CommandLine, AnUnreadableSceneIsSix) {
    const Folder folder;
    EXPECT_EQ(shell(folder, "$BEAMCAM check absent.json").code, 6);
    EXPECT_EQ(shell(folder, "$BEAMCAM check .").code, 6);
}

TEST(CommandLine, CheckReportsEveryScene) {
    const Folder folder;
    folder.write("good.json", "{}");
    folder.write("bad.json", "{,}");
    const Finished finished = shell(folder, "$BEAMCAM check bad.json good.json");
    EXPECT_EQ(finished.code, 3);
    EXPECT_THAT(finished.err, HasSubstr("bad.json:1:2: "));
    EXPECT_THAT(finished.err, HasSubstr("good.json: fine"));
    EXPECT_EQ(shell(folder, "$BEAMCAM check - < good.json").code, 0);
    folder.write("short.json", R"({"time": {"end": "5 ms"}})");  // of the film that a scene without outputs yields
    const Finished brief = shell(folder, "$BEAMCAM check short.json");
    EXPECT_EQ(brief.code, 3);
    EXPECT_THAT(brief.err, AllOf(HasSubstr("short.json:1:18: time.end: a scene without outputs makes a film: the film "
                                           "from 0 s to 0.005 s has no frame"),
                                 HasSubstr("reduce \"speed\"")));
    EXPECT_EQ(shell(folder, "$BEAMCAM simulate short.json").code, 0);
}

TEST(CommandLine, ASceneFromStandardInputNamesItsFilesStdin) {
    const Folder folder;
    EXPECT_THAT(shell(folder, "echo '{}' | $BEAMCAM plan -").out, HasSubstr("video       stdin.mp4: "));
    EXPECT_THAT(shell(folder, "echo '{,}' | $BEAMCAM check -").err, HasSubstr("stdin:1:2: "));
}

TEST(CommandLine, PlanPrintsDataAndDoesNothing) {
    const Folder folder;
    folder.write("s.json", "{}");
    const Finished plan = shell(folder, "$BEAMCAM plan s.json"), dry = shell(folder, "$BEAMCAM run -n s.json");
    EXPECT_EQ(plan.code, 0);
    EXPECT_THAT(plan.out, HasSubstr("video       s.mp4: 90 frames"));
    EXPECT_EQ(plan.out, dry.out);
    EXPECT_THAT(shell(folder, "$BEAMCAM plan s.json --json").out, HasSubstr("\"what\": \"motion\""));
    EXPECT_EQ(shell(folder, "$BEAMCAM plan s.json --json | /usr/bin/python3 -m json.tool").code, 0);
    EXPECT_FALSE(std::filesystem::exists(folder / "s.mp4"));
}

TEST(CommandLine, AccuracyOfAChannelStatesThePeakAndItsChanges) {
    const Folder folder;
    folder.write("s.json", R"({"beam": {"modes": 1}, "time": {"end": 0.4}})");
    const Finished found = shell(folder, "$BEAMCAM accuracy s.json --of contact_force -o a.json");
    ASSERT_EQ(found.code, 0) << found.err;
    EXPECT_THAT(found.out, HasSubstr("contact_force to 0.4 s: largest"));
    EXPECT_THAT(found.out, HasSubstr("stiffness × 2"));
    EXPECT_EQ(shell(folder, "/usr/bin/python3 -m json.tool a.json").code, 0);
    EXPECT_EQ(shell(folder, "$BEAMCAM accuracy s.json --of force").code, 2);
    EXPECT_EQ(shell(folder, "$BEAMCAM accuracy s.json --of gap --set cam=null").code, 2);
}

TEST(CommandLine, InitWritesASceneThatIsFineAndNeverReplacesOne) {
    const Folder folder;
    EXPECT_EQ(shell(folder, "$BEAMCAM init fall").code, 0);
    EXPECT_EQ(shell(folder, "$BEAMCAM check fall.json").code, 0);
    EXPECT_THAT(shell(folder, "$BEAMCAM plan fall.json").out, HasSubstr("fall.mp4"));
    EXPECT_EQ(shell(folder, "$BEAMCAM init fall").code, 6);
    EXPECT_EQ(shell(folder, "$BEAMCAM init fall --force").code, 0);
    EXPECT_THAT(shell(folder, "$BEAMCAM init \"it's a\"").err, HasSubstr("`beamcam run 'it'\\''s a.json'`"));
    EXPECT_THAT(shell(folder, "$BEAMCAM init none/a").err,
                ::testing::EndsWith("make the directory first or choose another one\n"));
    EXPECT_THAT(shell(folder, "$BEAMCAM init -").out, HasSubstr("\"beam\""));
}

TEST(CommandLine, MessagesNameTheFileAndTheRemedyOnce) {
    const Folder folder;
    folder.write("s.json", "{}");
    folder.write("m.csv", "t,theta\n0,1\n1\n");
    const std::pair<const char*, const char*> cases[] = {
        {"run s.json ./s.json", "s.json: s.mp4 and s.json: s.mp4 are the same file"},
        {"simulate s.json --set solver.max_steps=100", "a larger solver.max_steps allows more\n"},
        {"simulate s.json --state-at 2", "--state-at = 2 s is after the end of the scene"},
        {"simulate s.json --channels 'theta, gap' --rate 1", ""},
        {"figure s.json --preset no.json", "no.json does not exist; `beamcam figure SCENE` lists the presets"},
        {"check s.json --set outputs.0.type=video", "set outputs itself\n"},
        {"check - < s.json", "stdin: fine"},
        {"figure m.csv --x t --channels theta -o a.pdf", "the number of cells is 1 here, but 2 in the header"}};
    for (const auto& [command, text] : cases) {
        const Finished finished = shell(folder, std::string("$BEAMCAM ") + command);
        EXPECT_THAT(finished.err, HasSubstr(text)) << command;
        EXPECT_LE(std::ranges::count(finished.err, '\n'), 1) << finished.err;
    }
}

TEST(CommandLine, TheSummaryHasTheExtremaOfTheChannelsThatAreAskedFor) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.1}})");
    const auto channels = [&](const std::string& options) {
        return shell(folder, "$BEAMCAM simulate s.json -q " + options +
                                 " | /usr/bin/python3 -c \"import json, sys; print(*json.load(sys.stdin)['extrema'])\"")
            .out;
    };
    EXPECT_EQ(channels(""), "theta tip_deflection contact_force gap\n");
    EXPECT_EQ(channels("--summary - --channels q1,energy_elastic"), "q1 energy_elastic\n");
    EXPECT_EQ(channels("--summary - --channels q1 --trajectory a.csv"), "q1\n");
    EXPECT_EQ(testing::slurp(folder / "a.csv").substr(0, 5), "t,q1\n");
    folder.write("s.json", R"({"outputs": [{"type": "summary", "file": "a.json", "channels": ["gap", "theta"]},
                                            {"type": "summary", "file": "b.json", "channels": ["theta"]}]})");
    ASSERT_EQ(shell(folder, "$BEAMCAM run s.json -q").code, 0);
    EXPECT_EQ(shell(folder,
                    "/usr/bin/python3 -c \"import json; a, b = (json.load(open(f))['extrema'] for f in "
                    "('a.json', 'b.json')); assert list(a) == ['gap', 'theta'] and list(b) == ['theta'], (a, b); "
                    "assert a['theta'] == b['theta']\"")
                  .code,
              0);
}

TEST(CommandLine, SimulatePrintsTheSummaryOrTheRequestedTable) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.3}})");
    const Finished summary = shell(folder, "$BEAMCAM simulate s.json");
    EXPECT_EQ(summary.code, 0) << summary.err;
    EXPECT_THAT(summary.out, HasSubstr("\"energy_residual_max\""));
    EXPECT_EQ(shell(folder, "$BEAMCAM simulate s.json | /usr/bin/python3 -m json.tool").code, 0);
    const Finished table = shell(folder, "$BEAMCAM simulate s.json --channels theta --times '0.1,50 ms,0'");
    EXPECT_EQ(table.code, 0) << table.err;
    EXPECT_THAT(table.out, StartsWith("t,theta\n"));
    EXPECT_EQ(std::count(table.out.begin(), table.out.end(), '\n'), 4);
    EXPECT_THAT(table.out, HasSubstr("\n0,0.785398163397448"));
}

TEST(CommandLine, AddingOutputsLeavesTheTableBitIdentical) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.3}})");
    EXPECT_EQ(shell(folder, "$BEAMCAM simulate s.json --trajectory a.csv").code, 0);
    EXPECT_EQ(shell(folder, "$BEAMCAM simulate s.json --trajectory b.csv --impacts i.json --summary s2.json").code, 0);
    EXPECT_EQ(testing::slurp(folder / "a.csv"), testing::slurp(folder / "b.csv"));
}

TEST(CommandLine, FilesThatBeamcamDidNotMakeAreKept) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.05}, "outputs": [{"type": "trajectory", "file": "t.csv"}]})");
    folder.write("t.csv", "mine");
    const Finished rejected = shell(folder, "$BEAMCAM run s.json");
    EXPECT_EQ(rejected.code, 6);
    EXPECT_THAT(rejected.err, HasSubstr("t.csv"));
    EXPECT_EQ(testing::slurp(folder / "t.csv"), "mine");
    EXPECT_EQ(shell(folder, "$BEAMCAM run s.json --force").code, 0);
    EXPECT_EQ(shell(folder, "$BEAMCAM run s.json").code, 0);  // its own now
    EXPECT_EQ(shell(folder, "$BEAMCAM simulate s.json --trajectory absent/t.csv").code, 6);
}

TEST(CommandLine, PixelsDoNotDependOnTheNumberOfThreads) {
    const Folder folder;
    folder.write(
        "s.json",
        R"({"outputs": [{"type": "frames", "file": "f-##.png", "size": [320, 180], "fps": 20, "from": 0.2, "to": 0.5, "view": {"style": "flat"}}]})");
    for (const char* jobs : {"1", "2", "5"}) {
        const Finished finished = shell(folder, std::string("$BEAMCAM run s.json -j ") + jobs + " -o j" + jobs);
        ASSERT_EQ(finished.code, 0) << finished.err;
    }
    for (int k = 4; k < 10; ++k) {
        const std::string file = "f-0" + std::to_string(k) + ".png";
        const std::string one = testing::slurp(folder / ("j1/" + file));
        EXPECT_GT(one.size(), 1000u) << file;
        EXPECT_EQ(one, testing::slurp(folder / ("j2/" + file))) << file;
        EXPECT_EQ(one, testing::slurp(folder / ("j5/" + file))) << file;
    }
}

TEST(CommandLine, QuietSaysNothing) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.05}, "outputs": [{"type": "trajectory"}]})");
    const Finished finished = shell(folder, "$BEAMCAM run -q s.json");
    EXPECT_EQ(finished.code, 0);
    EXPECT_THAT(finished.err, IsEmpty());
    EXPECT_THAT(finished.out, IsEmpty());
}

// The terminal that messages go to may be full or gone; the exit code is the same.
TEST(CommandLine, UnreadMessagesChangeNothing) {
    const Folder folder;
    folder.write("bad.json", R"({"beam": {"lenght": 1}})");
    folder.write("s.json", R"({"time": {"end": 0.05}, "outputs": [{"type": "trajectory", "file": "t.csv"}]})");
    EXPECT_EQ(shell(folder, "$BEAMCAM check bad.json 2>/dev/full").code, 3);
    EXPECT_EQ(shell(folder, "$BEAMCAM render 2>/dev/full").code, 2);
    EXPECT_EQ(shell(folder, "{ $BEAMCAM check bad.json; echo $? > code; } 2>&1 | true; cat code").out, "3\n");
    for (const char* progress : {"auto", "bar", "plain", "json"})
        EXPECT_EQ(shell(folder, fmt::format("$BEAMCAM run s.json -v --force --progress {} 2>/dev/full", progress)).code,
                  0);
    EXPECT_GT(std::filesystem::file_size(folder / "t.csv"), 100u);
}

TEST(CommandLine, HelpThatCannotBeWrittenIsAnError) {
    const Folder folder;
    for (const char* option : {"--help", "--version", "run --help", "keys"})
        EXPECT_EQ(shell(folder, fmt::format("$BEAMCAM {} >/dev/full", option)).code, 6) << option;
}

TEST(CommandLine, ProgressForProgramsIsAnObjectALine) {
    const Folder folder;
    folder.write("s.json", R"({"time": {"end": 0.05}, "outputs": [{"type": "trajectory"}]})");
    const Finished finished = shell(folder, "$BEAMCAM run s.json --progress json");
    EXPECT_THAT(finished.err, HasSubstr("{\"stage\":\"simulate\""));
}

}  // namespace
}  // namespace beamcam::scenes
