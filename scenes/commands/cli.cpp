// The only file that sees CLI11.
#include "scenes/commands/cli.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <functional>
#include <iostream>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "output/files/interrupt.hpp"
#include "output/files/standard_output.hpp"
#include "output/film/video.hpp"
#include "output/json/source.hpp"
#include "output/json/tree.hpp"
#include "render/gl/renderer.hpp"
#include "scenes/commands/commands.hpp"
#include "scenes/format/absent.hpp"
#include "scenes/format/suggest.hpp"
#include "scenes/scene/version.hpp"

namespace beamcam::scenes {
namespace {

// Before the parser takes an unknown command for something else.
void reject_unknown_command(std::span<const char* const> words, const std::deque<Command>& commands) {
    if (commands.empty() || words.empty() || words.front()[0] == '-') return;
    const std::string word = words.front();
    std::vector<std::string> known;
    for (const Command& command : commands) known.push_back(command.name);
    const auto found = std::ranges::find(commands, word, &Command::name);
    if (found != commands.end()) return;
    if (word.ends_with(".json"))
        throw UsageError(fmt::format("there is no command before the scene; write beamcam run {}", word));
    const std::string remedy = absent_command(word);
    throw UsageError(fmt::format("unknown command {}{}", in_quotes(word),
                                 remedy.empty() ? suggestion_or_list(word, known) : remedy));
}

constexpr std::size_t kHelpColumns = 100;  // of the help

// The text with line breaks, so that its lines fit into `width` columns.
std::string wrapped(std::string_view text, std::size_t width) {
    std::string out;
    std::size_t column = 0;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find(' ', at), text.size());
        const std::string_view word = text.substr(at, end - at);
        if (column > 0 && column + 1 + word.size() > width) {
            out += '\n';
            column = 0;
        }
        if (column > 0) out += ' ';
        out += word;
        column += word.size() + (column > 0 ? 1 : 0);
        at = end + 1;
    }
    return out;
}

std::string exit_code_text() {
    std::string text = "Exit codes:";
    for (const auto& [code, meaning] : kExitCodes) text += fmt::format(" {} {},", int(code), meaning);
    text.back() = '.';
    return wrapped(text, kHelpColumns);
}

class HelpFormatter final : public CLI::Formatter {
  public:
    std::string make_option_desc(const CLI::Option* option) const override {
        return wrapped(option->get_description(), kHelpColumns - get_column_width());
    }
};

// The parsers of commands, and the options whose help is looked up only when it is printed.
struct Parsers {
    std::vector<std::pair<const CLI::App*, const Command*>> commands;
    std::vector<std::pair<CLI::Option*, const Parameter*>> key_options;
};

// Values separated by a character are several; throws UsageError for an empty one, as in "45deg,,3".
std::function<void(const std::vector<std::string>&)> splitter(const Parameter& parameter) {
    return [&parameter](const std::vector<std::string>& words) {
        auto& values = *std::get<std::vector<std::string>*>(parameter.storage);
        for (const std::string& word : words)
            for (std::string& value : split(word, parameter.separator)) {
                if (value.empty())
                    throw UsageError(fmt::format("{} {}: a value is empty; remove a \"{}\"", parameter.names, word,
                                                 parameter.separator));
                values.push_back(std::move(value));
            }
    };
}

void add_parameter(CLI::App& app, const Parameter& parameter, Parsers& parsers) {
    CLI::Option* option = std::visit(
        [&](const auto& storage) {
            using Stored = std::remove_cvref_t<decltype(storage)>;
            if constexpr (std::is_same_v<Stored, bool*>)
                return app.add_flag(parameter.names, *storage, parameter.meaning);
            else if constexpr (!std::is_pointer_v<Stored>)
                return app.add_option_function(parameter.names, storage, parameter.meaning)->type_name(parameter.value);
            else if (parameter.separator != 0)
                return app.add_option_function(parameter.names, splitter(parameter), parameter.meaning)
                    ->type_name(parameter.value);
            else
                return app.add_option(parameter.names, *storage, parameter.meaning)->type_name(parameter.value);
        },
        parameter.storage);
    option->required(parameter.is_required);
    if (!parameter.key.empty()) parsers.key_options.emplace_back(option, &parameter);
    if (!parameter.choices.empty()) option->check(CLI::IsMember(parameter.choices).description(""));
    if (!parameter.choices.empty()) option->description(help_of(parameter));
    if (parameter.problem) option->check(parameter.problem, "");
    if (parameter.limits) {
        const auto [low, high] = *parameter.limits;
        const bool whole = std::holds_alternative<int*>(parameter.storage);
        option->check((whole ? CLI::Range(static_cast<int>(low), static_cast<int>(high)) : CLI::Range(low, high))
                          .description(""));
        // Range lets NaN pass.
        const auto a_number = [](const std::string& word) {
            return std::isnan(std::strtod(word.c_str(), nullptr)) ? word + " is not a number" : "";
        };
        option->check(a_number, "");
        option->description(fmt::format("{} ({:g} to {:.10g})", parameter.meaning, low, high));
    }
    if (parameter.is_option() && !parameter.takes_several) option->allow_extra_args(false);
    if (!parameter.value_if_alone.empty())
        option->expected(0, CLI::detail::expected_max_vector_size)->default_str(parameter.value_if_alone);
}

