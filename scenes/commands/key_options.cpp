#include "scenes/commands/key_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "output/files/standard_output.hpp"
#include "scenes/format/description.hpp"
#include "scenes/format/overrides.hpp"
#include "scenes/format/reader.hpp"

namespace beamcam::scenes {
namespace {

// A number, JSON, or else a word, as --set reads values. `source`: where messages say that the value comes from.
Node value_of(const std::string& text, std::size_t source, std::vector<Message>& messages) {
    if (Node node = value_node(text); node.kind == Node::Kind::number) return node;
    Node holder = object_node();
    apply_override(holder, "value=" + text, source, messages);
    const Member* value = holder.find("value");
    return value ? value->value : Node{};
}

const DescribedKey& described_key(const std::string& type, const std::string& key) {
    static const std::vector<KeyRow> rows = key_rows();
    const std::string path = "outputs[]." + key;
    const auto row =
        std::ranges::find_if(rows, [&](const KeyRow& each) { return each.path == path && is_of_type(each, type); });
    if (row == rows.end()) throw std::logic_error(fmt::format("there is no key {} of {}", path, type));
    return *row->key;
}

}  // namespace

CLI::Option* KeyOptions::explained(CLI::App& app, CLI::Option* option, const char* key, const char* note) const {
    const auto meaning = [type = type_, key, note] {
        const DescribedKey& described = described_key(type, key);
        std::string text = *note ? fmt::format("{} {}", note, described.meaning) : described.meaning;
        if (!described.unit.empty()) text += fmt::format(" [{}]", described.unit);
        if (!described.words.empty()) return fmt::format("{} ({})", text, fmt::join(described.words, ", "));
        return described.type.find('"') == std::string::npos ? text : fmt::format("{} ({})", text, described.type);
    };
    static_cast<HelpFormatter&>(*app.get_formatter()).explain(option, meaning);
    return option;
}

CLI::Option* KeyOptions::add(CLI::App& app, const char* name, const char* key, const char* placeholder,
                             const char* note) {
    std::optional<std::string>& value = options_.emplace_back(Option{name, key, {}, {}}).value;
    return explained(app, add_option(app, name, value, placeholder, ""), key, note);
}

CLI::Option* KeyOptions::add_list(CLI::App& app, const char* name, const char* key, const char* placeholder,
                                  const char* note) {
    std::vector<std::string>& values = options_.emplace_back(Option{name, key, {}, {}}).values;
    return explained(app, scenes::add_list(app, name, values, placeholder, ""), key, note);
}

void KeyOptions::add_flag(CLI::App& app, const char* name, const char* key, const char* value, const char* meaning) {
    Option& option = options_.emplace_back(Option{name, key, {}, {}});
    app.add_flag_callback(
        name, [&option, value] { option.value = value; }, meaning);
}

const std::string* KeyOptions::value(std::string_view name) const {
    const auto option = std::ranges::find(options_, name, &Option::name);
    return option != options_.end() && option->value ? &*option->value : nullptr;
}

const std::vector<std::string>& KeyOptions::values(std::string_view name) const {
    return std::ranges::find(options_, name, &Option::name)->values;
}

std::vector<std::pair<std::string, std::string>> KeyOptions::given() const {
    std::vector<std::pair<std::string, std::string>> out;
    for (const Option& option : options_)
        if (option.given()) out.emplace_back(option.name, option.key.substr(0, option.key.find('.')));
    return out;
}

Output read_output(Node output, std::initializer_list<const KeyOptions*> options, Scene scene,
                   const std::string& scene_file, const Common& common) {
    std::vector<Message> messages;
    std::vector<const KeyOptions::Option*> given;  // each is a source of messages, after the scene
    for (const KeyOptions* group : options)
        for (const KeyOptions::Option& option : group->options_) {
            if (!option.given()) continue;
            given.push_back(&option);
            const auto read = [&](const std::string& text) { return value_of(text, given.size(), messages); };
            Node value = option.value ? read(*option.value) : array_node(option.values, read);
            move_to(value, {given.size(), 0});
            set_value(output, option.key, std::move(value), messages);
        }
    std::vector<Message> of_reader;
    read_only_output(output, scene_file, "", scene, of_reader);
    messages.insert(messages.end(), of_reader.begin(), of_reader.end());
    for (const Message& message : messages) {
        const KeyOptions::Option* option = message.place.source == 0 ? nullptr : given[message.place.source - 1];
        constexpr std::string_view kWhole = "the output: ";  // the option or the scene's name replaces it
        std::string text = message.text.substr(message.text.starts_with(kWhole) ? kWhole.size() : 0);
        if (option && text.starts_with(option->key)) {  // "--low = "abc" …" in place of "panels.0.low = "abc" …"
            std::size_t path = option->key.size();
            if (!option->values.empty() && text[path] == '.') path = text.find(' ', path);  // of one in a list
            text.replace(0, path, option->name);
        } else if (option)
            text = fmt::format("{}: {}", option->name, text);
        if (message.fatal) throw UsageError(text);
        inform(common, fmt::format("{}: warning: {}", scene_file, text));
    }
    return std::move(scene.outputs.front());
}

}  // namespace beamcam::scenes
