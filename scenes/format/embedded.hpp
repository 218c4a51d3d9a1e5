// Texts inside the program, so that it works without installed files.
#pragma once

#include <span>
#include <string_view>

namespace beamcam::scenes {

// The scenes in the program, by name: those of this folder, then those of the paper's figures.
struct EmbeddedScene {
    std::string_view name;  // "default", "paper/free-fall"
    std::string_view text;
    bool is_of_paper() const { return name.starts_with("paper/"); }
    std::string_view summary() const;  // its first comment
};
std::span<const EmbeddedScene> embedded_scenes();

}  // namespace beamcam::scenes
