#include "scenes/commands/grammar.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "scenes/format/description.hpp"

namespace beamcam::scenes {
namespace {

Parameter& add(std::deque<Parameter>& parameters, std::string names, ValueStorage storage, std::string value,
               std::string meaning) {
    Parameter& parameter = parameters.emplace_back();
    parameter.names = std::move(names);
    parameter.storage = storage;
    parameter.value = std::move(value);
    parameter.meaning = std::move(meaning);
    return parameter;
}

// Only help, completion and manual need the descriptions of keys; making them takes as long as the program's start.
const DescribedKey& described_key(const Parameter& parameter) {
    static const std::vector<KeyRow> rows = key_rows();
    const std::string path = "outputs[]." + parameter.key, type = "type=" + parameter.output_type;
    const auto row = std::ranges::find_if(rows, [&](const KeyRow& each) {
        const std::size_t at = each.when.find(type);
        return each.path == path && at != std::string::npos &&
               (at + type.size() == each.when.size() || each.when[at + type.size()] == ' ');
    });
    if (row == rows.end())
        throw std::logic_error(fmt::format("{}: there is no key {} of {}", parameter.names, path, type));
    return *row->key;
}

}  // namespace

void Command::flag(std::string names, bool& storage, std::string meaning) {
    add(parameters, std::move(names), &storage, "", std::move(meaning));
}
Parameter& Command::option(std::string names, ValueStorage storage, std::string value, std::string meaning) {
    return add(parameters, std::move(names), storage, std::move(value), std::move(meaning));
}
Parameter& Command::positional(std::string positional_name, ValueStorage storage, std::string meaning) {
    return add(parameters, std::move(positional_name), storage, "", std::move(meaning));
}
Command& add_command(std::deque<Command>& commands, std::string name, std::string summary) {
    Command& command = commands.emplace_back();
    command.name = std::move(name);
    command.summary = std::move(summary);
    return command;
}

std::string help_of(const Parameter& parameter) {
    std::string text = parameter.meaning;
    if (!parameter.key.empty()) {
        const DescribedKey& key = described_key(parameter);
        text = text.empty() ? key.meaning : fmt::format("{} {}", text, key.meaning);
        if (!key.unit.empty()) text += fmt::format(" [{}]", key.unit);
        if (key.words.empty() && key.type.find('"') != std::string::npos) text += fmt::format(" ({})", key.type);
    }
    const std::vector<std::string> words = words_of(parameter);
    return words.empty() ? text : fmt::format("{} ({})", text, fmt::join(words, ", "));
}

std::vector<std::string> words_of(const Parameter& parameter) {
    return parameter.key.empty() ? parameter.choices : described_key(parameter).words;
}

}  // namespace beamcam::scenes
