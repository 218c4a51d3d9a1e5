// Names of output files: validity, numbering, conflicts.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace beamcam::scenes {

// Why `file` is not a valid name of an output; empty if it is valid.
std::string problem_with_file(std::string_view file);

// Why `file` is not a valid name of a sequence, which needs one run of '#' in its last part; empty if it is valid.
std::string problem_with_numbering(std::string_view file);
bool is_numbered(std::string_view file);
inline bool is_stdout(std::string_view file) { return file == "-"; }
std::string ending_of(const std::filesystem::path& file);  // ".png"
// What a file with this ending is, if `info` reads no scene from it but from the list of files beside it; null: it
// does.
const char* kind_without_scene(std::string_view ending);

// "a-####.png" and 12 give "a-0012.png"; longer numbers get more digits.
std::string numbered_file(std::string_view pattern, long number);
// The number of `file` in the sequence; nullopt if it is not a part of it.
std::optional<long> number_of(std::string_view pattern, std::string_view file);

// One of several parts of a sweep, by its number from 1.
struct Shard {
    std::uint64_t number = 1, count = 1;
    bool whole() const { return count == 1; }
    std::string text() const;  // "2/3"
};
// The file of a part of a sweep: "r.csv" as the second of three parts is "r.2of3.points".
std::string part_file(const std::string& file, const Shard& shard);

// Finds owners that would write the same path, or a file where another needs a directory. The time is almost linear in
// the number of names.
class FileClaims {
  public:
    // Owners must come in increasing order; names of one owner do not clash.
    void add(std::string_view file, std::size_t owner);

    struct Claim {
        std::string file;
        std::size_t owner = 0;
    };
    struct Clash {
        Claim later, earlier;
    };
    // At most one clash for each owner, with the earliest other owner; in the order of `later`.
    std::vector<Clash> clashes() const;

  private:
    std::vector<Claim> claims_;
};

}  // namespace beamcam::scenes
