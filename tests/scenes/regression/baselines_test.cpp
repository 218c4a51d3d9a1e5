// Files of baselines: what the reader takes, and what the program writes into them.
#include "scenes/regression/baselines.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/regression/baseline_edit.hpp"
#include "tests/scenes/regression/guarded.hpp"

namespace beamcam::scenes {
namespace {

using testing::Finished, testing::Folder, testing::Guarded, testing::shell, testing::slurp;
using ::testing::HasSubstr;

// The schema for editors and the reader give the same verdicts, except on rules that only the reader can check.
TEST(Baselines, TheSchemaAndTheReaderAgree) {
    SKIP_UNDER_SANITIZERS();
    const Guarded folder;
    EXPECT_EQ(shell(folder, "$BEAMCAM schema --baselines").out,
              slurp(BEAMCAM_TEST_DIR "/../scenes/beamcam-baselines.schema.json"))
        << "after a change of keys: beamcam schema --baselines > scenes/beamcam-baselines.schema.json";
    const std::pair<const char*, bool> cases[] = {
        {R"({"entries": {"a": {"scene": "s.json", "output": {"type": "still", "at": 0}}}})", true},
        {R"({"entries": {"a": {"scene": {}, "set": ["gravity=9"], "physics": false, "tolerance": {"channel": 3, "share": 0.1, "motion": 0, "impacts": 1}, "output": {"type": "still", "at": 0}}}, "x-note": 1})",
         true},
        {R"({"entries": {}})", false},
        {R"({"entries": {"a/b": {"scene": "s.json", "output": {"type": "still", "at": 0}}}})", false},
        {R"({"entries": {"a": {"scene": "s.json"}}})", false},
        {R"({"entries": {"a": {"output": {"type": "still", "at": 0}}}})", false},
        {R"({"entries": {"a": {"scene": 3, "output": {"type": "still", "at": 0}}}})", false},
        {R"({"entries": {"a": {"scene": "s.json", "output": {"type": "still", "at": 0}, "tolerance": {"channel": 256}}}})",
         false},
        {R"({"entries": {"a": {"scene": "s.json", "output": {"type": "still", "at": 0}, "tolerance": {"channel": 1.5}}}})",
         false},
        {R"({"entries": {"a": {"scene": "s.json", "output": {"type": "still", "at": 0}, "accepted": [{"sha256": ["0"]}]}}})",
         false},
        {R"({"entries": {"a": {"scene": "s.json", "output": {"type": "still", "at": 0}, "accepted": [{}]}}})", false},
        {R"({"entries": {"a": {"scene": "s.json", "output": {"type": "still", "at": 0}, "set": "gravity=9"}}})", false},
        {R"({"entries": {"a": {"scene": "s.json", "output": {"type": "still", "at": 0}, "physics": 1}}})", false},
        {R"({"entries": {"a": {"scene": "s.json", "output": {"type": "still", "at": 0}, "tolerance": {"channel": 1, "renderers": {"0123456789ab": {"channel": 9, "share": 0.1, "ssim": 0.9}}}}}})",
         true},
        {R"({"entries": {"a": {"scene": "s.json", "output": {"type": "still", "at": 0}, "tolerance": {"renderers": {"mine": {"channel": 9}}}}}})",
         false},
        {R"({"entries": {"a": {"scene": "s.json", "output": {"type": "still", "at": 0}, "tolerance": {"renderers": {"0123456789ab": {"motion": 0.1}}}}}})",
         false},
        {R"({"entries": {"a": {"scene": "s.json", "output": {"type": "still", "at": 0}, "reproducible_until": -1}}})",
         false},
        {R"({"entries": {"a": {"scene": "s.json", "output": {"type": "still", "at": 0}}}, "referenzes": "x"})", false},
        {R"({"entries": {"a": {"scene": {}, "output": {"type": "still", "at": 0}, "tolerance": {"share": "5 %"}}}})",
         true},
        {R"({"entries": {"a": {"scene": {}, "output": {"type": "still", "at": 0}, "file": "a.png"}}})", false}};
    for (const auto& [text, valid] : cases) {
        folder.write("c.json", text);
        const Finished read = shell(folder, "$BEAMCAM test c.json -q --report r");
        EXPECT_EQ(read.code == 3, !valid) << text << read.err;
        const Finished schema = shell(
            folder,
            "$BEAMCAM schema --baselines > schema.json && /usr/bin/python3 -W ignore -c \"import json, jsonschema; "
            "jsonschema.Draft202012Validator(json.load(open('schema.json'))).validate(json.load(open('c.json')))\"");
        EXPECT_EQ(schema.code == 0, valid) << text << schema.err;
    }
}

TEST(Baselines, EditsKeepEveryOtherByte) {
    const Folder folder;
    folder.write("s.json", "{}");
    const std::string text =
        "{ // head\n  \"entries\": {\n    \"a\": {\"scene\": \"s.json\", \"output\": {\"type\": \"still\", \"at\": 0}, "
        "// why\n"
        "      \"accepted\": [], \"x-note\": \"a } in text\"}\n  }\n}\n";
    folder.write("b.json", text);
    const Baselines baselines = read_baselines((folder / "b.json").string());
    const std::string digest(64, 'a');
    const auto with_digest = [&digest](Baselines all) {
        all.entries.front().accepted = {{"r1", {digest}}};
        all.entries.front().reproducible_until = 0.25;
        all.renderers = {{"r1", {{"cairo", "1.16"}}}, {"unused", {{"cairo", "1.17"}}}};
        return all;
    };
    const std::string changed = edited(baselines, with_digest(baselines));
    folder.write("b.json", changed);
    const Baselines again = read_baselines((folder / "b.json").string());
    EXPECT_EQ(again.entries.front().accepted.front().sha256, std::vector<std::string>{digest});
    EXPECT_EQ(again.entries.front().reproducible_until, 0.25);
    EXPECT_EQ(again.renderers.at("r1").at("cairo"), "1.16");
    for (const char* kept : {"{ // head\n", "// why\n", "\"x-note\": \"a } in text\""})
        EXPECT_THAT(changed, HasSubstr(kept));
    EXPECT_EQ(edited(again, with_digest(again)), changed);
    EXPECT_EQ(edited(baselines, baselines), text);
}

// The tolerance of an entry overrides that of all entries; that of a renderer overrides the common one.
TEST(Baselines, TolerancesOfRenderersAreOverThoseOfTheSamePlace) {
    const Folder folder;
    folder.write("b.json", R"({"tolerance": {"channel": 3, "share": 0.1, "renderers": {"0123456789ab": {"channel": 4}}},
  "entries": {"a": {"scene": {}, "output": {"type": "still", "at": 0}},
              "b": {"scene": {}, "output": {"type": "still", "at": 0},
                    "tolerance": {"share": 0.2, "renderers": {"0123456789ab": {"ssim": 0.9}, "ba9876543210": {"channel": 7}}}}}})");
    const Baselines read = read_baselines((folder / "b.json").string());
    const Tolerances &a = read.entries[0].tolerances, &b = read.entries[1].tolerances;
    EXPECT_EQ(a.common.channel, 3);
    EXPECT_EQ(a.of("another").channel, 3);
    EXPECT_EQ(a.of("0123456789ab").channel, 4);
    EXPECT_EQ(a.of("0123456789ab").share, 0.1);
    EXPECT_EQ(b.of("0123456789ab").channel, 4);
    EXPECT_EQ(b.of("0123456789ab").share, 0.2);
    EXPECT_EQ(b.of("0123456789ab").ssim, 0.9);
    EXPECT_EQ(b.of("ba9876543210").channel, 7);
    EXPECT_EQ(b.of("ba9876543210").motion, 2e-5);
    const Tolerances command_line = b.overridden_by({{1, {}, {}, {}, {}}, {}});
    EXPECT_EQ(command_line.of("ba9876543210").channel, 1);
}

TEST(Baselines, AMissingFileIsExplained) {
    const Folder folder;
    const Finished finished = shell(folder, "$BEAMCAM test none.json");
    EXPECT_EQ(finished.code, 6);
    EXPECT_THAT(finished.err, HasSubstr("none.json does not exist; a file of baselines lists what to test"));
}

TEST(Baselines, PicturesAreExpectedOfPicturesOnly) {
    const Folder folder;
    folder.write("b.json", R"({"entries": {
  "a": {"scene": {}, "expected": "a.png", "output": {"type": "trajectory", "rate": 10}}}})");
    const Finished finished = shell(folder, "$BEAMCAM test b.json");
    EXPECT_EQ(finished.code, 3);
    EXPECT_THAT(finished.err, HasSubstr("b.json:2:53: entries.a.output has no pictures to compare with \"expected\""));
}

