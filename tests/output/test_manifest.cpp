#include "output/atomic_file.hpp"
#include "output/manifest.hpp"
#include "tests/output/scratch.hpp"

namespace beamcam::output {
namespace {

namespace fs = std::filesystem;

void make(const fs::path& file, const std::string& content) {
    Manifest manifest(false);
    manifest.require_replaceable(file);
    write_file(file, content);
    manifest.record(file);
}

std::string refusal(const fs::path& file) {
    try {
        Manifest(false).require_replaceable(file);
    } catch (const WouldOverwrite& error) {
        return error.what();
    }
    return "";
}

TEST(Manifest, ANewNameIsFree) {
    Scratch scratch;
    EXPECT_EQ(refusal(scratch / "a.csv"), "");
}

TEST(Manifest, AForeignFileIsRefusedWithTheRemedy) {
    Scratch scratch;
    write_file(scratch / "a.csv", "precious");
    const std::string message = refusal(scratch / "a.csv");
    EXPECT_NE(message.find((scratch / "a.csv").string()), std::string::npos) << message;
    EXPECT_NE(message.find("not made by beamcam"), std::string::npos) << message;
    EXPECT_NE(message.find("--force"), std::string::npos) << message;
}

TEST(Manifest, OnesOwnUnchangedFileIsReplaced) {
    Scratch scratch;
    make(scratch / "a.csv", "first");
    make(scratch / "a.csv", "second");
    EXPECT_EQ(refusal(scratch / "a.csv"), "");
}

TEST(Manifest, OnesOwnFileIsRefusedOnceSomebodyChangedIt) {
    Scratch scratch;
    make(scratch / "a.csv", "first");
    write_file(scratch / "a.csv", "edits");  // of the same size
    EXPECT_NE(refusal(scratch / "a.csv").find("changed after beamcam made it"), std::string::npos);
}

TEST(Manifest, ForceReplacesAnything) {
    Scratch scratch;
    write_file(scratch / "a.csv", "precious");
    EXPECT_NO_THROW(Manifest(true).require_replaceable(scratch / "a.csv"));
}

TEST(Manifest, RelativeAndAbsoluteNamesAreTheSameFile) {
    Scratch scratch;
    make(scratch / "a.csv", "first");
    EXPECT_EQ(refusal(fs::relative(scratch / "a.csv")), "");
    EXPECT_EQ(refusal(scratch / "../" / scratch.path().filename() / "a.csv"), "");
}

TEST(Manifest, ADamagedOneCountsAsEmptyAndIsMended) {
    for (const char* text :
         {"", "{", "[]", "{\"format\": \"beamcam manifest 1\"}", "{\"format\": \"other\", \"files\": {}}",
          "{\"format\": \"beamcam manifest 1\", \"files\": {\"a.csv\": {\"sha256\": 3, \"size\": -1}}}"}) {
        Scratch scratch;
        make(scratch / "a.csv", "first");
        write_file(scratch / Manifest::kFileName, text);
        EXPECT_NE(refusal(scratch / "a.csv"), "") << text;
        make(scratch / "b.csv", "second");
        EXPECT_EQ(refusal(scratch / "b.csv"), "") << text;
    }
}

TEST(Manifest, ForgetsFilesThatAreGone) {
    Scratch scratch;
    make(scratch / "a.csv", "first");
    fs::remove(scratch / "a.csv");
    make(scratch / "b.csv", "second");
    const auto files = parse_manifest(read_file(scratch / Manifest::kFileName));
    ASSERT_TRUE(files.has_value());
    EXPECT_EQ(files->size(), 1u);
    EXPECT_TRUE(files->contains("b.csv"));
}

TEST(Manifest, ProcessesSideBySideLoseNoEntry) {
    Scratch scratch;
    constexpr int kProcesses = 8, kFiles = 10;
    std::vector<pid_t> children;
    for (int p = 0; p < kProcesses; ++p) {
        const pid_t child = fork();
        ASSERT_GE(child, 0);
        if (child == 0) {
            for (int i = 0; i < kFiles; ++i) make(scratch / (std::to_string(p) + "-" + std::to_string(i)), "x");
            _exit(0);
        }
        children.push_back(child);
    }
    for (pid_t child : children) waitpid(child, nullptr, 0);
    const auto files = parse_manifest(read_file(scratch / Manifest::kFileName));
    ASSERT_TRUE(files.has_value());
    EXPECT_EQ(files->size(), std::size_t(kProcesses * kFiles));
}

TEST(Manifest, KnowsWhatAFileWasMadeFrom) {
    Scratch scratch;
    write_file(scratch / "a.csv", "first");
    {
        Manifest manifest(false);
        manifest.record(scratch / "a.csv", {"recipe", "", ""});
    }
    EXPECT_TRUE(Manifest(false).is_made_from(scratch / "a.csv", "recipe"));
    EXPECT_FALSE(Manifest(false).is_made_from(scratch / "a.csv", "other"));
    EXPECT_FALSE(Manifest(false).is_made_from(scratch / "a.csv", ""));
    EXPECT_FALSE(Manifest(false).is_made_from(scratch / "b.csv", "recipe"));
    write_file(scratch / "a.csv", "edits");
    EXPECT_FALSE(Manifest(false).is_made_from(scratch / "a.csv", "recipe"));
}

TEST(Manifest, AFileThatAKilledRunPutInItsPlaceIsOnesOwn) {
    Scratch scratch;
    const pid_t child = fork();
    if (child == 0) {
        Manifest manifest(false);
        manifest.announce({scratch / "a.csv", scratch / "b.csv"});
        write_file(scratch / "a.csv", "made");
        _exit(0);  // as a kill does: no destructor, no record
    }
    waitpid(child, nullptr, 0);
    EXPECT_EQ(refusal(scratch / "a.csv"), "");
    EXPECT_FALSE(Manifest(false).is_made_from(scratch / "a.csv", "recipe"));
    // What stood there before stays foreign.
    write_file(scratch / "b.csv", "precious");
    fs::last_write_time(scratch / "b.csv", fs::file_time_type::clock::now() - std::chrono::hours(1));
    EXPECT_NE(refusal(scratch / "b.csv"), "");
}

TEST(Manifest, WhatWasAnnouncedAndNotMadeIsForgottenByARunThatEnds) {
    Scratch scratch;
    make(scratch / "a.csv", "first");
    {
        Manifest manifest(false);
        manifest.announce({scratch / "a.csv", scratch / "b.csv"});
    }
    const auto files = parse_manifest(read_file(scratch / Manifest::kFileName));
    ASSERT_TRUE(files.has_value());
    EXPECT_EQ(files->size(), 1u);
    EXPECT_EQ(files->at("a.csv").making, 0);
    EXPECT_EQ(refusal(scratch / "a.csv"), "");
    write_file(scratch / "b.csv", "precious");
    EXPECT_NE(refusal(scratch / "b.csv"), "");
}

TEST(Manifest, NamesOfAnyBytesSurvive) {
    const MadeFiles files = {{"Balken θ \"x\"\n.mp4", {"00", 3, {"recipe", "0.1", "{}"}, "1:2", 4}}};
    EXPECT_EQ(parse_manifest(manifest_json(files)), files);
}

}  // namespace
}  // namespace beamcam::output
