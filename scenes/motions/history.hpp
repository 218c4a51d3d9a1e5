// What work took in earlier runs of this user, from which a plan says what the next takes: a small text file beside the
// kept trajectories. Whatever is wrong with it, nothing is known; it decides nothing but the words of a plan.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/problem/problem.hpp"

namespace beamcam::scenes {

// What one unit of some work took: a second of motion, a picture, a number of a table.
struct Rate {
    double seconds = 0;
    double amount = 0;  // steps of a motion, bytes of a file
};

class History {
  public:
    // Knows nothing and keeps nothing.
    History() = default;
    explicit History(const std::filesystem::path& directory);

    // Of the first of these names of work that is known.
    std::optional<Rate> find(const std::vector<std::string>& names) const;
    // So many units took so long. Later runs count as much as all before them.
    void note(const std::vector<std::string>& names, double units, double seconds, double amount);
    // Beside what other processes have noted meanwhile. That it fails is of no consequence.
    void save();

  private:
    std::filesystem::path file_;  // empty: none
    std::map<std::string, Rate> known_;
    std::vector<std::pair<std::string, Rate>> noted_;
};

// Names of the work per second of motion: this very motion first, then those that are like it.
// `key`: motion_key(problem).
std::vector<std::string> motion_work(const std::string& key, const sim::Problem& problem, bool read_back, bool horizon);

}  // namespace beamcam::scenes
