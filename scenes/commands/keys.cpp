// `beamcam keys`: the reference of scene keys.
#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <cmath>

#include "scenes/commands/commands.hpp"
#include "scenes/format/absent.hpp"
#include "scenes/format/description.hpp"
#include "scenes/format/suggest.hpp"

namespace beamcam::scenes {
namespace {

struct KeysArguments {
    std::string pattern;
    bool json = false, markdown = false;
};

// Whether a part of the text matches the pattern, in which blanks and '*' stand for any text.
bool matches(const std::string& text, std::string pattern) {
    replace_all(pattern, " ", "*");
    replace_all(pattern, "[", "\\[");
    return fnmatch(("*" + pattern + "*").c_str(), text.c_str(), 0) == 0;
}

std::vector<KeyRow> chosen(const std::string& pattern) {
    std::vector<KeyRow> rows = key_rows();
    std::erase_if(rows, [&](const KeyRow& row) {
        return !matches(lowered(row.path), lowered(pattern)) && !matches(lowered(row.key->meaning), lowered(pattern)) &&
               (pattern.empty() || !is_of_type(row, pattern));
    });
    return rows;
}

Node json_of(const KeyRow& row) {
    const DescribedKey& key = *row.key;
    const auto bound = [](double value) { return std::isfinite(value) ? Node(value) : Node{}; };
    Node out = object_node({{"key", row.path}});
    if (!row.when.empty()) add(out, "when", row.when);
    add(out, "type", key.type);
    if (!key.words.empty()) add(out, "words", key.words);
    add(out, "unit", key.unit.empty() ? Node{} : Node(key.unit));
    add(out, "default", key.required() ? Node() : key.value);
    add(out, "min", bound(key.range.min));
    add(out, "max", bound(key.range.max));
    add(out, "required", key.required());
    add(out, "meaning", key.meaning);
    return out;
}

std::string text_of(const std::vector<KeyRow>& rows) {
    std::string text;
    for (const KeyRow& row : rows) {
        const DescribedKey& key = *row.key;
        std::string facts = key.words.empty() ? key.type : fmt::format("{}", fmt::join(key.words, " | "));
        if (!key.unit.empty()) facts += fmt::format(" [{}]", key.unit);
        if (const std::string range = range_text(key); !range.empty()) facts += ", " + range;
        if (key.required()) facts += ", required";
        if (const std::string value = default_text(key); !value.empty()) facts += ", default " + value;
        text += fmt::format("{}{}\n    {}\n    {}\n", row.path, row.when.empty() ? "" : fmt::format("  ({})", row.when),
                            facts, key.meaning);
    }
    return text;
}

void act(const KeysArguments& args) {
    if (args.markdown) return print_data(reference_text());
    const std::vector<KeyRow> rows = chosen(args.pattern);
    if (rows.empty()) {
        std::string remedy = absent_key(args.pattern);
        std::vector<std::string> names;
        for (const KeyRow& row : key_rows()) {
            names.push_back(row.path);
            names.push_back(row.path.substr(row.path.rfind('.') + 1));  // npos + 1 is 0
        }
        if (remedy.empty()) remedy = suggestion(args.pattern, names);
        throw UsageError(fmt::format("no key matches {}{}", args.pattern, remedy));
    }
    print_data(args.json ? to_text(array_node(rows, json_of)) : text_of(rows));
}

}  // namespace

void add_keys(Program& program) {
    const auto [app, args] = add_command<KeysArguments>(
        program, "keys", "Explain the keys of scenes: type, unit, range, default, meaning", act);
    add_examples(app, {"keys damping", "keys 'contact*'"});
    app.add_option(
        "PATTERN", args.pattern,
        "Only keys with this text in their path or meaning, or of this type of output; * stands for any text");
    app.add_flag("--json", args.json, "Print JSON");
    app.add_flag("--markdown", args.markdown, "Print all keys as Markdown (scenes/FORMAT.md)");
}

}  // namespace beamcam::scenes
