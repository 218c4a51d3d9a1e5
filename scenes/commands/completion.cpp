// `beamcam completion`: the scripts by which shells complete commands, their options and the names of files.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <vector>

#include "scenes/commands/commands.hpp"

namespace beamcam::scenes {
namespace {

struct CompletionArguments {
    std::string shell;
    const Grammar* grammar = nullptr;
};

// These call _beamcam_list, which prints the options of the command $1, or all commands without $1.
constexpr const char* kBash = R"sh(_beamcam() {
    if [ "$COMP_CWORD" = 1 ]; then
        mapfile -t COMPREPLY < <(compgen -W "$(_beamcam_list)" -- "$2")
    elif [[ $2 == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$(_beamcam_list "${COMP_WORDS[1]}")" -- "$2")
    else
        compopt -o filenames 2>/dev/null
        mapfile -t COMPREPLY < <(compgen -f -- "$2")
    fi
}
complete -F _beamcam beamcam
)sh";

constexpr const char* kZsh = R"sh(_beamcam() {
    if (( CURRENT == 2 )); then
        compadd -- $(_beamcam_list)
    elif [[ $PREFIX == -* ]]; then
        compadd -- $(_beamcam_list $words[2])
    else
        _files
    fi
}
if [ "$funcstack[1]" = _beamcam ]; then _beamcam "$@"; else compdef _beamcam beamcam; fi
)sh";

constexpr const char* kFish = R"sh(function _beamcam_complete
    set -l words (commandline -opc)
    if test (count $words) = 1
        _beamcam_list
    else if string match -q -- '-*' (commandline -ct)
        _beamcam_list $words[2]
    else
        __fish_complete_path (commandline -ct)
    end
end
complete -c beamcam -f -a '(_beamcam_complete)'
)sh";

// "--help -o --output": the options of a command.
std::string options_of(const Command& command) {
    std::string words = "--help";
    for (const Parameter& parameter : command.parameters)
        if (parameter.is_option()) words += " " + parameter.names;
    for (char& c : words)
        if (c == ',') c = ' ';
    return words;
}

// The cases of _beamcam_list. `line`: the case of a command, and what it prints.
std::string cases_of(const Grammar& grammar, const char* line) {
    std::string text, all = "--help --version";
    for (const Command& command : grammar.commands) {
        text += fmt::format(fmt::runtime(line), command.name, options_of(command));
        all += " " + command.name;
    }
    return text + fmt::format(fmt::runtime(line), "''", all);
}

void act(const CompletionArguments& args) {
    const std::string head =
        fmt::format("# {0} completion of beamcam, printed by `beamcam completion {0}`\n", args.shell);
    if (args.shell == "fish")
        return print_data(head + "function _beamcam_list\n    switch \"$argv\"\n" +
                          cases_of(*args.grammar, "        case {}; printf '%s\\n' {}\n") + "    end\nend\n" + kFish);
    print_data((args.shell == "zsh" ? "#compdef beamcam\n" : "") + head + "_beamcam_list() {\n    case $1 in\n" +
               cases_of(*args.grammar, "        {}) printf '%s\\n' {} ;;\n") + "    esac\n}\n" +
               (args.shell == "zsh" ? kZsh : kBash));
}

}  // namespace

void add_completion(Grammar& grammar) {
    const auto [app, args] =
        grammar.command<CompletionArguments>("completion", "Print the completion script for a shell", act);
    args.grammar = &grammar;
    app.examples = {"completion bash > ~/.local/share/bash-completion/completions/beamcam"};
    app.positional("SHELL", &args.shell, "The shell").required().one_of({"bash", "zsh", "fish"});
}

}  // namespace beamcam::scenes
