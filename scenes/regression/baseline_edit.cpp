#include "scenes/regression/baseline_edit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "output/files/numbers.hpp"
#include "output/files/standard_output.hpp"
#include "scenes/format/tree.hpp"
#include "scenes/regression/references.hpp"

namespace beamcam::scenes {
namespace {

// The position after the value that begins at `begin`. `plain` has no comments.
std::size_t end_of_value(std::string_view plain, std::size_t begin) {
    int depth = 0;
    bool in_string = false;
    for (std::size_t i = begin; i < plain.size(); ++i) {
        const char c = plain[i];
        if (in_string) {
            if (c == '\\')
                ++i;
            else if (c == '"') {
                in_string = false;
                if (depth == 0) return i + 1;
            }
            continue;
        }
        if (c == '"') {
            in_string = true;
        } else if (c == '{' || c == '[') {
            ++depth;
        } else if (c == '}' || c == ']') {
            if (depth == 0) return i;  // the end of the object or array around a scalar
            if (--depth == 0) return i + 1;
        } else if (depth == 0 && (c == ',' || c == ' ' || c == '\n' || c == '\t' || c == '\r')) {
            return i;
        }
    }
    return plain.size();
}

struct Edit {
    std::size_t begin = 0, end = 0;
    std::string text;
};

std::string json_text(std::string_view text) {
    std::string out;
    out.push_back('"');
    for (const char c : text) {
        if (c == '"' || c == '\\')
            out.append(1, '\\').append(1, c);
        else if (static_cast<unsigned char>(c) < 0x20)
            out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
        else
            out.push_back(c);
    }
    out.push_back('"');
    return out;
}

// Replaces the value of a key, or adds the key after the last one.
void set_member(std::string_view plain, const Node& object, const std::string& key, const std::string& value,
                const std::string& indent, std::vector<Edit>& edits) {
    if (const Member* member = object.find(key)) {
        const std::size_t begin = member->value.place.offset;
        edits.push_back({begin, end_of_value(plain, begin), value});
    } else if (object.members.empty()) {
        edits.push_back(
            {object.place.offset + 1, object.place.offset + 1, fmt::format("{}{}: {}", indent, json_text(key), value)});
    } else {
        const std::size_t at = end_of_value(plain, object.members.back().value.place.offset);
        edits.push_back({at, at, fmt::format(",{}{}: {}", indent, json_text(key), value)});
    }
}

std::string accepted_text(const std::vector<Accepted>& accepted) {
    std::string text = "[";
    for (const Accepted& one : accepted) {
        text += text.size() > 1 ? "," : "";
        text += fmt::format("\n        {{\"renderer\": {}, \"sha256\": [", json_text(one.renderer));
        if (one.sha256.size() == 1) {
            text += json_text(one.sha256.front()) + "]}";
            continue;
        }
        for (std::size_t i = 0; i < one.sha256.size(); ++i)
            text += fmt::format("{}\n          {}", i > 0 ? "," : "", json_text(one.sha256[i]));
        text += "\n        ]}";
    }
    return text + (accepted.empty() ? "]" : "\n      ]");
}

std::string renderers_text(const std::map<std::string, RendererParts>& renderers) {
    std::string text = "{";
    for (const auto& [id, parts] : renderers) {
        text += fmt::format("{}\n    {}: {{", text.size() > 1 ? "," : "", json_text(id));
        bool first = true;
        for (const auto& [part, version] : parts) {
            text += fmt::format("{}\n      {}: {}", first ? "" : ",", json_text(part), json_text(version));
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

std::string edited(const Baselines& baselines, const std::vector<BaselineEdit>& changes,
                   const std::map<std::string, RendererParts>& renderers) {
    const std::string& text = baselines.source.text;
    const std::string plain = blank_comments(text);  // the same offsets
    const Parsed parsed = parse(text);
    const Node& entries = parsed.root.find("entries")->value;
    std::vector<Edit> edits;
    std::set<std::string> used;
    for (const Baseline& entry : baselines.entries) {
        const auto change =
            std::find_if(changes.begin(), changes.end(), [&](const BaselineEdit& c) { return c.name == entry.name; });
        for (const Accepted& one : change == changes.end() ? entry.accepted : change->accepted)
            used.insert(one.renderer);
        if (change == changes.end()) continue;
        const Node& object = entries.find(entry.name)->value;
        if (entry.has_pictures() && entry.expected.empty())
            set_member(plain, object, "accepted", accepted_text(change->accepted), "\n      ", edits);
        if (change->reproducible_until) {
            std::string number;
            output::append_number(number, *change->reproducible_until);
            set_member(plain, object, "reproducible_until", number, "\n      ", edits);
        }
    }
    std::map<std::string, RendererParts> listed;
    for (const std::string& id : used)
        if (const auto found = renderers.find(id); found != renderers.end())
            listed[id] = found->second;
        else if (const auto known = baselines.renderers.find(id); known != baselines.renderers.end())
            listed[id] = known->second;
    if (!listed.empty() || !baselines.renderers.empty())
        set_member(plain, parsed.root, "renderers", renderers_text(listed), "\n  ", edits);

    std::stable_sort(edits.begin(), edits.end(), [](const Edit& a, const Edit& b) { return a.begin > b.begin; });
    std::string result = text;
    for (const Edit& edit : edits) result.replace(edit.begin, edit.end - edit.begin, edit.text);
    return result;
}

}  // namespace beamcam::scenes
