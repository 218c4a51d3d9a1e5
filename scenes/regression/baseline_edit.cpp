#include "scenes/regression/baseline_edit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <map>
#include <vector>

#include "output/files/standard_output.hpp"
#include "output/json/tree.hpp"
#include "scenes/regression/references.hpp"

namespace beamcam::scenes {
namespace {

struct Edit {
    std::size_t begin = 0, end = 0;
    std::string text;
};

// Replaces the value of a key, or adds the key after the last one, on a line of its own.
void set_member(const Node& object, const std::string& key, const Node& node, std::size_t indent,
                std::vector<Edit>& edits) {
    constexpr std::size_t kWidth = 120;  // of lines
    const std::string value = folded_text(node, kWidth, indent);
    if (const Member* member = object.find(key)) {
        edits.push_back({member->value.place.offset, member->value.end, value});
    } else {
        const bool first = object.members.empty();
        const std::size_t at = first ? object.place.offset + 1 : object.members.back().value.end;
        edits.push_back({at, at, fmt::format("{}\n{:{}}{}: {}", first ? "" : ",", "", indent, one_line(key), value)});
    }
}

// Sets those of these keys that differ.
template <class Struct>
void set_changed(const Node& object, Struct before, Struct after, std::initializer_list<const char*> keys,
                 std::size_t indent, std::vector<Edit>& edits) {
    const auto tree = [](Struct& all) { return tree_of([&all](SceneVisitor& v) { visit(v, all); }); };
    const Node old = tree(before), now = tree(after);
    for (const char* key : keys) {
        const Member *was = old.find(key), *is = now.find(key);
        if (is && !(was && one_line(was->value) == one_line(is->value)))
            set_member(object, key, is->value, indent, edits);
    }
}

// Those that entries name.
std::map<std::string, RendererParts> used_renderers(const Baselines& baselines) {
    std::map<std::string, RendererParts> used;
    for (const Baseline& entry : baselines.entries)
        for (const Accepted& accepted : entry.accepted)
            if (const auto found = baselines.renderers.find(accepted.renderer); found != baselines.renderers.end())
                used.insert(*found);
    return used;
}

}  // namespace

Baselines read_recovered(const std::string& path) {
    Baselines baselines = read_baselines(path);
    if (path == "-") return baselines;
    const std::string message = ReferenceUpdate::recover(baselines.references);
    if (message.empty()) return baselines;
    output::print_message("{}: {}\n", path, message);
    return read_baselines(path);
}

std::string edited(const Baselines& before, Baselines after) {
    std::string text = before.source.text;
    const Parsed parsed = parse(text);
    const Node& entries = parsed.root.find("entries")->value;
    std::vector<Edit> edits;
    for (std::size_t i = 0; i < before.entries.size(); ++i)
        set_changed(entries.find(before.entries[i].name)->value, before.entries[i], after.entries[i],
                    {"accepted", "reproducible_until"}, 6, edits);
    after.renderers = used_renderers(after);
    set_changed(parsed.root, before, after, {"renderers"}, 2, edits);
    std::ranges::stable_sort(edits, std::greater(), &Edit::begin);
    for (const Edit& edit : edits) text.replace(edit.begin, edit.end - edit.begin, edit.text);
    return text;
}

}  // namespace beamcam::scenes
