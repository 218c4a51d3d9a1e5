// `beamcam completion`: the scripts by which shells complete commands, their options and the names of files.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

#include "scenes/commands/commands.hpp"

namespace beamcam::scenes {
namespace {

struct CompletionArguments {
    std::string shell;
    const Program* program = nullptr;
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
std::string names_of_options(const CLI::App& command) {
    std::string words = "--help";
    for (const CLI::Option* option : options_of(command))
        if (!option->get_positional()) words += " " + option->get_name(false, true);
    std::ranges::replace(words, ',', ' ');
    return words;
}

// The cases of _beamcam_list. `line`: the case of a command, and what it prints.
std::string cases_of(const Program& program, const char* line) {
    std::string text, all = "--help --version";
    for (const CLI::App* command : commands_of(program)) {
        text += fmt::format(fmt::runtime(line), command->get_name(), names_of_options(*command));
        all += " " + command->get_name();
    }
    return text + fmt::format(fmt::runtime(line), "''", all);
}

void act(const CompletionArguments& args) {
    const std::string head =
        fmt::format("# {0} completion of beamcam, printed by `beamcam completion {0}`\n", args.shell);
    if (args.shell == "fish")
        return print_data(head + "function _beamcam_list\n    switch \"$argv\"\n" +
                          cases_of(*args.program, "        case {}; printf '%s\\n' {}\n") + "    end\nend\n" + kFish);
    print_data((args.shell == "zsh" ? "#compdef beamcam\n" : "") + head + "_beamcam_list() {\n    case $1 in\n" +
               cases_of(*args.program, "        {}) printf '%s\\n' {} ;;\n") + "    esac\n}\n" +
               (args.shell == "zsh" ? kZsh : kBash));
}

}  // namespace

void add_completion(Program& program) {
    const auto [app, args] =
        add_command<CompletionArguments>(program, "completion", "Print the completion script for a shell", act);
    args.program = &program;
    add_examples(app, {"completion bash > ~/.local/share/bash-completion/completions/beamcam"});
    one_of(app.add_option("SHELL", args.shell, "The shell")->required(), {"bash", "zsh", "fish"});
}

}  // namespace beamcam::scenes
