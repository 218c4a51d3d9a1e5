// Files of baselines: what the reader takes.
#include "scenes/regression/baselines.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scenes/regression/guarded.hpp"

namespace beamcam::scenes {
namespace {

using testing::Finished, testing::Folder, testing::Guarded, testing::shell, testing::slurp;
using ::testing::HasSubstr;

// The schema for editors and the reader give the same verdicts, except on rules that only the reader can check.
TEST(Baselines, TheSchemaAndTheReaderAgree) {
    SKIP_UNDER_SANITIZERS();
    const Guarded folder;
    EXPECT_TRUE(shell(folder, "$BEAMCAM schema --baselines").out ==
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
        {R"({"entries": {"a": {"scene": "s.json", "output": {"type": "still", "at": 0}, "accepted": []}}})", false},
        {R"({"entries": {"a": {"file": "a.png"}}})", false},
        {R"({"entries": {"a": {"scene": "s.json", "output": {"type": "still", "at": 0}, "set": "gravity=9"}}})", false},
        {R"({"entries": {"a": {"scene": "s.json", "output": {"type": "still", "at": 0}, "physics": 1}}})", false},
        {R"({"entries": {"a": {"scene": "s.json", "output": {"type": "still", "at": 0}, "tolerance": {"renderers": {}}}}})",
         false},
        {R"({"entries": {"a": {"scene": "s.json", "output": {"type": "still", "at": 0}, "reproducible_until": 1}}})",
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
        // An entry without scene or output is an error of that entry alone, which no schema can express.
        const bool incomplete =
            read.err.find("entries.a needs") != std::string::npos && read.err.find("unknown key") == std::string::npos;
        EXPECT_EQ(schema.code == 0, valid || incomplete) << text << schema.err;
    }
}

TEST(Baselines, TheToleranceOfAnEntryIsOverThatOfTheFile) {
    const Folder folder;
    folder.write("b.json", R"({"tolerance": {"channel": 3, "share": 0.1}, "entries": {
        "a": {"scene": {}, "output": {"type": "still", "at": 0}},
        "b": {"scene": {}, "output": {"type": "still", "at": 0}, "tolerance": {"share": 0.2, "ssim": 0.9}}}})");
    const Baselines read = read_baselines((folder / "b.json").string());
    const Tolerance &a = read.entries[0].tolerance, &b = read.entries[1].tolerance;
    EXPECT_EQ(a.channel, 3);
    EXPECT_EQ(a.share, 0.1);
    EXPECT_FALSE(a.ssim);
    EXPECT_EQ(b.channel, 3);
    EXPECT_EQ(b.share, 0.2);
    EXPECT_EQ(b.ssim, 0.9);
    EXPECT_EQ(b.motion, 2e-5);
    EXPECT_EQ(b.overridden_by({1, {}, {}, {}, {}}).channel, 1);
}

TEST(Baselines, AMissingFileIsExplained) {
    const Folder folder;
    const Finished finished = shell(folder, "$BEAMCAM test none.json");
    EXPECT_EQ(finished.code, 6);
    EXPECT_THAT(finished.err, HasSubstr("none.json does not exist; a file of baselines lists what to test"));
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
    EXPECT_EQ(shell(folder, "$BEAMCAM test " + names + " --update all --report 'ü/r' --junit 'ü/j.xml'").code, 7);
    EXPECT_EQ(shell(folder, "$BEAMCAM test " + names + " --strict").code, 0);
    folder.write("c.json", R"({"entries": {"ä": {"scene": "s.json", "output": {"type": "still", "at": 0}}}})");
    EXPECT_THAT(shell(folder, "$BEAMCAM test c.json").err, HasSubstr("\"ä\" is the name of files"));
}

}  // namespace
}  // namespace beamcam::scenes
