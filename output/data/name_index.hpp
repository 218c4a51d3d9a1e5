// The positions of names in a list. Of equal names, the first counts.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace beamcam::output {

class NameIndex {
  public:
    // False: the name exists already and keeps its position.
    bool add(std::string_view name, std::size_t position) {
        return positions_.try_emplace(std::string(name), position).second;
    }
    std::optional<std::size_t> find(std::string_view name) const {
        const auto found = positions_.find(name);
        return found == positions_.end() ? std::nullopt : std::optional(found->second);
    }
    // Removes the name if it has this position.
    void remove(std::string_view name, std::size_t position) {
        const auto found = positions_.find(name);
        if (found != positions_.end() && found->second == position) positions_.erase(found);
    }

  private:
    std::map<std::string, std::size_t, std::less<>> positions_;  // ordered: fast for any input
};

}  // namespace beamcam::output
