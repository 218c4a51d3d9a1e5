#include "scenes/commands/grammar.hpp"

namespace beamcam::scenes {
namespace {

Parameter& add(std::deque<Parameter>& parameters, std::string names, Target target, std::string value,
               std::string meaning) {
    Parameter& parameter = parameters.emplace_back();
    parameter.names = std::move(names);
    parameter.target = target;
    parameter.value = std::move(value);
    parameter.meaning = std::move(meaning);
    return parameter;
}

Command& add(std::deque<Command>& commands, std::string name, std::string summary) {
    Command& command = commands.emplace_back();
    command.name = std::move(name);
    command.summary = std::move(summary);
    return command;
}

}  // namespace

void Command::flag(std::string names, bool& target, std::string meaning) {
    add(parameters, std::move(names), &target, "", std::move(meaning));
}
Parameter& Command::option(std::string names, Target target, std::string value, std::string meaning) {
    return add(parameters, std::move(names), target, std::move(value), std::move(meaning));
}
Parameter& Command::positional(std::string positional_name, Target target, std::string meaning) {
    return add(parameters, std::move(positional_name), target, "", std::move(meaning));
}
Command& Command::subcommand(std::string command, std::string what) {
    return add(subcommands, std::move(command), std::move(what));
}
Command& Grammar::command(std::string name, std::string summary) {
    return add(commands, std::move(name), std::move(summary));
}

}  // namespace beamcam::scenes
