// `beamcam completion`: the completion of a command line by the grammar, and the scripts by which shells call it.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/commands/commands.hpp"
#include "scenes/figures/figure_types.hpp"
#include "scenes/format/description.hpp"
#include "scenes/format/embedded.hpp"
#include "scenes/format/presets.hpp"
#include "sim/observe/channels.hpp"

namespace beamcam::scenes {
namespace {

struct CompletionArguments {
    std::string shell;
    std::vector<std::string> words;
    const Grammar* grammar = nullptr;
};

// Each asks the program for the candidates of the last word: a line "words", "open" (a word goes on without a blank) or
// "files" (the shell knows them), then a candidate a line.
const std::map<std::string_view, const char*> kScripts{
    {"bash", R"(# bash completion of beamcam, printed by `beamcam completion bash`
_beamcam() {
    mapfile -t COMPREPLY < <("$1" completion bash -- "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null)
    case ${COMPREPLY[0]} in
        files) compopt -o filenames 2>/dev/null; mapfile -t -O 1 COMPREPLY < <(compgen -f -- "$2") ;;
        open) compopt -o nospace 2>/dev/null ;;
    esac
    unset 'COMPREPLY[0]'
}
complete -F _beamcam beamcam
)"},
    {"zsh", R"(#compdef beamcam
# zsh completion of beamcam, printed by `beamcam completion zsh`
_beamcam() {
    local -a answer=("${(@f)$(${~words[1]} completion zsh -- "${(@Q)words[2,CURRENT]}" 2>/dev/null)}")
    local kind=$answer[1]
    shift answer
    case $kind in
        files) _files ;;
        open) _describe beamcam answer -S '' ;;
        words) _describe beamcam answer ;;
    esac
}
if [ "$funcstack[1]" = _beamcam ]; then _beamcam "$@"; else compdef _beamcam beamcam; fi
)"},
    {"fish", R"(# fish completion of beamcam, printed by `beamcam completion fish`
function __beamcam_complete
    set -l words (commandline -opc)
    set -l answer ($words[1] completion fish -- $words[2..-1] (commandline -ct) 2>/dev/null)
    if test "$answer[1]" = files
        __fish_complete_path (commandline -ct)
    else
        printf '%s\n' $answer[2..-1]
    end
end
complete -c beamcam -f -a '(__beamcam_complete)'
)"}};

struct Candidates {
    const char* kind = "words";
    std::map<std::string, std::string> words;  // with their meanings

    void add(const std::vector<std::string>& more) {
        for (const std::string& word : more) words.emplace(word, "");
    }
    // Keys of a scene that belong to no element of a list.
    void add_keys(const char* ending) {
        for (const KeyRow& row : key_rows())
            if (row.path.find('[') == std::string::npos) words.emplace(row.path + ending, row.key->meaning);
    }
};

// `word`: the part of the value that is there.
Candidates values_of(const Parameter& parameter, std::string_view word) {
    const std::string& placeholder = parameter.value.empty() ? parameter.names : parameter.value;
    Candidates out;
    out.add(words_of(parameter));
    if (placeholder == "CHANNEL,...") {
        const std::string before(word.substr(0, word.find_last_of(',') + 1));
        for (const sim::Channel& channel : sim::all_channels({})) out.words.emplace(before + sim::name(channel), "");
        out.kind = "open";
    } else if (placeholder.starts_with("KEY=")) {
        out.add_keys("=");
        out.kind = "open";
    } else if (placeholder == "PATTERN") {
        out.add_keys("");
    } else if (placeholder == "FIGURE") {
        out.add(names_of_figures_and_presets());
    } else if (placeholder == "EXAMPLE") {
        for (const EmbeddedText& scene : embedded_scenes()) out.words.emplace(scene.name, "");
    }
    constexpr std::string_view kFiles[] = {"FILE",   "DIR",  "SCENE", "OTHERS", "BASELINES", "SEGMENT",
                                           "REPORT", "FILM", "PART",  "A",      "B"};
    if (out.words.empty() && std::ranges::find(kFiles, placeholder) != std::end(kFiles)) out.kind = "files";
    return out;
}

// "-o,--output" as two words.
std::vector<std::string> spellings(const Parameter& parameter) {
    const std::size_t comma = parameter.names.find(',');
    if (comma == std::string::npos) return {parameter.names};
    return {parameter.names.substr(0, comma), parameter.names.substr(comma + 1)};
}

Candidates options_of(const Command& command) {
    Candidates out{.words = {{"--help", "Print this help"}}};
    for (const Parameter& parameter : command.parameters)
        if (parameter.is_option())
            for (const std::string& spelling : spellings(parameter)) out.words.emplace(spelling, help_of(parameter));
    return out;
}

Candidates names_of(const std::deque<Command>& commands) {
    Candidates out;
    for (const Command& command : commands) out.words.emplace(command.name, command.summary);
    return out;
}

// Of the word after `before`: the value of the option before it, or the argument at its place.
Candidates of_command(const Command& command, std::span<const std::string> before, const std::string& word) {
    std::vector<const Parameter*> places;
    for (const Parameter& parameter : command.parameters)
        if (!parameter.is_option()) places.push_back(&parameter);
    const Parameter* option = nullptr;  // that takes the next word
    std::size_t place = 0;
    for (const std::string& each : before) {
        const auto is_it = [&](const Parameter& p) { return std::ranges::count(spellings(p), each) > 0; };
        const auto named = std::ranges::find_if(command.parameters, is_it);
        place += !option && !each.starts_with('-');
        option = !option && named != command.parameters.end() && !named->value.empty() ? &*named : nullptr;
    }
    if (option) return values_of(*option, word);
    if (word.starts_with('-')) return options_of(command);
    return places.empty() ? Candidates{} : values_of(*places[std::min(place, places.size() - 1)], word);
}

Candidates candidates(const Grammar& grammar, std::span<const std::string> words) {
    if (words.size() == 1) {
        Candidates out = names_of(grammar.commands);
        out.add({"--help", "--version"});
        return out;
    }
    const auto command = std::ranges::find(grammar.commands, words.front(), &Command::name);
    if (command == grammar.commands.end()) return {};
    return of_command(*command, words.subspan(1, words.size() - 2), words.back());
}

void act(const CompletionArguments& args) {
    if (args.words.empty()) return print_data(kScripts.at(args.shell));
    const Candidates all = candidates(*args.grammar, args.words);
    std::string text = fmt::format("{}\n", all.kind);
    for (const auto& [word, meaning] : all.words)
        if (word.starts_with(args.words.back()))
            text += args.shell == "bash" || meaning.empty()
                        ? fmt::format("{}\n", word)
                        : fmt::format("{}{}{}\n", word, args.shell == "zsh" ? ':' : '\t', meaning);
    print_data(text);
}

}  // namespace

void add_completion(Grammar& grammar) {
    const auto [app, args] =
        grammar.command<CompletionArguments>("completion", "Print the completion script for a shell", act);
    args.grammar = &grammar;
    app.examples = {"completion bash > ~/.local/share/bash-completion/completions/beamcam"};
    app.positional("SHELL", &args.shell, "The shell").required().one_of({"bash", "zsh", "fish"});
    app.positional("WORD", &args.words, "Words of a command line, after --: print what completes the last one instead");
}

}  // namespace beamcam::scenes
