// The reference of all keys: FORMAT.md and `beamcam keys`.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "scenes/format/absent.hpp"
#include "scenes/format/description.hpp"
#include "scenes/scene/pictures.hpp"
#include "sim/observe/channels.hpp"

namespace beamcam::scenes {
namespace {

// How a shape differs from the others: by its tags, and by its required keys if several shapes have these tags.
std::string when(const DescribedObject& shape, const std::vector<DescribedObject>& all) {
    std::vector<std::string> parts;
    for (const auto& [tag, word] : shape.tags) parts.push_back(fmt::format("{}={}", tag, word));
    const auto alike =
        std::ranges::count_if(all, [&](const DescribedObject& other) { return other.tags == shape.tags; });
    for (const DescribedKey& key : shape.keys)
        if (alike > 1 && key.required()) parts.push_back(key.name);
    return fmt::format("{}", fmt::join(parts, " "));
}

// The tags that come before this one in a shape: a law is that of a prescribed drive.
std::string before(const std::string& tag, const std::vector<DescribedObject>& shapes) {
    for (const DescribedObject& shape : shapes) {
        std::string text;
        for (const auto& [name, word] : shape.tags) {
            if (name == tag) return text;
            text += fmt::format("{}{}={}", text.empty() ? "" : " ", name, word);
        }
    }
    return {};
}

std::string joined(const std::string& outside, const std::string& inside) {
    return outside + (outside.empty() || inside.empty() ? "" : ", ") + inside;
}

void add_rows(const DescribedObject& shape, const std::string& path, const std::string& needed,
              std::vector<KeyRow>& rows) {
    for (const DescribedKey& key : shape.keys) {
        const std::string own = path.empty() ? key.name : path + "." + key.name;
        rows.push_back({own, needed, &key});
        for (const DescribedKey& tag : key.tags)
            rows.push_back(
                {own + (key.list ? "[]." : ".") + tag.name, joined(needed, before(tag.name, key.shapes)), &tag});
        for (const DescribedObject& inside : key.shapes) {
            const std::string more = when(inside, key.shapes);
            add_rows(inside, own + (key.list ? "[]" : ""), joined(needed, more), rows);
        }
    }
}

}  // namespace

std::vector<KeyRow> key_rows() {
    std::vector<KeyRow> all, merged;
    add_rows(scene_format(), "", "", all);
    for (KeyRow& row : all) {  // one row for a key that several shapes share
        const auto alike = std::ranges::find_if(merged, [&](const KeyRow& other) {
            return other.path == row.path && other.key->meaning == row.key->meaning && other.key->type == row.key->type;
        });
        if (alike == merged.end())
            merged.push_back(std::move(row));
        else
            alike->when += " | " + row.when;
    }
    return merged;
}

bool is_of_type(const KeyRow& row, const std::string& type) {
    const std::string tag = "type=" + type;
    const std::size_t at = row.when.find(tag);
    return at != std::string::npos && (row.when + " ").find_first_of(" ,", at) == at + tag.size();
}

std::string place_of_key(const std::string& path, const std::string& type, bool inside) {
    constexpr std::size_t kMostPlaces = 3;
    const std::string key = path.substr(path.rfind('.') + 1);  // npos + 1 is 0
    std::string object;                                        // "outputs[]."
    for (const std::string& part : split(path.substr(0, path.size() - key.size()), '.'))
        if (!part.empty()) object += part.find_first_not_of("0123456789") == std::string::npos ? "[]." : part + ".";
    replace_all(object, ".[]", "[]");
    std::vector<std::string> places;
    for (const KeyRow& row : key_rows()) {
        const bool within = row.path.starts_with(object) && row.path.size() > object.size() + key.size();
        const bool other_type = !type.empty() && !is_of_type(row, type);
        if (row.path == object + key) return "; it goes with " + row.when;
        if (!("." + row.path).ends_with("." + key)) continue;
        if (inside && (!within || other_type)) continue;
        if (std::ranges::find(places, row.path) == places.end()) places.push_back(row.path);
    }
    if (places.empty()) return {};
    std::ranges::stable_sort(places, {}, [](const std::string& place) { return std::ranges::count(place, '.'); });
    places.resize(std::min(places.size(), kMostPlaces));
    return fmt::format("; its place is \"{}\"", fmt::join(places, "\" or \""));
}

std::string range_text(const DescribedKey& key) {
    const sim::Range& r = key.range;
    const bool below = std::isfinite(r.min), above = std::isfinite(r.max);
    if (below && above && !r.exclusive_min && !r.exclusive_max) return fmt::format("{:g} … {:g}", r.min, r.max);
    std::string text;
    if (below) text = fmt::format("{} {:g}", r.exclusive_min ? ">" : "≥", r.min);
    if (above) text += fmt::format("{}{} {:g}", below ? ", " : "", r.exclusive_max ? "<" : "≤", r.max);
    return text;
}

std::string default_text(const DescribedKey& key) {
    return key.value.is_null() || key.required() ? "" : one_line(key.value);
}

// ---- FORMAT.md ---------------------------------------------------------------------------------

namespace {

std::string escaped_for_table(std::string text) {
    replace_all(text, "|", "\\|");
    return text;
}

std::string type_of(const DescribedKey& key) {
    std::string type = key.words.empty() ? key.type : fmt::format("`{}`", fmt::join(key.words, "` `"));
    if (const std::string range = range_text(key); !range.empty()) type += ", " + range;
    return type;
}

// A valid value of the key, for the example.
std::optional<std::string> example_of(const DescribedKey& key) {
    if (key.required()) return key.example;
    if (!key.shapes.empty()) return std::nullopt;
    const std::string value = default_text(key);
    return value.empty() || value == "\"\"" ? std::nullopt : std::optional(value);
}

std::string example_of(const DescribedObject& shape) {
    std::vector<std::string> members;
    for (const auto& [tag, word] : shape.tags) members.push_back(fmt::format("\"{}\": \"{}\"", tag, word));
    for (const DescribedKey& key : shape.keys)
        if (const auto value = example_of(key); value && (key.required() || members.size() < 6))
            members.push_back(fmt::format("\"{}\": {}", key.name, *value));
    return fmt::format("{{{}}}", fmt::join(members, ", "));
}

class Reference {
  public:
    std::string write() {
        out_ =
            "# The scene format\n\n"
            "Written by `beamcam keys --markdown`; `beamcam keys PATTERN` prints a part. " +
            scene_format().meaning +
            "\n\nA quantity may be a text with a unit: `\"12 mm\"`, `\"300 rpm\"`, `\"5 %\"`.\n";
        shape(scene_format(), "", "The scene");
        events();
        channels();
        absent();
        return std::move(out_);
    }