TEST(Baselines, AnEntryWithoutASceneIsAnErrorOfThatEntryAlone) {
    const Folder folder;
    folder.write("b.json", R"({"entries": {
  "a": {"output": {"type": "still", "at": 0}},
  "b": {"scene": {}},
  "c": {"scene": {"time": {"end": 0.1}}, "output": {"type": "trajectory", "rate": 10, "channels": ["theta"]}}}})");
    const Finished finished = shell(folder, "$BEAMCAM test b.json --junit j.xml");
    EXPECT_EQ(finished.code, 3);
    EXPECT_THAT(finished.err, HasSubstr("b.json:2:3: entries.a needs \"scene\", for example \"fall.json\""));
    EXPECT_THAT(finished.err, HasSubstr("0 different, 1 missing, 2 not-run; 1 simulation"));
    EXPECT_THAT(finished.out, HasSubstr("not-run     a  picture not-run: b.json:2:3: "));
    EXPECT_THAT(finished.out, HasSubstr("missing     c  motion missing: "));
    EXPECT_THAT(testing::slurp(folder / "j.xml"), HasSubstr("failures=\"1\" errors=\"2\""));
    EXPECT_THAT(shell(folder, "$BEAMCAM test b.json --json").out, HasSubstr("\"verdict\": \"not-run\""));
}

