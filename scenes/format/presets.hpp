// Presets of figures: JSON objects with the keys of a figure output, by the names of their files. Those of
// scenes/presets are embedded in the program.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "output/json/tree.hpp"

namespace beamcam::scenes {

struct Preset {
    std::string name;  // "energy"
    Node keys;

    std::string figure() const;  // the type of figure
    std::string title() const;
};

const std::vector<Preset>& embedded_presets();  // by name
const Preset* embedded_preset(std::string_view name);  // nullptr: none
std::vector<std::string> names_of_figures_and_presets();

// Adds the keys of a preset to an output that does not have them, and the name of its file.
void add_preset(Node& output, const Preset& preset);
// Replaces the name of an embedded preset in "figure" by its keys, in an output of type "figure".
void resolve_preset(Node& output);

}  // namespace beamcam::scenes
