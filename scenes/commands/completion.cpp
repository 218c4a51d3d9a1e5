// `beamcam completion`: completion scripts for shells, made from the grammar.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

#include "scenes/commands/commands.hpp"
#include "scenes/figures/figure_types.hpp"
#include "scenes/format/description.hpp"
#include "scenes/format/embedded.hpp"
#include "sim/observe/channels.hpp"

namespace beamcam::scenes {
namespace {

using Names = std::vector<std::string>;

struct CompletionArguments {
    std::string shell;
    const Grammar* grammar = nullptr;
};

// The words that complete a value.
struct Completion {
    Names words;
    bool files = false;
    bool in_list = false;  // several words with commas between them
    bool open = false;     // the word goes on without a blank
};

Names channel_names() {
    Names names;
    for (const sim::Channel& channel : sim::all_channels({})) names.push_back(sim::name(channel));
    return names;
}

// Of keys of a scene, each with this ending.
Names key_names(const char* ending) {
    Names names;
    for (const KeyRow& row : key_rows()) {
        const std::string name = row.path + ending;
        if (row.path.find('[') == std::string::npos && std::ranges::find(names, name) == names.end())
            names.push_back(name);
    }
    return names;
}

Completion completion_of(const Parameter& parameter) {
    const std::string& placeholder = parameter.value.empty() ? parameter.names : parameter.value;
    Completion out;
    out.words = words_of(parameter);
    if (placeholder == "CHANNEL,...") {
        out.words = channel_names();
        out.in_list = true;
    } else if (placeholder == "KEY=VALUE" || placeholder == "KEY=VALUES" || placeholder == "KEY=FROM:TO") {
        out.words = key_names("=");
        out.open = true;
    } else if (placeholder == "PATTERN") {
        out.words = key_names("");
    } else if (placeholder == "FIGURE") {
        out.words = figure_names();
    } else if (placeholder == "EXAMPLE") {
        for (const EmbeddedScene& scene : embedded_scenes()) out.words.emplace_back(scene.name);
    }
    constexpr std::string_view kFiles[] = {"FILE",   "DIR",  "SCENE", "OTHERS", "BASELINES", "SEGMENT",
                                           "REPORT", "FILM", "PART",  "A",      "B"};
    out.files = out.words.empty() && std::ranges::find(kFiles, placeholder) != std::end(kFiles);
    return out;
}

bool takes_value(const Parameter& parameter) { return parameter.is_option() && !parameter.value.empty(); }

// "-o,--output" as two words.
Names spellings(const Parameter& parameter) {
    const std::size_t comma = parameter.names.find(',');
    if (comma == std::string::npos) return {parameter.names};
    return {parameter.names.substr(0, comma), parameter.names.substr(comma + 1)};
}

Names names_of(const std::deque<Command>& commands) {
    Names names;
    for (const Command& command : commands) names.push_back(command.name);
    return names;
}

// ---- bash ------------------------------------------------------------------------------------------

std::string bash_words(const Completion& c) {
    if (c.files) return "_beamcam_files";
    return fmt::format("{} '{}'",
                       c.in_list ? "_beamcam_list"
                       : c.open  ? "_beamcam_open"
                                 : "_beamcam_words",
                       fmt::join(c.words, " "));
}

std::string bash_command(const Command& command) {
    Names options{"--help"};
    std::string values, positional;
    for (const Parameter& parameter : command.parameters) {
        const Completion completion = completion_of(parameter);
        if (!parameter.is_option()) {
            // The candidates of all arguments are offered together: after `figure`, files and names of figures.
            if (completion.files || !completion.words.empty())
                positional += fmt::format("            {}\n", bash_words(completion));
            continue;
        }
        for (const std::string& spelling : spellings(parameter)) options.push_back(spelling);
        if (takes_value(parameter))
            values += fmt::format("                {}) {}; return ;;\n", fmt::join(spellings(parameter), "|"),
                                  completion.files || !completion.words.empty() ? bash_words(completion) : ":");
    }
    if (!command.subcommands.empty())
        positional += fmt::format("            _beamcam_words '{}'\n", fmt::join(names_of(command.subcommands), " "));
    return fmt::format(
        "        {})\n            case $before in\n{}            esac\n"
        "            case $cur in -*) _beamcam_words '{}'; return ;; esac\n{}            ;;\n",
        command.name, values, fmt::join(options, " "), positional);
}

std::string bash_script(const Grammar& grammar) {
    std::string commands;
    for (const Command& command : grammar.commands) commands += bash_command(command);
    return fmt::format(R"(# bash completion of beamcam, printed by `beamcam completion bash`
_beamcam_words() {{ mapfile -t -O "${{#COMPREPLY[@]}}" COMPREPLY < <(compgen -W "$1" -- "$cur"); }}
_beamcam_open() {{ compopt -o nospace 2>/dev/null; _beamcam_words "$1"; }}
_beamcam_files() {{ compopt -o filenames 2>/dev/null; mapfile -t -O "${{#COMPREPLY[@]}}" COMPREPLY < <(compgen -f -- "$cur"); }}
_beamcam_list() {{
    compopt -o nospace 2>/dev/null
    local last=${{cur##*,}}
    mapfile -t COMPREPLY < <(compgen -P "${{cur%"$last"}}" -W "$1" -- "$last")
}}
_beamcam() {{
    local cur=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}}
    COMPREPLY=()
    if [ "$COMP_CWORD" -eq 1 ]; then
        _beamcam_words '{} --help --version'
        return
    fi
    case ${{COMP_WORDS[1]}} in
{}    esac
}}
complete -F _beamcam beamcam
)",
                       fmt::join(names_of(grammar.commands), " "), commands);
}

// ---- zsh -------------------------------------------------------------------------------------------

std::string quoted_for_zsh(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '\'')
            out += "'\\''";
        else if (c == '[' || c == ']' || c == ':' || c == '\\')
            out += fmt::format("\\{}", c);
        else
            out += c;
    }
    return out;
}

