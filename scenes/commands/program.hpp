// The command line, parsed by CLI11: each command adds its options to the program once.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <initializer_list>
#include <map>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "sim/base/named.hpp"

namespace beamcam::scenes {

// Prints the help of options. That of an option for a key of an output is the key's meaning, which is looked up only
// here: to describe all keys takes as long as the program's start.
class HelpFormatter final : public CLI::Formatter {
  public:
    void explain(const CLI::Option* option, std::function<std::string()> meaning) {
        meanings_[option] = std::move(meaning);
    }
    std::string make_option_desc(const CLI::Option* option) const override;

  private:
    std::map<const CLI::Option*, std::function<std::string()>> meanings_;
};

struct Program {
    Program();

    CLI::App app;
    std::shared_ptr<HelpFormatter> help;
    std::function<int()> action;  // of the command that was parsed; returns the exit code
};

// The text with line breaks for the columns of the help.
std::string wrapped(const std::string& text, std::size_t columns);
inline constexpr std::size_t kHelpColumns = 100;

// The commands in the order of --help.
std::vector<const CLI::App*> commands_of(const Program& program);
// The options and positional arguments of a command, without --help.
std::vector<const CLI::Option*> options_of(const CLI::App& app);

// A command, and its arguments, in which its options store their values.
template <class Arguments>
struct AddedCommand {
    CLI::App& app;
    Arguments& arguments;
};
// `act` returns the exit code, or nothing: then the code is 0.
template <class Arguments, class Code>
AddedCommand<Arguments> add_command(Program& program, const std::string& name, const std::string& summary,
                                    Code (*act)(const Arguments&)) {
    const auto arguments = std::make_shared<Arguments>();
    CLI::App& app = *program.app.add_subcommand(name, summary);
    app.callback([&program, arguments, act] {
        program.action = [arguments, act] {
            if constexpr (std::is_void_v<Code>)
                return act(*arguments), 0;
            else
                return act(*arguments);
        };
    });
    return {app, *arguments};
}
// Below the options: command lines after "beamcam", then a note.
void add_examples(CLI::App& app, std::initializer_list<const char*> examples);
void add_note(CLI::App& app, const std::string& note);

// Why the word after an option is not its value: "-o" after "--theme"; empty: it may be.
std::string missing_value(const std::string& word);

// An option with one value, which a vector collects where the option is repeated.
template <class Value>
CLI::Option* add_option(CLI::App& app, const std::string& names, Value& value, const std::string& placeholder,
                        const std::string& meaning) {
    return app.add_option(names, value, meaning)
        ->type_name(placeholder)
        ->allow_extra_args(false)
        ->check(missing_value, "");
}
// Values that are separated by commas; an empty one, as in "45deg,,3", is an error.
CLI::Option* add_list(CLI::App& app, const std::string& names, std::vector<std::string>& values,
                      const std::string& placeholder, const std::string& meaning);
CLI::Option* one_of(CLI::Option* option, const std::vector<std::string>& words);
// An option whose words are the names of an enumeration.
template <class Enum, std::size_t n>
CLI::Option* add_choice(CLI::App& app, const std::string& names, Enum& value, const sim::Named<Enum> (&words)[n],
                        const std::string& placeholder, const std::string& meaning) {
    std::vector<std::string> allowed;
    for (const sim::Named<Enum>& each : words) allowed.emplace_back(each.name);
    const auto store = [&value, &words](const std::string& word) {
        value = std::ranges::find(words, word, &sim::Named<Enum>::name)->value;
    };
    return one_of(app.add_option_function<std::string>(names, store, meaning)->type_name(placeholder), allowed);
}
template <class Number>
CLI::Option* within(CLI::Option* option, Number low, Number high) {
    // Range lets NaN pass.
    option->check(
        [](const std::string& word) {
            return std::isnan(std::strtod(word.c_str(), nullptr)) ? word + " is not a number" : "";
        },
        "");
    option->check(CLI::Range(low, high).description(""));
    return option->description(
        fmt::format("{} ({:g} to {:.10g})", option->get_description(), double(low), double(high)));
}

}  // namespace beamcam::scenes
