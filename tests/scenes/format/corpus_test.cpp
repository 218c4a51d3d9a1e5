// The reader and the JSON Schema are two descriptions of one format: they agree on a corpus of small
// scenes and on hundreds of scenes made from one by a single change. What a schema cannot express —
// syntax, units, rules across keys — is tested with the reader alone.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>

#include "tests/scenes/support.hpp"

namespace beamcam::scenes {
namespace {

using testing::kCorpus;
const std::filesystem::path kSchema = BEAMCAM_TEST_DIR "/../scenes/beamcam-scene.schema.json";

struct Verdict {
    bool accepted;
    std::string scene;
};

std::vector<Verdict> schema_verdicts(const std::string& arguments) {
    const std::string command = "/usr/bin/python3 -W ignore '" BEAMCAM_TEST_DIR "/scenes/schema_verdicts.py' '" +
                                kSchema.string() + "' " + arguments;
    std::FILE* pipe = popen(command.c_str(), "r");
    std::string text;
    std::array<char, 65536> block;
    while (const std::size_t n = std::fread(block.data(), 1, block.size(), pipe)) text.append(block.data(), n);
    EXPECT_EQ(pclose(pipe), 0) << command << "\nneeds python3 with jsonschema (Debian: python3-jsonschema)";
    std::vector<Verdict> verdicts;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
        verdicts.push_back({line.starts_with("accept"), line.substr(line.find('\t') + 1)});
    return verdicts;
}

std::vector<std::filesystem::path> files_in(const std::string& folder) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(kCorpus / folder))
        if (entry.path().extension() == ".json") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

Reading read_file(const std::filesystem::path& file) { return read_scene(load_source(file.string())); }

TEST(Corpus, TheReaderAcceptsEveryValidScene) {
    const auto files = files_in("valid");
    EXPECT_GE(files.size(), 90u);
    for (const auto& file : files) {
        const Reading reading = read_file(file);
        EXPECT_TRUE(reading.scene) << reading.report();
    }
}

TEST(Corpus, TheReaderRejectsEveryInvalidSceneAtAPlaceInsideIt) {
    const auto files = files_in("invalid");
    EXPECT_GE(files.size(), 150u);
    for (const auto& file : files) {
        const Reading reading = read_file(file);
        EXPECT_FALSE(reading.scene) << file;
        for (const Message& message : reading.messages) {
            EXPECT_LT(message.place.offset, reading.sources[0].text.size()) << reading.report();
            EXPECT_GE(message.text.size(), 20u) << reading.report();
        }
    }
}

TEST(Corpus, TheReaderAloneRejectsWhatASchemaCannotExpress) {
    const auto files = files_in("reader_only");
    EXPECT_GE(files.size(), 45u);
    for (const auto& file : files) {
        const Reading reading = read_file(file);
        EXPECT_FALSE(reading.scene) << file;
        EXPECT_FALSE(reading.messages.empty()) << file;
    }
}

TEST(Corpus, TheSchemaAcceptsAndRejectsTheSame) {
    const auto valid = schema_verdicts("'" + (kCorpus / "valid").string() + "'");
    EXPECT_EQ(valid.size(), files_in("valid").size());
    for (const Verdict& verdict : valid) EXPECT_TRUE(verdict.accepted) << verdict.scene;
    const auto invalid = schema_verdicts("'" + (kCorpus / "invalid").string() + "'");
    EXPECT_EQ(invalid.size(), files_in("invalid").size());
    for (const Verdict& verdict : invalid) EXPECT_FALSE(verdict.accepted) << verdict.scene;
}

// Rules between keys are no part of the schema.
bool breaks_a_rule(const Reading& reading) {
    return std::ranges::any_of(reading.messages, [](const Message& message) {
        return message.text.find("is a strip; it needs") != std::string::npos ||
               message.text.find("shows nothing; name \"channels\"") != std::string::npos;
    });
}

// One change to one value, key by key, of scenes that together use every key of the format.
TEST(Corpus, ReaderAndSchemaAgreeOnEveryMutant) {
    SKIP_UNDER_SANITIZERS();
    std::size_t mutants = 0, accepted = 0;
    for (const auto& file : files_in("whole")) {
        ASSERT_TRUE(read_file(file).scene) << read_file(file).report();
        for (const Verdict& verdict : schema_verdicts("--mutate '" + file.string() + "'")) {
            const Reading reading = testing::read(verdict.scene);
            if (!breaks_a_rule(reading)) {
                EXPECT_EQ(reading.scene.has_value(), verdict.accepted)
                    << file.filename() << ": " << verdict.scene << "\n"
                    << reading.report();
            }
            ++mutants;
            accepted += verdict.accepted;
        }
    }
    EXPECT_GE(mutants, 1000u);
    EXPECT_GE(accepted, 100u);
}

TEST(Corpus, AResolvedSceneReadsBackToItself) {
    for (const char* folder : {"valid", "whole", "full"})
        for (const auto& file : files_in(folder)) {
            const Reading first = read_file(file);
            ASSERT_TRUE(first.scene);
            const std::string text = to_json(*first.scene);
            const Reading second = read_scene({file.string(), text, true});
            ASSERT_TRUE(second.scene) << second.report() << text;
            EXPECT_EQ(to_json(*second.scene), text) << file;
        }
}

TEST(ShippedScenes, AreFineWithoutAWarning) {
    std::size_t scenes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(BEAMCAM_TEST_DIR "/../scenes")) {
        const std::string name = entry.path().filename().string();
        if (!name.ends_with(".json") || name.ends_with(".schema.json")) continue;
        const Reading reading = read_file(entry.path());
        EXPECT_TRUE(reading.scene) << reading.report();
        EXPECT_TRUE(reading.messages.empty()) << reading.report();
        ++scenes;
    }
    EXPECT_GE(scenes, 5u);
}

}  // namespace
}  // namespace beamcam::scenes
