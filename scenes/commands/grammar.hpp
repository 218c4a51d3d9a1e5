// The grammar of the command line as data: every command lists its options here once. The parser reads the lists
// (cli.cpp, the only file that sees CLI11).
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace beamcam::scenes {

// Where a value goes. A vector collects repeated values; a bool becomes true.
using Target = std::variant<bool*, int*, double*, std::optional<double>*, std::string*, std::optional<std::string>*,
                            std::vector<std::string>*>;

// A flag, an option or a positional argument of a command.
struct Parameter {
    std::string names;  // "-o,--output"; a positional argument: "SCENE"
    Target target;
    std::string value;  // placeholder of an option's value in the help: "FILE"
    std::string meaning;
    std::vector<std::string> choices;  // the allowed values; none: any
    std::optional<std::pair<double, double>> limits;
    char separator = 0;  // of several values in one word
    bool is_required = false, is_positive = false, takes_several = false;

    Parameter& required() { return is_required = true, *this; }
    Parameter& positive() { return is_positive = true, *this; }
    // One occurrence of the option takes all the words that follow.
    Parameter& several() { return takes_several = true, *this; }
    Parameter& separated_by(char c) { return separator = c, *this; }
    Parameter& one_of(std::vector<std::string> values) { return choices = std::move(values), *this; }
    Parameter& range(double low, double high) { return limits.emplace(low, high), *this; }
};

struct Command {
    std::string name, summary, footer;
    std::deque<Parameter> parameters;
    std::deque<Command> subcommands;  // one of them is required if there are any
    std::function<int()> action;      // returns the exit code

    // The targets must outlive the parsing.
    void flag(std::string names, bool& target, std::string meaning);
    Parameter& option(std::string names, Target target, std::string value, std::string meaning);
    Parameter& positional(std::string name, Target target, std::string meaning);
    Command& subcommand(std::string command, std::string what);

    // `arguments` lives as long as the grammar; `act` takes it.
    template <class Arguments>
    void bind(std::shared_ptr<Arguments> arguments, int (*act)(const Arguments&)) {
        action = [arguments, act] { return act(*arguments); };
    }
};

struct Grammar {
    static constexpr const char* kSummary =
        "Films a mechanism: JSON scenes of a flexible beam and a turning cam in; films, stills and data out.";

    std::deque<Command> commands;  // in the order of --help

    Command& command(std::string name, std::string summary);
};

}  // namespace beamcam::scenes
