#include "scenes/format/presets.hpp"

#include <algorithm>

#include "scenes/figures/figure_types.hpp"
#include "scenes/format/embedded.hpp"
#include "scenes/format/overrides.hpp"

namespace beamcam::scenes {
namespace {

std::string word_of(const Node& object, std::string_view key) {
    const Node* value = child(object, key);
    return value && value->kind == Node::Kind::string ? value->text : "";
}

}  // namespace

std::string Preset::figure() const {
    const std::string given = word_of(keys, "figure");
    return given.empty() ? "series" : given;
}
std::string Preset::title() const { return word_of(keys, "title"); }

const std::vector<Preset>& embedded_presets() {
    static const std::vector<Preset> kPresets = [] {
        std::vector<Preset> all;
        for (const EmbeddedText& preset : embedded_preset_texts())
            all.push_back({std::string(preset.name.substr(preset.name.rfind('/') + 1)), node_of(preset.text)});
        return all;
    }();
    return kPresets;
}

const Preset* embedded_preset(std::string_view name) {
    const auto it = std::ranges::find(embedded_presets(), name, &Preset::name);
    return it == embedded_presets().end() ? nullptr : &*it;
}

std::vector<std::string> names_of_figures_and_presets() {
    std::vector<std::string> names = figure_names();
    for (const Preset& preset : embedded_presets()) names.push_back(preset.name);
    return names;
}

void add_preset(Node& output, const Preset& preset) {
    if (Node* figure = child(output, "figure")) figure->text = preset.figure();
    Node keys = preset.keys;
    move_to(keys, output.place);
    for (Member& member : keys.members)
        if (!output.find(member.key)) output.members.add(std::move(member));
    if (!output.find("file")) output.members.add({"file", output.place, preset.name + ".pdf"});
}

void resolve_preset(Node& output) {
    const std::string type = word_of(output, "type");
    if (output.kind != Node::Kind::object || (!type.empty() && type != "figure")) return;
    if (const Preset* preset = embedded_preset(word_of(output, "figure"))) add_preset(output, *preset);
}

}  // namespace beamcam::scenes