  private:
    void events() {
        out_ +=
            "\n## Events\n\nAn instant is a time, an event with its number from 1, `\"impact:3\"`, or `\"last\"`, the "
            "end.\n\n| event | meaning |\n|---|---|\n";
        for (const EventWord& event : kEventWords) out_ += fmt::format("| `{}:N` | {} |\n", event.word, event.meaning);
    }
    void channels() {
        out_ +=
            "\n## Channels\n\nFunctions of time, for tables, films and figures; [sim/MODEL.md](../sim/MODEL.md) "
            "defines "
            "them.\n\n| channel | unit | meaning |\n|---|---|---|\n";
        for (const sim::ChannelRow& row : sim::kChannels) {
            const bool of_mode = row.traits.of_mode;
            std::string name = row.name;
            if (of_mode)
                name = fmt::format("{}`, `{}", std::string(name).insert(1, "1"), std::string(name).insert(1, "2"));
            out_ += fmt::format("| `{}`{} | {} | {} |\n", name, of_mode ? " …" : "", row.unit,
                                escaped_for_table(row.meaning));
        }
    }
    void absent() {
        out_ +=
            "\n## Not modelled\n\nA key with one of these words is an error that says the same.\n\n"
            "| words |  |\n|---|---|\n";
        for (const NotModelled& each : not_modelled())
            out_ += fmt::format("| {} | {} |\n", fmt::join(each.words, ", "), each.sentence);
    }

    void shape(const DescribedObject& shape, const std::string& path, const std::string& title) {
        if (shape.keys.empty() && shape.tags.empty()) return;
        const bool top = path.empty();
        out_ += fmt::format("\n{} {}\n", top ? "##" : "###", title);
        if (!top) out_ += fmt::format("\n{}\n\n    {}\n", shape.meaning, example_of(shape));
        if (!shape.keys.empty()) {
            out_ += "\n| key | value | unit | default | meaning |\n|---|---|---|---|---|\n";
            for (const DescribedKey& key : shape.keys) row(key);
        }
        for (const DescribedKey& key : shape.keys)
            for (const DescribedObject& inside : key.shapes)
                nested(key, inside, top ? key.name : path + "." + key.name);
    }

    void row(const DescribedKey& key) {
        const std::string value = key.type == "text" ? "" : default_text(key);
        out_ += fmt::format("| `{}` | {} | {} | {} | {} |\n", key.name, escaped_for_table(type_of(key)), key.unit,
                            key.required()   ? "**required**"
                            : !value.empty() ? fmt::format("`{}`", escaped_for_table(value))
                                             : "",
                            escaped_for_table(key.meaning));
    }

    // An object that several outputs share is explained once.
    void nested(const DescribedKey& key, const DescribedObject& inside, const std::string& path) {
        const std::string tags = when(inside, key.shapes), place = path + (key.list ? "[]" : "");
        const std::string title = fmt::format("`{}`{}", place, tags.empty() ? "" : fmt::format(" with {}", tags));
        if (std::ranges::find(done_, title) != done_.end()) return;
        done_.push_back(title);
        shape(inside, place, title);
    }

    std::string out_;
    std::vector<std::string> done_;
};

}  // namespace

std::string reference_text() { return Reference().write(); }

}  // namespace beamcam::scenes
