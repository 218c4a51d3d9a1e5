// The cost of work in earlier runs of this user, for the estimates of plans: a small text file beside the cache. An
// invalid file counts as empty; it has no effect on results.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/problem/problem.hpp"

namespace beamcam::scenes {

// Cost of a stage of work, or of one unit of it: a second of motion, a picture, a number of a table.
struct Cost {
    double seconds = 0;
    double amount = 0;  // steps of a motion, bytes of a file
};

class History {
  public:
    // Empty, without a file.
    History() = default;
    explicit History(const std::filesystem::path& directory);

    // The cost of `units` of the first known name.
    std::optional<Cost> find(const std::vector<std::string>& names, double units = 1) const;
    // Adds a measurement. The mean gives the latest run the same weight as all earlier ones together.
    void note(const std::vector<std::string>& names, double units, double seconds, double amount);
    // Merges with the measurements of other processes. Ignores errors.
    void save();

  private:
    std::filesystem::path file_;         // may be empty
    std::map<std::string, Cost> known_;  // of one unit
    std::vector<std::pair<std::string, Cost>> noted_;
};

// Names of the work per second of motion: first of this motion, then of similar ones. `key`: motion_key(problem).
std::vector<std::string> motion_work(const std::string& key, const sim::Problem& problem, bool read_back, bool horizon);

}  // namespace beamcam::scenes
