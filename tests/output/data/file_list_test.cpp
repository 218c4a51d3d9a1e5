#include "output/data/file_list.hpp"

#include <gmock/gmock.h>

#include <chrono>

#include "output/files/atomic_file.hpp"
#include "tests/output/scratch.hpp"

namespace beamcam::output {
namespace {

namespace fs = std::filesystem;

void make(const fs::path& file, const std::string& content) {
    FileList files(false);
    files.require_replaceable(file);
    write_file(files.target(file), content);
}

std::string refusal(const fs::path& file) {
    try {
        FileList(false).require_replaceable(file);
    } catch (const WouldOverwrite& error) {
        return error.what();
    }
    return "";
}

bool mentions(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::vector<FileRecord> records_in(const Scratch& scratch) {
    return parse_file_list(read_file(scratch / FileList::kFileName));
}

TEST(FileList, ANewNameIsFree) {
    Scratch scratch;
    EXPECT_EQ(refusal(scratch / "a.csv"), "");
}

TEST(FileList, AForeignFileIsRefusedWithTheRemedy) {
    Scratch scratch;
    write_file(scratch / "a.csv", "precious");
    const std::string message = refusal(scratch / "a.csv");
    for (const std::string& part :
         {(scratch / "a.csv").string(), std::string("not made by beamcam"), std::string("--force")})
        EXPECT_TRUE(mentions(message, part)) << message;
}

TEST(FileList, OnesOwnUnchangedFileIsReplaced) {
    Scratch scratch;
    make(scratch / "a.csv", "first");
    make(scratch / "a.csv", "second");
    EXPECT_EQ(refusal(scratch / "a.csv"), "");
}

TEST(FileList, OnesOwnFileIsRefusedOnceSomebodyChangedIt) {
    Scratch scratch;
    make(scratch / "a.csv", "first");
    write_file(scratch / "a.csv", "edits");  // of the same size
    EXPECT_TRUE(mentions(refusal(scratch / "a.csv"), "changed after beamcam made it"));
}

TEST(FileList, ForceReplacesAnything) {
    Scratch scratch;
    write_file(scratch / "a.csv", "precious");
    EXPECT_NO_THROW(FileList(true).require_replaceable(scratch / "a.csv"));
}

TEST(FileList, RelativeAndAbsoluteNamesAreTheSameFile) {
    Scratch scratch;
    make(scratch / "a.csv", "first");
    EXPECT_EQ(refusal(fs::proximate(scratch / "a.csv")), "");
}

TEST(FileList, AFileThatWasCopiedWithItsListIsStillOnesOwn) {
    Scratch scratch, copy;
    make(scratch / "a.csv", "first");
    for (const char* name : {"a.csv", FileList::kFileName}) fs::copy_file(scratch / name, copy / name);
    EXPECT_EQ(refusal(copy / "a.csv"), "");
}

// ---- lists of others -----------------------------------------------------------------------------

// The digest is right, but the mark is that of another user, or none, or that of another name.
TEST(FileList, AListThatCameWithAFolderMakesNothingOnesOwn) {
    Scratch scratch;
    make(scratch / "a.csv", "made");
    FileRecord record = records_in(scratch).front();
    const std::string own = record.mark;
    ASSERT_FALSE(own.empty());
    for (const std::string& mark : {std::string(), std::string(32, 'a'), own + "0"}) {
        record.mark = mark;
        write_file(scratch / FileList::kFileName, line_of(record));
        const std::string message = refusal(scratch / "a.csv");
        EXPECT_TRUE(mentions(message, "came from elsewhere") && mentions(message, "--force")) << message;
        EXPECT_FALSE(FileList(false).is_up_to_date(scratch / "a.csv", record.origin.inputs));
    }
    record.mark = own;
    record.name = "b.csv";
    write_file(scratch / FileList::kFileName, line_of(record));
    fs::copy_file(scratch / "a.csv", scratch / "b.csv");
    EXPECT_TRUE(mentions(refusal(scratch / "b.csv"), "came from elsewhere"));
}

TEST(FileList, LinesThatAreNoRecordsAreSkipped) {
    Scratch scratch;
    make(scratch / "a.csv", "made");
    const std::string line = read_file(scratch / FileList::kFileName);
    for (const std::string text :
         {"", "\n", "{\n", "[]\n", "{\"name\": 3}\n", "<<<<<<< HEAD\n",
          "{\"name\": \"../x\", \"sha256\": \"00\", \"size\": 1}\n", "{\"name\": \"a.csv\", \"size\": -1}\n"}) {
        write_file(scratch / FileList::kFileName, text + line + text);
        EXPECT_EQ(records_in(scratch).size(), 1u) << text;
        EXPECT_EQ(refusal(scratch / "a.csv"), "") << text;
    }
}

// Links and other things in the place of the list are neither written through nor replaced.
TEST(FileList, ALinkInThePlaceOfTheListIsNotFollowed) {
    Scratch scratch, victim;
    write_file(victim / "profile", "precious");
    fs::create_symlink(victim / "profile", scratch / FileList::kFileName);
    EXPECT_THROW(make(scratch / "a.csv", "made"), IoError);
    fs::remove(scratch / FileList::kFileName);
    fs::create_hard_link(victim / "profile", scratch / FileList::kFileName);
    EXPECT_THROW(make(scratch / "a.csv", "made"), IoError);
    FileList::recover(scratch.path());
    EXPECT_EQ(read_file(victim / "profile"), "precious");
    fs::remove(scratch / FileList::kFileName);
    fs::create_directory(scratch / FileList::kFileName);
    EXPECT_THAT([&] { make(scratch / "a.csv", "made"); },
                ::testing::ThrowsMessage<IoError>(::testing::HasSubstr("it is no plain file; remove it")));
}

// ---- lines ---------------------------------------------------------------------------------------

TEST(FileList, TheLinesOfFilesThatAreGoneOrReplacedGoWhenTheyAreMost) {
    Scratch scratch;
    FileList files(false);
    for (const char* content : {"first", "second", "third"}) write_file(files.target(scratch / "a.csv"), content);
    write_file(files.target(scratch / "b.csv"), "gone");
    fs::remove(scratch / "b.csv");
    EXPECT_EQ(records_in(scratch).size(), 4u);
    FileList::recover(scratch.path());
    ASSERT_EQ(records_in(scratch).size(), 1u);
    EXPECT_EQ(refusal(scratch / "a.csv"), "");
}

TEST(FileList, ProcessesSideBySideLoseNoEntry) {
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
    EXPECT_EQ(records_in(scratch).size(), std::size_t(kProcesses * kFiles));
}

TEST(FileList, KnowsWhatAFileWasMadeFrom) {
    Scratch scratch;
    {
        FileList files(false);
        write_file(files.target(scratch / "a.csv", {"recipe", "", ""}), "first");
    }
    EXPECT_TRUE(FileList(false).is_up_to_date(scratch / "a.csv", "recipe"));
    EXPECT_FALSE(FileList(false).is_up_to_date(scratch / "a.csv", "other"));
    EXPECT_FALSE(FileList(false).is_up_to_date(scratch / "a.csv", ""));
    EXPECT_FALSE(FileList(false).is_up_to_date(scratch / "b.csv", "recipe"));
    write_file(scratch / "a.csv", "edits");
    EXPECT_FALSE(FileList(false).is_up_to_date(scratch / "a.csv", "recipe"));
}

TEST(FileList, NamesOfAnyBytesSurvive) {
    const FileRecord record{"Balken θ \"x\"\n.mp4", "00", 3, "mark", "1:2", {"recipe", "0.1", "{}"}};
    EXPECT_EQ(parse_file_list(line_of(record)), std::vector{record});
}

// ---- runs that are killed ------------------------------------------------------------------------

// Runs `body` in a process that ends as a kill ends it: no destructor runs.
template <typename Body>
void killed(Body body) {
    exit_code_of([&] {
        auto* files = new FileList(false);  // leaked on purpose
        body(*files);
        return 0;
    });
}

TEST(FileList, AFileThatAKilledRunPutInItsPlaceIsOnesOwn) {
    Scratch scratch;
    killed([&](FileList& files) { write_file(files.target(scratch / "a.csv", {"recipe", "", ""}), "made"); });
    EXPECT_EQ(refusal(scratch / "a.csv"), "");
    EXPECT_TRUE(FileList(false).is_up_to_date(scratch / "a.csv", "recipe"));
}

TEST(FileList, AFileThatTheUserPutsWhereAKilledRunWasAboutToIsTheUsers) {
    Scratch scratch;
    killed([&](FileList& files) {
        auto* file = new AtomicFile(files.target(scratch / "a.csv"));
        file->write("half");
    });
    write_file(scratch / "a.csv", "precious");
    EXPECT_TRUE(mentions(refusal(scratch / "a.csv"), "not made by beamcam"));
}

// Killed between the line and the new name: either content is beamcam's own, and no third one.
TEST(FileList, WhicheverOfTwoVersionsAKillLeavesIsOnesOwn) {
    for (const bool renamed : {false, true}) {
        Scratch scratch;
        make(scratch / "a.csv", "first");
        killed([&](FileList& files) {
            FileTarget target = files.target(scratch / "a.csv");
            if (!renamed)
                target.before_rename = [record = target.before_rename](const fs::path& temporary) {
                    record(temporary);
                    _exit(0);
                };
            write_file(target, "second");
        });
        EXPECT_EQ(read_file(scratch / "a.csv"), renamed ? "second" : "first");
        EXPECT_EQ(refusal(scratch / "a.csv"), "");
        FileList::recover(scratch.path());
        EXPECT_EQ(refusal(scratch / "a.csv"), "");
        write_file(scratch / "a.csv", "edited");
        EXPECT_TRUE(mentions(refusal(scratch / "a.csv"), "changed after beamcam made it"));
    }
}

TEST(FileList, RecoveryRemovesTheHalfWrittenFilesOfAnHourAgoAndNoOthers) {
    Scratch scratch;
    killed([&](FileList& files) { (new AtomicFile(files.target(scratch / "a.csv")))->write("half"); });
    ASSERT_EQ(scratch.names().size(), 1u);
    const std::string abandoned = scratch.names().front();
    fs::create_directory(scratch / ".a.01234567.part");
    fs::create_symlink("a.part", scratch / ".l.01234567.part");
    for (const char* own : {".mine.part", "a.part", ".a.12345678.part.txt", ".a.ghijklmn.part"})
        write_file(scratch / own, "precious");
    FileList living(false);
    AtomicFile file(living.target(scratch / "b.csv"));
    FileList::recover(scratch.path());
    EXPECT_TRUE(fs::exists(scratch / abandoned));  // its run might live where the file system has no locks
    for (const std::string& name : scratch.names())
        if (!fs::is_symlink(scratch / name))
            fs::last_write_time(scratch / name, fs::file_time_type::clock::now() - std::chrono::hours(2));
    const std::size_t before = scratch.names().size();
    FileList::recover(scratch.path());
    EXPECT_FALSE(fs::exists(scratch / abandoned));
    EXPECT_EQ(scratch.names().size(), before - 1);
    file.commit();
    EXPECT_EQ(refusal(scratch / "b.csv"), "");
}

TEST(FileList, AFileThatAppearsWhileARunWorksIsNotReplaced) {
    Scratch scratch;
    FileList files(false);
    files.require_replaceable(scratch / "a.csv");
    AtomicFile file(files.target(scratch / "a.csv"));
    write_file(scratch / "a.csv", "precious");
    EXPECT_THROW(file.commit(), WouldOverwrite);
    EXPECT_EQ(read_file(scratch / "a.csv"), "precious");
}

TEST(FileList, TwoRunsMayMakeTheSameFile) {
    Scratch scratch;
    FileList files(false);
    files.require_replaceable(scratch / "a.csv");
    AtomicFile file(files.target(scratch / "a.csv"));
    make(scratch / "a.csv", "of the other");
    EXPECT_NO_THROW(file.commit());
}

TEST(FileList, LeavesNothingOfARunThatMadeNothing) {
    Scratch scratch;
    {
        FileList files(false);
        const AtomicFile given_up(files.target(scratch / "a.csv"));
    }
    EXPECT_EQ(scratch.names(), std::vector<std::string>{});
}

}  // namespace
}  // namespace beamcam::output
