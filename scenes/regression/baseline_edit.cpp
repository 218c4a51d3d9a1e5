#include "scenes/regression/baseline_edit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "output/files/numbers.hpp"
#include "output/files/standard_output.hpp"
#include "output/json/tree.hpp"
#include "scenes/regression/references.hpp"

namespace beamcam::scenes {
namespace {

struct Edit {
    std::size_t begin = 0, end = 0;
    std::string text;
};

// Replaces the value of a key, or adds the key after the last one.
void set_member(const Node& object, const std::string& key, const std::string& value, const std::string& indent,
                std::vector<Edit>& edits) {
    if (const Member* member = object.find(key)) {
        edits.push_back({member->value.place.offset, member->value.end, value});
    } else {
        const bool first = object.members.empty();
        const std::size_t at = first ? object.place.offset + 1 : object.members.back().value.end;
        edits.push_back({at, at, fmt::format("{}{}{}: {}", first ? "" : ",", indent, one_line(key), value)});
    }
}

std::string accepted_text(const std::vector<Accepted>& accepted) {
    std::string text = "[";
    for (const Accepted& one : accepted) {
        text += text.size() > 1 ? "," : "";
        text += fmt::format("\n        {{\"renderer\": {}, \"sha256\": [", one_line(one.renderer));
        if (one.sha256.size() == 1) {
            text += one_line(one.sha256.front()) + "]}";
            continue;
        }
        for (std::size_t i = 0; i < one.sha256.size(); ++i)
            text += fmt::format("{}\n          {}", i > 0 ? "," : "", one_line(one.sha256[i]));
        text += "\n        ]}";
    }
    return text + (accepted.empty() ? "]" : "\n      ]");
}

std::string renderers_text(const std::map<std::string, RendererParts>& renderers) {
    std::string text = "{";
    for (const auto& [id, parts] : renderers) {
        text += fmt::format("{}\n    {}: {{", text.size() > 1 ? "," : "", one_line(id));
        bool first = true;
        for (const auto& [part, version] : parts) {
            text += fmt::format("{}\n      {}: {}", first ? "" : ",", one_line(part), one_line(version));
            first = false;
        }
        text += "\n    }";
    }
    return text + (renderers.empty() ? "}" : "\n  }");
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

bool has_new_motion_only(const Baseline& entry, const EntryResult& found) {
    return found.picture == Verdict::identical && found.motion && !found.frames.empty() && !entry.accepted.empty() &&
           entry.expected.empty();
}

BaselineEdit acceptance_of(const Baseline& entry, const EntryResult& found, bool replaces) {
    BaselineEdit edit{entry.name, entry.accepted, entry.reproducible_until};
    if (!found.frames.empty() && entry.expected.empty() && !has_new_motion_only(entry, found)) {
        if (replaces) edit.accepted.clear();
        edit.accepted.push_back({found.renderer, found.digests()});
    }
    if (found.reproducible_until) edit.reproducible_until = found.reproducible_until;
    return edit;
}

std::string edited(const Baselines& baselines, const std::vector<BaselineEdit>& changes,
                   const std::map<std::string, RendererParts>& renderers) {
    const std::string& text = baselines.source.text;
    const Parsed parsed = parse(text);
    const Node& entries = parsed.root.find("entries")->value;
    std::vector<Edit> edits;
    std::set<std::string> used;
    for (const Baseline& entry : baselines.entries) {
        const auto change = std::ranges::find(changes, entry.name, &BaselineEdit::name);
        for (const Accepted& one : change == changes.end() ? entry.accepted : change->accepted)
            used.insert(one.renderer);
        if (change == changes.end()) continue;
        const Node& object = entries.find(entry.name)->value;
        if (entry.has_pictures() && entry.expected.empty())
            set_member(object, "accepted", accepted_text(change->accepted), "\n      ", edits);
        if (change->reproducible_until) {
            std::string number;
            output::append_number(number, *change->reproducible_until);
            set_member(object, "reproducible_until", number, "\n      ", edits);
        }
    }
    std::map<std::string, RendererParts> listed;
    for (const std::string& id : used)
        if (const auto found = renderers.find(id); found != renderers.end())
            listed[id] = found->second;
        else if (const auto known = baselines.renderers.find(id); known != baselines.renderers.end())
            listed[id] = known->second;
    if (!listed.empty() || !baselines.renderers.empty())
        set_member(parsed.root, "renderers", renderers_text(listed), "\n  ", edits);

    std::ranges::stable_sort(edits, std::greater(), &Edit::begin);
    std::string result = text;
    for (const Edit& edit : edits) result.replace(edit.begin, edit.end - edit.begin, edit.text);
    return result;
}

}  // namespace beamcam::scenes