TEST(Baselines, ReferencesMayBeBesideTheFile) {
    const Folder folder;
    folder.write("b.json", R"({"references": "", "entries": {
  "a": {"scene": {"time": {"end": 0.1}}, "output": {"type": "trajectory", "rate": 10, "channels": ["theta"]}}}})");
    EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --update all").code, 7);
    EXPECT_TRUE(std::filesystem::exists(folder / "a/motion.csv"));
    EXPECT_EQ(shell(folder, "$BEAMCAM test b.json --strict").code, 0);
}

// Names that only lead to files may be anything; those of entries are those of folders.
TEST(Baselines, NamesOfFilesMayHoldAnything) {
    const Folder folder;
    const std::string names = "'ü ö/日本/b ä, %:.json'";
    folder.write("s.json", R"({"time": {"end": 0.1}, "title": "Größe 角"})");
    folder.write("b.json", R"({"entries": {"a": {"scene": "s.json",
  "output": {"type": "still", "at": 0.1, "size": [64, 64], "view": {"style": "flat"}}}}})");
    ASSERT_EQ(shell(folder, "mkdir -p 'ü ö/日本'; cp s.json 'ü ö/日本'; cp b.json " + names).code, 0);
    const Finished missing = shell(folder, "$BEAMCAM test " + names + " --annotate github");
    EXPECT_THAT(missing.err, HasSubstr("::error file=ü ö/日本/b ä%2C %25%3A.json,title=a: missing::"));
    EXPECT_EQ(shell(folder, "$BEAMCAM test " + names + " --update all --report 'ü/r' --junit 'ü/j.xml'").code, 7);
    EXPECT_EQ(shell(folder, "$BEAMCAM test " + names + " --strict").code, 0);
    folder.write("c.json", R"({"entries": {"ä": {"scene": "s.json", "output": {"type": "still", "at": 0}}}})");
    EXPECT_THAT(shell(folder, "$BEAMCAM test c.json").err, HasSubstr("\"ä\" is the name of files"));
}

}  // namespace
}  // namespace beamcam::scenes
