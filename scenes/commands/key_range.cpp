#include "scenes/commands/key_range.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "scenes/commands/commands.hpp"
#include "scenes/format/checks.hpp"
#include "scenes/format/suggest.hpp"

namespace beamcam::scenes {

KeyRange range_argument(const std::string& over, const sim::Problem& problem, render::Units& units) {
    const std::size_t equals = over.find('='), colon = over.find(':', equals);
    if (equals == std::string::npos || colon == std::string::npos || over.find(':', colon + 1) != std::string::npos)
        throw UsageError(fmt::format("--over {}: write KEY=FROM:TO, for example cam.speed=40:60", over));
    const std::string path = over.substr(0, equals), option = "--over " + over;
    const std::vector<sim::NumberKey> keys = sim::number_keys(problem);
    const auto key = std::ranges::find(keys, path, &sim::NumberKey::path);
    if (key == keys.end()) {
        std::vector<std::string> known;
        for (const sim::NumberKey& each : keys) known.push_back(each.path);
        throw SceneError(fmt::format("{}: {} is no number of this scene{}", option, in_quotes(path),
                                     suggestion_or_list(path, known)));
    }
    if (key->whole)
        throw UsageError(
            fmt::format("{}: {} takes whole numbers alone, and an orbit is followed over a key that varies "
                        "continuously; give sweep --over {} a list of them",
                        option, path, path));
    const std::string from = over.substr(equals + 1, colon - equals - 1);
    adopt_unit(from, key->dimension, units);
    KeyRange range{*key, signed_argument(option, from, key->dimension),
                   signed_argument(option, over.substr(colon + 1), key->dimension)};
    if (!(range.from < range.to)) throw UsageError(fmt::format("{}: the range must ascend", option));
    return range;
}

}  // namespace beamcam::scenes
