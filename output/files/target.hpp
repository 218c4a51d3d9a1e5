// The destination of a file. A path converts to it; FileList::target adds the function that records the file as made by
// beamcam.
#pragma once

#include <concepts>
#include <filesystem>
#include <functional>
#include <utility>

namespace beamcam::output {

struct FileTarget {
    template <typename Path>
    // NOLINTNEXTLINE(bugprone-forwarding-reference-overload): a target is no path, so it never hides a copy.
    requires std::convertible_to<Path, std::filesystem::path> FileTarget(Path&& file)
        : path(std::forward<Path>(file)) {}  // implicit: a path is a target

    std::filesystem::path path;
    std::filesystem::path within;  // the file must lie below this folder, symbolic links followed; empty: anywhere
    // Called with the path of the temporary file before it, complete, replaces `path`. If it throws, `path` stays
    // unchanged.
    std::function<void(const std::filesystem::path& temporary)> before_rename;
};

}  // namespace beamcam::output
