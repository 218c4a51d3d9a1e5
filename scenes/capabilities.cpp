#include "scenes/capabilities.hpp"

#include <fmt/format.h>

namespace beamcam::scenes {
namespace {

struct Planned {
    std::string_view where, what;
    std::string_view instead;
};

constexpr Planned kPlanned[] = {
    {"outputs.type", "apng", "write a \"video\" whose \"file\" ends in .apng"},
    {"outputs.type", "gif", "write a \"video\" whose \"file\" ends in .gif"},
    {"command", "sweep", "run beamcam once for each value with --set"},
};

}  // namespace

std::optional<std::string> not_available(std::string_view where, std::string_view what) {
    for (const Planned& planned : kPlanned)
        if (planned.where == where && planned.what == what)
            return fmt::format("{} is not available in this version; {}", what, planned.instead);
    return std::nullopt;
}

std::vector<std::string> planned_commands() {
    std::vector<std::string> commands;
    for (const Planned& planned : kPlanned)
        if (planned.where == "command") commands.emplace_back(planned.what);
    return commands;
}

}  // namespace beamcam::scenes
