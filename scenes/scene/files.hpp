// Names of output files: which are allowed, which numbered ones they stand for, which collide.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace beamcam::scenes {

// Why `file` cannot be the name of an output below the output directory; empty when it can.
std::string problem_with_file(std::string_view file);

// Why `file` cannot name a sequence: it needs one run of '#' in its last part; empty when it can.
std::string problem_with_numbering(std::string_view file);
bool is_numbered(std::string_view file);

// "a-####.png" and 12 make "a-0012.png"; a number with more digits takes the room it needs.
std::string numbered_file(std::string_view pattern, long number);
// The number by which `file` is one of them; nothing when it is none.
std::optional<long> number_of(std::string_view pattern, std::string_view file);

// "fall.mp4" as the second of three parts: "fall.2of3.mp4".
std::string shard_file(const std::string& file, int shard, int shards);

// Who writes which files, and which of them could write the same path, or one a file where another needs a directory.
// The time grows with the number of names, not with its square.
class FileClaims {
  public:
    // Owners claim their names in the order of their numbers; names of one owner do not clash.
    void add(std::string_view file, std::size_t owner);

    struct Claim {
        std::string file;
        std::size_t owner = 0;
    };
    struct Clash {
        Claim later, earlier;
    };
    // At most one for each owner: with the earliest of the others. In the order of `later`.
    std::vector<Clash> clashes() const;

  private:
    std::vector<Claim> claims_;
};

}  // namespace beamcam::scenes
