#include "scenes/scene/files.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <random>
#include <string>
#include <vector>

namespace beamcam::scenes {
namespace {

std::string normal(const std::string& file) { return std::filesystem::path(file).lexically_normal().generic_string(); }

// The definition, pair by pair.
bool may_collide(const std::string& first, const std::string& second) {
    const std::string a = normal(first), b = normal(second);
    const auto numbers = [](const std::string& pattern, const std::string& file) {
        const std::string before = pattern.substr(0, pattern.find('#')),
                          after = pattern.substr(pattern.find_last_of('#') + 1);
        return file.size() > before.size() + after.size() && file.starts_with(before) && file.ends_with(after) &&
               file.substr(before.size(), file.size() - before.size() - after.size()).find_first_not_of("0123456789") ==
                   std::string::npos;
    };
    if (is_numbered(a) && is_numbered(b))
        return a.substr(0, a.find('#')) == b.substr(0, b.find('#')) &&
               a.substr(a.find_last_of('#') + 1) == b.substr(b.find_last_of('#') + 1);
    if (is_numbered(a)) return numbers(a, b);
    if (is_numbered(b)) return numbers(b, a);
    return a == b || b.starts_with(a + "/") || a.starts_with(b + "/");
}

TEST(FileClaims, FindTheEarliestClashOfEveryOwnerAsPairByPair) {
    const std::vector<std::string> names = {"a.png",     "./a.png",   "a-1.png",  "a-12.png", "a-#.png", "a-####.png",
                                            "d/a-1.png", "d/a-#.png", "a-1#.png", "a",        "a/b",     "a/b/c.png",
                                            "1.png",     "#.png",     "d2/x.csv", "d2",       "11.png",  "a-2-3.png"};
    std::mt19937 dice(1);
    for (int trial = 0; trial < 3000; ++trial) {
        FileClaims claims;
        std::vector<std::vector<std::string>> owned(6);
        for (std::size_t owner = 0; owner < owned.size(); ++owner)
            for (unsigned k = 0; k < 1 + dice() % 2; ++k) {
                owned[owner].push_back(names[dice() % names.size()]);
                claims.add(owned[owner].back(), owner);
            }
        std::vector<std::pair<std::size_t, std::size_t>> expected, found;
        for (std::size_t later = 0; later < owned.size(); ++later)
            for (std::size_t earlier = 0; earlier < later; ++earlier) {
                bool clash = false;
                for (const std::string& a : owned[later])
                    for (const std::string& b : owned[earlier]) clash = clash || may_collide(a, b);
                if (!clash) continue;
                expected.emplace_back(later, earlier);
                break;
            }
        for (const auto& [later, earlier] : claims.clashes()) {
            EXPECT_TRUE(may_collide(later.file, earlier.file)) << later.file << " " << earlier.file;
            found.emplace_back(later.owner, earlier.owner);
        }
        ASSERT_EQ(found.size(), expected.size()) << trial;
        for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i].first, expected[i].first) << trial;
    }
}

}  // namespace
}  // namespace beamcam::scenes
