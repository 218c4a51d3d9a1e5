#include "scenes/format/capabilities.hpp"

#include <fmt/format.h>

namespace beamcam::scenes {
namespace {

struct Missing {
    std::string_view where, what;
    std::string_view instead;
};

constexpr Missing kMissing[] = {
    {"outputs.type", "apng", "write a \"video\" whose \"file\" ends in .apng"},
    {"outputs.type", "gif", "write a \"video\" whose \"file\" ends in .gif"},
};

}  // namespace

std::optional<std::string> not_available(std::string_view where, std::string_view what) {
    for (const Missing& missing : kMissing)
        if (missing.where == where && missing.what == what)
            return fmt::format("{} is not available in this version; {}", what, missing.instead);
    return std::nullopt;
}

}  // namespace beamcam::scenes
