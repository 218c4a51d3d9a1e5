#include "scenes/commands/key_range.hpp"

#include <fmt/format.h>

#include "scenes/commands/commands.hpp"
#include "scenes/format/checks.hpp"
#include "scenes/format/sweep_keys.hpp"

namespace beamcam::scenes {

KeyRange range_argument(const std::string& over, const sim::Problem& problem, render::Units& units) {
    const std::size_t equals = over.find('='), colon = over.find(':', equals);
    if (equals == std::string::npos || colon == std::string::npos || over.find(':', colon + 1) != std::string::npos)
        throw UsageError(fmt::format("--over {}: write KEY=FROM:TO, for example cam.speed=40:60", over));
    const std::string path = over.substr(0, equals), option = "--over " + over;
    if (const std::string wrong = problem_with_number_key(problem, path); !wrong.empty())
        throw SceneError(fmt::format("{}: {}", option, wrong));
    const auto key = sim::number_key(problem, path);
    if (key->whole)
        throw UsageError(
            fmt::format("{}: {} takes whole numbers alone, and an orbit is followed over a key that varies "
                        "continuously; give sweep --over {} a list of them",
                        option, path, path));
    const std::string from = over.substr(equals + 1, colon - equals - 1);
    const std::string to = over.substr(colon + 1);
    require_units(option, {from, to});
    adopt_unit(from, key->dimension, units);
    KeyRange range{*key, signed_argument(option, from, key->dimension), signed_argument(option, to, key->dimension)};
    if (!(range.from < range.to)) throw UsageError(fmt::format("{}: the range must ascend", option));
    return range;
}

}  // namespace beamcam::scenes