std::string zsh_values(const Completion& c) {
    if (c.files) return "_files";
    if (c.words.empty()) return " ";
    if (c.in_list) return fmt::format("_values -s , word {}", fmt::join(c.words, " "));
    if (c.open) return fmt::format("compadd -S \"\" -- {}", fmt::join(c.words, " "));
    return fmt::format("({})", fmt::join(c.words, " "));
}

std::string zsh_command(const Command& command) {
    std::string lines;
    const auto arguments = std::ranges::count_if(command.parameters, [](const Parameter& p) { return !p.is_option(); });
    int place = 0;
    for (const Parameter& parameter : command.parameters) {
        const std::string meaning = quoted_for_zsh(help_of(parameter)), values = zsh_values(completion_of(parameter));
        if (!parameter.is_option()) {
            // The last argument may be repeated; zsh accepts only one of that kind.
            const std::string which = ++place < arguments ? std::to_string(place) : "*";
            lines += fmt::format(" \\\n                '{}:{}:{}'", which, parameter.names, values);
            continue;
        }
        for (const std::string& spelling : spellings(parameter))
            lines += fmt::format(" \\\n                '*{}[{}]{}'", spelling, meaning,
                                 takes_value(parameter) ? fmt::format(":value:{}", values) : "");
    }
    if (!command.subcommands.empty())
        lines += fmt::format(" \\\n                '1:what:({})'", fmt::join(names_of(command.subcommands), " "));
    return fmt::format("        {})\n            _arguments{} ;;\n", command.name, lines);
}

std::string zsh_script(const Grammar& grammar) {
    std::string commands, names;
    for (const Command& command : grammar.commands) {
        commands += zsh_command(command);
        names += fmt::format("        '{}:{}'\n", command.name, quoted_for_zsh(command.summary));
    }
    return fmt::format(R"(#compdef beamcam
# zsh completion of beamcam, printed by `beamcam completion zsh`
_beamcam() {{
    local -a commands
    commands=(
{}    )
    if (( CURRENT == 2 )); then
        _describe command commands
        return
    fi
    shift words
    (( CURRENT-- ))
    case $words[1] in
{}    esac
}}
_beamcam "$@"
)",
                       names, commands);
}

// ---- fish ------------------------------------------------------------------------------------------

std::string quoted_for_fish(const std::string& text) {
    std::string out = "'";
    for (const char c : text) {
        if (c == '\'' || c == '\\') out += '\\';
        out += c;
    }
    return out + "'";
}

std::string fish_parameter(const Command& command, const Parameter& parameter) {
    const Completion completion = completion_of(parameter);
    std::string line = fmt::format("complete -c beamcam -n '__fish_seen_subcommand_from {}'", command.name);
    if (parameter.is_option()) {
        for (const std::string& spelling : spellings(parameter))
            line += spelling.starts_with("--") ? fmt::format(" -l {}", spelling.substr(2))
                                               : fmt::format(" -s {}", spelling.substr(1));
        if (takes_value(parameter)) line += completion.files ? " -r -F" : " -x";
        line += fmt::format(" -d {}", quoted_for_fish(help_of(parameter)));
    } else if (completion.files) {
        line += " -F";
    } else if (completion.words.empty()) {
        return "";
    }
    if (completion.in_list)
        line += fmt::format(" -a '(__fish_complete_list , \"string split , {}\")'", fmt::join(completion.words, ","));
    else if (!completion.words.empty())
        line += fmt::format(" -a '{}'", fmt::join(completion.words, " "));
    return line + "\n";
}

std::string fish_script(const Grammar& grammar) {
    std::string text = "# fish completion of beamcam, printed by `beamcam completion fish`\ncomplete -c beamcam -f\n";
    for (const Command& command : grammar.commands) {
        text += fmt::format("complete -c beamcam -n __fish_use_subcommand -a {} -d {}\n", command.name,
                            quoted_for_fish(command.summary));
        for (const Parameter& parameter : command.parameters) text += fish_parameter(command, parameter);
        for (const Command& subcommand : command.subcommands)
            text += fmt::format("complete -c beamcam -n '__fish_seen_subcommand_from {}' -a {} -d {}\n", command.name,
                                subcommand.name, quoted_for_fish(subcommand.summary));
    }
    return text;
}

void act(const CompletionArguments& args) {
    print_data(args.shell == "bash"  ? bash_script(*args.grammar)
               : args.shell == "zsh" ? zsh_script(*args.grammar)
                                     : fish_script(*args.grammar));
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
