#include "output/data/manifest.hpp"

#include "output/files/atomic_file.hpp"
#include "tests/output/scratch.hpp"

namespace beamcam::output {
namespace {

namespace fs = std::filesystem;

void make(const fs::path& file, const std::string& content) {
    Manifest manifest(false);
    manifest.require_replaceable(file);
    write_file(manifest.target(file), content);
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

TEST(Manifest, TheRefusalNamesADamagedOne) {
    Scratch scratch;
    make(scratch / "a.csv", "first");
    write_file(scratch / Manifest::kFileName, "{\n  \"format\": \"beamcam manifest 1\",\n  \"files\": {\"a.c");
    const std::string why = refusal(scratch / "a.csv");
    for (const char* part :
         {".beamcam.json, the list of the files that beamcam made, is damaged (line 3: ", "restore it", "--force"})
        EXPECT_NE(why.find(part), std::string::npos) << why;
    // What replaces it keeps it.
    const std::string list = read_file(scratch / Manifest::kFileName);
    make(scratch / "b.csv", "second");
    EXPECT_EQ(read_file(scratch / Manifest::kDamagedName), list);
    EXPECT_NE(refusal(scratch / "a.csv").find("kept as .beamcam.json.damaged"), std::string::npos);
    fs::remove(scratch / Manifest::kDamagedName);
    write_file(scratch / Manifest::kFileName, manifest_json({}));
    EXPECT_NE(refusal(scratch / "a.csv").find("was not made by beamcam; move it"), std::string::npos);
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
    {
        Manifest manifest(false);
        write_file(manifest.target(scratch / "a.csv", {"recipe", "", ""}), "first");
    }
    EXPECT_TRUE(Manifest(false).is_up_to_date(scratch / "a.csv", "recipe"));
    EXPECT_FALSE(Manifest(false).is_up_to_date(scratch / "a.csv", "other"));
    EXPECT_FALSE(Manifest(false).is_up_to_date(scratch / "a.csv", ""));
    EXPECT_FALSE(Manifest(false).is_up_to_date(scratch / "b.csv", "recipe"));
    write_file(scratch / "a.csv", "edits");
    EXPECT_FALSE(Manifest(false).is_up_to_date(scratch / "a.csv", "recipe"));
}

// ---- runs that are killed ------------------------------------------------------------------------

// Runs `body` in a process that ends as a kill ends it: no destructor runs.
template <typename Body>
void killed(Body body) {
    exit_code_of([&] {
        auto* manifest = new Manifest(false);  // leaked on purpose
        body(*manifest);
        return 0;
    });
}

TEST(Manifest, AFileThatAKilledRunPutInItsPlaceIsOnesOwn) {
    Scratch scratch;
    killed([&](Manifest& manifest) { write_file(manifest.target(scratch / "a.csv", {"recipe", "", ""}), "made"); });
    EXPECT_EQ(refusal(scratch / "a.csv"), "");
    EXPECT_TRUE(Manifest(false).is_up_to_date(scratch / "a.csv", "recipe"));
}

TEST(Manifest, AFileThatTheUserPutsWhereAKilledRunWasAboutToIsTheUsers) {
    Scratch scratch;
    killed([&](Manifest& manifest) {
        auto* file = new AtomicFile(manifest.target(scratch / "a.csv"));
        file->write("half");
    });
    write_file(scratch / "a.csv", "precious");
    EXPECT_NE(refusal(scratch / "a.csv").find("not made by beamcam"), std::string::npos);
}

// Killed between the journal's line and the new name: either content is beamcam's own, and no third one.
TEST(Manifest, WhicheverOfTwoVersionsAKillLeavesIsOnesOwn) {
    for (const bool renamed : {false, true}) {
        Scratch scratch;
        make(scratch / "a.csv", "first");
        killed([&](Manifest& manifest) {
            Target target = manifest.target(scratch / "a.csv");
            if (!renamed)
                target.before_rename = [record = target.before_rename](const fs::path& temporary) {
                    record(temporary);
                    _exit(0);
                };
            write_file(target, "second");
        });
        EXPECT_EQ(read_file(scratch / "a.csv"), renamed ? "second" : "first");
        EXPECT_EQ(refusal(scratch / "a.csv"), "");
        Manifest(false).recover(scratch.path());
        EXPECT_EQ(refusal(scratch / "a.csv"), "");
        EXPECT_EQ(scratch.names(), (std::vector<std::string>{".beamcam.json", "a.csv"}));
        write_file(scratch / "a.csv", "edited");
        EXPECT_NE(refusal(scratch / "a.csv").find("changed after beamcam made it"), std::string::npos);
    }
}

TEST(Manifest, RecoveryRemovesTheHalfWrittenFilesOfKilledRunsAndNoOthers) {
    Scratch scratch;
    killed([&](Manifest& manifest) { (new AtomicFile(manifest.target(scratch / "a.csv")))->write("half"); });
    for (const char* own : {".mine.part", ".a.csv.0123abcd.part", "a.part"}) write_file(scratch / own, "precious");
    ASSERT_EQ(scratch.names().size(), 5u);  // and the journal
    Manifest living(false);
    AtomicFile file(living.target(scratch / "b.csv"));
    Manifest(false).recover(scratch.path());
    std::vector<std::string> left = {".a.csv.0123abcd.part", ".mine.part", "a.part",
                                     file.temporary_path().filename().string()};
    for (const std::string& name : left) EXPECT_TRUE(fs::exists(scratch / name)) << name;
    EXPECT_EQ(scratch.names().size(), left.size() + 1);  // and the journal of the one that lives
    file.commit();
    living.save();
    EXPECT_EQ(refusal(scratch / "b.csv"), "");
}

// A journal may have come with a folder of somebody else.
TEST(Manifest, AForgedJournalRemovesNothingElse) {
    Scratch scratch;
    fs::create_directory(scratch / "sub");
    const std::vector<std::string> files = {"precious.txt", ".precious.part", ".a.12345678.part.txt",
                                            ".a.ghijklmn.part", "sub/.a.01234567.part"};
    std::string lines;
    for (const std::string& name : files) {
        write_file(scratch / name, "precious");
        lines += journal_line(name);
    }
    write_file(scratch / ".beamcam.01234567.journal", lines + journal_line("../" + scratch.path().filename().string()));
    Manifest(false).recover(scratch.path());
    EXPECT_FALSE(fs::exists(scratch / ".beamcam.01234567.journal"));
    for (const std::string& name : files) EXPECT_TRUE(fs::exists(scratch / name)) << name;
}

TEST(Manifest, ALineOfTheJournalThatIsCutOffIsLeftOut) {
    const FileRecord made{"00", 3, {"recipe", "", ""}, "1:2"};
    const std::string text = journal_line(".a.01234567.part") + journal_line("a", made) + journal_line("b", made);
    const JournalLines lines = parse_journal(text.substr(0, text.size() - 5));
    EXPECT_EQ(lines.temporaries, std::vector<std::string>{".a.01234567.part"});
    ASSERT_EQ(lines.placed.size(), 1u);
    EXPECT_EQ(lines.placed[0].second, made);
}

TEST(Manifest, AFileThatAppearsWhileARunWorksIsNotReplaced) {
    Scratch scratch;
    Manifest manifest(false);
    manifest.require_replaceable(scratch / "a.csv");
    AtomicFile file(manifest.target(scratch / "a.csv"));
    write_file(scratch / "a.csv", "precious");
    EXPECT_THROW(file.commit(), WouldOverwrite);
    EXPECT_EQ(read_file(scratch / "a.csv"), "precious");
}

TEST(Manifest, TwoRunsMayMakeTheSameFile) {
    Scratch scratch;
    Manifest manifest(false);
    manifest.require_replaceable(scratch / "a.csv");
    AtomicFile file(manifest.target(scratch / "a.csv"));
    make(scratch / "a.csv", "of the other");
    EXPECT_NO_THROW(file.commit());
}

TEST(Manifest, LeavesNothingOfARunThatMadeNothing) {
    Scratch scratch;
    {
        Manifest manifest(false);
        const AtomicFile given_up(manifest.target(scratch / "a.csv"));
    }
    EXPECT_EQ(scratch.names(), std::vector<std::string>{});
}

TEST(Manifest, NamesOfAnyBytesSurvive) {
    const FileRecords files = {{"Balken θ \"x\"\n.mp4", {"00", 3, {"recipe", "0.1", "{}"}, "1:2"}}};
    EXPECT_EQ(parse_manifest(manifest_json(files)), files);
}

}  // namespace
}  // namespace beamcam::output
