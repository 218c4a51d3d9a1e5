// Positions of names in a list, found without walking it. Of equal names the first counts.
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
    // False: the name is there already and keeps its position.
    bool add(std::string_view name, std::size_t position) {
        return positions_.try_emplace(std::string(name), position).second;
    }
    std::optional<std::size_t> find(std::string_view name) const {
        const auto found = positions_.find(name);
        return found == positions_.end() ? std::nullopt : std::optional(found->second);
    }

  private:
    std::map<std::string, std::size_t, std::less<>> positions_;  // ordered: no input makes it slow
};

}  // namespace beamcam::output
