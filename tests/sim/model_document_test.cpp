// MODEL.md defines every equation that the code cites, once, and no others.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <string>

namespace {

const std::filesystem::path kFolder = std::filesystem::path(BEAMCAM_TEST_DIR).parent_path() / "sim";

std::string contents(const std::filesystem::path& path) {
    std::ifstream in(path);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::map<std::string, int> occurrences(const std::string& text, const std::regex& pattern) {
    std::map<std::string, int> found;
    for (std::sregex_iterator it(text.begin(), text.end(), pattern), end; it != end; ++it) ++found[(*it)[1]];
    return found;
}

std::map<std::string, int> cited() {
    std::string code;
    for (const char* folder : {"sim", "scenes"})
        for (const auto& entry : std::filesystem::recursive_directory_iterator(kFolder.parent_path() / folder))
            if (entry.path().extension() == ".cpp" || entry.path().extension() == ".hpp")
                code += contents(entry.path());
    return occurrences(code, std::regex(R"(\((S[0-9]+[a-z]?)\))"));
}

std::map<std::string, int> defined() {
    return occurrences(contents(kFolder / "MODEL.md"), std::regex(R"(\*\*\((S[0-9]+[a-z]?)\)\*\*)"));
}

TEST(ModelDocument, DefinesEveryEquationThatTheCodeCites) {
    const auto have = defined();
    ASSERT_GT(cited().size(), 30u);
    for (const auto& [number, count] : cited()) EXPECT_TRUE(have.count(number)) << number;
}

TEST(ModelDocument, DefinesNothingTwiceAndNothingThatIsNotCited) {
    const auto used = cited();
    for (const auto& [number, count] : defined()) {
        EXPECT_EQ(count, 1) << number;
        EXPECT_TRUE(used.count(number)) << number;
    }
}

}  // namespace
