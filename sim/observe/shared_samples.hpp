// Samples of one step that several requests ask for: each is evaluated once.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "sim/observe/channels.hpp"
#include "sim/observe/constants.hpp"
#include "sim/observe/pose.hpp"

namespace beamcam::sim {

// What was found at an instant, by what was asked for.
template <class Asked, class Found>
class Shared {
  public:
    // `find(found)` evaluates what is not known yet. Valid until the next call.
    template <class Find>
    const Found& get(double t, const Asked& asked, Find&& find) {
        if (known_.size() == kMostSharedInstants) known_.clear();
        std::vector<std::pair<Asked, Found>>& here = known_[t];
        for (const auto& [known, found] : here)
            if (known == asked) return found;
        find(here.emplace_back(asked, Found{}).second);
        return here.back().second;
    }

  private:
    std::map<double, std::vector<std::pair<Asked, Found>>> known_;
};

struct SharedSamples {
    Shared<std::vector<Channel>, std::vector<double>> rows;
    Shared<int, Pose> poses;  // by the number of stations
};

}  // namespace beamcam::sim
