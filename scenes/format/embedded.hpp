// Texts inside the program, so that it works without installed files.
#pragma once

#include <span>
#include <string_view>

namespace beamcam::scenes {

struct EmbeddedText {
    std::string_view name;  // "default", "paper/free-fall"
    std::string_view text;
    std::string_view summary() const;  // its first comment
};
// The scenes in the program, by name: those of the folder scenes, then those of the paper's figures.
std::span<const EmbeddedText> embedded_scenes();
// The presets of figures: "presets/energy".
std::span<const EmbeddedText> embedded_preset_texts();

}  // namespace beamcam::scenes
