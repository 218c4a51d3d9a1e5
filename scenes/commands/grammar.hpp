// The grammar of the command line as data: each command lists its options once. The parser (cli.cpp, the only file that
// includes CLI11), the completion and the manual page are made from these lists.
#pragma once

#include <algorithm>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "sim/base/named.hpp"

namespace beamcam::scenes {

// The storage of a value that the parser has read. A vector collects repeated values; a bool becomes true; a function
// stores a word.
using ValueStorage =
    std::variant<bool*, int*, double*, std::optional<double>*, std::string*, std::optional<std::string>*,
                 std::vector<std::string>*, std::function<void(const std::string&)>>;

// A flag, an option or a positional argument of a command.
struct Parameter {
    std::string names;  // "-o,--output"; a positional argument: "SCENE"
    ValueStorage storage;
    std::string value;                 // placeholder of an option's value in the help: "FILE"
    std::string meaning;               // help text; of an option that sets a key of an output, empty: see help_of
    std::string output_type, key;      // the option sets this key of outputs of this type: "video", "view.style"
    std::vector<std::string> choices;  // the allowed values; empty: any
    std::optional<std::pair<double, double>> limits;
    std::string (*problem)(const std::string& value) = nullptr;  // of a value; empty: it has none
    char separator = 0;                                          // between several values in one word
    bool is_required = false, takes_several = false;
    std::string value_if_alone;  // of an option that takes several words; empty: it needs one

    Parameter& required() { return is_required = true, *this; }
    // One occurrence of the option takes all words that follow it.
    Parameter& several() { return takes_several = true, *this; }
    Parameter& alone(std::string word) { return value_if_alone = std::move(word), *this; }
    Parameter& separated_by(char c) { return separator = c, *this; }
    Parameter& one_of(std::vector<std::string> values) { return choices = std::move(values), *this; }
    // The help text of an option that sets a key, in place of the key's meaning.
    Parameter& says(std::string text) { return key.clear(), meaning = std::move(text), *this; }
    Parameter& checked_by(std::string (*check)(const std::string& value)) { return problem = check, *this; }
    Parameter& range(double low, double high) { return limits.emplace(low, high), *this; }
    bool is_option() const { return names.starts_with('-'); }
};

struct Command;
Command& add_command(std::deque<Command>& commands, std::string name, std::string summary);

// A new command, and its arguments: where its options store their values, which live as long as the command.
template <class Arguments>
struct BoundCommand {
    Command& command;
    Arguments& arguments;
};

struct Command {
    std::string name, summary;
    std::vector<std::string> examples;  // arguments after "beamcam", one command line each
    std::string footer;                 // notes after the options
    std::deque<Parameter> parameters;
    std::function<int()> action;  // returns the exit code

    // The storage must outlive the parsing.
    void flag(std::string names, bool& storage, std::string meaning);
    Parameter& option(std::string names, ValueStorage storage, std::string value, std::string meaning);
    Parameter& positional(std::string name, ValueStorage storage, std::string meaning);
    // An option whose words are the names of an enumeration.
    template <class Enum, std::size_t n>
    Parameter& choice(const std::string& names, Enum& storage, const sim::Named<Enum> (&words)[n],
                      const std::string& value, const std::string& meaning) {
        std::vector<std::string> allowed;
        for (const sim::Named<Enum>& each : words) allowed.emplace_back(each.name);
        const auto store = [&storage, &words](const std::string& word) {
            storage = std::ranges::find(words, word, &sim::Named<Enum>::name)->value;
        };
        return option(names, store, value, meaning).one_of(std::move(allowed));
    }

    // `act` returns the exit code, or nothing: then the code is 0.
    template <class Arguments, class Code>
    BoundCommand<Arguments> bind(Code (*act)(const Arguments&)) {
        const auto arguments = std::make_shared<Arguments>();
        action = [arguments, act] {
            if constexpr (std::is_void_v<Code>)
                return act(*arguments), 0;
            else
                return act(*arguments);
        };
        return {*this, *arguments};
    }
};

struct Grammar {
    static constexpr const char* kSummary =
        "Simulates a flexible beam that strikes a turning cam and films it: JSON scenes in; films, stills, figures and "
        "data out.";

    std::deque<Command> commands;  // in the order of --help

    template <class Arguments, class Code>
    BoundCommand<Arguments> command(std::string name, std::string summary, Code (*act)(const Arguments&)) {
        return add_command(commands, std::move(name), std::move(summary)).bind(act);
    }
};

// The help text of a parameter: its own, or the meaning of the key that it sets, with the key's unit and words.
std::string help_of(const Parameter& parameter);
// The words that a parameter accepts; empty: other values, too.
std::vector<std::string> words_of(const Parameter& parameter);

}  // namespace beamcam::scenes
