// Where a writer puts a file. A path alone is enough; Manifest::target adds what makes the file beamcam's own.
#pragma once

#include <concepts>
#include <filesystem>
#include <functional>
#include <utility>

namespace beamcam::output {

struct Target {
    template <typename Path>
    requires std::convertible_to<Path, std::filesystem::path> Target(Path&& file)
        : path(std::forward<Path>(file)) {}  // implicit: a path is a target

    std::filesystem::path path;
    std::filesystem::path within;  // the file must lie below this folder, symbolic links followed; empty: anywhere
    // Called with the temporary file's path, before it is created and before it, complete, replaces `path`. What they
    // throw leaves `path` as it was.
    std::function<void(const std::filesystem::path&temporary)> before_creation, before_rename;
};

}  // namespace beamcam::output