void add_command(CLI::App& parent, const Command& command, Parsers& parsers) {
    CLI::App* app = parent.add_subcommand(command.name, command.summary);
    std::string footer = command.examples.empty() ? "" : "Examples:\n";
    for (const std::string& example : command.examples) footer += fmt::format("  beamcam {}\n", example);
    if (!command.footer.empty()) footer += fmt::format("{}{}\n", footer.empty() ? "" : "\n", command.footer);
    if (!footer.empty()) app->footer(fmt::format("{}\n{}", footer, exit_code_text()));  // else that of the program
    parsers.commands.emplace_back(app, &command);
    for (const Parameter& parameter : command.parameters) add_parameter(*app, parameter, parsers);
}

// Names the words that the command does not take; values of unknown options go without saying.
std::string unexpected_words(const std::vector<std::string>& words, const Command& command) {
    std::vector<std::string> known, named;
    for (const Parameter& parameter : command.parameters)
        if (parameter.is_option())
            for (std::string& name : split(parameter.names, ',')) known.push_back(std::move(name));
    for (const std::string& word : words) {
        if (!word.starts_with('-') || word == "-") continue;
        std::string remedy = absent_option(word);
        if (remedy.empty() && word.starts_with("--")) remedy = suggestion(word.substr(0, word.find('=')), known);
        named.push_back(fmt::format("unknown option {}{}", word, remedy));
    }
    return named.empty() ? fmt::format("unexpected argument {}", fmt::join(words, " "))
                         : fmt::format("{}", fmt::join(named, "; "));
}

int parse_and_run(int argc, const char* const* argv) {
    Grammar grammar;
    for (const auto add : kCommands) add(grammar);
    reject_unknown_command({argv + std::min(argc, 1), argv + argc}, grammar.commands);

    CLI::App app(Grammar::kSummary, "beamcam");
    app.formatter(std::make_shared<HelpFormatter>());
    app.set_version_flag("--version", fmt::format("beamcam {}", kVersion), "Print the version");
    app.set_help_flag("-h,--help", "Print this help");
    app.require_subcommand(1);
    app.footer(exit_code_text());
    Parsers parsers;
    for (const Command& command : grammar.commands) add_command(app, command, parsers);
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& success) {  // --help, --version
        if (dynamic_cast<const CLI::CallForHelp*>(&success))
            for (const auto& [option, parameter] : parsers.key_options) option->description(help_of(*parameter));
        app.exit(success, std::cout, std::cerr);
        output::flush_data();
        return kDone;
    } catch (const CLI::ParseError& error) {
        std::string name, what = error.what();
        for (const auto& [parser, command] : parsers.commands) {
            if (!parser->parsed()) continue;
            name += " " + command->name;
            if (dynamic_cast<const CLI::ExtrasError*>(&error)) what = unexpected_words(app.remaining(true), *command);
        }
        throw UsageError(fmt::format("{} (see beamcam{} --help)", what, name));
    }
    for (const auto& [parser, command] : parsers.commands)
        if (parser->parsed() && command->action) return command->action();
    return kDone;
}

}  // namespace

int command_line(int argc, const char* const* argv) {
    try {
        output::install_handlers();
        output::install_crash_handlers(kInputOutput);
        render::ignored_gl_settings();  // the environment may be changed while there is one thread
        return parse_and_run(argc, argv);
    } catch (const std::exception& e) {
        return report(e);
    } catch (...) {
        output::print_message(
            "beamcam: internal error of unknown kind; please report it with the scene and the command\n");
        return kBug;
    }
}

}  // namespace beamcam::scenes
